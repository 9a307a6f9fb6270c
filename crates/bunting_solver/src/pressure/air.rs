//! What the air inside a cloth does.

use crate::batch::BatchError;

/// Pressure of the atmosphere at sea level, Pa.
pub(super) const ATMOSPHERE: f32 = 101_325.0;

/// The air inside a cloth, see [`ClothBatch::set_pressure`](crate::ClothBatch::set_pressure).
///
/// Pressures are those above the surrounding air's, in Pa = N/m², and act along the normals of the triangles: mesh that is wound
/// counter-clockwise, seen from outside, is pushed outwards.
///
/// ```
/// use bunting_solver::Pressure;
///
/// // A football: 80 kPa above the atmosphere's pressure.
/// assert!(matches!(Pressure::sealed(8e4), Pressure::Sealed { ambient, .. } if ambient > 1e5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Pressure {
    /// The same pressure always, as of a pump that goes on: for cloth that is closed or open.
    Constant {
        /// Pressure above the surrounding air's, Pa; negative where it sucks.
        pressure: f32,
    },
    /// Air that cannot leave: the product of its absolute pressure and its volume is constant. For closed cloth, whose holes
    /// are closed by lids without mass.
    Sealed {
        /// Pressure above the surrounding air's at the volume that the cloth has at rest, Pa.
        pressure: f32,
        /// Absolute pressure of the surrounding air, Pa. The lower, the softer the air: it is the pressure by which air
        /// pushes back at half its volume.
        ambient: f32,
    },
    /// Air that the wind, or the way of the cloth through still air, traps in a canopy that is open at one side. It comes to rest in
    /// there, and so has the dynamic pressure ½ρu² everywhere, u being its speed into the mouth.
    Canopy {
        /// Difference of pressure between inside and outside over ½ρu²: the drag coefficient of the mouth's area.
        coefficient: f32,
    },
}

impl Pressure {
    /// Drag coefficient of a hollow hemisphere that is open towards the wind: 1.42 for a rigid one (Hoerner 1965, 3-17), and
    /// less for cloth, through which some air escapes.
    pub const CANOPY: Self = Self::Canopy { coefficient: 1.3 };

    /// Air that cannot leave, at the atmosphere's pressure and a pressure above it, Pa, at the volume that the cloth has at
    /// rest.
    #[must_use]
    pub const fn sealed(pressure: f32) -> Self {
        Self::Sealed { pressure, ambient: ATMOSPHERE }
    }

    /// Names the first number that cannot be.
    pub(super) fn validate(self) -> Result<(), BatchError> {
        let (name, is_good) = match self {
            Self::Constant { pressure } => ("pressure", pressure.is_finite()),
            Self::Sealed { pressure, ambient } if pressure.is_finite() => {
                ("ambient pressure", ambient >= 0.0 && ambient.is_finite())
            }
            Self::Sealed { .. } => ("pressure", false),
            Self::Canopy { coefficient } => {
                ("coefficient", coefficient >= 0.0 && coefficient.is_finite())
            }
        };
        if is_good { Ok(()) } else { Err(BatchError::Pressure { name }) }
    }
}
