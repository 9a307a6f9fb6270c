//! The particles that may touch each collider in a tick.

use parry3d::bounding_volume::{Aabb, BoundingVolume};

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::bounds::moved_by_forces;
use crate::contact::near::swept_box;
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Gathers, for a tick of `tick` seconds, the particles that may touch each collider: those within reach
    /// of the box that the collider sweeps. The reach of a particle is its greatest motion relative to the
    /// box.
    pub fn gather_contacts(&mut self, tick: f32) {
        let positions = self.positions.packs();
        for (cloth, state) in self.lanes.iter_mut().enumerate() {
            let Some(state) = state else { continue };
            let by_forces = moved_by_forces(state, tick);
            let LaneState { material, drive, colliders, contacts, .. } = state;
            contacts.resize_with(colliders.len(), Vec::new);
            // Velocities are relative to the world. The frame's motion is added, and the greatest speed that
            // gravity and wind can give to a particle within the tick.
            let by_frame = drive.motion.translation.length();
            for (collider, candidates) in colliders.iter().zip(contacts) {
                candidates.clear();
                // Particles that the collider hits pull others along.
                let by_neighbours = collider.from.0.distance(collider.to.0);
                let clearance = material.thickness + collider.margin;
                let common = clearance + by_frame + by_forces + by_neighbours;
                let particles = 0..self.fabric.particle_count();
                let position_and_reach = |particle: usize| {
                    let (pack, lane) = self.layout.locate(particle, cloth);
                    let reach = common + lane3(&self.velocity[pack], lane).length() * tick;
                    (lane3(&positions[pack], lane), reach)
                };
                let reached = || {
                    let boxes = particles.clone().map(position_and_reach);
                    let boxes = boxes.map(|(at, reach)| Aabb::new(at - reach, at + reach));
                    boxes.reduce(|one, other| one.merged(&other))
                };
                let Some(swept) = swept_box(collider, reached) else { continue };
                candidates.extend(particles.clone().filter_map(|particle| {
                    let (at, reach) = position_and_reach(particle);
                    let outside = (swept.mins - at).max(at - swept.maxs).max_element();
                    (outside <= reach && !self.fabric.is_pinned(particle))
                        .then_some(particle as u32)
                }));
            }
        }
    }
}
