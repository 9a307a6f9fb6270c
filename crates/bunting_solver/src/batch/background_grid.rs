//! The background grids of the cloths of a batch: side by side, as the cloths are, or that of a lone cloth across the
//! lanes of a vector. Both have the same bits.

use glam::Vec3;

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch, SingleGrid};
use crate::batch::layout::{Layout, Positions};
use crate::batch::single_cloth::SingleCloth;
use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::{Pack3, lane3};
use crate::step::clock::Clock;
use crate::step::load_stretch::LoadStretch;
use crate::step::parameters::ParameterInputs;

/// Evaluates an expression with the batch of grids in any layout.
macro_rules! with_grid {
    ($grid:expr, $batch:ident => $body:expr) => {
        match $grid {
            BackgroundGrid::SideBySide($batch) => $body,
            BackgroundGrid::Single(single) => {
                let $batch = &mut single.batch;
                $body
            }
        }
    };
}

impl<P: Pack> BackgroundGrid<P> {
    /// The background grids of a batch of cloths of a fabric; none if it has none.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        let background = fabric.background()?;
        let grid = &background.fabric;
        let is_single = P::WIDTH == 1 && background.transfer.heights.is_empty();
        let single = if is_single { LaneBatch::single_cloth(grid) } else { None };
        Some(match single {
            Some(batch) => Self::Single(Box::new(SingleGrid::new(batch, fabric))),
            None => Self::SideBySide(Box::new(LaneBatch::side_by_side(grid.clone()))),
        })
    }

    /// Marks a cloth's lanes as empty.
    pub fn set_empty(&mut self, cloth: usize) {
        with_grid!(self, batch => batch.set_empty(cloth));
    }

    /// Sets how far a cloth's loads may stretch it.
    pub fn set_load_stretch(&mut self, cloth: usize, stretch: &LoadStretch) {
        with_grid!(self, batch => batch.set_load_stretch(cloth, stretch));
    }

    /// Computes all values that depend on a cloth's material, along the grid's rows, and on the formula.
    pub fn set_inputs(&mut self, cloth: usize, inputs: &ParameterInputs) {
        with_grid!(self, batch => batch.set_inputs(cloth, inputs));
    }

    /// Sets the inverse masses of a cloth's nodes, 1/m².
    pub fn set_inverse_masses(&mut self, cloth: usize, of_nodes: &[f32]) {
        with_grid!(self, batch => {
            batch.layout.write_numbers(of_nodes, cloth, &mut batch.masses.inverse);
            batch.positions.set_inverse_masses(of_nodes);
        });
    }

    /// Takes over the time of the cloths' batch.
    pub fn set_clock(&mut self, clock: Clock) {
        with_grid!(self, batch => batch.clock = clock);
    }

    /// Solves bending along the grids' lines.
    pub fn solve_bending(&mut self) {
        with_grid!(self, batch => batch.solve_bending_before_stretch());
    }

    /// Solves stretch and shear.
    pub fn solve_stretch(&mut self) {
        with_grid!(self, batch => batch.solve_stretch_of_grid());
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    fn set_empty(&mut self, cloth: usize) {
        self.parameters.set_empty(Y::lanes(cloth));
    }

    fn set_load_stretch(&mut self, cloth: usize, stretch: &LoadStretch) {
        self.parameters.set_load_stretch(Y::lanes(cloth), stretch);
    }
}

impl SingleGrid {
    fn new(batch: LaneBatch<Pack8, SingleCloth<Pack8>>, fabric: &Fabric) -> Self {
        let zero = Pack4::splat(0.0);
        let particles = vec![zero; fabric.particle_count()];
        Self {
            nodes: vec![zero; batch.fabric.particle_count()],
            unresolved: particles.clone(),
            particles,
            columns: batch.fabric.grid().map_or(1, |grid| grid.columns as usize),
            batch,
        }
    }

    /// Takes over the particles' positions from those of a batch of one lane.
    pub fn take_particles<P: Pack>(&mut self, positions: &[Pack3<P>]) {
        for (particle, position) in self.particles.iter_mut().zip(positions) {
            let Vec3 { x, y, z } = lane3(position, 0);
            particle.lanes_mut().copy_from_slice(&[x, y, z, 0.0]);
        }
    }

    /// Writes the nodes' positions to the batch.
    pub fn write_nodes(&mut self) {
        let packs = self.batch.positions.packs_mut();
        let in_row = self.columns.div_ceil(Pack8::WIDTH);
        for (nodes, packs) in self.nodes.chunks(self.columns).zip(packs.chunks_mut(in_row)) {
            for (nodes, [x, y, z]) in nodes.chunks(Pack8::WIDTH).zip(packs) {
                let lanes = x.lanes_mut().iter_mut().zip(y.lanes_mut()).zip(z.lanes_mut());
                for (node, ((x, y), z)) in nodes.iter().zip(lanes) {
                    [*x, *y, *z, _] = node.vector();
                }
            }
        }
    }

    /// Reads the nodes' positions from the batch.
    pub fn read_nodes(&mut self) {
        let packs = self.batch.positions.packs_mut();
        let in_row = self.columns.div_ceil(Pack8::WIDTH);
        for (nodes, packs) in self.nodes.chunks_mut(self.columns).zip(packs.chunks(in_row)) {
            for (nodes, [x, y, z]) in nodes.chunks_mut(Pack8::WIDTH).zip(packs) {
                let lanes = x.lanes().iter().zip(y.lanes()).zip(z.lanes());
                for (node, ((&x, &y), &z)) in nodes.iter_mut().zip(lanes) {
                    node.lanes_mut().copy_from_slice(&[x, y, z, 0.0]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::BackgroundGrid;
    use crate::fabric::{FabricBuilder, Grid};
    use crate::simd::registers::{Pack1, Pack8};

    #[test]
    fn the_grid_of_a_lone_mesh_lies_across_the_lanes() {
        let grid = Grid::new(12, 9, 1.0, 0.8);
        let all = grid.triangles(false);
        let holed = all.iter().enumerate().filter(|(index, _)| !(80..84).contains(index));
        let holed: Vec<[u32; 3]> = holed.map(|(_, corners)| *corners).collect();
        for triangles in [all, holed] {
            let mesh = FabricBuilder::new(grid.positions(), triangles.into_flattened());
            let fabric = mesh.pin_where(|at, _| at.x == 0.0).build().expect("a good fabric");
            assert!(matches!(
                BackgroundGrid::<Pack1>::of(&fabric),
                Some(BackgroundGrid::Single(_))
            ));
            let eight = BackgroundGrid::<Pack8>::of(&fabric);
            assert!(matches!(eight, Some(BackgroundGrid::SideBySide(_))));
        }
        let curved = grid.positions().iter().map(|at| *at + Vec3::Z * at.x * at.x).collect();
        let curved = FabricBuilder::new(curved, grid.triangles(false).into_flattened());
        assert!(BackgroundGrid::<Pack1>::of(&curved.build().expect("a good fabric")).is_none());
    }
}
