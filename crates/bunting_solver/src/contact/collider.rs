//! What a cloth may touch: parry shapes, and which particles are near them in a tick.

use glam::{Quat, Vec3};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Pose;
use parry3d::shape::SharedShape;

use crate::batch::lane_batch::{LaneBatch, Slot};
use crate::batch::places::Constant;
use crate::contact::near::swept_box;
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;
use crate::step::frame::FrameMotion;

/// A shape that a cloth cannot enter, moving along a straight line and turning at a constant rate
/// over the tick. It pushes cloth and is not pushed.
#[derive(Clone)]
pub struct Collider {
    /// Any parry shape: ball, capsule, cuboid, half-space, mesh, compound …
    pub shape: SharedShape,
    /// Position (m) and orientation at the start of the tick, in the cloth's frame as it stood then.
    pub from: (Vec3, Quat),
    /// Position (m) and orientation at the end of the tick, in the cloth's frame as it stands then.
    pub to: (Vec3, Quat),
    /// Distance that is kept in addition to the cloth's thickness, m.
    pub margin: f32,
    /// Coulomb friction coefficient; the cloth's own is multiplied by it and the root taken.
    pub friction: f32,
}

impl core::fmt::Debug for Collider {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter
            .debug_struct("Collider")
            .field("shape", &self.shape.shape_type())
            .field("from", &self.from)
            .field("to", &self.to)
            .field("margin", &self.margin)
            .field("friction", &self.friction)
            .finish()
    }
}

impl Collider {
    /// A shape that stays where it is in the cloth's frame.
    #[must_use]
    pub fn fixed(shape: SharedShape, position: Vec3, rotation: Quat) -> Self {
        let pose = (position, rotation);
        Self { shape, from: pose, to: pose, margin: 0.0, friction: 1.0 }
    }

    /// The pose after a part of the tick, in the cloth's frame.
    pub(crate) fn pose_at(&self, part: f32) -> Pose {
        let turned = FrameMotion::between(self.from, self.to).rotation_at(part);
        Pose::from_parts(self.from.0.lerp(self.to.0, part), self.from.1 * turned)
    }
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Gathers, once a tick, the particles that may touch each collider: those that its swept
    /// bounding box reaches, grown by how far the particle may go.
    pub fn gather_contacts(&mut self, tick: f32) {
        for (cloth, slot) in self.slots.iter_mut().enumerate() {
            let Some(Slot { material, drive, colliders, contacts, .. }) = slot else {
                continue;
            };
            contacts.resize_with(colliders.len(), Vec::new);
            // Speeds are the world's; the frame's motion comes on top, and gravity and wind may
            // add to them within the tick.
            let frame_reach = drive.motion.translation.length();
            let gained = drive.gravity.length() * tick * tick + drive.wind.length() * tick;
            for (collider, candidates) in colliders.iter().zip(contacts) {
                candidates.clear();
                // What the collider has caught draws the rest along.
                let drawn = collider.from.0.distance(collider.to.0);
                let keep = material.thickness + collider.margin + frame_reach + gained + drawn;
                let particles = 0..self.fabric.particle_count();
                let place_and_reach = |particle: usize| {
                    let (pack, lane) = self.seating.seat(particle, cloth);
                    let reach = keep + lane3(&self.velocity[pack], lane).length() * tick;
                    (lane3(&self.position[pack], lane), reach)
                };
                let around = || {
                    let boxes = particles.clone().map(place_and_reach);
                    let boxes = boxes.map(|(at, reach)| Aabb::new(at - reach, at + reach));
                    boxes.reduce(|one, other| one.merged(&other))
                };
                let Some(swept) = swept_box(collider, around) else { continue };
                candidates.extend(particles.clone().filter_map(|particle| {
                    let (at, reach) = place_and_reach(particle);
                    let outside = (swept.mins - at).max(at - swept.maxs).max_element();
                    (outside <= reach && !self.fabric.is_pinned(particle))
                        .then_some(particle as u32)
                }));
            }
        }
    }
}
