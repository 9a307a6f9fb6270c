//! Which backward differentiation formula a lane takes in a substep, and what it must remember for it.

use crate::constants::GRAVITY;
use crate::step::Scheme;

/// A backward differentiation formula of order one or two. With Δ and Δ₋₁ the last two changes of x,
/// x changes in a substep of h seconds by γ₁ Δ + γ₂ Δ₋₁ + β h ẋ, ẋ being that at its end, and v
/// alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Formula {
    /// γ₁ and γ₂: how much of the last change, and of the one before, is extrapolated.
    pub extrapolation: [f32; 2],
    /// β: what part of the substep the new derivative counts for.
    pub weight: f32,
}

impl Formula {
    pub const BACKWARD_EULER: Self = Self { extrapolation: [0.0, 0.0], weight: 1.0 };
    /// Curtiss and Hirschfelder 1952.
    pub const BDF2: Self = Self { extrapolation: [1.0 / 3.0, 0.0], weight: 2.0 / 3.0 };
    /// The mean of BDF2 and BDF3: of order two, with half the error of BDF2, and no less stable. With
    /// more of BDF3 it would make undamped oscillations grow (BDF2OPT, Vatsa, Carpenter and Lockard
    /// 2010, has 0.48 of BDF3 where this has 0.5).
    pub const BDF2_OPT: Self = Self { extrapolation: [0.5, -0.1], weight: 0.6 };

    /// What is extrapolated times this is the whole of a steady change; zero where little is known, as the
    /// first change after a beginning is not like those that follow.
    pub fn foresight(&self) -> f32 {
        let [last, before] = self.extrapolation;
        if before == 0.0 { 0.0 } else { 1.0 / (last + before) }
    }
}

/// Velocities of which the first or the second difference is this many times larger, all squared and
/// summed over the particles, are not worth extrapolating. Where taut links vibrate faster than a substep
/// can follow, that feeds on itself, and the cloth boils: white noise has 2 and 6. Where air stops a
/// cloth at once, it would turn it round. A flag in a strong wind at two substeps exceeds 1 in one of a
/// thousand.
const ROUGH: f32 = 2.0;

/// Speeds that do not matter, in units of what gravity gives in a substep. Cloth at rest is not rough.
const SLOW: f32 = 5.0;

/// RMS speed below which a cloth hardly moves, in units of what gravity gives in a substep. Limp flags tremble
/// with 0.7 to 1.2, and with 3 one that flies in a light wind would be held.
const CREEPING: f32 = 2.0;

/// What a lane remembers of its last substeps besides the particles' past.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Past {
    /// Length of the last substep, s; zero where there is none.
    step: f32,
    /// Substeps of this length since the integrator began anew.
    substeps: u32,
    /// What the last substep's corrections have turned the cloth by about its pole, to be taken out again.
    pub turned: Turned,
}

/// A turn about the pole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Turned {
    /// rad.
    pub angle: f32,
    /// rad/s.
    pub rate: f32,
}

impl Past {
    /// Whether there is anything to remember.
    pub fn exists(&self) -> bool {
        self.step > 0.0
    }

    /// Begins a substep of `step` seconds, and chooses its formula: the best that the past allows.
    pub fn begin(&mut self, step: f32, scheme: Scheme) -> Formula {
        if self.step != step {
            *self = Self { step, ..Self::default() };
        }
        self.substeps = self.substeps.saturating_add(1);
        match (scheme, self.substeps) {
            (Scheme::GaussSeidel, _) | (Scheme::Yarns, 1) => Formula::BACKWARD_EULER,
            (Scheme::Yarns, 2) => Formula::BDF2,
            (Scheme::Yarns, _) => Formula::BDF2_OPT,
        }
    }

    /// Whether the lane hardly moves, and has for as long as velocities are remembered.
    pub fn creeps(&self, unrest: Unrest<f32>, particles: usize) -> bool {
        let slow = CREEPING * GRAVITY * self.step;
        self.substeps > 2 && unrest.motion < particles as f32 * slow * slow
    }

    /// Begins anew where the motion is rough: backward Euler takes the heat out.
    pub fn judge(&mut self, unrest: Unrest<f32>, particles: usize) {
        let slow = SLOW * GRAVITY * self.step;
        let calm = ROUGH * (unrest.motion + particles as f32 * slow * slow);
        // The first substep knows no velocity before, the second only one.
        let changes = self.substeps > 1 && unrest.change > calm;
        let shakes = self.substeps > 2 && unrest.shake > calm;
        if changes || shakes {
            self.substeps = 0;
        }
    }
}

/// Sums over the particles of a lane, or of all lanes, (m/s)².
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Unrest<T> {
    /// Of |v|².
    pub motion: T,
    /// Of |Δv|².
    pub change: T,
    /// Of |Δ²v|².
    pub shake: T,
}

#[cfg(test)]
mod tests {
    use super::{Formula, Past, Unrest};
    use crate::step::Scheme;

    const STEP: f32 = 0.01;

    fn after(substeps: u32) -> Past {
        let mut past = Past::default();
        (0..substeps).for_each(|_| {
            past.begin(STEP, Scheme::Yarns);
        });
        past
    }

    /// The change of x in the substep from 0 to 1, given its changes in the two before and the
    /// derivative at the end.
    fn change(formula: Formula, changes: [f32; 2], derivative: f32) -> f32 {
        let [last, before] = formula.extrapolation;
        last * changes[0] + before * changes[1] + formula.weight * derivative
    }

    #[test]
    fn formulas_have_their_order() {
        for formula in [Formula::BACKWARD_EULER, Formula::BDF2, Formula::BDF2_OPT] {
            assert!((change(formula, [1.0, 1.0], 1.0) - 1.0).abs() < 1e-6, "{formula:?}, x = t");
        }
        for formula in [Formula::BDF2, Formula::BDF2_OPT] {
            assert!((change(formula, [-1.0, -3.0], 2.0) - 1.0).abs() < 1e-6, "{formula:?}, x = t²");
        }
        // x = t³: what is missing is the error constant.
        let error = |formula| change(formula, [1.0, 7.0], 3.0) - 1.0;
        assert!((error(Formula::BDF2_OPT) / error(Formula::BDF2) - 0.45).abs() < 1e-5);
    }

    #[test]
    fn the_order_rises_as_the_past_grows() {
        let mut past = Past::default();
        let formulas: Vec<Formula> = (0..4).map(|_| past.begin(STEP, Scheme::Yarns)).collect();
        let expected =
            [Formula::BACKWARD_EULER, Formula::BDF2, Formula::BDF2_OPT, Formula::BDF2_OPT];
        assert_eq!(formulas, expected);
        assert_eq!(past.begin(2.0 * STEP, Scheme::Yarns), Formula::BACKWARD_EULER);
        assert_eq!(past.begin(2.0 * STEP, Scheme::GaussSeidel), Formula::BACKWARD_EULER);
    }

    #[test]
    fn what_is_slow_for_long_enough_creeps() {
        let of = |speed: f32| Unrest { motion: 4.0 * speed * speed, ..Unrest::default() };
        // 9.81 m/s² in a hundredth of a second.
        assert!(after(3).creeps(of(0.19), 4));
        assert!(!after(3).creeps(of(0.20), 4));
        assert!(!after(2).creeps(of(0.0), 4));
    }

    #[test]
    fn rough_motion_begins_anew() {
        let boiling = Unrest { motion: 1.0, change: 1.9, shake: 6.0 };
        let stopped = Unrest { motion: 1.0, change: 4.0, shake: 1.0 };
        let smooth = Unrest { motion: 1.0, change: 0.5, shake: 1.0 };
        let noise_of_rest = Unrest { motion: 1e-6, change: 2e-6, shake: 6e-6 };
        for (substeps, unrest, next) in [
            (3, boiling, Formula::BACKWARD_EULER),
            (3, stopped, Formula::BACKWARD_EULER),
            (3, smooth, Formula::BDF2_OPT),
            (3, noise_of_rest, Formula::BDF2_OPT),
            // Not known yet.
            (2, boiling, Formula::BDF2_OPT),
            (1, stopped, Formula::BDF2),
        ] {
            let mut past = after(substeps);
            past.judge(unrest, 1);
            assert_eq!(past.begin(STEP, Scheme::Yarns), next, "{substeps} {unrest:?}");
        }
    }
}
