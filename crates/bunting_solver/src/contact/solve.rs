//! Contacts: a particle stays a thickness away from a collider, C = n·(x − q) − d ≥ 0, and slides
//! along it with Coulomb friction.

use glam::Vec3;
use parry3d::query::Ray;
use parry3d::shape::{HeightField, Shape};

use crate::batch::lane_batch::{Clock, LaneBatch};
use crate::batch::places::Constant;
use crate::constants::{LEAST_CLEARANCE, LEAST_LENGTH};
use crate::contact::ground;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Projects every contact candidate once.
    pub fn solve_contacts(&mut self) {
        let Clock { settings, done, .. } = self.clock;
        // `integrate` has counted this substep already.
        let index = done - 1;
        let part = |substep: u32| substep as f32 / settings.substeps as f32;
        for (cloth, slot) in self.slots.iter_mut().enumerate() {
            let Some(slot) = slot else { continue };
            slot.contact_moment = 0.0;
            let effective_step = self.parameters.step.lanes()[C::lanes(cloth).start];
            let carry = slot.drive.motion.carry(index, settings.substeps);
            for (collider, candidates) in slot.colliders.iter().zip(&slot.contacts) {
                let (old_pose, pose) =
                    (collider.pose_at(part(index)), collider.pose_at(part(done)));
                let surface = Surface {
                    shape: &*collider.shape.0,
                    ground: collider.shape.as_heightfield(),
                    rise: ground::RISE * self.clock.step,
                    keep: (slot.material.thickness + collider.margin).max(LEAST_CLEARANCE),
                    friction: (slot.material.surface_friction * collider.friction).sqrt(),
                };
                for &particle in candidates {
                    let (pack, lane) = self.seating.seat(particle as usize, cloth);
                    let position = &mut self.position[pack];
                    let old = lane3(&self.scratch[pack], lane);
                    let before = lane3(position, lane);
                    // Both ends of the particle's way in the collider's own frame, so that it is
                    // relative to the surface; the old end as it stood before the frame moved.
                    let from = old_pose.inverse_transform_point(carry.back(old));
                    let to = pose.inverse_transform_point(before);
                    let Some(push) = surface.push(from, to) else { continue };
                    let after = pose.transform_point(push.to);
                    set_lane3(position, lane, after);

                    // A surface takes a particle along, but does not throw it off.
                    let was = carry.forth(old_pose.transform_point(push.to));
                    let of_surface = (after - was) / self.clock.step;
                    let normal = pose.rotation * push.normal;
                    let predicted = old + lane3(&self.displacement[pack], lane);
                    let velocity = lane3(&self.velocity[pack], lane);
                    let given = (after - before) / effective_step;
                    let leaves = velocity + (after - predicted) / effective_step - of_surface;
                    let thrown = leaves.dot(normal).min(given.dot(normal)).max(0.0) * normal;
                    set_lane3(&mut self.velocity[pack], lane, velocity - thrown);
                    // A blow is not to be extrapolated: the past is carried along with it. What presses
                    // on a surface is, for it goes on.
                    let arrived = lane3(&self.older_velocity[pack], lane);
                    let approach = (of_surface - arrived).dot(normal);
                    let blow = approach.min((given - thrown).dot(normal)).max(0.0) * normal;
                    for past in [&mut self.older_velocity[pack], &mut self.oldest_velocity[pack]] {
                        set_lane3(past, lane, lane3(past, lane) + blow);
                    }
                    if let Some(pole) = self.pole {
                        let inertia = self.lane_inertias[pack].lanes()[lane];
                        let moment = |at: Vec3| pole.moment(inertia, at, at - predicted);
                        slot.contact_moment += moment(after) - moment(before);
                    }
                }
            }
        }
    }
}

/// A collider as a particle meets it, in the collider's frame.
struct Surface<'a> {
    shape: &'a dyn Shape,
    /// The shape, if it is a heightfield.
    ground: Option<&'a HeightField>,
    /// How far a particle deep under ground rises in this substep, m.
    rise: f32,
    /// Distance to keep, m.
    keep: f32,
    /// Coulomb friction coefficient.
    friction: f32,
}

/// A particle's distance from a plane that it should stay above.
struct Touch {
    normal: Vec3,
    /// How far it is short of the distance to keep, m.
    depth: f32,
}

/// Where a contact puts a particle.
struct Push {
    to: Vec3,
    /// Out of the surface.
    normal: Vec3,
}

impl Surface<'_> {
    /// Pushes a particle that goes from one point to another out of the shape, if it is in it.
    fn push(&self, from: Vec3, to: Vec3) -> Option<Push> {
        let (to, normal) = match self.crossing(from, to) {
            Some(hit) => hit,
            None => self.slide(from, to)?,
        };
        Some(Push { to, normal })
    }

    /// Where a particle stays whose way enters the shape from outside, and the normal there. What a fast
    /// shape overtakes goes with it, and does not slide: a slide as long as the way would let the particle
    /// slip round the shape within the substep.
    fn crossing(&self, from: Vec3, to: Vec3) -> Option<(Vec3, Vec3)> {
        if self.contains(from) {
            return None;
        }
        let way = Ray::new(from, to - from);
        let hit = self.shape.cast_local_ray_and_get_normal(&way, 1.0, true)?;
        let above = |at: Vec3| hit.normal.dot(at - way.point_at(hit.time_of_impact)) - self.keep;
        if above(to) >= 0.0 {
            return None;
        }
        let at = from - hit.normal * above(from);
        // Beside an edge, and where the ray's normal is but an estimate.
        let out = self.overlap(from, at).map_or(at, |Touch { normal, depth }| at + normal * depth);
        Some((out, hit.normal))
    }

    /// Where a particle slides that comes nearer than the distance to keep, and the normal there.
    fn slide(&self, from: Vec3, to: Vec3) -> Option<(Vec3, Vec3)> {
        let Touch { normal, depth } = self.overlap(from, to)?;
        let moved = to - from;
        let slide = moved - normal * moved.dot(normal);
        // Friction holds back a slide as far as the push is deep (Coulomb's cone).
        let held = (self.friction * depth / slide.length().max(LEAST_LENGTH)).min(1.0);
        Some((to + normal * depth - slide * held, normal))
    }

    /// The surface nearest to `to`, if it is nearer than the distance to keep.
    fn overlap(&self, from: Vec3, to: Vec3) -> Option<Touch> {
        let nearest = match self.ground {
            Some(field) => ground::project(field, to, self.keep)?,
            None => self.shape.project_local_point(to, false),
        };
        let away = if nearest.is_inside { nearest.point - to } else { to - nearest.point };
        let distance = away.length();
        let signed = if nearest.is_inside { -distance } else { distance };
        if signed >= self.keep {
            return None;
        }
        // On the surface itself, or at the centre of a ball, the way it came tells the side.
        let normal =
            if distance > LEAST_LENGTH { away / distance } else { (from - to).try_normalize()? };
        let depth = self.keep - signed;
        let rises = self.ground.is_some() && nearest.is_inside;
        Some(Touch { normal, depth: if rises { depth.min(self.rise) } else { depth } })
    }

    fn contains(&self, at: Vec3) -> bool {
        match self.ground {
            Some(field) => ground::depth(field, at).is_some_and(|depth| depth > 0.0),
            None => self.shape.contains_local_point(at),
        }
    }
}
