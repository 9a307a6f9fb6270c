//! The backward differentiation formula of a substep, and the history from which it is selected.

use crate::constants::{BETA, GRAVITY};
use crate::simd::lane::Pack;
use crate::stability::disturbance::Disturbance;
use crate::stability::pole::PoleTurn;
use crate::step::Scheme;

/// A backward differentiation formula of order one or two. With Δ and Δ₋₁ the last two changes of x, and ẋ
/// the derivative at the end of the substep, x changes in a substep of h seconds by γ₁ Δ + γ₂ Δ₋₁ + β h ẋ; v
/// changes likewise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Formula {
    /// Coefficients γ₁ and γ₂: the fractions of the last change, and of the one before, that are
    /// extrapolated.
    pub extrapolation: [f32; 2],
    /// Coefficient β: the effective length of the substep is β h.
    pub beta: f32,
    /// h/(γ₁ h₁ + γ₂ h₂): the ratio of a steady change to its extrapolated part. Zero for formulas of fewer
    /// than three substeps, since the first change after a restart is unlike the following ones.
    pub inverse_extrapolation: f32,
}

impl Formula {
    pub const BACKWARD_EULER: Self =
        Self { extrapolation: [0.0, 0.0], beta: 1.0, inverse_extrapolation: 0.0 };
    /// The mean of BDF2 and BDF3 in equal substeps: of order two, with half the error of BDF2, and as stable.
    /// With a larger fraction of BDF3, undamped oscillations would grow (BDF2OPT, Vatsa, Carpenter and
    /// Lockard 2010, has 0.48 of BDF3 where this has 0.5).
    pub const BDF2_OPT: Self =
        Self { extrapolation: [0.5, -0.1], beta: BETA, inverse_extrapolation: 2.5 };

    /// BDF2 for a substep of h seconds after one of h₁ (Curtiss and Hirschfelder 1952):
    /// (1 + a) Δ = (h/h₁) a Δ₁ + h ẋ with a = h/(h + h₁).
    fn bdf2(step: f32, last: f32) -> Self {
        let [h, h1] = [step, last].map(f64::from);
        let a = h / (h + h1);
        let beta = 1.0 / (1.0 + a);
        Self {
            extrapolation: [((h / h1) * a * beta) as f32, 0.0],
            beta: beta as f32,
            inverse_extrapolation: 0.0,
        }
    }

    /// The mean of BDF2 and BDF3 for a substep of h seconds after two of h₁ and h₂, the latest first.
    ///
    /// BDF3 is (1 + a + b) Δ = (h/h₁)(a + b + c) Δ₁ − (h/h₂) c Δ₂ + h ẋ with a = h/(h + h₁), b = h/(h + h₁ + h₂)
    /// and c = b (h + h₁)/(h₁ + h₂): the derivative of Newton's interpolation (Hairer, Nørsett and Wanner 1993,
    /// III.5). BDF2 has neither b nor c, and the mean of both has half of each.
    fn bdf2_opt(step: f32, last: f32, before: f32) -> Self {
        let [h, h1, h2] = [step, last, before].map(f64::from);
        let a = h / (h + h1);
        let b = 0.5 * h / (h + h1 + h2);
        let c = b * (h + h1) / (h1 + h2);
        let beta = 1.0 / (1.0 + a + b);
        let [of_last, of_before] = [(h / h1) * (a + b + c) * beta, -(h / h2) * c * beta];
        Self {
            extrapolation: [of_last as f32, of_before as f32],
            beta: beta as f32,
            inverse_extrapolation: (h / (of_last * h1 + of_before * h2)) as f32,
        }
    }
}

/// Ratio of a substep's length to that of the one before at which the integrator restarts. BDF2 is stable up
/// to 1 + √2 (Grigorieff 1983). Larger: alternating ticks of 1/30 and 1/90 s gain energy. Smaller: hosts
/// whose ticks vary lose their second order.
const MOST_GROWTH: f32 = 2.4;

/// Greatest ratio of a substep's length to that of the one before at which BDF3 is part of the formula: BDF3
/// by itself is stable up to 1.534 (Calvo, Grande and Grigorieff 1990). Beyond, the last two substeps count as one, and
/// BDF2 follows: it amplifies the changes of short substeps less. Larger: a change from three substeps to two, of a
/// ratio of 1.5, is seen.
const MOST_GROWTH_OF_BDF3: f32 = 1.49;

/// Ratio of the squared first or second difference of velocities, summed over the particles, to the squared
/// velocities at which the integrator restarts. If taut links vibrate faster than a substep can resolve,
/// extrapolation amplifies itself and the whole cloth oscillates from substep to substep: white noise has
/// ratios of 2 and 6. If air stops a cloth at once, extrapolation would reverse its motion. Smaller: flags in
/// wind lose their second order; in a strong wind, with two substeps, one substep of a thousand exceeds 1.
const ROUGH: f32 = 2.0;

/// RMS speed that is added to the cloth's own in this comparison, in units of the speed that gravity adds in
/// a substep. Smaller: cloth at rest counts as rough by its rounding.
const SLOW: f32 = 5.0;

/// RMS speed below which a cloth hardly moves, in units of the speed that gravity adds in a substep, or in a
/// [`SHORT_SUBSTEP`]. Smaller: limp flags, which oscillate with 0.7 to 1.2, are not relaxed. Larger: with 3 a flag in a light
/// wind is held.
const NEAR_REST: f32 = 2.0;

/// Length of a substep, s, up to which that speed stays the same: links oscillate no slower in shorter substeps. Smaller: the
/// mouth of a dome that hangs from one point oscillates for ever with six substeps a tick.
const SHORT_SUBSTEP: f32 = 1.0 / 120.0;

/// Ratio of the squared first difference of velocities to the squared velocities above which a cloth that hardly moves
/// vibrates: 0.3 is that of periods of eleven substeps. Smaller: cloth that swings counts, too. Larger: cloth vibrates for ever.
const FAST: f32 = 0.3;

/// RMS speed above which vibration counts, m/s. Smaller: perturbations of a cloth that is about to buckle count, too.
const SEEN: f32 = 1e-3;

/// Time, s, for which a cloth that hardly moves must have vibrated for BDF3 to be left out until the cloth moves again: BDF3
/// damps vibrations too little to outweigh what solves that undo one another's work feed into them. Smaller: each flag that
/// comes to rest changes its formula.
const LONG: f32 = 1.0;

/// History of a cloth's integrator besides its particles' vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct IntegratorHistory {
    /// Lengths of the last two substeps, s, the latest first; zero before the first ones.
    steps: [f32; 2],
    /// Number of substeps since the integrator restarted.
    substeps: u32,
    /// Number of substeps whose velocities are known: a restart forgets none.
    recorded: u32,
    /// Time for which the cloth has vibrated since it hardly moves, s.
    vibrated: f32,
    /// Turn of the cloth about its pole by the last substep's corrections, which the next prediction undoes.
    pub pole_turn: PoleTurn,
    /// Pressure of the air inside the cloth in the last substep, Pa; none before the first one with air.
    pub pressure: Option<f32>,
    /// Substeps in which actions from outside have an effect on a free cloth's angular momentum.
    pub disturbance: Disturbance,
}

impl IntegratorHistory {
    /// Lengths of the last two substeps, s, the latest first.
    pub const fn steps(&self) -> [f32; 2] {
        self.steps
    }

    /// Whether any substep has been recorded.
    pub fn exists(&self) -> bool {
        self.steps[0] > 0.0
    }

    /// Counts the last two substeps as one if the next one, of `step` seconds, is too long beside the last for BDF3.
    /// Returns whether it does so: displacements and velocities must then be joined, too.
    pub fn join_last_substeps(&mut self, step: f32, scheme: Scheme) -> bool {
        let [last, before] = self.steps;
        let is_long = step > MOST_GROWTH_OF_BDF3 * last && step <= MOST_GROWTH * last;
        let joins = scheme == Scheme::Yarns && self.substeps >= 2 && is_long;
        if joins {
            self.steps = [last + before, 0.0];
            self.substeps = 1;
            self.recorded = 1;
        }
        joins
    }

    /// Begins a substep of `step` seconds, and returns the formula of the highest order that the history allows.
    pub fn begin_substep(&mut self, step: f32, scheme: Scheme) -> Formula {
        let [last, before] = self.steps;
        if step > MOST_GROWTH * last {
            *self = Self::default();
        }
        self.steps = [step, last];
        self.substeps = self.substeps.saturating_add(1);
        self.recorded = self.recorded.saturating_add(1);
        let has_bdf3 = step <= MOST_GROWTH_OF_BDF3 * last && self.vibrated < LONG;
        match (scheme, self.substeps) {
            (Scheme::GaussSeidel, _) | (Scheme::Yarns, 1) => Formula::BACKWARD_EULER,
            (Scheme::Yarns, 3..) if has_bdf3 => Formula::bdf2_opt(step, last, before),
            (Scheme::Yarns, _) => Formula::bdf2(step, last),
        }
    }

    /// Whether the cloth hardly moves, and three velocities are known. Counts for how long it vibrates while it `is_free` of
    /// wind and colliders: without BDF3 implicit drag takes a part of a wind that leans on the cloth, and friction under
    /// tension holds less, as β h is longer.
    pub fn assess_rest(&mut self, sums: MotionSums<f32>, particles: usize, is_free: bool) -> bool {
        let slow = NEAR_REST * GRAVITY * self.steps[0].max(SHORT_SUBSTEP);
        let is_slow = self.recorded > 2 && sums.velocity < particles as f32 * slow * slow;
        let vibrates = sums.first_difference > FAST * sums.velocity
            && sums.velocity > particles as f32 * SEEN * SEEN;
        if !is_slow || !is_free {
            self.vibrated = 0.0;
        } else if vibrates {
            self.vibrated += self.steps[0];
        }
        is_slow
    }

    /// Restarts the integrator at first order where the motion is rough: backward Euler dissipates it.
    pub fn restart_if_rough(&mut self, sums: MotionSums<f32>, particles: usize) {
        let slow = SLOW * GRAVITY * self.steps[0];
        let smooth = ROUGH * (sums.velocity + particles as f32 * slow * slow);
        // The first substep has no earlier velocity, the second only one.
        let first = self.substeps > 1 && sums.first_difference > smooth;
        let second = self.substeps > 2 && sums.second_difference > smooth;
        if first || second {
            self.substeps = 0;
        }
    }
}

/// Sums over the particles of a cloth, or over those in each lane, (m/s)².
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MotionSums<T> {
    /// Sum of |v|².
    pub velocity: T,
    /// Sum of |Δv|², with Δv the change of velocity in the last substep.
    pub first_difference: T,
    /// Sum of |Δ²v|², with Δ²v the change of Δv.
    pub second_difference: T,
}

impl<P: Pack> MotionSums<P> {
    /// The sums in a lane.
    pub fn of_lane(&self, lane: usize) -> MotionSums<f32> {
        let of_lane = |sum: &P| sum.lanes()[lane];
        MotionSums {
            velocity: of_lane(&self.velocity),
            first_difference: of_lane(&self.first_difference),
            second_difference: of_lane(&self.second_difference),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Formula, IntegratorHistory, MotionSums};
    use crate::step::Scheme;

    const STEP: f32 = 0.01;

    /// BDF2 in equal substeps (Curtiss and Hirschfelder 1952).
    const BDF2: Formula =
        Formula { extrapolation: [1.0 / 3.0, 0.0], beta: 2.0 / 3.0, inverse_extrapolation: 0.0 };

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
        for formula in [Formula::BACKWARD_EULER, BDF2, Formula::BDF2_OPT] {
            assert!((change(formula, [1.0, 1.0], 1.0) - 1.0).abs() < 1e-6, "{formula:?}, x = t");
        }
        for formula in [BDF2, Formula::BDF2_OPT] {
            assert!((change(formula, [-1.0, -3.0], 2.0) - 1.0).abs() < 1e-6, "{formula:?}, x = t²");
        }
        // With x = t³ the difference is the error constant.
        let error = |formula| change(formula, [1.0, 7.0], 3.0) - 1.0;
        assert!((error(Formula::BDF2_OPT) / error(BDF2) - 0.45).abs() < 1e-5);
    }

    #[test]
    fn substeps_of_different_lengths_have_the_same_order() {
        for steps in [[1.0, 1.0, 1.0], [0.5, 1.0, 2.0], [1.5, 1.0, 0.7], [1.0, 2.0, 0.3]] {
            let [h, h1, h2] = steps;
            // Values of t at the ends of the last three substeps and at the start of the first.
            let at = [h, 0.0, -h1, -h1 - h2];
            let second_order = [Formula::bdf2_opt(h, h1, h2), Formula::bdf2(h, h1)];
            for (formula, power) in second_order.iter().flat_map(|&f| [(f, 1), (f, 2)]) {
                let x = at.map(|t: f32| t.powi(power));
                let slope = power as f32 * h.powi(power - 1);
                let found = change(formula, [x[1] - x[2], x[2] - x[3]], h * slope);
                assert!((found - (x[0] - x[1])).abs() < 1e-5, "{steps:?} {formula:?} t^{power}");
            }
            // With v = t the velocity changes steadily.
            let [of_last, of_before] = second_order[0].extrapolation;
            let extrapolated = of_last * h1 + of_before * h2;
            assert!((second_order[0].inverse_extrapolation * extrapolated - h).abs() < 1e-5);
        }
        assert_eq!(Formula::bdf2_opt(STEP, STEP, STEP), Formula::BDF2_OPT);
        assert_eq!(Formula::bdf2(STEP, STEP), BDF2);
    }

    #[test]
    fn the_order_rises_as_the_history_grows() {
        let mut history = IntegratorHistory::default();
        let formulas: Vec<Formula> =
            (0..4).map(|_| history.begin_substep(STEP, Scheme::Yarns)).collect();
        let expected = [Formula::BACKWARD_EULER, BDF2, Formula::BDF2_OPT, Formula::BDF2_OPT];
        assert_eq!(formulas, expected);
        for (growth, formula) in [
            (1.4, Formula::bdf2_opt(1.4 * STEP, STEP, STEP)),
            (1.5, Formula::bdf2(1.5 * STEP, STEP)),
            (2.0, Formula::bdf2(2.0 * STEP, STEP)),
            (2.5, Formula::BACKWARD_EULER),
        ] {
            let mut history = history;
            assert_eq!(history.begin_substep(growth * STEP, Scheme::Yarns), formula, "{growth}");
        }
        assert_eq!(history.begin_substep(2.0 * STEP, Scheme::GaussSeidel), Formula::BACKWARD_EULER);
    }

    #[test]
    fn short_substeps_are_joined_before_a_long_one() {
        let joined = |substeps, growth: f32| {
            let mut history = after(substeps);
            let joins = history.join_last_substeps(growth * STEP, Scheme::Yarns);
            (joins, history.begin_substep(growth * STEP, Scheme::Yarns))
        };
        assert_eq!(joined(4, 2.0), (true, BDF2), "two substeps as long as the next");
        assert_eq!(joined(4, 1.6), (true, Formula::bdf2(1.6 * STEP, 2.0 * STEP)));
        assert_eq!(joined(4, 2.5), (false, Formula::BACKWARD_EULER));
        assert_eq!(joined(4, 1.5), (true, Formula::bdf2(1.5 * STEP, 2.0 * STEP)), "three to two");
        assert_eq!(joined(4, 1.4), (false, Formula::bdf2_opt(1.4 * STEP, STEP, STEP)));
        assert_eq!(joined(1, 2.0), (false, Formula::bdf2(2.0 * STEP, STEP)), "one is known");
        assert!(!after(4).join_last_substeps(2.0 * STEP, Scheme::GaussSeidel));
    }

    #[test]
    fn a_cloth_that_is_slow_for_three_substeps_is_near_rest() {
        let of = |speed: f32| MotionSums { velocity: 4.0 * speed * speed, ..MotionSums::default() };
        // Gravity of 9.81 m/s² acts for a hundredth of a second.
        assert!(after(3).assess_rest(of(0.19), 4, true));
        assert!(!after(3).assess_rest(of(0.20), 4, true));
        assert!(!after(2).assess_rest(of(0.0), 4, true));
        // Short substeps make no difference, and a restart forgets no velocity.
        let mut history = IntegratorHistory::default();
        (0..3).for_each(|_| {
            history.begin_substep(0.1 * STEP, Scheme::Yarns);
        });
        assert!(history.assess_rest(of(0.16), 4, true));
        let oscillating =
            MotionSums { first_difference: 16.0, second_difference: 64.0, ..of(0.16) };
        history.restart_if_rough(oscillating, 4);
        assert_eq!(history.begin_substep(0.1 * STEP, Scheme::Yarns), Formula::BACKWARD_EULER);
        assert!(history.assess_rest(oscillating, 4, true));
    }

    #[test]
    fn a_cloth_that_has_vibrated_at_rest_has_no_bdf3_until_it_moves() {
        let moving = |speed: f32, difference: f32| MotionSums {
            velocity: 4.0 * speed * speed,
            first_difference: 4.0 * difference * difference,
            second_difference: 0.0,
        };
        let formula = |sums: MotionSums<f32>, is_free: bool| {
            let mut history = after(200);
            for _ in 0..101 {
                history.assess_rest(sums, 4, is_free);
            }
            history.begin_substep(STEP, Scheme::Yarns)
        };
        let bdf2 = Formula::bdf2(STEP, STEP);
        let opt = Formula::bdf2_opt(STEP, STEP, STEP);
        assert_eq!(formula(moving(0.01, 0.01), true), bdf2);
        assert_eq!(formula(moving(0.01, 0.005), true), opt, "it swings");
        assert_eq!(formula(moving(5e-4, 5e-4), true), opt, "nobody sees it");
        assert_eq!(formula(moving(0.3, 0.3), true), opt, "it moves");
        assert_eq!(formula(moving(0.01, 0.01), false), opt, "something acts on it");
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
            (1, stopped, BDF2),
        ] {
            let mut history = after(substeps);
            history.restart_if_rough(sums, 1);
            assert_eq!(history.begin_substep(STEP, Scheme::Yarns), next, "{substeps} {sums:?}");
        }
    }
}
