//! Strips that stretch under their own weight or their own spin.

/// Strain δ/L of a strip that hangs from its top edge: σ g L/(2Y), at every resolution if the tip row has
/// half the mass of the others. Density in kg/m², gravity in m/s², length in m, stiffness in N/m.
#[must_use]
pub fn hung_strip(density: f64, gravity: f64, length: f64, stiffness: f64) -> f64 {
    density * gravity * length / (2.0 * stiffness)
}

/// Factor on this strain if the tip row of `segments` segments wrongly has the full mass.
#[must_use]
pub fn full_tip_mass_factor(segments: usize) -> f64 {
    (segments + 1) as f64 / segments as f64
}

/// Elongation in metres of a strip that spins about one end at `rate` rad/s: σ ω² L³/(3Y).
#[must_use]
pub fn spinning_strip(density: f64, rate: f64, length: f64, stiffness: f64) -> f64 {
    density * rate * rate * length.powi(3) / (3.0 * stiffness)
}

/// Elongation in metres of a free strip that spins about its middle: σ ω² L³/(12Y).
#[must_use]
pub fn free_spinning_strip(density: f64, rate: f64, length: f64, stiffness: f64) -> f64 {
    2.0 * spinning_strip(density, rate, length / 2.0, stiffness)
}

/// How far the lower rim of a funnel sinks that hangs from its upper one, m: a cone of half the angle φ, from a radius to
/// a smaller one, without Poisson's ratio. Weight below hangs on each circle, and tension around it, σ g r tan φ, carries
/// what of the weight points outwards.
#[must_use]
pub fn hung_funnel(
    density: f64,
    gravity: f64,
    [upper, lower]: [f64; 2],
    height: f64,
    stiffness: f64,
) -> f64 {
    const PARTS: u32 = 1000;
    let (slant, narrower) = (height.hypot(upper - lower), upper - lower);
    let [sin, cos] = [narrower / slant, height / slant];
    let strain = |part: u32| {
        let radius = upper - narrower * (f64::from(part) + 0.5) / f64::from(PARTS);
        (radius * radius - lower * lower) / (2.0 * radius * sin * cos)
    };
    let lengthening = slant * (0..PARTS).map(strain).sum::<f64>() / f64::from(PARTS);
    // The wider lower rim hangs lower, as the length along the cone is the same.
    let widening = sin * lower * lower * sin / cos;
    density * gravity * (lengthening + widening) / (stiffness * cos)
}
