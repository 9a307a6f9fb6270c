//! Walks over a surface from triangle to triangle.

use glam::DVec3;

use super::triangle::nearest;
use crate::fabric::faces::Faces;

/// Walks over the triangles of a mesh, with what is remembered from one to the next.
pub(super) struct Walks<'a> {
    faces: &'a Faces<'a>,
    /// Of each triangle the walk that reached it last.
    reached_by: Vec<u32>,
    /// Number of walks so far.
    count: u32,
    /// The triangles that the walk has reached, those of the fewest steps first.
    reached: Vec<u32>,
}

impl<'a> Walks<'a> {
    pub fn on(faces: &'a Faces<'a>) -> Self {
        Self { faces, reached_by: vec![0; faces.count()], count: 0, reached: Vec::new() }
    }

    /// Visits the triangles that are reached from one through triangles nearer to a place than a distance, m, until `ends` is true
    /// of one; returns whether it was of any.
    pub fn any_within(
        &mut self,
        (start, at): (u32, DVec3),
        distance: f64,
        mut ends: impl FnMut(u32) -> bool,
    ) -> bool {
        self.count += 1;
        self.reached.clear();
        self.reach(start);
        let mut next = 0;
        while let Some(&triangle) = self.reached.get(next) {
            if ends(triangle) {
                return true;
            }
            next += 1;
            for other in self.faces.neighbours(triangle) {
                let is_near = || {
                    let corners = self.faces.corners(other).map(|corner| corner.as_dvec3());
                    let near = |point: DVec3| point.distance_squared(at) < distance * distance;
                    corners.into_iter().any(near) || near(nearest(at, corners))
                };
                if self.reached_by[other as usize] != self.count && is_near() {
                    self.reach(other);
                }
            }
        }
        false
    }

    fn reach(&mut self, triangle: u32) {
        self.reached_by[triangle as usize] = self.count;
        self.reached.push(triangle);
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::Walks;
    use crate::fabric::faces::Faces;
    use crate::fabric::topology;

    /// Cells of a strip that is folded in the middle, so that its halves lie on one another.
    const CELLS: u32 = 20;

    #[test]
    fn a_walk_stays_on_the_surface_and_within_the_distance() {
        let place = |row: u32, column: u32| {
            let along = 0.1 * row.min(CELLS - row) as f32;
            Vec3::new(along, 0.1 * column as f32, if row > CELLS / 2 { 0.001 } else { 0.0 })
        };
        let positions: Vec<Vec3> =
            (0..=CELLS).flat_map(|row| [place(row, 0), place(row, 1)]).collect();
        let halves = |row: u32| {
            let first = 2 * row;
            [[first, first + 1, first + 2], [first + 2, first + 1, first + 3]]
        };
        let triangles: Vec<[u32; 3]> = (0..CELLS).flat_map(halves).collect();
        let edges = topology::edges(&triangles).expect("a surface");
        let faces = Faces::new(&positions, &triangles, &edges);
        let mut walks = Walks::on(&faces);
        let start = (0, DVec3::new(0.0, 0.05, 0.0));
        for _ in 0..2 {
            let mut reached = Vec::new();
            let ended = walks.any_within(start, 0.32, |triangle| {
                reached.push(triangle);
                false
            });
            // The two triangles of the fourth cell begin .3 m away; the other half of the strip is as near through the air.
            reached.sort_unstable();
            assert!(!ended && reached == [0, 1, 2, 3, 4, 5, 6, 7], "{reached:?}");
        }
        assert!(walks.any_within(start, 0.32, |triangle| triangle == 3));
    }
}
