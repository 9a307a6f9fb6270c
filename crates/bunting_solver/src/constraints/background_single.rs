//! A single mesh on its background grid, as in `background.rs`. Particles and nodes are interpolated from one another with
//! the coordinates of a vector in the lanes of a register: neither particles nor nodes of a row are neighbours in
//! memory.

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch, SingleGrid};
use crate::batch::layout::{Layout, Positions};
use crate::batch::single_mesh::{
    AddHeightPacks, MeshPositions, SingleMesh, read_vectors, write_vectors,
};
use crate::constraints::interpolate::{AddInterpolated, Interpolate, Remainder};
use crate::fabric::GridTransfer;
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::Pack3;

/// Evaluates an expression with the background grid or the net of a single mesh, if it has one.
macro_rules! with_single {
    ($background:expr, $grid:ident => $body:expr) => {
        match $background {
            Some(BackgroundGrid::Single($grid)) => $body,
            Some(BackgroundGrid::SingleNet($grid)) => $body,
            Some(BackgroundGrid::SideBySide(_)) | None => {}
        }
    };
}

impl LaneBatch<Pack8, SingleMesh> {
    /// Projects the predicted positions onto all constraints.
    pub fn solve_constraints(&mut self) {
        self.solve_all_bending();
        self.solve_all_but_bending();
    }

    /// The first part of [`solve_constraints`](Self::solve_constraints): bending.
    pub fn solve_all_bending(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        if self.integrates_particles() {
            let moves = self.lanes[0].as_ref().is_some_and(|state| !state.moving_pins.is_empty());
            with_single!(&mut self.background, grid => {
                grid.project(self.positions.read_vectors());
                if moves {
                    grid.batch.update_tethered_pins(0);
                }
            });
            self.draw_nodes();
        }
        with_single!(&mut self.background, grid => grid.batch.solve_bending_before_stretch());
    }

    /// The second part of [`solve_constraints`](Self::solve_constraints): all other constraints.
    pub fn solve_all_but_bending(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        let integrates = self.integrates_particles();
        if !integrates {
            // The particles' own vectors are those of pins alone.
            self.positions.read_vectors();
        }
        with_single!(&mut self.background, grid => {
            grid.batch.solve_stretch_of_grid();
            grid.batch.join_ends();
            grid.batch.update_node_velocities(&mut self.lanes);
            grid.place_particles(&mut self.positions);
            if !integrates && self.clock.begun == self.clock.settings.substeps {
                grid.give_velocities(&mut self.velocity, self.layout.velocities_mut());
            }
        });
        self.sum_reactions();
        self.solve_guides();
        self.solve_contacts();
    }
}

impl<Y: Layout<Pack8>> SingleGrid<Y> {
    /// Moves the predicted nodes to where the particles are, m.
    fn project(&mut self, of: &[Pack4]) {
        let Self { batch, nodes, unresolved, lowered, transfer, heights } = self;
        let GridTransfer { particles: rows, means, held, .. } = &*transfer;
        read_vectors(batch.positions.packs_mut(), nodes);
        Pack4::run(Interpolate { rows: held, from: of, to: nodes });
        Pack4::run(Remainder { rows, from: nodes, of, to: unresolved });
        if !heights.is_empty() {
            write_vectors(unresolved, lowered);
            Pack8::run(AddHeightPacks { heights, sign: -1.0, nodes, to: lowered });
            read_vectors(lowered, unresolved);
        }
        Pack4::run(AddInterpolated { rows: means, from: unresolved, to: nodes });
        write_vectors(nodes, batch.positions.packs_mut());
    }

    /// Interpolates the positions of the free particles from the nodes, m.
    fn place_particles(&mut self, particles: &mut MeshPositions) {
        let Self { batch, nodes, transfer, heights, .. } = self;
        read_vectors(batch.positions.packs_mut(), nodes);
        let to = particles.vectors_mut();
        Pack4::run(Interpolate { rows: &transfer.particles, from: nodes, to });
        particles.write_vectors();
        Pack8::run(AddHeightPacks { heights, sign: 1.0, nodes, to: particles.packs_mut() });
    }

    /// Interpolates the velocities of the free particles from the nodes, m/s, by way of vectors.
    fn give_velocities(&mut self, particles: &mut [Pack3<Pack8>], vectors: &mut [Pack4]) {
        let Self { batch, nodes, transfer, .. } = self;
        read_vectors(particles, vectors);
        read_vectors(&batch.velocity, nodes);
        Pack4::run(Interpolate { rows: &transfer.particles, from: nodes, to: vectors });
        write_vectors(vectors, particles);
    }
}
