//! Gives cloths air, and takes it away.

use super::air::Pressure;
use super::state::LanePressure;
use crate::batch::BatchError;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::simd::lane::Pack;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Gives a cloth air, or takes it away.
    ///
    /// # Errors
    ///
    /// Those of [`LanePressure::new`]; the cloth keeps its air.
    pub fn set_pressure(&mut self, cloth: usize, air: Option<Pressure>) -> Result<(), BatchError> {
        let fabric = &self.fabrics[Y::fabric_of(cloth)].fabric;
        let Some(state) = &mut self.lanes[cloth] else { return Ok(()) };
        let former = state.inner_air.as_ref().map(|inner| inner.air);
        if former == air {
            return Ok(());
        }
        let kind = |air: Option<Pressure>| air.as_ref().map(core::mem::discriminant);
        match (air, &mut state.inner_air) {
            (Some(air), Some(inner)) if kind(former) == kind(Some(air)) => {
                air.validate()?;
                inner.air = air;
            }
            (Some(air), inner) => *inner = Some(Box::new(LanePressure::new(air, fabric)?)),
            (None, inner) => *inner = None,
        }
        // A cloth that is new in its lane comes with the pressure that it had.
        if former.is_some() && kind(former) != kind(air) {
            state.history.pressure = None;
        }
        // Canopies change the coefficients of the air.
        state.inputs = None;
        Ok(())
    }
}
