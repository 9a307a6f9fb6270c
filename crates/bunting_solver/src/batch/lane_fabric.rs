//! Numbers that a batch computes from its fabrics, of each fabric by itself and in lanes.

use core::ops::Range;
use std::sync::Arc;

use crate::contact::itself::mesh::ContactMesh;
use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::stability::added_mass::InverseMasses;
use crate::stability::pole::{Pole, PolePacks};

/// A fabric of a batch: of all its cloths, or of the cloth in one lane.
#[derive(Clone, Debug)]
pub(crate) struct LaneFabric {
    pub fabric: Arc<Fabric>,
    /// The line about which a cloth of this fabric is free to turn.
    pub pole: Option<Pole>,
    /// Inverse masses for a substep, from which those of each cloth are computed.
    pub inverse_masses: InverseMasses,
    /// Features that may touch; none until a cloth of the batch keeps its layers apart.
    pub contact_mesh: Option<Arc<ContactMesh>>,
}

impl LaneFabric {
    /// A fabric in substeps of the effective length `substep`, s; zero for no added mass.
    pub fn new(fabric: Arc<Fabric>, substep: f32) -> Self {
        Self {
            pole: Pole::of(&fabric),
            inverse_masses: if substep == 0.0 {
                InverseMasses::without_added(&fabric)
            } else {
                InverseMasses::new(&fabric, substep)
            },
            contact_mesh: None,
            fabric,
        }
    }
}

/// Numbers of each lane's fabric that do not belong to a particle or a constraint.
#[derive(Clone, Debug)]
pub(crate) struct FabricNumbers<P: Pack> {
    /// Area of the whole cloth, m².
    pub area: P,
    /// Length of a grid's diagonals at rest, m; zero of other meshes.
    pub diagonal_length: P,
    /// The line about which the cloth is free to turn. All fabrics of a batch have one, or none has.
    pub pole: Option<PolePacks<P>>,
}

impl<P: Pack> FabricNumbers<P> {
    /// Numbers of one fabric in all lanes.
    pub fn new(fabric: &LaneFabric) -> Self {
        let mut numbers = Self {
            area: P::splat(0.0),
            diagonal_length: P::splat(0.0),
            pole: fabric.pole.map(PolePacks::splat),
        };
        numbers.set(0..P::WIDTH, fabric);
        numbers
    }

    /// Sets the numbers of some lanes to those of a fabric.
    pub fn set(&mut self, lanes: Range<usize>, LaneFabric { fabric, pole, .. }: &LaneFabric) {
        let diagonal = fabric.diagonal();
        self.area.lanes_mut()[lanes.clone()].fill(fabric.mass_area());
        self.diagonal_length.lanes_mut()[lanes.clone()].fill(diagonal);
        if let (Some(packs), Some(pole)) = (&mut self.pole, pole) {
            packs.set_lanes(&lanes, *pole);
        }
    }
}
