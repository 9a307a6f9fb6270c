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
