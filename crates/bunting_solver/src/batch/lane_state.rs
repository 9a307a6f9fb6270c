//! What a batch keeps of each cloth besides its particles.

use crate::contact::collider::Collider;
use crate::fabric::FabricMaterial;
use crate::stability::added_mass::AddedMass;
use crate::stability::pin_strain::PinStrain;
use crate::step::Drive;
use crate::step::bdf::IntegratorHistory;
use crate::step::parameters::ParameterInputs;

/// What a batch keeps of one cloth besides its particles.
#[derive(Clone, Debug)]
pub(crate) struct LaneState {
    pub material: FabricMaterial,
    pub drive: Drive,
    pub colliders: Vec<Collider>,
    /// For each collider, the particles that may touch it in this tick.
    pub contacts: Vec<Vec<u32>>,
    /// Moment about the pole of this substep's corrections from outside the cloth, by contacts and by users, in
    /// units of the density, m⁴.
    pub external_moment: f32,
    pub history: IntegratorHistory,
    pub pin_strain: PinStrain,
    /// What the lane's parameters were computed from; none if they are yet to be.
    pub inputs: Option<ParameterInputs>,
    /// What the lane's inverse masses were computed from; none if they are yet to be.
    pub added_mass: Option<AddedMass>,
}

impl LaneState {
    /// A cloth that nothing acts on but standard gravity and still air.
    pub fn new(material: FabricMaterial) -> Self {
        Self {
            material,
            drive: Drive::default(),
            colliders: Vec::new(),
            contacts: Vec::new(),
            external_moment: 0.0,
            history: IntegratorHistory::default(),
            pin_strain: PinStrain::default(),
            inputs: None,
            added_mass: None,
        }
    }
}
