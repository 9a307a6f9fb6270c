//! The particles and triangles that may touch each collider in a tick.

use glam::{Affine3A, Vec3};
use parry3d::bounding_volume::{Aabb, BoundingVolume};

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::bounds::{dragged_by_anchors, moved_by_forces};
use crate::contact::candidates::Candidates;
use crate::contact::closed_form::ClosedForm;
use crate::contact::collider::Collider;
use crate::contact::collider_packs::{ColliderPacks, Member};
use crate::contact::lane_shapes::Kind;
use crate::contact::near::swept_box;
use crate::contact::obstacle::Obstacle;
use crate::contact::pressing::Pressing;
use crate::contact::reaction::ReactionSum;
use crate::contact::swept_boxes::{Sweep, SweptBoxes};
use crate::contact::triangles::{LaneTriangles, TriangleCells};
use crate::fabric::Fabric;
use crate::simd::lane::Pack;

/// Way of a collider relative to a particle in a substep, in lengths of the shortest link, from which on the collider carries along what it hits.
/// Smaller: cloth cannot slide over shapes that draw it along, and is stretched. Larger: the cloth in front of balls of 20 m/s opens around them.
pub(super) const CARRIED: f32 = 0.5;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Gathers, for a tick of `tick` seconds, what may touch each collider.
    pub fn gather_contacts(&mut self, tick: f32) {
        let positions = self.positions.packs();
        let carried = CARRIED * self.fabric.shortest_link() * self.clock.settings.substeps as f32;
        let mut boxes = SweptBoxes::default();
        let mut sets = Vec::new();
        let (mut at, mut velocities) = (Vec::new(), Vec::new());
        for (cloth, state) in self.lanes.iter_mut().enumerate() {
            let Some(state) = state else { continue };
            let by_forces = moved_by_forces(state, tick);
            state.pressing = Pressing::default();
            state.approach = 0.0;
            let LaneState { colliders, contacts, reactions, .. } = state;
            contacts.resize_with(colliders.len(), Candidates::default);
            let reports = colliders.iter().any(|collider| collider.reports_as.is_some());
            reactions.resize_with(if reports { colliders.len() } else { 0 }, Default::default);
            reactions.iter_mut().for_each(ReactionSum::begin_tick);
            if colliders.is_empty() {
                continue;
            }
            // Particles reach what lies within their way in the moving frame, in any direction, since other particles
            // turn them, and within the greatest way that gravity and wind can add in the tick. What drags the cloth moves a
            // particle that rests, too.
            self.layout.read(positions, cloth, &mut at);
            self.layout.read(&self.velocity, cloth, &mut velocities);
            let sweep = Sweep {
                motion: state.drive.motion,
                tick,
                common: state.material.thickness + by_forces,
                dragged: dragged_by_anchors(state, |particle| at[particle as usize]),
            };
            boxes.set(&at, &velocities, &sweep);
            let frame = state.drive.motion.substep(0, 1);
            let is_held = state.is_held(&self.fabric);
            for (index, (collider, candidates)) in
                state.colliders.iter().zip(&mut state.contacts).enumerate()
            {
                gather_candidates(&self.fabric, collider, &boxes, candidates);
                TriangleCells::begin_tick(
                    &mut candidates.cells,
                    &collider.shape,
                    [collider.clearance(state.material.thickness), self.fabric.shortest_link()],
                    self.fabric.particle_count(),
                );
                let to_end = to_end_of_tick(collider);
                let moving = |particle: u32| {
                    let (at, velocity) = (at[particle as usize], velocities[particle as usize]);
                    let surface = to_end.transform_point3(at);
                    let way = surface - frame.to_new(at) - velocity * tick;
                    Moving { at, surface, way }
                };
                let (mut farthest, mut in_frame) = (0.0_f32, 0.0_f32);
                for &particle in candidates.particles.iter().chain(&candidates.corners) {
                    let Moving { at, surface, way } = moving(particle);
                    farthest = farthest.max(way.length_squared());
                    in_frame = in_frame.max(surface.distance_squared(at));
                }
                candidates.carries = farthest.sqrt() > carried;
                if is_held {
                    state.approach = state.approach.max(in_frame.sqrt() / tick);
                }
                candidates.wait_for_end = !candidates.triangles.is_empty()
                    || candidates.carries
                    || !candidates.is_empty() && contains_pin(&self.fabric, collider, &at);
                let member = Member { cloth, collider: index };
                candidates.is_in_lanes = !candidates.wait_for_end
                    && add_to_sets(&mut sets, &self.layout, member, collider, candidates, moving);
            }
        }
        sets.sort_by_key(|set: &ColliderPacks<P>| set.key);
        sets.iter_mut().filter_map(|set| set.triangles.as_mut()).for_each(LaneTriangles::pack);
        self.collider_packs = sets;
    }
}

/// Part of the way of a particle in a tick, beyond half of the reach of the cells, within which triangles are known in lanes. Smaller: particles that are
/// pulled along come to where they are not known, and are solved one by one. Larger: more triangles are asked.
const WAY: f32 = 1.5;

/// A particle and a collider in a tick.
struct Moving {
    /// Position of the particle at the start, m.
    at: Vec3,
    /// Where the collider carries a point of it that is there, m.
    surface: Vec3,
    /// Way of the collider relative to the particle, m.
    way: Vec3,
}

/// From the points of a collider at the start of the tick to the same points at its end, each in the cloth's frame as it is then.
fn to_end_of_tick(collider: &Collider) -> Affine3A {
    let [from, to] = [collider.from, collider.to]
        .map(|(at, turn)| Affine3A::from_rotation_translation(turn, at));
    if from == to { Affine3A::IDENTITY } else { to * from.inverse() }
}

/// Whether a pin of a fabric is within a collider at the start of the tick, given the positions of particles, m.
fn contains_pin(fabric: &Fabric, collider: &Collider, positions: &[Vec3]) -> bool {
    let pose = collider.pose_at(0.0);
    let mut pins = fabric.pins().iter().map(|pin| positions[pin.particle as usize]);
    pins.any(|pin| collider.shape.contains_local_point(pose.inverse_transform_point(pin)))
}

/// Adds the particles that may touch a collider to the set of its kind, if there are lanes for it. Returns whether there are. `moving` tells how
/// each moves.
fn add_to_sets<P: Pack, Y: Layout<P>>(
    sets: &mut Vec<ColliderPacks<P>>,
    layout: &Y,
    member: Member,
    collider: &Collider,
    candidates: &mut Candidates,
    moving: impl Fn(u32) -> Moving,
) -> bool {
    let Candidates { particles, cells, .. } = candidates;
    let form = ClosedForm::of(&*collider.shape.0).and_then(|form| Kind::of(&form));
    let kind = form.or(cells.as_ref().map(|_| Kind::Triangles)).filter(|_| !particles.is_empty());
    let Some(kind) = kind else { return false };
    let key = (member.collider, kind);
    let found = sets.iter().position(|set| set.key == key);
    let index = found.unwrap_or_else(|| {
        sets.push(ColliderPacks::new(key, layout.pack_count()));
        sets.len() - 1
    });
    let set = &mut sets[index];
    set.members.push(member);
    let pose = collider.pose_at(0.0);
    let is_closed = cells.as_ref().is_some_and(TriangleCells::is_closed);
    for &particle in &*particles {
        let (pack, lane) = layout.locate(particle as usize, member.cloth);
        let near = set.add((pack, lane));
        let (Some(triangles), Some(cells)) = (&mut set.triangles, cells.as_mut()) else { continue };
        let Moving { at, way, .. } = moving(particle);
        let at = pose.inverse_transform_point(at);
        let reach = cells.reach();
        let radius = reach.min(0.5 * reach + WAY * way.length());
        let find = |found: &mut _| cells.within(at, radius, found);
        triangles.add((near, lane), at, is_closed, find);
    }
    true
}

/// Gathers what may touch a collider: particles within reach of the box that the collider sweeps, and triangles whose
/// boxes are.
fn gather_candidates(
    fabric: &Fabric,
    collider: &Collider,
    boxes: &SweptBoxes,
    candidates: &mut Candidates,
) {
    candidates.clear();
    // Particles that the collider hits pull others along.
    let by_neighbours = collider.from.0.distance(collider.to.0);
    let reach = collider.margin + by_neighbours;
    let all = || boxes.around().map(|all| Aabb::new(all.mins - reach, all.maxs + reach));
    let Some(swept) = swept_box(collider, all) else { return };
    let swept = Aabb::new(swept.mins - reach, swept.maxs + reach);
    boxes.meeting(&swept, &mut candidates.particles);
    candidates.particles.retain(|&particle| !fabric.is_pinned(particle as usize));
    candidates.touching.clone_from(&candidates.particles);
    if collider.features && Obstacle::can_cut(&*collider.shape.0) {
        let is_near = |[a, b, c]: [usize; 3]| {
            let around = boxes.get(a).merged(&boxes.get(b)).merged(&boxes.get(c));
            swept.intersects(&around)
        };
        if all().is_some_and(|all| all.intersects(&swept)) {
            candidates.gather_triangles(fabric, is_near);
        }
    }
}
