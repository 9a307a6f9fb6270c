//! Cloths whose particles follow the nodes of their background grid.
//!
//! Where nothing acts on the single particles of a mesh with a grid, the nodes carry all of the motion, air included. The
//! particles are then neither integrated nor projected onto the nodes, but interpolated from them: positions in each
//! substep, velocities at the end of a tick. In a tick in which something may act on particles (contacts, holds, guides,
//! moving pins, local wind, users, reports of what acts on pins) they take the nodes' motion over, and are integrated themselves.

use core::mem;
use core::ops::Range;

use glam::Vec3;

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch};
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::batch::snapshot::{ClothSnapshot, SnapshotHistory};
use crate::constraints::background::{AddHeights, nodes_of};
use crate::fabric::{GridTransfer, Height, Interpolation, Term};
use crate::simd::lane::Pack;
use crate::simd::level::has_fused_products;
use crate::simd::registers::Pack1;
use crate::simd::vec3::{Pack3, lane3, splat3};
use crate::step::Scheme;
use crate::step::bdf::IntegratorHistory;

/// Number of the vectors of each particle or node.
const VECTORS: usize = 7;

/// How many of the vectors, the first ones, are its history. The others are valid in a substep.
const HISTORY: usize = 4;

/// Which of the vectors are positions: at the start of the substep, and predicted.
const POSITIONS: Range<usize> = 5..VECTORS;

/// The vectors of each particle of a cloth, or of each node.
type Motion = [Vec<Vec3>; VECTORS];

impl LaneState {
    /// Whether something may act on single particles in this tick.
    pub fn is_acted_on(&self) -> bool {
        self.contacts.iter().any(|candidates| !candidates.is_empty())
            || self.self_contacts.is_some()
            || self.guides.is_some()
            || self.local_wind.is_some()
            || self.holds.is_some()
            || self.pin_reports.is_some()
            || !self.moving_pins.is_empty()
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Begins a tick after one of the scheme `before`: decides which cloths follow their nodes.
    pub fn begin_following(&mut self, before: Scheme) {
        if self.fabric.background().is_none() {
            return;
        }
        let has_yarns = self.clock.settings.scheme == Scheme::Yarns;
        if has_yarns && before != Scheme::Yarns {
            self.find_nodes();
        }
        for cloth in 0..self.lanes.len() {
            let Some(state) = &mut self.lanes[cloth] else { continue };
            let is_acted_on = !has_yarns || state.is_acted_on();
            let was_acted_on = mem::replace(&mut state.history.was_acted_on, is_acted_on);
            if is_acted_on || was_acted_on {
                self.stop_following(cloth);
            } else if !state.follows_nodes {
                self.start_following(cloth);
            }
        }
    }

    /// Reads the nodes of all cloths from their particles, which have moved without them.
    fn find_nodes(&mut self) {
        for cloth in 0..self.lanes.len() {
            let state = self.snapshot_without_history(cloth);
            let nodes = nodes_of(&self.fabric, &state.positions, &state.velocities);
            if let Some(grid) = &mut self.background {
                grid.restore(cloth, &nodes);
            }
            // The nodes have no history that belongs to these positions.
            if let Some(state) = &mut self.lanes[cloth] {
                state.history = IntegratorHistory::default();
            }
        }
    }

    /// Whether any particles are integrated.
    pub fn integrates_particles(&self) -> bool {
        let follows = |state: &Option<LaneState>| state.as_ref().is_none_or(|it| it.follows_nodes);
        self.background.is_none() || !self.lanes.iter().all(follows)
    }

    /// Whether the particles of a cloth follow its nodes.
    pub fn follows_nodes(&self, cloth: usize) -> bool {
        self.lanes[cloth].as_ref().is_some_and(|state| state.follows_nodes)
    }

    /// Lets a cloth's particles move by themselves in the rest of this tick and in the next: something acts on them.
    pub fn access_particles(&mut self, cloth: usize) {
        if let Some(state) = &mut self.lanes[cloth] {
            state.history.was_acted_on = true;
            state.history.disturbance.disturb();
        }
        self.stop_following(cloth);
    }

    /// Gives the motion of a cloth's particles to its nodes, as far as the grid resolves it, and lets them follow. Nothing
    /// changes where they have followed before.
    fn start_following(&mut self, cloth: usize) {
        let ClothSnapshot { positions, velocities, history } = self.snapshot(cloth);
        if let Some(SnapshotHistory { displacements, older_velocities, nodes, .. }) = history
            && let Some(mut nodes) = nodes
            && let Some(nodes_history) = &mut nodes.history
            && let (Some(background), Some(grid)) = (self.fabric.background(), &mut self.background)
        {
            let transfer = &background.transfer;
            add_resolved(transfer, &transfer.heights, &positions, &mut nodes.positions);
            add_resolved(transfer, &[], &velocities, &mut nodes.velocities);
            let of_nodes = &mut nodes_history.displacements;
            for (particles, nodes) in displacements.iter().zip(of_nodes) {
                add_resolved(transfer, &[], particles, nodes);
            }
            let of_nodes = &mut nodes_history.older_velocities;
            for (particles, nodes) in older_velocities.iter().zip(of_nodes) {
                add_resolved(transfer, &[], particles, nodes);
            }
            grid.restore(cloth, &nodes);
        }
        self.reset_relaxation(cloth);
        if let Some(state) = &mut self.lanes[cloth] {
            state.follows_nodes = true;
        }
    }

    /// Gives the motion of a cloth's nodes to its particles, if they follow them.
    fn stop_following(&mut self, cloth: usize) {
        let Some(motion) = self.followed_motion(cloth) else { return };
        // Between substeps positions and velocities are there already.
        let count = if self.clock.predicted { VECTORS } else { HISTORY };
        let arrays: [&mut Vec<Pack3<P>>; VECTORS] = [
            &mut self.displacement,
            &mut self.older_displacement,
            &mut self.older_velocity,
            &mut self.oldest_velocity,
            &mut self.velocity,
            &mut self.scratch,
            self.positions.packs_mut(),
        ];
        for (packs, vectors) in arrays.into_iter().zip(&motion).take(count) {
            self.layout.write(packs, &[(cloth, Some(vectors))]);
        }
        if let Some(state) = &mut self.lanes[cloth] {
            state.follows_nodes = false;
        }
    }

    /// Velocities at the end of a tick of the particles that follow nodes while others are integrated.
    pub fn end_following(&mut self) {
        if self.clock.begun < self.clock.settings.substeps || !self.integrates_particles() {
            return;
        }
        for cloth in 0..self.lanes.len() {
            if let Some([.., velocities, _, _]) = self.followed_motion(cloth) {
                self.layout.write(&mut self.velocity, &[(cloth, Some(&velocities))]);
            }
        }
    }

    /// The history of particles that follow nodes: displacements and older velocities.
    pub fn followed_history(&self, cloth: usize) -> Option<[Vec<Vec3>; HISTORY]> {
        let [first, second, third, fourth, ..] = self.followed_motion(cloth)?;
        Some([first, second, third, fourth])
    }

    /// The motion of particles that follow nodes; that of pins is their own.
    fn followed_motion(&self, cloth: usize) -> Option<Motion> {
        let (background, grid) = (self.fabric.background()?, self.background.as_ref()?);
        if !self.follows_nodes(cloth) {
            return None;
        }
        let nodes = match grid {
            BackgroundGrid::SideBySide(batch) => batch.motion_of(cloth),
            BackgroundGrid::Single(single) => single.batch.motion_of(cloth),
            BackgroundGrid::SingleNet(single) => single.batch.motion_of(cloth),
        };
        let mut motion = self.motion_of(cloth);
        let GridTransfer { particles: rows, heights, .. } = &background.transfer;
        for (kind, (particles, nodes)) in motion.iter_mut().zip(&nodes).enumerate() {
            let are_positions = POSITIONS.contains(&kind);
            follow(rows, if are_positions { heights } else { &[] }, nodes, particles);
        }
        Some(motion)
    }

    fn motion_of(&self, cloth: usize) -> Motion {
        [
            &self.displacement,
            &self.older_displacement,
            &self.older_velocity,
            &self.oldest_velocity,
            &self.velocity,
            &self.scratch,
            self.positions.packs(),
        ]
        .map(|packs| {
            let mut vectors = Vec::new();
            self.layout.read(packs, cloth, &mut vectors);
            vectors
        })
    }
}

/// Adds to vectors of nodes R (x − P X): what they resolve of the difference of particles' vectors. Positions have heights.
fn add_resolved(
    transfer: &GridTransfer,
    heights: &[Height],
    particles: &[Vec3],
    nodes: &mut [Vec3],
) {
    let mut followed = particles.to_vec();
    follow(&transfer.particles, heights, nodes, &mut followed);
    let differences: Vec<Vec3> =
        particles.iter().zip(&followed).map(|(of, followed)| *of - *followed).collect();
    for (node, row) in nodes.iter_mut().zip(transfer.means.rows()) {
        *node += interpolated(row, &differences);
    }
}

/// Overwrites the vectors of particles that have rows by those that nodes interpolate, and raises positions by their heights.
pub(crate) fn follow(
    rows: &Interpolation,
    heights: &[Height],
    nodes: &[Vec3],
    particles: &mut [Vec3],
) {
    for (vector, row) in particles.iter_mut().zip(rows.rows()) {
        if !row.is_empty() {
            *vector = interpolated(row, nodes);
        }
    }
    raise(heights, nodes, particles);
}

/// Raises positions of particles by their heights above the surface between nodes.
fn raise(heights: &[Height], nodes: &[Vec3], particles: &mut [Vec3]) {
    if heights.is_empty() {
        return;
    }
    let in_packs = |of: &[Vec3]| of.iter().copied().map(splat3).collect();
    let (nodes, mut to): (Vec<Pack3<Pack1>>, Vec<_>) = (in_packs(nodes), in_packs(particles));
    Pack1::run(AddHeights { heights, sign: 1.0, nodes: &nodes, to: &mut to });
    particles.iter_mut().zip(&to).for_each(|(particle, raised)| *particle = lane3(raised, 0));
}

/// The position of a particle that has a row, raised by its height, if it has one, which is that of particle 0.
pub(crate) fn followed(row: &[Term], height: &[Height], nodes: &[Vec3]) -> Vec3 {
    let mut particle = [interpolated(row, nodes)];
    raise(height, nodes, &mut particle);
    particle[0]
}

/// The vector that the terms of a row interpolate, with the bits of the kernels.
fn interpolated(row: &[Term], from: &[Vec3]) -> Vec3 {
    let is_fused = has_fused_products();
    let mut sum = Vec3::ZERO;
    for term in row {
        let from = from[term.from as usize];
        let plus = |sum: f32, value: f32| match is_fused {
            true => libm::fmaf(value, term.weight, sum),
            false => sum + value * term.weight,
        };
        sum = Vec3::new(plus(sum.x, from.x), plus(sum.y, from.y), plus(sum.z, from.z));
    }
    sum
}
