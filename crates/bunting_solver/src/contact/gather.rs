//! The particles and triangles that may touch each collider in a tick.

use parry3d::bounding_volume::{Aabb, BoundingVolume};

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::bounds::moved_by_forces;
use crate::contact::candidates::Candidates;
use crate::contact::collider::Collider;
use crate::contact::near::swept_box;
use crate::contact::obstacle::Obstacle;
use crate::contact::reaction::ReactionSum;
use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Gathers, for a tick of `tick` seconds, what may touch each collider.
    pub fn gather_contacts(&mut self, tick: f32) {
        let positions = self.positions.packs();
        let mut boxes: Vec<Aabb> = Vec::new();
        for (cloth, state) in self.lanes.iter_mut().enumerate() {
            let Some(state) = state else { continue };
            let by_forces = moved_by_forces(state, tick);
            let LaneState { material, drive, colliders, contacts, reactions, .. } = state;
            contacts.resize_with(colliders.len(), Candidates::default);
            let reports = colliders.iter().any(|collider| collider.reports_as.is_some());
            reactions.resize_with(if reports { colliders.len() } else { 0 }, Default::default);
            reactions.iter_mut().for_each(ReactionSum::begin_tick);
            if colliders.is_empty() {
                continue;
            }
            // Velocities are relative to the world. The frame's motion is added, and the greatest speed that
            // gravity and wind can give to a particle within the tick.
            let common = material.thickness + drive.motion.translation.length() + by_forces;
            boxes.clear();
            boxes.extend((0..self.fabric.particle_count()).map(|particle| {
                let (pack, lane) = self.layout.locate(particle, cloth);
                let reach = common + lane3(&self.velocity[pack], lane).length() * tick;
                let at = lane3(&positions[pack], lane);
                Aabb::new(at - reach, at + reach)
            }));
            let around = boxes.iter().copied().reduce(|one, other| one.merged(&other));
            for (collider, candidates) in colliders.iter().zip(contacts) {
                gather_candidates(&self.fabric, collider, &boxes, around, candidates);
            }
        }
    }
}

/// Gathers what may touch a collider: particles within reach of the box that the collider sweeps, and triangles whose
/// boxes are. `boxes` contain all positions that particles reach, and `around` all boxes.
fn gather_candidates(
    fabric: &Fabric,
    collider: &Collider,
    boxes: &[Aabb],
    around: Option<Aabb>,
    candidates: &mut Candidates,
) {
    candidates.clear();
    // Particles that the collider hits pull others along.
    let by_neighbours = collider.from.0.distance(collider.to.0);
    let reach = collider.margin + by_neighbours;
    let all = || around.map(|around| Aabb::new(around.mins - reach, around.maxs + reach));
    let Some(swept) = swept_box(collider, all) else { return };
    let swept = Aabb::new(swept.mins - reach, swept.maxs + reach);
    let is_near = |particle: &u32| {
        swept.intersects(&boxes[*particle as usize]) && !fabric.is_pinned(*particle as usize)
    };
    candidates.particles.extend((0..boxes.len() as u32).filter(is_near));
    if collider.features && Obstacle::can_cut(&*collider.shape.0) {
        let around = |[a, b, c]: [usize; 3]| boxes[a].merged(&boxes[b]).merged(&boxes[c]);
        if all().is_some_and(|all| all.intersects(&swept)) {
            candidates.gather_triangles(fabric, |triangle| swept.intersects(&around(triangle)));
        }
    }
}
