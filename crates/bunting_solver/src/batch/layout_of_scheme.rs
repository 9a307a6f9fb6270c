//! The layout of a batch of one cloth, which depends on the scheme: the lanes of a vector hold parts of yarns, which
//! Gauss–Seidel does not solve.

use std::sync::Arc;

use crate::batch::cloth_batch::{ClothBatch, Lanes};
use crate::batch::exchange::Entering;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::Layout;
use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::registers::Pack1;
use crate::simd::vec3::set_lane3;
use crate::step::Scheme;
use crate::step::guides::ClothGuides;

impl Lanes {
    /// A batch of one cloth, across all lanes of a vector if it can lie there.
    pub(super) fn of_one_cloth(fabric: Arc<Fabric>) -> Self {
        if let Some(batch) = LaneBatch::single_cloth(&fabric) {
            Self::Single(Box::new(batch))
        } else if let Some(batch) = LaneBatch::single_net(&fabric) {
            Self::SingleNet(Box::new(batch))
        } else {
            Self::One(Box::new(LaneBatch::side_by_side(fabric)))
        }
    }
}

impl ClothBatch {
    /// Moves a lone cloth to the layout that a scheme needs, if it does not lie in it.
    pub(super) fn lay_out_for(&mut self, scheme: Scheme) {
        let lanes = match (&self.0, scheme) {
            (Lanes::Single(single), Scheme::GaussSeidel) => {
                Lanes::One(Box::new(single.to_one_lane()))
            }
            (Lanes::SingleNet(single), Scheme::GaussSeidel) => {
                Lanes::One(Box::new(single.to_one_lane()))
            }
            (Lanes::One(one), Scheme::Yarns)
                if one.clock.settings.scheme == Scheme::GaussSeidel =>
            {
                let mut lanes = Lanes::of_one_cloth(Arc::clone(&one.fabric));
                match &mut lanes {
                    Lanes::Single(single) => single.take_over(one),
                    Lanes::SingleNet(single) => single.take_over(one),
                    _ => return,
                }
                lanes
            }
            _ => return,
        };
        self.0 = lanes;
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// The batch of one lane for the only cloth of this one, for a scheme without chains.
    pub fn to_one_lane(&self) -> LaneBatch<Pack1> {
        let mut batch = LaneBatch::side_by_side(Arc::clone(&self.fabric));
        batch.take_over(self);
        batch
    }

    /// Takes over the only cloth of another batch of the same fabric between two ticks, with all that is set for it.
    fn take_over<Q: Pack, Z: Layout<Q>>(&mut self, other: &LaneBatch<Q, Z>) {
        if let Some(cloth) = &other.lanes[0] {
            let (snapshot, material) = (&other.snapshot(0), cloth.material);
            let fabric = &Arc::clone(&self.fabric);
            self.exchange(&[], &[Entering { lane: 0, fabric, snapshot, material }]);
            let mut state = LaneState { inputs: None, added_mass: None, ..cloth.clone() };
            state.guides.iter_mut().for_each(ClothGuides::write_again);
            state.seams.iter_mut().for_each(|seams| seams.forget_places());
            self.lanes[0] = Some(state);
        }
        self.clock = other.clock;
        self.fabrics[0].contact_mesh.clone_from(&other.fabrics[0].contact_mesh);
        // Between two ticks the scratch array holds the normals.
        for (particle, normal) in other.of_cloth(&other.scratch, 0).enumerate() {
            let (pack, lane) = self.layout.locate(particle, 0);
            set_lane3(&mut self.scratch[pack], lane, normal);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::batch::lane_count::LaneCount;
    use crate::batch::snapshot::ClothSnapshot;
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};
    use crate::step::{Drive, StepSettings};

    /// A flag as a grid, and as a net.
    fn flags() -> [Fabric; 2] {
        let grid = Grid::new(12, 12, 1.0, 1.0);
        let mesh = FabricBuilder::new(grid.positions(), grid.triangles(false).into_flattened());
        [FabricBuilder::grid(grid), mesh]
            .map(|flag| flag.pin_where(|at, _| at.x == 0.0).build().expect("a good fabric"))
    }

    #[test]
    fn a_lone_cloth_returns_to_its_layout_after_gauss_seidel() {
        for fabric in flags().map(Arc::new) {
            let fly = |lanes: LaneCount| {
                let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
                let at_rest = ClothSnapshot::at_rest(&fabric);
                batch.insert(&at_rest, FabricMaterial::NYLON).expect("a free lane");
                let wind = Vec3::new(5.0, 0.0, 2.0);
                batch.drive(0, Drive { wind, ..Drive::default() }).expect("a good drive");
                for tick in 0..30 {
                    let is_yarns = tick != 10;
                    let yarns = StepSettings::default();
                    batch.step(
                        1.0 / 60.0,
                        if is_yarns { yarns } else { StepSettings::gauss_seidel(4) },
                    );
                    let is_lone = matches!(batch.0, Lanes::Single(_) | Lanes::SingleNet(_));
                    assert_eq!(is_lone, lanes == LaneCount::One && is_yarns, "tick {tick}");
                }
                let mut normals = Vec::new();
                batch.copy_normals(0, &mut normals);
                (batch.snapshot(0), normals)
            };
            // The lanes of eight cloths never change.
            assert!(fly(LaneCount::One) == fly(LaneCount::Eight), "other bits");
        }
    }
}
