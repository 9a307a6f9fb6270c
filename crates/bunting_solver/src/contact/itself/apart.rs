//! Planes that keep two triangles apart over a substep.

use glam::Vec3;

use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::region::Swept;

/// A cloth that may touch itself.
#[derive(Clone, Copy)]
pub(super) struct Cloth<'a> {
    pub mesh: &'a ContactMesh,
    pub particles: &'a Particles,
    /// Distance of layers, m.
    pub thickness: f32,
}

impl Cloth<'_> {
    /// Positions of some particles at the start and at the end, m.
    pub fn positions<const COUNT: usize>(&self, of: [u32; COUNT]) -> [[Vec3; COUNT]; 2] {
        let Particles { start, end, .. } = self.particles;
        [of.map(|particle| start[particle as usize]), of.map(|particle| end[particle as usize])]
    }

    /// Boxes around the paths of some particles.
    pub fn swept<const COUNT: usize>(&self, of: [u32; COUNT]) -> Swept {
        let [start, end] = self.positions(of);
        Swept::around(start, end, 0.0)
    }

    /// Whether two triangles may touch: they have at most one corner in common, and no plane keeps them apart.
    pub fn may_touch(&self, triangles: [u32; 2]) -> bool {
        let corners = triangles.map(|triangle| self.mesh.triangles[triangle as usize]);
        let mut common = corners[0].iter().filter(|&corner| corners[1].contains(corner));
        match (common.next(), common.next()) {
            (None, _) => {
                let [one, other] = corners.map(|corners| self.positions(corners));
                let are_apart = (0..2).all(|at: usize| self.are_apart([one[at], other[at]]));
                let is_beside = self.is_beside(one, other) || self.is_beside(other, one);
                !(are_apart || is_beside)
            }
            (Some(&corner), None) => !self.are_apart_around(corner, corners),
            _ => false,
        }
    }

    /// Whether a plane between the middles of two triangles keeps them farther than the thickness from each other.
    fn are_apart(&self, [one, other]: [[Vec3; 3]; 2]) -> bool {
        let axis = one[0] + one[1] + one[2] - other[0] - other[1] - other[2];
        let gap = least(one.map(|at| axis.dot(at))) - greatest(other.map(|at| axis.dot(at)));
        gap > 0.0 && gap * gap > self.thickness * self.thickness * axis.length_squared()
    }

    /// Whether a triangle's plane keeps it farther than the thickness from another triangle, on the same side at the start
    /// and at the end.
    fn is_beside(&self, one: [[Vec3; 3]; 2], other: [[Vec3; 3]; 2]) -> bool {
        let side = |[a, b, c]: [Vec3; 3], other: [Vec3; 3]| {
            let normal = (b - a).cross(c - a);
            let heights = other.map(|corner| normal.dot(corner - a));
            let far = self.thickness * self.thickness * normal.length_squared();
            let (least, greatest) = (least(heights), greatest(heights));
            let is_far = |height: f32| height * height > far;
            match () {
                () if least > 0.0 && is_far(least) => 1,
                () if greatest < 0.0 && is_far(greatest) => -1,
                () => 0,
            }
        };
        let end = side(one[1], other[1]);
        end != 0 && end == side(one[0], other[0])
    }

    /// Whether a plane through a common corner keeps two triangles apart.
    fn are_apart_around(&self, corner: u32, triangles: [[u32; 3]; 2]) -> bool {
        let others = triangles.map(|[a, b, c]| match corner {
            _ if corner == a => [b, c],
            _ if corner == b => [c, a],
            _ => [a, b],
        });
        let Particles { start, end, .. } = self.particles;
        [start, end].into_iter().all(|at| {
            let from = at[corner as usize];
            let [one, other] = others.map(|it| it.map(|end| at[end as usize] - from));
            let axis = one[0] + one[1] - other[0] - other[1];
            one.iter().all(|side| axis.dot(*side) > 0.0)
                && other.iter().all(|side| axis.dot(*side) < 0.0)
        })
    }
}

fn least([a, b, c]: [f32; 3]) -> f32 {
    a.min(b).min(c)
}

fn greatest([a, b, c]: [f32; 3]) -> f32 {
    a.max(b).max(c)
}
