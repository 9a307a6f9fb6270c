//! A single mesh on its background grid, as in `background.rs`. Particles and nodes are interpolated from one another with
//! the coordinates of a vector in the lanes of a register: neither particles nor nodes of a row are neighbours in
//! memory.

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch, SingleGrid};
use crate::batch::layout::Positions;
use crate::batch::single_mesh::{SingleMesh, read_vectors, write_vectors};
use crate::constraints::interpolate::{AddInterpolated, Interpolate, Remainder};
use crate::fabric::GridTransfer;
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};

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
        let Some(BackgroundGrid::Single(grid)) = &mut self.background else { return };
        grid.batch.predict_nodes(self.clock, self.parameters.any_frame_moved);
        grid.project(self.positions.read_vectors());
        self.draw_nodes();
        let Some(BackgroundGrid::Single(grid)) = &mut self.background else { return };
        grid.batch.solve_bending_before_stretch();
    }

    /// The second part of [`solve_constraints`](Self::solve_constraints): all other constraints.
    pub fn solve_all_but_bending(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        let Some(BackgroundGrid::Single(grid)) = &mut self.background else { return };
        grid.batch.solve_stretch_of_grid();
        grid.place_particles(self.positions.vectors_mut());
        self.positions.write_vectors();
        self.solve_tethers();
        self.sum_reactions();
        self.solve_guides();
        self.solve_contacts();
    }
}

impl SingleGrid {
    /// Moves the predicted nodes to where the particles are, m.
    fn project(&mut self, of: &[Pack4]) {
        let Self { batch, nodes, unresolved, transfer } = self;
        let GridTransfer { particles: rows, means, held, .. } = &*transfer;
        read_vectors(batch.positions.packs_mut(), nodes);
        Pack4::run(Interpolate { rows: held, from: of, to: nodes });
        Pack4::run(Remainder { rows, from: nodes, of, to: unresolved });
        Pack4::run(AddInterpolated { rows: means, from: unresolved, to: nodes });
        write_vectors(nodes, batch.positions.packs_mut());
    }

    /// Interpolates the positions of the free particles from the nodes, m.
    fn place_particles(&mut self, particles: &mut [Pack4]) {
        let Self { batch, nodes, transfer, .. } = self;
        read_vectors(batch.positions.packs_mut(), nodes);
        batch.update_node_velocities();
        Pack4::run(Interpolate { rows: &transfer.particles, from: nodes, to: particles });
    }
}
