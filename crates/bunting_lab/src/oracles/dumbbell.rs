//! A rigid dumbbell in free rotation as each integrator turns it.

use glam::DVec2;

/// How an integrator extrapolates and weighs: x + γ₁ Δ + γ₂ Δ₋₁ + β h v with Δ the last changes of x, and
/// alike for v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    gamma: [f64; 2],
    beta: f64,
}

impl Formula {
    /// Backward Euler.
    pub const BACKWARD_EULER: Self = Self { gamma: [0.0, 0.0], beta: 1.0 };
    /// Second-order backward differentiation.
    pub const BDF2: Self = Self { gamma: [1.0 / 3.0, 0.0], beta: 2.0 / 3.0 };
    /// The mean of that and third-order backward differentiation.
    pub const BDF2_OPT: Self = Self { gamma: [0.5, -0.1], beta: 0.6 };
}

/// Part of its angular momentum that a dumbbell keeps in `steps` steps of `h` seconds from `rate`
/// rad/s, the first step by backward Euler, the second by BDF2: predicted ahead, then drawn back to its length.
#[must_use]
pub fn spin_left(formula: Formula, rate: f64, h: f64, steps: u32) -> f64 {
    let (mut x, mut v) = (DVec2::X, DVec2::Y * rate);
    let (mut moved, mut older) = ([DVec2::ZERO; 2], [v; 2]);
    for step in 0..steps {
        let Formula { gamma: [last, before], beta } = match (step, formula) {
            (0, _) => Formula::BACKWARD_EULER,
            (1, Formula::BDF2_OPT) => Formula::BDF2,
            _ => formula,
        };
        let extrapolated = v + (v - older[0]) * last + (older[0] - older[1]) * before;
        let predicted = x + moved[0] * last + moved[1] * before + extrapolated * (beta * h);
        let drawn_back = predicted.normalize();
        older = [v, older[0]];
        v = extrapolated + (drawn_back - predicted) / (beta * h);
        moved = [drawn_back - x, moved[0]];
        x = drawn_back;
    }
    x.perp_dot(v) / rate
}
