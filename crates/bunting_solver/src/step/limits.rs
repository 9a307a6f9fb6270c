//! How many substeps a fabric needs, from what is known before anything moves.

use core::ops::RangeInclusive;

use crate::fabric::Fabric;
use crate::step::{Scheme, StepSettings};

/// Greatest h² T/(m l) of the topmost link of a hanging cloth: beyond, links vibrate faster than the yarns'
/// frozen directions can follow. At this, grids of 33 × 33 and 65 × 65 a square metre take 2 and 4
/// substeps of a tick of 1/60 s.
const FASTEST_VIBRATION: f32 = 0.75;

/// Between what limits a tick is solved. Within them the number of substeps depends on the fabric, the
/// tick and gravity alone, so that it is the same for all cloths of a fabric, whatever they do.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct StepLimits {
    /// How the constraints are solved.
    pub scheme: Scheme,
    /// Fewest and most substeps in a tick. Strong wind wants more than what hangs: for 25 m/s, five for
    /// 33 × 33 a square metre.
    pub substeps: RangeInclusive<u32>,
    /// Passes in a substep, see [`StepSettings::passes`].
    pub passes: u32,
}

impl StepLimits {
    /// How a fabric is solved in ticks of `tick` seconds under a gravity of so many m/s².
    ///
    /// A link under the tension T of what hangs from it vibrates at ω² = 4 T/(m l). At the top of a cloth
    /// of length L that is 4 g L/l², whatever it weighs.
    #[must_use]
    pub fn of_fabric(&self, fabric: &Fabric, tick: f32, gravity: f32) -> StepSettings {
        self.of_tautness(fabric.tautness(), tick, gravity)
    }

    /// How a fabric of a tautness √L/l in m^−½ is solved, with L the greatest distance of a particle from its nearest
    /// pin and l the length of the shortest link of warp and weft.
    #[must_use]
    pub fn of_tautness(&self, tautness: f32, tick: f32, gravity: f32) -> StepSettings {
        let wanted = tick * tautness * (gravity / FASTEST_VIBRATION).sqrt();
        // What is not a number becomes zero.
        let wanted = wanted.ceil() as u32;
        let (fewest, most) = (*self.substeps.start(), *self.substeps.end());
        StepSettings {
            scheme: self.scheme,
            substeps: wanted.min(most).max(fewest).max(1),
            passes: self.passes.max(1),
        }
    }
}

impl From<StepSettings> for StepLimits {
    /// Exactly these.
    fn from(StepSettings { scheme, substeps, passes }: StepSettings) -> Self {
        Self { scheme, substeps: substeps..=substeps, passes }
    }
}

impl Default for StepLimits {
    /// Yarns, two to eight substeps of two passes.
    fn default() -> Self {
        let StepSettings { scheme, substeps, passes } = StepSettings::default();
        Self { scheme, substeps: substeps..=8, passes }
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
    fn fine_cloth_and_long_ticks_want_more() {
        let all = StepLimits { substeps: 1..=100, ..StepLimits::default() };
        let of_size = [9, 17, 33, 65].map(|n| substeps(&all, n, TICK, 9.81));
        assert_eq!(of_size, [1, 1, 2, 4]);
        assert_eq!(substeps(&all, 65, 0.5 * TICK, 9.81), 2);
        assert_eq!(substeps(&all, 65, TICK, 4.0 * 9.81), 8);
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
