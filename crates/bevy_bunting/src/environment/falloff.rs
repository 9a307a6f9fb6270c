//! The smooth fall of an effect to zero at the border of the space in which it acts.

use bevy_math::Vec4;

/// The part of an effect that is left at a depth inside a border (m): 0 at the border and outside, 1 from the width of
/// the fall on (m), and a cubic between the two. A width of zero, or one that is not a positive number, makes a sharp
/// border.
pub(crate) fn falloff(depth: f32, width: f32) -> f32 {
    falloffs(Vec4::splat(depth), width).x
}

/// The [`falloff`] at each of four depths (m).
pub(crate) fn falloffs(depths: Vec4, width: f32) -> Vec4 {
    let parts = (depths / width.max(0.0)).min(Vec4::ONE);
    let smooth = parts * parts * (3.0 - 2.0 * parts);
    Vec4::select(depths.cmpgt(Vec4::ZERO), smooth, Vec4::ZERO)
}

#[cfg(test)]
mod tests {
    use super::falloff;

    #[test]
    fn effects_fall_smoothly_to_zero_at_the_border() {
        let at = [-1.0, 0.0, 0.5, 1.0, 2.0, 9.0].map(|depth| falloff(depth, 2.0));
        assert_eq!(at, [0.0, 0.0, 0.156_25, 0.5, 1.0, 1.0]);
        for width in [0.0, -1.0, f32::NAN] {
            assert_eq!([-0.1, 0.1].map(|depth| falloff(depth, width)), [0.0, 1.0]);
        }
        assert_eq!(falloff(f32::NAN, 1.0), 0.0);
    }
}
