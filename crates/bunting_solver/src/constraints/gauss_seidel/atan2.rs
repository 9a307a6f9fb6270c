//! The function atan2 in lanes.

use crate::simd::lane::Lane;

/// Angle of the point (x, y), rad, exact to 2e-7 rad. The polynomial is a minimax fit to atan(r)/r in r² on
/// [0, 1].
#[inline(always)]
pub(super) fn atan2<L: Lane>(token: L::Token, y: L, x: L) -> L {
    const COEFFICIENTS: [f32; 8] = [
        0.999_999_34,
        -0.333_298_6,
        0.199_465_66,
        -0.139_086_3,
        0.096_421_96,
        -0.055_912_3,
        0.021_862_94,
        -0.004_054_561_7,
    ];
    let zero = L::splat(token, 0.0);
    let (tall, wide) = (y.abs(), x.abs());
    let steep = wide.lt(tall);
    let small = wide.or_where_not(steep, tall);
    let large = tall.or_where_not(steep, wide).max(L::splat(token, f32::MIN_POSITIVE));
    let ratio = small / large;
    let square = ratio * ratio;
    let mut sum = L::splat(token, COEFFICIENTS[7]);
    for coefficient in COEFFICIENTS[..7].iter().rev() {
        sum = L::splat(token, *coefficient).plus_product(sum, square);
    }
    let mut angle = sum * ratio;
    angle = (L::splat(token, core::f32::consts::FRAC_PI_2) - angle).or_where_not(steep, angle);
    angle = (L::splat(token, core::f32::consts::PI) - angle).or_where_not(x.lt(zero), angle);
    (-angle).or_where_not(y.lt(zero), angle)
}

#[cfg(test)]
mod tests {
    use super::atan2;
    use crate::simd::lane::{Kernel, Lane, Pack};
    use crate::simd::registers::Pack1;

    struct Atan2<'a> {
        y: f32,
        x: f32,
        angle: &'a mut Pack1,
    }

    impl Kernel<Pack1> for Atan2<'_> {
        fn run<L: Lane<Pack = Pack1>>(self, token: L::Token) {
            atan2(token, L::splat(token, self.y), L::splat(token, self.x)).store(self.angle);
        }
    }

    fn atan2_of(y: f32, x: f32) -> f32 {
        let mut angle = Pack1::splat(0.0);
        Pack1::run(Atan2 { y, x, angle: &mut angle });
        angle.lanes()[0]
    }

    #[test]
    fn atan2_is_exact_to_rounding() {
        for step in 0..=720 {
            let angle = (step as f32 - 360.0).to_radians() * 0.499;
            let (sine, cosine) = (libm::sinf(angle), libm::cosf(angle));
            for scale in [1e-12, 1.0, 1e6] {
                let found = atan2_of(sine * scale, cosine * scale);
                assert!((found - angle).abs() < 4e-7, "{angle}: {found}");
            }
        }
        assert_eq!(atan2_of(0.0, 0.0), 0.0);
    }
}
