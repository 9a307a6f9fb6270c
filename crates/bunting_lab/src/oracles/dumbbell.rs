//! A rigid dumbbell in free rotation, as integrated by each formula.

use glam::DVec2;

/// Coefficients of a backward differentiation formula: x changes by γ₁ Δ + γ₂ Δ₋₁ + β h v, with Δ and Δ₋₁ its
/// last two changes; v changes likewise with its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BdfFormula {
    gamma: [f64; 2],
    beta: f64,
}

impl BdfFormula {
    /// Backward Euler.
    pub const BACKWARD_EULER: Self = Self { gamma: [0.0, 0.0], beta: 1.0 };
    /// Second-order backward differentiation.
    pub const BDF2: Self = Self { gamma: [1.0 / 3.0, 0.0], beta: 2.0 / 3.0 };
    /// The mean of BDF2 and third-order backward differentiation.
    pub const BDF2_OPT: Self = Self { gamma: [0.5, -0.1], beta: 0.6 };
}

/// Fraction of the angular momentum that a dumbbell keeps in `steps` steps of `h` seconds from `rate` rad/s.
/// The first step is backward Euler, the second BDF2. Each step predicts the position and projects it to the
/// dumbbell's length.
#[must_use]
pub fn spin_left(formula: BdfFormula, rate: f64, h: f64, steps: u32) -> f64 {
    let (mut x, mut v) = (DVec2::X, DVec2::Y * rate);
    let (mut moved, mut older) = ([DVec2::ZERO; 2], [v; 2]);
    for step in 0..steps {
        let BdfFormula { gamma: [last, before], beta } = match (step, formula) {
            (0, _) => BdfFormula::BACKWARD_EULER,
            (1, BdfFormula::BDF2_OPT) => BdfFormula::BDF2,
            _ => formula,
        };
        let extrapolated = v + (v - older[0]) * last + (older[0] - older[1]) * before;
        let predicted = x + moved[0] * last + moved[1] * before + extrapolated * (beta * h);
        let projected = predicted.normalize();
        older = [v, older[0]];
        v = extrapolated + (projected - predicted) / (beta * h);
        moved = [projected - x, moved[0]];
        x = projected;
    }
    x.perp_dot(v) / rate
}
