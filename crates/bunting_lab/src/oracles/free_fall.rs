//! Free fall from rest as each integrator sums it.

/// Height after `n` steps of `h` seconds of symplectic Euler under gravity `g`: −g h² n(n+1)/2, m.
#[must_use]
pub fn symplectic_euler(g: f64, h: f64, n: u32) -> f64 {
    let n = f64::from(n);
    -g * h * h * n * (n + 1.0) / 2.0
}

/// Height after `n` steps of `h` seconds of BDF2 under gravity `g`, the first step by backward Euler, m.
///
/// Velocities are exact, vₙ = −g h n. Then xₙ − 4/3 xₙ₋₁ + 1/3 xₙ₋₂ = 2/3 h vₙ with x₀ = 0, x₁ = −g h²
/// has the solution −g h² (n²/2 + 3/4 (1 − 3⁻ⁿ)).
#[must_use]
pub fn bdf2(g: f64, h: f64, n: u32) -> f64 {
    let steps = f64::from(n);
    -g * h * h * (0.5 * steps * steps + 0.75 * (1.0 - 3_f64.powf(-steps)))
}
