//! The component of cloth with air inside.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::Pressure;

use crate::cloth::error::NumberRule::{self, Finite, NotNegative};

/// The air inside a cloth, for cushions, balls, balloons and parachutes. Without this component air is only around it.
///
/// Pressures are those above the surrounding air's, in Pa, along the normals: the triangles of the mesh must be wound
/// counter-clockwise, seen from outside. A cushion looks full at ten times its weight per area, some 20 to 50 Pa. The more pressure, the more
/// substeps the cloth takes, up to those that [`ClothSettings::steps`](crate::ClothSettings::steps) allow; what these do not resolve is
/// not exerted, so that no cloth bursts. Pressure can change at any time: pump it up, let it out.
///
/// A number that cannot be is reported as [`ClothError::Pressure`](crate::ClothError::Pressure), and sealed air in an open mesh as
/// [`ClothError::OpenPressure`](crate::ClothError::OpenPressure): the cloth has no air then.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// let cushion = ClothPressure::Constant { pressure: 30.0 };
/// let ball = ClothPressure::sealed(20.0);
/// let parachute = ClothPressure::CANOPY;
/// # assert!(cushion != ball && ball != parachute);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub enum ClothPressure {
    /// The same pressure always, whatever the volume, for meshes that are closed or open. On an open one it pushes like a wind along
    /// the normals.
    Constant {
        /// Pressure above the surrounding air's, Pa; negative where it sucks.
        pressure: f32,
    },
    /// Air that cannot leave: pressure times volume is constant, with the absolute pressure (Boyle's law). The mesh must be closed, but for
    /// holes of up to a twentieth of its area.
    Sealed {
        /// Pressure above the surrounding air's at the volume that the mesh has at rest, Pa.
        pressure: f32,
        /// Absolute pressure of the surrounding air, Pa: how hard the air pushes back when its volume is halved. That of the
        /// atmosphere is stiffer than substeps resolve, and is softer then, as far as it must be.
        ambient: f32,
    },
    /// Air that is trapped in a canopy with one mouth, as a parachute or a spinnaker has: it has the dynamic pressure of the wind that
    /// blows into the mouth, or through which the canopy falls, everywhere inside. Shallow canopies trap less, flat ones none.
    Canopy {
        /// Drag coefficient of the mouth's area towards the wind.
        coefficient: f32,
    },
}

impl Default for ClothPressure {
    /// A cushion: constant 30 Pa.
    fn default() -> Self {
        Self::Constant { pressure: 30.0 }
    }
}

impl ClothPressure {
    /// A canopy with the drag coefficient 1.3, of a hemisphere of cloth.
    pub const CANOPY: Self = match Pressure::CANOPY {
        Pressure::Canopy { coefficient } => Self::Canopy { coefficient },
        _ => Self::Canopy { coefficient: 0.0 },
    };

    /// Air that cannot leave, in an atmosphere of 101 325 Pa, with a pressure above it, Pa, at the volume that the mesh has at rest.
    #[must_use]
    pub const fn sealed(pressure: f32) -> Self {
        match Pressure::sealed(pressure) {
            Pressure::Sealed { pressure, ambient } => Self::Sealed { pressure, ambient },
            _ => Self::Constant { pressure },
        }
    }

    /// The first number that cannot be: the name of its field, its value, and what it must be.
    pub(super) fn wrong_number(&self) -> Option<(&'static str, f32, NumberRule)> {
        let numbers = match *self {
            Self::Constant { pressure } => [Some(("pressure", pressure, Finite)), None],
            Self::Sealed { pressure, ambient } => {
                [Some(("pressure", pressure, Finite)), Some(("ambient", ambient, NotNegative))]
            }
            Self::Canopy { coefficient } => [Some(("coefficient", coefficient, NotNegative)), None],
        };
        numbers.into_iter().flatten().find(|(_, value, rule)| !rule.allows(*value))
    }
}

impl From<ClothPressure> for Pressure {
    fn from(air: ClothPressure) -> Self {
        match air {
            ClothPressure::Constant { pressure } => Self::Constant { pressure },
            ClothPressure::Sealed { pressure, ambient } => Self::Sealed { pressure, ambient },
            ClothPressure::Canopy { coefficient } => Self::Canopy { coefficient },
        }
    }
}
