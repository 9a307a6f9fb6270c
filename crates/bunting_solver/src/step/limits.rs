//! The number of substeps that a fabric needs, from its geometry, the tick and the acceleration that it bears.

use core::ops::RangeInclusive;

use crate::fabric::Fabric;
use crate::step::{Scheme, StepSettings};

/// Greatest h² T/(m l) of the topmost link of a hanging cloth. Larger: links vibrate faster than substeps
/// with frozen link directions can resolve. With this value, grids of 33 × 33 and 65 × 65 particles a square
/// metre take 2 and 4 substeps in a tick of 1/60 s.
const FASTEST_VIBRATION: f32 = 0.75;

/// Fraction of a substep by which a tick may exceed a whole number of substeps: in 32 bits 1/60 s is longer
/// than two of 1/120 s. Larger: substeps are longer than they should be.
const TOO_LONG: f32 = 1e-3;

/// Limits within which the number of substeps is chosen, from the fabric, the tick and the acceleration that the cloth
/// bears: gravity, or that of its [`EffortClass`](crate::EffortClass).
///
/// ```
/// use bunting_solver::StepLimits;
///
/// // At least 720 substeps in a second, for layers that lie on one another.
/// let fine = StepLimits { rate: 720, ..StepLimits::default() };
/// # assert!(fine.rate > StepLimits::default().rate);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "bevy_reflect",
    derive(bevy_reflect::Reflect),
    type_path = "bunting_solver",
    reflect(Debug, PartialEq, Hash, Clone)
)]
pub struct StepLimits {
    /// Constraint solver and integrator.
    pub scheme: Scheme,
    /// Least and greatest number of substeps in a tick.
    pub substeps: RangeInclusive<u32>,
    /// Least rate of substeps, 1/s, whatever the length of a tick: longer ticks are divided into more. Faster motion than the
    /// substeps resolve is damped.
    pub rate: u32,
    /// Passes in a substep, see [`StepSettings::passes`].
    pub passes: u32,
}

impl StepLimits {
    /// Settings for a fabric in ticks of `tick` seconds under an acceleration in m/s²: gravity for calm cloth, otherwise
    /// that of the cloth's [`EffortClass`](crate::EffortClass).
    ///
    /// A link of length l under the tension T of the cloth below it vibrates at ω² = 4 T/(m l). At the top of a
    /// cloth of length L that is 4 a L/l² under the acceleration a, whatever it weighs.
    #[must_use]
    pub fn of_fabric(&self, fabric: &Fabric, tick: f32, acceleration: f32) -> StepSettings {
        let by_load = tick * fabric.tautness() * (acceleration / FASTEST_VIBRATION).sqrt();
        let by_rate = tick * self.rate as f32 - TOO_LONG;
        // NaN becomes zero.
        let wanted = by_load.max(by_rate).ceil() as u32;
        let (fewest, most) = (*self.substeps.start(), *self.substeps.end());
        StepSettings {
            scheme: self.scheme,
            substeps: wanted.min(most).max(fewest).max(1),
            passes: self.passes.max(1),
        }
    }
}

impl From<StepSettings> for StepLimits {
    /// Limits that allow only these settings.
    fn from(StepSettings { scheme, substeps, passes }: StepSettings) -> Self {
        Self { scheme, substeps: substeps..=substeps, rate: 0, passes }
    }
}

impl Default for StepLimits {
    /// The scheme of yarns with one to 24 substeps of two passes, at least 120 a second.
    fn default() -> Self {
        let StepSettings { scheme, passes, .. } = StepSettings::default();
        Self { scheme, substeps: 1..=24, rate: 120, passes }
    }
}

#[cfg(test)]
mod tests {
    use super::StepLimits;
    use crate::fabric::{FabricBuilder, Grid};

    const TICK: f32 = 1.0 / 60.0;

    fn substeps(limits: &StepLimits, n: u32, tick: f32, gravity: f32) -> u32 {
        let grid = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0));
        let fabric = grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric");
        limits.of_fabric(&fabric, tick, gravity).substeps
    }

    #[test]
    fn fine_cloth_and_long_ticks_need_more_substeps() {
        let all = StepLimits { substeps: 1..=100, rate: 0, ..StepLimits::default() };
        let of_size = [9, 17, 33, 65].map(|n| substeps(&all, n, TICK, 9.81));
        assert_eq!(of_size, [1, 1, 2, 4]);
        assert_eq!(substeps(&all, 65, 0.5 * TICK, 9.81), 2);
        assert_eq!(substeps(&all, 65, TICK, 4.0 * 9.81), 8);
    }

    #[test]
    fn long_ticks_are_divided() {
        for (rate, expected) in [(240, 1), (120, 1), (119, 2), (64, 2), (60, 2), (30, 4), (4, 24)] {
            let tick = 1.0 / rate as f32;
            assert_eq!(substeps(&StepLimits::default(), 9, tick, 9.81), expected, "{rate}");
        }
    }

    #[test]
    fn limits_hold() {
        let limits = StepLimits { substeps: 2..=3, ..StepLimits::default() };
        for (n, gravity, expected) in
            [(9, 9.81, 2), (65, 9.81, 3), (65, f32::NAN, 2), (65, f32::INFINITY, 3)]
        {
            assert_eq!(substeps(&limits, n, TICK, gravity), expected, "{n} {gravity}");
        }
        let none = StepLimits { substeps: 0..=0, passes: 0, ..limits };
        assert_eq!(substeps(&none, 65, TICK, 9.81), 1);
    }
}
