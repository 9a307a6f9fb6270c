//! Waves and random numbers with the same bits on all machines, for gusts and imperfections.

use bevy_math::Vec4;

/// Constant 1.5 × 2²³: added to a float and subtracted again, it rounds the float to the nearest integer.
const TO_INTEGER: f32 = 12_582_912.0;

/// Random numbers from the hashes of a counter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Random(u32);

impl Random {
    /// A sequence of numbers that depends on the seed.
    pub const fn with_seed(seed: u32) -> Self {
        Self(mix(seed))
    }

    /// A random number from 0 (included) to 1 (excluded).
    pub const fn unit(&mut self) -> f32 {
        self.0 = mix(self.0.wrapping_add(0x9e37_79b9));
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }
}

/// A bijection of 32-bit integers in which each input bit affects all output bits (Wellons' lowbias32).
pub(crate) const fn mix(mut bits: u32) -> u32 {
    bits ^= bits >> 16;
    bits = bits.wrapping_mul(0x7feb_352d);
    bits ^= bits >> 15;
    bits = bits.wrapping_mul(0x846c_a68b);
    bits ^ (bits >> 16)
}

/// A sine of period 1 and amplitude 1, composed of parabolas, for phases up to 2²² periods.
pub(crate) fn sine(phase: f32) -> f32 {
    let part = phase - ((phase + TO_INTEGER) - TO_INTEGER);
    8.0 * part * (1.0 - 2.0 * part.abs())
}

/// The [`sine`] of each of four phases.
pub(crate) fn sines(phases: Vec4) -> Vec4 {
    let part = phases - ((phases + TO_INTEGER) - TO_INTEGER);
    8.0 * part * (1.0 - 2.0 * part.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sine_is_exact_to_six_hundredths() {
        for step in -4000..4000 {
            let phase = step as f32 / 1000.0;
            let exact = (core::f32::consts::TAU * phase).sin();
            assert!((sine(phase) - exact).abs() < 0.06, "{phase}");
            assert_eq!(sines(Vec4::splat(phase)), Vec4::splat(sine(phase)), "{phase}");
        }
    }

    #[test]
    fn random_numbers_fill_their_range_evenly() {
        let mut random = Random::with_seed(3);
        let mut counts = [0; 10];
        (0..10_000).for_each(|_| counts[(10.0 * random.unit()) as usize] += 1);
        assert!(counts.iter().all(|&count| (900..1100).contains(&count)), "{counts:?}");
    }
}
