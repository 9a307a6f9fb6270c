//! How hard colliders press a cloth, by which its effort is chosen: see [`Loads::of_contacts`](crate::step::loads::Loads::of_contacts).

/// Sums over a cloth's contacts in a tick of the accelerations by steady pushes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pressing {
    /// Sum of the squares, m²/s⁴.
    squares: f64,
    /// Sum of the cubes, m³/s⁶.
    cubes: f64,
}

impl Pressing {
    /// Adds the size of a particle's acceleration by the steady part of a push, m/s².
    pub fn add(&mut self, acceleration: f32) {
        let size = f64::from(acceleration);
        self.squares += size * size;
        self.cubes += size * size * size;
    }

    /// The mean of the accelerations, each weighted by its square, m/s²: what presses where the cloth is pressed most. Neither
    /// the particles that nothing touches count nor those along which a shape brushes.
    pub fn mean(&self) -> f32 {
        if self.squares > 0.0 { (self.cubes / self.squares) as f32 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty particles that are pressed hard, among none or a thousand that are hardly.
    #[test]
    fn what_presses_hard_counts_however_little_it_is() {
        for others in [0, 1000] {
            let mut pressing = Pressing::default();
            (0..20).for_each(|_| pressing.add(500.0));
            (0..others).for_each(|_| pressing.add(1.0));
            assert!((pressing.mean() / 500.0 - 1.0).abs() < 1e-3, "{}", pressing.mean());
        }
        assert_eq!(Pressing::default().mean(), 0.0);
    }
}
