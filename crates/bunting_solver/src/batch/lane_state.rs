//! The state of a cloth in a batch besides its particles.

use glam::Vec3;

use crate::anchors::holds::Holds;
use crate::anchors::pin_reports::PinReports;
use crate::contact::candidates::Candidates;
use crate::contact::collider::Collider;
use crate::contact::itself::state::SelfContacts;
use crate::contact::pressing::Pressing;
use crate::contact::reaction::ReactionSum;
use crate::fabric::{Fabric, FabricMaterial};
use crate::pressure::LanePressure;
use crate::seams::state::LaneSeams;
use crate::stability::added_mass::AddedMass;
use crate::stability::pin_strain::PinStrain;
use crate::step::Drive;
use crate::step::bdf::IntegratorHistory;
use crate::step::guides::ClothGuides;
use crate::step::moving_pins::MovingPins;
use crate::step::parameters::ParameterInputs;

/// The state of one cloth in a batch besides its particles.
#[derive(Clone, Debug)]
pub(crate) struct LaneState {
    pub material: FabricMaterial,
    pub drive: Drive,
    pub colliders: Vec<Collider>,
    /// What may touch each collider in this tick.
    pub contacts: Vec<Candidates>,
    /// Contacts of the cloth with itself, if it has any.
    pub self_contacts: Option<Box<SelfContacts>>,
    /// Whether the contacts of the present substep are solved together with those of other cloths, after the batch's.
    pub is_grouped: bool,
    /// What the cloth has done to each collider in this tick; empty if none reports it.
    pub reactions: Vec<ReactionSum>,
    /// How hard colliders press the cloth in this tick.
    pub pressing: Pressing,
    /// Greatest speed, relative to the frame, of the colliders that are near in this tick, m/s, if pins or springs hold the cloth.
    pub approach: f32,
    /// Moment about the pole of this substep's corrections from outside the cloth, by contacts and by users, in
    /// units of the density, m⁴.
    pub external_moment: f32,
    pub history: IntegratorHistory,
    pub pin_strain: PinStrain,
    /// Whether the pins are where they are at rest.
    pub are_pins_at_rest: bool,
    pub moving_pins: MovingPins,
    pub guides: Option<ClothGuides>,
    /// Wind at each particle less that of the drive, m/s, along the frame's axes at the end of the tick.
    pub local_wind: Option<Vec<Vec3>>,
    /// The air inside the cloth, if it has a pressure.
    pub inner_air: Option<Box<LanePressure>>,
    /// Springs and rails that hold particles, if any do.
    pub holds: Option<Box<Holds>>,
    /// What of the cloth is sewn together, if anything is.
    pub seams: Option<Box<LaneSeams>>,
    /// What the cloth does to its pins, if that is asked for.
    pub pin_reports: Option<Box<PinReports>>,
    /// Velocities of the pins at the end of the last tick, m/s, of a restored cloth whose pins do not report yet.
    pub pin_velocities: Vec<Vec3>,
    /// Inputs of the lane's parameters; none if the parameters must be computed.
    pub inputs: Option<ParameterInputs>,
    /// Inputs of the lane's inverse masses besides the substep; none if the masses must be computed.
    pub added_mass: Option<AddedMass>,
}

impl LaneState {
    /// A cloth under standard gravity in still air, without colliders.
    pub fn new(material: FabricMaterial) -> Self {
        Self {
            material,
            drive: Drive::default(),
            colliders: Vec::new(),
            contacts: Vec::new(),
            self_contacts: None,
            is_grouped: false,
            reactions: Vec::new(),
            pressing: Pressing::default(),
            approach: 0.0,
            external_moment: 0.0,
            history: IntegratorHistory::default(),
            pin_strain: PinStrain::default(),
            are_pins_at_rest: true,
            moving_pins: MovingPins::default(),
            guides: None,
            local_wind: None,
            inner_air: None,
            holds: None,
            seams: None,
            pin_reports: None,
            pin_velocities: Vec::new(),
            inputs: None,
            added_mass: None,
        }
    }

    /// Whether the cloth may touch colliders in this tick.
    pub fn is_near_colliders(&self) -> bool {
        self.contacts.iter().any(|candidates| !candidates.is_empty())
    }

    /// Pressure of the air inside the cloth in the last substep, Pa; none without air, or before the first substep.
    pub fn pressure_inside(&self) -> Option<f32> {
        self.inner_air.as_ref().and(self.history.pressure)
    }

    /// Whether pins or springs hold the cloth, which has this fabric: loose cloth can follow a shape, and guides may prescribe any strain.
    pub fn is_held(&self, fabric: &Fabric) -> bool {
        self.holds.is_some() || fabric.has_pins()
    }

    /// Whether something may act on single particles in this tick.
    pub fn is_acted_on(&self) -> bool {
        self.is_near_colliders()
            || self.self_contacts.is_some()
            || self.guides.is_some()
            || self.local_wind.is_some()
            || self.holds.is_some()
            || self.pin_reports.is_some()
            || !self.moving_pins.is_empty()
    }
}
