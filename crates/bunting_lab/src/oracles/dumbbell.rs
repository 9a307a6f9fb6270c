//! A rigid dumbbell in free rotation as each integrator turns it.

use glam::DVec2;

/// How an integrator extrapolates and weighs: x + γ(x − x₋₁) + β h v, and alike for v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    gamma: f64,
    beta: f64,
}

impl Formula {
    /// Backward Euler.
    pub const BACKWARD_EULER: Self = Self { gamma: 0.0, beta: 1.0 };
    /// Second-order backward differentiation.
    pub const BDF2: Self = Self { gamma: 1.0 / 3.0, beta: 2.0 / 3.0 };
}

/// Part of its angular momentum that a dumbbell keeps in `steps` steps of `h` seconds from `rate`
/// rad/s, the first step by backward Euler: predicted ahead, then drawn back to its length.
#[must_use]
pub fn spin_left(formula: Formula, rate: f64, h: f64, steps: u32) -> f64 {
    let (mut x, mut v) = (DVec2::X, DVec2::Y * rate);
    let (mut moved, mut older) = (DVec2::ZERO, v);
    for step in 0..steps {
        let Formula { gamma, beta } = if step == 0 { Formula::BACKWARD_EULER } else { formula };
        let extrapolated = v + (v - older) * gamma;
        let predicted = x + moved * gamma + extrapolated * (beta * h);
        let drawn_back = predicted.normalize();
        older = v;
        v = extrapolated + (drawn_back - predicted) / (beta * h);
        moved = drawn_back - x;
        x = drawn_back;
    }
    x.perp_dot(v) / rate
}
