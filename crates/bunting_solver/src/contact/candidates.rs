//! The particles and triangles that may touch each collider in a tick.

use parry3d::bounding_volume::{Aabb, BoundingVolume};

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::bounds::moved_by_forces;
use crate::contact::collider::Collider;
use crate::contact::near::swept_box;
use crate::contact::obstacle::Obstacle;
use crate::contact::reaction::ReactionSum;
use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;

/// What of a cloth may touch a collider in a tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Candidates {
    /// Particles.
    pub particles: Vec<u32>,
    /// Particles that are corners of [`triangles`](Self::triangles).
    pub corners: Vec<u32>,
    /// Triangles that features of the shape may cut between the particles, as indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Candidates {
    pub fn is_empty(&self) -> bool {
        self.particles.is_empty() && self.triangles.is_empty()
    }

    fn clear(&mut self) {
        self.particles.clear();
        self.corners.clear();
        self.triangles.clear();
    }

    /// Gathers the triangles of which a selected box reaches the collider.
    fn gather_triangles(&mut self, fabric: &Fabric, is_near: impl Fn([usize; 3]) -> bool) {
        /// No index of a corner yet.
        const NONE: u32 = u32::MAX;
        let mut index_of = vec![NONE; fabric.particle_count()];
        for triangle in fabric.triangles() {
            let particles = triangle.map(|particle| particle as usize);
            if !is_near(particles) || particles.iter().all(|&at| fabric.is_pinned(at)) {
                continue;
            }
            self.triangles.push(particles.map(|particle| {
                if index_of[particle] == NONE {
                    index_of[particle] = self.corners.len() as u32;
                    self.corners.push(particle as u32);
                }
                index_of[particle]
            }));
        }
    }
}

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
