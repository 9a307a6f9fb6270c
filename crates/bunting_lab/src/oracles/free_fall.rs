//! Free fall from rest, as summed by each integrator.

/// Height after `n` steps of `h` seconds of symplectic Euler under gravity `g`: −g h² n(n+1)/2, m.
#[must_use]
pub fn symplectic_euler(g: f64, h: f64, n: u32) -> f64 {
    let n = f64::from(n);
    -g * h * h * n * (n + 1.0) / 2.0
}

/// Height in metres after `n` steps of `h` seconds of the mean of BDF2 and BDF3 under gravity `g`; the first
/// step is backward Euler, the second BDF2.
///
/// Velocities are exact, vₙ = −g h n. With xₙ − xₙ₋₁ = −g h² (n − ½ + eₙ), the formula Δₙ = ½ Δₙ₋₁ − ⅒ Δₙ₋₂ +
/// ⅗ h vₙ reduces to eₙ = ½ eₙ₋₁ − ⅒ eₙ₋₂, with e₁ = ½ and e₂ = ⅙ (so e₀ = ⅚): a decaying oscillation with
/// the roots √⅒ exp(±iθ), cos θ = ¼ √10. All eₙ sum to 25/36, and those after n to (⅖ eₙ − ⅒ eₙ₋₁)/⅗.
#[must_use]
pub fn bdf2_opt(g: f64, h: f64, n: u32) -> f64 {
    let cosine = 0.25 * 10_f64.sqrt();
    let sine = (1.0 - cosine * cosine).sqrt();
    let (a, b) = (5.0 / 6.0, (0.5 * 10_f64.sqrt() - 5.0 / 6.0 * cosine) / sine);
    let e = |n: f64| {
        let angle = n * sine.atan2(cosine);
        0.1_f64.powf(0.5 * n) * (a * angle.cos() + b * angle.sin())
    };
    let n = f64::from(n);
    let after = (0.4 * e(n) - 0.1 * e(n - 1.0)) / 0.6;
    -g * h * h * (0.5 * n * n + 25.0 / 36.0 - after)
}
