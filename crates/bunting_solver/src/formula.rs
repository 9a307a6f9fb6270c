//! Which backward differentiation formula a lane takes in a substep, and what it must remember for it.

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
}

/// A lane boils when its velocities change to and fro from substep to substep, which happens where taut
/// links vibrate faster than a substep can follow, and feeds on itself: with Δ² the second difference
/// of velocity, when Σ |Δ²v|² exceeds this many times Σ |v|². White noise has 6; a flag in a strong
/// wind at two substeps exceeds 1 in one of a thousand.
const BOILING: f32 = 2.0;

/// Speeds that do not matter, in units of what gravity gives in a substep. Cloth at rest does not boil.
const SLOW: f32 = 5.0;

/// Standard gravity, m/s².
const GRAVITY: f32 = 9.81;

/// What a lane remembers of its last substeps besides the particles' past.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Past {
    /// Length of the last substep, s; zero where there is none.
    step: f32,
    /// Substeps of this length since the integrator began anew.
    substeps: u32,
}

impl Past {
    /// Whether there is anything to remember.
    pub fn exists(&self) -> bool {
        self.step > 0.0
    }

    /// Begins a substep of `step` seconds, and chooses its formula: the best that the past allows.
    pub fn begin(&mut self, step: f32, scheme: Scheme) -> Formula {
        if self.step != step {
            *self = Self { step, substeps: 0 };
        }
        self.substeps = self.substeps.saturating_add(1);
        match (scheme, self.substeps) {
            (Scheme::GaussSeidel, _) | (Scheme::Yarns, 1) => Formula::BACKWARD_EULER,
            (Scheme::Yarns, 2) => Formula::BDF2,
            (Scheme::Yarns, _) => Formula::BDF2_OPT,
        }
    }

    /// Begins anew where the lane boils: backward Euler takes the heat out. Given are the sums of
    /// |Δ²v|² and of |v|² over `particles` particles.
    pub fn cool(&mut self, [unrest, motion]: [f32; 2], particles: usize) {
        let slow = SLOW * GRAVITY * self.step;
        // The first two substeps do not know two velocities before.
        if self.substeps > 2 && unrest > BOILING * (motion + particles as f32 * slow * slow) {
            self.substeps = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Formula, Past};
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
    fn what_boils_begins_anew() {
        for (unrest, motion, next) in [
            (6.0, 1.0, Formula::BACKWARD_EULER),
            (1.0, 1.0, Formula::BDF2_OPT),
            // Noise of rest.
            (6e-6, 1e-6, Formula::BDF2_OPT),
        ] {
            let mut past = after(3);
            past.cool([unrest, motion], 1);
            assert_eq!(past.begin(STEP, Scheme::Yarns), next, "{unrest} {motion}");
        }
        let mut past = after(2);
        past.cool([6.0, 1.0], 1);
        assert_eq!(past.begin(STEP, Scheme::Yarns), Formula::BDF2_OPT, "nothing to judge by");
    }
}
