//! Air that cannot leave: Boyle's law, pV = const.
//!
//! The pressure falls by p/V for each unit of volume, with p absolute, and a volume that yields by Y to a unit of pressure in a substep would
//! vibrate faster than the substep resolves where Y p/V is more than 1. Such air counts as softer: it
//! answers to a change of volume by 1/Y.

use super::state::LanePressure;

/// Greatest Y p/V: at 1 a volume that nothing else holds is at its rest after one substep. Larger: taut balls vibrate from substep to
/// substep. Smaller: a ball on the ground is flatter.
const STIFFEST: f32 = 0.5;

/// Least volume, as a part of the volume at rest, at which the pressure still rises. Smaller: a cloth that is pressed flat bursts.
const LEAST_VOLUME: f32 = 0.1;

impl LanePressure {
    /// The pressure along the normals at the present volume, Pa, given that at rest and the surrounding air's, Pa; `yielding`
    /// is by how much a unit of pressure makes the volume larger in a substep, m³/Pa.
    pub(super) fn sealed(&self, pressure: f32, ambient: f32, yielding: f32) -> f32 {
        // A mesh that is wound inwards has a negative volume, and a negative pressure along its normals.
        let sign = self.rest_volume.signum();
        let part = (self.volume() / self.rest_volume).max(LEAST_VOLUME);
        let resolved = STIFFEST * self.rest_volume.abs() / yielding.max(f32::MIN_POSITIVE);
        let absolute = (pressure + ambient).min(resolved);
        sign * (pressure + absolute * (1.0 / part - 1.0))
    }
}
