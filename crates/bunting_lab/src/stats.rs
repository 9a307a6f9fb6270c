//! Statistics of positions, velocities and signals.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Statistics of the strain magnitudes |length/rest − 1| of many links.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Strain {
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// 99th percentile.
    pub p99: f64,
    /// 99.9th percentile.
    pub p999: f64,
    /// Maximum.
    pub max: f64,
}

impl Strain {
    /// Statistics of the magnitudes of signed strains.
    #[must_use]
    pub fn of(strains: impl Iterator<Item = f64>) -> Self {
        let mut sizes: Vec<f64> = strains.map(f64::abs).collect();
        if sizes.is_empty() {
            return Self::default();
        }
        sizes.sort_by(f64::total_cmp);
        Self {
            mean: mean(&sizes),
            p95: percentile(&sizes, 0.95),
            p99: percentile(&sizes, 0.99),
            p999: percentile(&sizes, 0.999),
            max: sizes[sizes.len() - 1],
        }
    }
}

/// The larger of two figures, NaN where either is NaN: `f64::max` would ignore it.
#[must_use]
pub fn worse(one: f64, other: f64) -> f64 {
    if one.is_nan() || other.is_nan() { f64::NAN } else { one.max(other) }
}

/// The value that a fraction `p` of the ascending samples does not exceed (nearest rank).
#[must_use]
pub fn percentile(ascending: &[f64], p: f64) -> f64 {
    let rank = (p * ascending.len() as f64).ceil() as usize;
    ascending[rank.clamp(1, ascending.len()) - 1]
}

/// Arithmetic mean; zero for no samples.
#[must_use]
pub fn mean(samples: &[f64]) -> f64 {
    if samples.is_empty() { 0.0 } else { samples.iter().sum::<f64>() / samples.len() as f64 }
}

/// Standard deviation about the mean.
#[must_use]
pub fn spread(samples: &[f64]) -> f64 {
    let centre = mean(samples);
    let squares: Vec<f64> = samples.iter().map(|s| (s - centre).powi(2)).collect();
    mean(&squares).sqrt()
}

/// Root mean square distance between two sets of positions, m.
#[must_use]
pub fn rms_distance(a: &[DVec3], b: &[DVec3]) -> f64 {
    let squares: Vec<f64> = a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).collect();
    mean(&squares).sqrt()
}

/// Root mean square length, for velocities in m/s.
#[must_use]
pub fn rms_length(vectors: &[DVec3]) -> f64 {
    let squares: Vec<f64> = vectors.iter().map(|v| v.length_squared()).collect();
    mean(&squares).sqrt()
}

/// Frequency in Hz of a signal sampled `rate` times a second, from its upward crossings of its mean,
/// each placed between two samples by linear interpolation. None with fewer than two crossings.
#[must_use]
pub fn crossing_frequency(samples: &[f64], rate: f64) -> Option<f64> {
    let centre = mean(samples);
    let crossings: Vec<f64> = samples
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < centre && pair[1] >= centre)
        .map(|(k, pair)| k as f64 + (centre - pair[0]) / (pair[1] - pair[0]))
        .collect();
    let (first, last) = (crossings.first()?, crossings.last()?);
    (crossings.len() > 1).then(|| (crossings.len() - 1) as f64 * rate / (last - first))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative error of a frequency found by linear interpolation of a sine sampled 26 times a period.
    const FREQUENCY_TOLERANCE: f64 = 1e-3;

    #[test]
    fn crossing_frequency_of_a_sine() {
        let samples: Vec<f64> = (0..600)
            .map(|k| 0.7 + (std::f64::consts::TAU * 2.3 * f64::from(k) / 60.0).sin())
            .collect();
        let measured = crossing_frequency(&samples, 60.0).unwrap();
        assert!((measured / 2.3 - 1.0).abs() < FREQUENCY_TOLERANCE, "{measured} Hz");
        assert_eq!(crossing_frequency(&[1.0; 9], 60.0), None);
    }

    #[test]
    fn strain_sizes_are_of_absolute_values() {
        let strain =
            Strain::of((1..=1000).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 } * f64::from(k)));
        assert_eq!(
            strain,
            Strain { mean: 500.5, p95: 950.0, p99: 990.0, p999: 999.0, max: 1000.0 }
        );
    }

    #[test]
    fn rms_of_a_shift_is_its_length() {
        let a: Vec<DVec3> = (0..5).map(|k| DVec3::splat(f64::from(k))).collect();
        let b: Vec<DVec3> = a.iter().map(|x| *x + DVec3::new(3.0, 4.0, 0.0)).collect();
        assert_eq!(rms_distance(&a, &b), 5.0);
    }
}
