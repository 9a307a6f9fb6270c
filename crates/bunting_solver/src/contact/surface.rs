//! Projection of a particle onto the surface of a shape: C = n·(x − q) − d ≥ 0, with Coulomb friction.

use core::cell::RefCell;

use glam::Vec3;
use parry3d::query::Ray;
use parry3d::shape::{HeightField, Shape};

use crate::constants::LEAST_LENGTH;
use crate::contact::closed_form::ClosedForm;
use crate::contact::ground;
use crate::contact::nearest::nearest_point;
use crate::contact::reach::LONGER;
use crate::contact::triangles::{Near, TriangleCells};

/// Part of the clearance by which a particle may be farther from a shape that carries it along than it must be and touches it. Larger:
/// particles that the shape hits slide around it. Smaller: by rounding, particles that are pressed against the shape count as hit by it.
const TOUCHING: f32 = 0.1;

/// Depth up to which a particle slides on a shape that carries it along, in clearances. Larger: particles in front of a fast edge slide around
/// it, substep by substep. Smaller: cloth that is carried along cannot slip off.
const PRESSED: f32 = 6.0;

/// The surface of a shape, in the shape's frame.
pub(super) struct Surface<'a> {
    pub shape: &'a dyn Shape,
    pub closed_form: Option<ClosedForm<'a>>,
    /// The shape as ground, if it is a heightfield.
    pub ground: Option<&'a HeightField>,
    /// The shape's triangles near the cloth, if it consists of triangles and they are known.
    pub cells: Option<RefCell<&'a mut TriangleCells>>,
    /// Distance by which a particle deep in the ground rises in this substep, m.
    pub rise: f32,
    /// Whether the shape carries along what it hits, as it moves far in this substep.
    pub carries: bool,
    /// Least distance of particles from the shape, m.
    pub clearance: f32,
    /// Coulomb friction coefficient of the contact.
    pub friction: f32,
}

/// What of the surface is nearest to a point.
struct Nearest {
    /// Distance, m, negative inside. The surface may be farther away if there is no normal.
    distance: f32,
    /// Unit normal of the nearest plane, out of the shape; none if several planes are nearest, and if the surface is beyond reach.
    normal: Option<Vec3>,
}

/// The nearest plane of the surface to a particle that is closer than the clearance.
struct Overlap {
    /// Unit normal, out of the shape.
    normal: Vec3,
    /// Clearance less distance, m.
    depth: f32,
}

/// The projection of a particle by a contact.
pub(super) struct Projection {
    /// Position, m.
    pub to: Vec3,
    /// Unit normal of the surface, out of the shape.
    pub normal: Vec3,
    /// Whether the particle moves with the shape in this substep.
    pub sticks: bool,
}

impl Surface<'_> {
    /// Projects a particle that moves from one point to another, m; none if it stays outside the clearance.
    pub fn project(&self, from: Vec3, to: Vec3) -> Option<Projection> {
        let nearest = self.nearest(to);
        match self.cross(from, to, &nearest) {
            Some(projection) => Some(projection),
            None => Some(self.slide(from, to, &self.overlap_of(&nearest, from, to)?)),
        }
    }

    /// Projects a particle whose path enters the shape from outside. It slides along the plane through which it enters; if the shape carries
    /// it along, only where it touched the shape before and does not come far into it: a slide as long as the path would carry it
    /// around the shape within the substep.
    fn cross(&self, from: Vec3, to: Vec3, nearest: &Nearest) -> Option<Projection> {
        let (entry, normal) = self.entry(from, to, nearest)?;
        let above = |at: Vec3| normal.dot(at - entry) - self.clearance;
        if above(to) >= 0.0 {
            return None;
        }
        let depth = -above(to);
        let is_pressed =
            above(from) < TOUCHING * self.clearance && depth < PRESSED * self.clearance;
        let slides = !self.carries || is_pressed;
        let at = if slides {
            self.pushed(from, to, &Overlap { normal, depth })
        } else {
            entry + normal * self.clearance
        };
        // Beside an edge this point may lie within another face, and normals of rays against round shapes are
        // estimates.
        let overlap = self.overlap(from, at);
        let to = overlap.map_or(at, |Overlap { normal, depth }| at + normal * depth);
        Some(Projection { to, normal, sticks: !slides })
    }

    /// The first point of the surface on a path that begins outside, and the unit normal there, given what is nearest to the path's end.
    fn entry(&self, from: Vec3, to: Vec3, nearest: &Nearest) -> Option<(Vec3, Vec3)> {
        if let Some(form) = &self.closed_form {
            // A convex shape lies below the plane: a path whose ends are above it does not enter the shape.
            let height = |normal: Vec3| nearest.distance + normal.dot(from - to);
            let is_above = |normal| nearest.distance > 0.0 && height(normal) > 0.0;
            return if nearest.normal.is_some_and(is_above) { None } else { form.entry(from, to) };
        }
        // Nothing of the surface is nearer to an end of the path than its distance.
        let length = LONGER * from.distance(to);
        if length < nearest.distance {
            return None;
        }
        if let Some(cells) = &self.cells {
            let mut cells = cells.borrow_mut();
            let start = match cells.nearest(from) {
                Near::At { away, is_inside: false } => away.length(),
                Near::Outside => cells.reach(),
                Near::At { .. } | Near::Inside => return None,
            };
            if length < start + nearest.distance {
                return None;
            }
            if length <= cells.reach() {
                return cells.entry(from, to);
            }
        } else if self.contains(from) {
            return None;
        }
        let path = Ray::new(from, to - from);
        let hit = self.shape.cast_local_ray_and_get_normal(&path, 1.0, true)?;
        Some((path.point_at(hit.time_of_impact), hit.normal))
    }

    /// Projects a particle that comes closer than the clearance.
    fn slide(&self, from: Vec3, to: Vec3, overlap: &Overlap) -> Projection {
        let to = self.pushed(from, to, overlap);
        Projection { to, normal: overlap.normal, sticks: false }
    }

    /// The end of a particle's path, m, moved out of an overlap, with friction.
    fn pushed(&self, from: Vec3, to: Vec3, &Overlap { normal, depth }: &Overlap) -> Vec3 {
        let moved = to - from;
        let slide = moved - normal * moved.dot(normal);
        // Friction shortens the slide by at most its coefficient times the depth (Coulomb's cone).
        let held = (self.friction * depth / slide.length().max(LEAST_LENGTH)).min(1.0);
        to + normal * depth - slide * held
    }

    /// Unit normal of the surface, out of the shape, near a point that is closer than the clearance.
    pub fn normal_at(&self, at: Vec3) -> Option<Vec3> {
        Some(self.overlap(at, at)?.normal)
    }

    /// The plane of the surface nearest to `to`, if it is closer than the clearance.
    fn overlap(&self, from: Vec3, to: Vec3) -> Option<Overlap> {
        self.overlap_of(&self.nearest(to), from, to)
    }

    /// The overlap with what is nearest to `to`, if that is closer than the clearance.
    fn overlap_of(&self, nearest: &Nearest, from: Vec3, to: Vec3) -> Option<Overlap> {
        let depth = self.clearance - nearest.distance;
        if depth <= 0.0 {
            return None;
        }
        // On the surface itself, and where several planes are nearest, the path determines the side.
        let normal = nearest.normal.or_else(|| (from - to).try_normalize())?;
        let rises = self.ground.is_some() && nearest.distance < 0.0;
        Some(Overlap { normal, depth: if rises { depth.min(self.rise) } else { depth } })
    }

    /// What of the surface is nearest to a point.
    fn nearest(&self, at: Vec3) -> Nearest {
        if let Some(plane) = self.closed_form.and_then(|form| form.plane(at)) {
            return Nearest { distance: plane.distance, normal: Some(plane.normal) };
        }
        let beyond = |distance: f32| Nearest { distance, normal: None };
        let near = self.cells.as_ref().map(|cells| {
            let mut cells = cells.borrow_mut();
            (cells.nearest(at), cells.reach())
        });
        let (away, is_inside) = match (near, self.ground) {
            (Some((Near::Outside, reach)), _) => return beyond(reach),
            (Some((Near::At { away, is_inside }, _)), _) => (away, is_inside),
            (_, None) => {
                let nearest = nearest_point(self.shape, at);
                (at - nearest.point, nearest.is_inside)
            }
            (_, Some(field)) => match ground::project(field, at, self.clearance) {
                Some(nearest) => (at - nearest.point, nearest.is_inside),
                None => return beyond(self.clearance),
            },
        };
        let distance = if is_inside { -away.length() } else { away.length() };
        Nearest { distance, normal: (distance.abs() > LEAST_LENGTH).then(|| away / distance) }
    }

    /// Whether a point is inside the shape, or in the ground.
    pub fn contains(&self, at: Vec3) -> bool {
        if self.closed_form.is_some() || self.cells.is_some() {
            return self.nearest(at).distance < 0.0;
        }
        match self.ground {
            Some(field) => ground::depth(field, at).is_some_and(|depth| depth > 0.0),
            None => self.shape.contains_local_point(at),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use parry3d::shape::Cuboid;

    use super::{ClosedForm, Surface};

    /// Where a particle ends that moves from a height above a slab to a place 8 mm within it, m, and whether it sticks.
    fn pressed(carries: bool, height: f32, slide: f32, friction: f32) -> (Vec3, bool) {
        let slab = Cuboid::new(Vec3::new(1.0, 1.0, 0.1));
        let (clearance, rise) = (2e-3, 0.0);
        let closed_form = ClosedForm::of(&slab);
        let surface = Surface {
            shape: &slab,
            closed_form,
            ground: None,
            cells: None,
            rise,
            carries,
            clearance,
            friction,
        };
        let at = |x: f32, z: f32| Vec3::new(x, 0.0, 0.1 + z);
        let projection = surface.project(at(0.0, height), at(slide, -8e-3)).expect("a contact");
        (projection.to, projection.sticks)
    }

    #[test]
    fn a_particle_that_passes_through_the_surface_rubs_on_it() {
        // The friction is that of 10 mm: the whole depth below the clearance.
        for (slide, friction, end) in [(1e-3, 0.5, 0.0), (6e-3, 0.5, 1e-3), (6e-3, 0.0, 6e-3)] {
            for (carries, height) in [(false, 2e-3), (false, 0.5), (true, 2e-3)] {
                let (to, sticks) = pressed(carries, height, slide, friction);
                assert!(to.distance(Vec3::new(end, 0.0, 0.102)) < 1e-6 && !sticks, "{to} of {end}");
            }
        }
    }

    #[test]
    fn a_particle_that_is_hit_is_carried_along() {
        let (to, sticks) = pressed(true, 8e-3, 6e-3, 0.0);
        assert!(to.distance(Vec3::new(3e-3, 0.0, 0.102)) < 1e-6 && sticks, "{to}");
    }
}
