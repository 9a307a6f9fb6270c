//! A value that decays smoothly to zero.

use bevy_math::{Vec3, ops};

/// Rate ω of the decay, 1/s: 3 % of the value is left after 0.25 s. Larger: the surface jerks. Smaller: a
/// surface whose level changes again and again lags behind.
const RATE: f32 = 28.0;

/// A value x that decays to zero by x‴ = −3ω x″ − 3ω² x′ − ω³ x with ω = 28/s: critically damped, and of
/// third order, so that x stays smooth when its rate is changed.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Decay {
    pub value: Vec3,
    /// Change of the value per second.
    pub rate: Vec3,
    /// Change of the rate per second.
    pub acceleration: Vec3,
}

impl Decay {
    /// Advances the value by `time` (s), with the exact solution x = (a + b t + c t²) exp(−ω t).
    pub fn advance(&mut self, time: f32) {
        let (a, w) = (self.value, RATE);
        let b = self.rate + a * w;
        let c = 0.5 * (self.acceleration + 2.0 * w * self.rate + w * w * a);
        let decay = ops::exp(-w * time);
        let (x, dx, ddx) = (a + (b + c * time) * time, b + 2.0 * c * time, 2.0 * c);
        self.value = x * decay;
        self.rate = (dx - x * w) * decay;
        self.acceleration = (ddx - dx * (2.0 * w) + x * (w * w)) * decay;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decay_continues_its_motion_and_ends() {
        let start = Decay { value: Vec3::X, rate: Vec3::Y, acceleration: Vec3::ZERO };
        let mut soon = start;
        soon.advance(1e-3);
        assert!(soon.value.distance(Vec3::X + 1e-3 * Vec3::Y) < 2e-5, "{soon:?}");
        let (mut once, mut often) = (start, start);
        once.advance(0.1);
        (0..100).for_each(|_| often.advance(1e-3));
        assert!(once.value.distance(often.value) < 1e-4 && once.rate.distance(often.rate) < 1e-2);
        let mut end = start;
        end.advance(0.25);
        assert!(end.value.length() < 0.035, "{end:?}");
    }
}
