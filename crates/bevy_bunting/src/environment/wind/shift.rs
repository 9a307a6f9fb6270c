//! Winds in a world that is moved as a whole.

use bevy_ecs::prelude::*;

use crate::environment::wind::field::{GustTravel, WindField};
use crate::environment::wind::tick_wind::TickWind;
use crate::environment::wind::wake::WakeTrail;
use crate::motion::shift::ShiftOrigin;

/// Moves what winds know of places: the phases of gusts and the trails of wakes. All else is where the entities of the winds are.
pub(super) fn shift_winds(
    shift: On<ShiftOrigin>,
    mut fields: Query<(&WindField, &mut GustTravel)>,
    mut trails: Query<&mut WakeTrail>,
    mut wind: ResMut<TickWind>,
) {
    let by = shift.acting();
    for (field, mut travel) in &mut fields {
        let lengths = by.as_dvec3() / f64::from(field.gust_length());
        // Of a field that is not finite it is not.
        if lengths.is_finite() {
            travel.0 += lengths;
        }
    }
    trails.iter_mut().for_each(|mut trail| trail.shift(by));
    wind.shift(by);
}
