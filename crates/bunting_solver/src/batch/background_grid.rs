//! The background grids of the cloths of a batch: side by side, as the cloths are, or that of a single mesh across the
//! lanes of a vector, as a grid or as a net. All have the same bits.

use glam::Vec3;

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch, SingleGrid};
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::batch::single_mesh::{HeightPacks, pack_count};
use crate::batch::snapshot::ClothSnapshot;
use crate::fabric::{Background, Fabric, GridTransfer};
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::{lane3, set_lane3, splat3};
use crate::stability::added_mass::inertias;
use crate::step::Drive;
use crate::step::bdf::IntegratorHistory;
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
            BackgroundGrid::SingleNet(single) => {
                let $batch = &mut single.batch;
                $body
            }
        }
    };
}

impl<P: Pack> BackgroundGrid<P> {
    /// The background grids of a batch of cloths of a fabric, across the lanes if it is that of a single mesh; none if
    /// the fabric has none.
    pub fn of(fabric: &Fabric, is_single: bool) -> Option<Self> {
        let background = fabric.background()?;
        let grid = &background.fabric;
        let single = || {
            let batch = LaneBatch::single_cloth(grid)?;
            Some(Self::Single(Box::new(SingleGrid::new(batch, fabric, background))))
        };
        let single_net = || {
            let batch = LaneBatch::single_net(grid)?;
            Some(Self::SingleNet(Box::new(SingleGrid::new(batch, fabric, background))))
        };
        let single = if is_single { single().or_else(single_net) } else { None };
        let side_by_side = || Self::SideBySide(Box::new(LaneBatch::side_by_side(grid.clone())));
        Some(single.unwrap_or_else(side_by_side))
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

    /// Sets what acts on a cloth in the substep that `clock` is about to begin.
    pub fn set_drive(&mut self, cloth: usize, drive: &Drive, clock: &Clock) {
        with_grid!(self, batch => batch.set_drive(cloth, drive, clock));
    }

    /// Sets how the nodes of a cloth are stabilised: see [`LaneBatch::begin_nodes`].
    pub fn begin_nodes(&mut self, cloth: usize, state: &LaneState, damping_factor: f32) {
        with_grid!(self, batch => batch.begin_nodes(cloth, state, damping_factor));
    }

    /// Predicts the positions of the nodes: see [`LaneBatch::predict_nodes`].
    pub fn predict_nodes(
        &mut self,
        clock: Clock,
        frame_moved: bool,
        cloths: &mut [Option<LaneState>],
    ) {
        with_grid!(self, batch => batch.predict_nodes(clock, frame_moved, cloths));
    }

    /// Sets whether the nodes of a cloth are under-relaxed.
    pub fn set_nodes_near_rest(&mut self, cloth: usize, near_rest: bool) {
        with_grid!(self, batch => batch.set_nodes_near_rest(cloth, near_rest));
    }

    /// Makes one substep of a cloth's last two.
    pub fn join_last_substeps(&mut self, cloth: usize) {
        with_grid!(self, batch => batch.join_last_substeps(cloth));
    }

    /// The state of a cloth's nodes, whose history is that of the particles.
    pub fn snapshot(&self, cloth: usize, integrator: IntegratorHistory) -> ClothSnapshot {
        match self {
            Self::SideBySide(batch) => batch.snapshot_with(cloth, integrator),
            Self::Single(single) => single.batch.snapshot_with(cloth, integrator),
            Self::SingleNet(single) => single.batch.snapshot_with(cloth, integrator),
        }
    }

    /// Overwrites the state of a cloth's nodes.
    pub fn restore(&mut self, cloth: usize, nodes: &ClothSnapshot) {
        with_grid!(self, batch => batch.restore(&[(cloth, nodes)]));
    }

    /// Sets the wind at each node of some cloths less that of their drives, m/s.
    pub fn spread_local_wind(&mut self, of_cloths: &[(usize, Vec<Vec3>)]) {
        with_grid!(self, batch => batch.spread_local_wind(of_cloths));
    }

    /// Moves a node of a cloth by a vector over its mass, m³.
    pub fn push_node(&mut self, cloth: usize, node: usize, by: Vec3) {
        with_grid!(self, batch => {
            let (pack, lane) = batch.layout.locate(node, cloth);
            let inverse_mass = batch.masses.inverse[pack].lanes()[lane];
            let position = &mut batch.positions.packs_mut()[pack];
            let from = lane3(position, lane);
            set_lane3(position, lane, from + by * inverse_mass);
        });
    }

    /// Sets the velocities of some nodes of a cloth, m/s.
    pub fn set_velocities(&mut self, cloth: usize, of_nodes: &[(usize, Vec3)]) {
        with_grid!(self, batch => batch.set_node_velocities(cloth, of_nodes));
    }

    /// Sets the inverse masses of a cloth's nodes, 1/m².
    pub fn set_inverse_masses(&mut self, cloth: usize, of_nodes: &[f32]) {
        with_grid!(self, batch => {
            batch.layout.write_numbers(of_nodes, cloth, &mut batch.masses.inverse);
            batch.layout.write_numbers(&inertias(of_nodes), cloth, &mut batch.masses.inertia);
            batch.positions.set_inverse_masses(of_nodes);
        });
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

impl<Y: Layout<Pack8>> SingleGrid<Y> {
    fn new(batch: LaneBatch<Pack8, Y>, fabric: &Fabric, background: &Background) -> Self {
        let zero = Pack4::splat(0.0);
        let count = batch.layout.pack_count() * Pack8::WIDTH;
        let place = |node: usize| {
            let (pack, lane) = batch.layout.locate(node, 0);
            (pack * Pack8::WIDTH + lane) as u32
        };
        let places: Vec<u32> = (0..batch.fabric.particle_count()).map(place).collect();
        let GridTransfer { nodes, particles, means, held, moved_areas, heights, joined: _ } =
            background.transfer.clone();
        Self {
            heights: HeightPacks::new(&heights, fabric.particle_count(), &places),
            nodes: vec![zero; count],
            lowered: vec![
                splat3(Vec3::ZERO);
                if heights.is_empty() { 0 } else { pack_count(fabric.particle_count()) }
            ],
            unresolved: vec![zero; pack_count(fabric.particle_count()) * Pack8::WIDTH],
            transfer: GridTransfer {
                nodes: nodes.with_rows_at(&places, count),
                particles: particles.with_columns(&places),
                means: means.with_rows_at(&places, count),
                held: held.with_rows_at(&places, count),
                moved_areas,
                heights: Vec::new(),
                joined: Vec::new(),
            },
            batch,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::BackgroundGrid;
    use crate::batch::lane_batch::LaneBatch;
    use crate::fabric::{FabricBuilder, Grid};
    use crate::simd::registers::{Pack1, Pack8};

    #[test]
    fn the_grid_of_a_single_mesh_lies_across_the_lanes() {
        let grid = Grid::new(12, 9, 1.0, 0.8);
        let triangles = grid.triangles(false).into_flattened();
        let flat = FabricBuilder::new(grid.positions(), triangles.clone());
        let flat = Arc::new(flat.pin_where(|at, _| at.x == 0.0).build().expect("a good fabric"));
        let single = LaneBatch::single_mesh(&flat).expect("a flat mesh that fills its grid");
        assert!(matches!(single.background, Some(BackgroundGrid::Single(_))));
        for lanes in [LaneBatch::<Pack1>::side_by_side, |fabric| {
            LaneBatch::<Pack8>::side_by_side(fabric).to_one_lane()
        }] {
            let batch = lanes(Arc::clone(&flat));
            assert!(matches!(batch.background, Some(BackgroundGrid::SideBySide(_))));
        }
        let curved = grid.positions().iter().map(|at| *at + Vec3::Z * at.x * at.x).collect();
        let curved = Arc::new(FabricBuilder::new(curved, triangles).build().expect("a cloth"));
        assert!(LaneBatch::single_mesh(&curved).is_some());
    }
}
