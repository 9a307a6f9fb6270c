//! The backward differentiation formula of a substep, and the history that it is chosen from.

use crate::constants::GRAVITY;
use crate::stability::pole::PoleTurn;
use crate::step::Scheme;

/// A backward differentiation formula of order one or two. With Δ and Δ₋₁ the last two changes of x and ẋ the
/// derivative at the end of the substep, x changes in a substep of h seconds by γ₁ Δ + γ₂ Δ₋₁ + β h ẋ; so does
/// v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Formula {
    /// γ₁ and γ₂: the parts of the last change, and of the one before, that are extrapolated.
    pub extrapolation: [f32; 2],
    /// β: the effective substep is β h.
    pub beta: f32,
}

impl Formula {
    pub const BACKWARD_EULER: Self = Self { extrapolation: [0.0, 0.0], beta: 1.0 };
    /// Curtiss and Hirschfelder 1952.
    pub const BDF2: Self = Self { extrapolation: [1.0 / 3.0, 0.0], beta: 2.0 / 3.0 };
    /// The mean of BDF2 and BDF3: of order two, with half the error of BDF2, and as stable. With a larger part
    /// of BDF3 undamped oscillations would grow (BDF2OPT, Vatsa, Carpenter and Lockard 2010, has 0.48 of BDF3
    /// where this has 0.5).
    pub const BDF2_OPT: Self = Self { extrapolation: [0.5, -0.1], beta: 0.6 };

    /// 1/(γ₁ + γ₂): times the extrapolated part of a steady change it is the whole change. Zero for formulas of
    /// less than three substeps, as the first change after a restart is not like those that follow.
    pub fn inverse_extrapolation(&self) -> f32 {
        let [last, before] = self.extrapolation;
        if before == 0.0 { 0.0 } else { 1.0 / (last + before) }
    }
}

/// The integrator restarts where the first or the second difference of velocities, squared and summed over the
/// particles, is this many times the squared velocities. Where taut links vibrate faster than a substep can
/// resolve, extrapolation feeds on itself and the whole cloth oscillates from substep to substep: white noise
/// has 2 and 6. Where air stops a cloth at once, extrapolation would reverse it. Smaller: flags in wind lose
/// their second order; in a strong wind, with two substeps, one substep of a thousand exceeds 1.
const ROUGH: f32 = 2.0;

/// RMS speed that is added to the cloth's own in this comparison, in units of the speed that gravity gives in
/// a substep. Smaller: cloth at rest is rough by its rounding.
const SLOW: f32 = 5.0;

/// RMS speed below which a cloth hardly moves, in units of the speed that gravity gives in a substep. Smaller:
/// limp flags, which oscillate with 0.7 to 1.2, are not relaxed. Larger: with 3 a flag in a light wind is held.
const NEAR_REST: f32 = 2.0;

/// History of a cloth's integrator besides its particles' vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct IntegratorHistory {
    /// Length of the last substep, s; zero where there is none.
    step: f32,
    /// Substeps of this length since the integrator restarted.
    substeps: u32,
    /// Turn of the cloth about its pole by the last substep's corrections, to be taken back.
    pub pole_turn: PoleTurn,
}

impl IntegratorHistory {
    /// Whether there was a substep.
    pub fn exists(&self) -> bool {
        self.step > 0.0
    }

    /// Begins a substep of `step` seconds, and returns the formula of the highest order that the history allows.
    pub fn begin_substep(&mut self, step: f32, scheme: Scheme) -> Formula {
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

    /// Whether the cloth hardly moves, and three velocities are known.
    pub fn is_near_rest(&self, sums: MotionSums<f32>, particles: usize) -> bool {
        let slow = NEAR_REST * GRAVITY * self.step;
        self.substeps > 2 && sums.velocity < particles as f32 * slow * slow
    }

    /// Restarts the integrator at first order where the motion is rough: backward Euler dissipates it.
    pub fn restart_if_rough(&mut self, sums: MotionSums<f32>, particles: usize) {
        let slow = SLOW * GRAVITY * self.step;
        let smooth = ROUGH * (sums.velocity + particles as f32 * slow * slow);
        // In the first substep no velocity before is known, in the second only one.
        let first = self.substeps > 1 && sums.first_difference > smooth;
        let second = self.substeps > 2 && sums.second_difference > smooth;
        if first || second {
            self.substeps = 0;
        }
    }
}

/// Sums over the particles of a cloth, or of those in each lane, (m/s)².
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MotionSums<T> {
    /// Of |v|².
    pub velocity: T,
    /// Of |Δv|², Δv being the change of velocity in the last substep.
    pub first_difference: T,
    /// Of |Δ²v|², Δ²v being the change of Δv.
    pub second_difference: T,
}

#[cfg(test)]
mod tests {
    use super::{Formula, IntegratorHistory, MotionSums};
    use crate::step::Scheme;

    const STEP: f32 = 0.01;

    fn after(substeps: u32) -> IntegratorHistory {
        let mut history = IntegratorHistory::default();
        (0..substeps).for_each(|_| {
            history.begin_substep(STEP, Scheme::Yarns);
        });
        history
    }

    /// The change of x in the substep from 0 to 1, given its changes in the two before and the
    /// derivative at the end.
    fn change(formula: Formula, changes: [f32; 2], derivative: f32) -> f32 {
        let [last, before] = formula.extrapolation;
        last * changes[0] + before * changes[1] + formula.beta * derivative
    }

    #[test]
    fn formulas_have_their_order() {
        for formula in [Formula::BACKWARD_EULER, Formula::BDF2, Formula::BDF2_OPT] {
            assert!((change(formula, [1.0, 1.0], 1.0) - 1.0).abs() < 1e-6, "{formula:?}, x = t");
        }
        for formula in [Formula::BDF2, Formula::BDF2_OPT] {
            assert!((change(formula, [-1.0, -3.0], 2.0) - 1.0).abs() < 1e-6, "{formula:?}, x = t²");
        }
        // x = t³: the difference is the error constant.
        let error = |formula| change(formula, [1.0, 7.0], 3.0) - 1.0;
        assert!((error(Formula::BDF2_OPT) / error(Formula::BDF2) - 0.45).abs() < 1e-5);
    }

    #[test]
    fn the_order_rises_as_the_history_grows() {
        let mut history = IntegratorHistory::default();
        let formulas: Vec<Formula> =
            (0..4).map(|_| history.begin_substep(STEP, Scheme::Yarns)).collect();
        let expected =
            [Formula::BACKWARD_EULER, Formula::BDF2, Formula::BDF2_OPT, Formula::BDF2_OPT];
        assert_eq!(formulas, expected);
        assert_eq!(history.begin_substep(2.0 * STEP, Scheme::Yarns), Formula::BACKWARD_EULER);
        assert_eq!(history.begin_substep(2.0 * STEP, Scheme::GaussSeidel), Formula::BACKWARD_EULER);
    }

    #[test]
    fn a_cloth_that_is_slow_for_three_substeps_is_near_rest() {
        let of = |speed: f32| MotionSums { velocity: 4.0 * speed * speed, ..MotionSums::default() };
        // 9.81 m/s² in a hundredth of a second.
        assert!(after(3).is_near_rest(of(0.19), 4));
        assert!(!after(3).is_near_rest(of(0.20), 4));
        assert!(!after(2).is_near_rest(of(0.0), 4));
    }

    #[test]
    fn rough_motion_restarts_the_integrator() {
        let of = |velocity, first_difference, second_difference| MotionSums {
            velocity,
            first_difference,
            second_difference,
        };
        let oscillating = of(1.0, 1.9, 6.0);
        let stopped = of(1.0, 4.0, 1.0);
        let smooth = of(1.0, 0.5, 1.0);
        let rounding_at_rest = of(1e-6, 2e-6, 6e-6);
        for (substeps, sums, next) in [
            (3, oscillating, Formula::BACKWARD_EULER),
            (3, stopped, Formula::BACKWARD_EULER),
            (3, smooth, Formula::BDF2_OPT),
            (3, rounding_at_rest, Formula::BDF2_OPT),
            // The differences are not known yet.
            (2, oscillating, Formula::BDF2_OPT),
            (1, stopped, Formula::BDF2),
        ] {
            let mut history = after(substeps);
            history.restart_if_rough(sums, 1);
            assert_eq!(history.begin_substep(STEP, Scheme::Yarns), next, "{substeps} {sums:?}");
        }
    }
}
