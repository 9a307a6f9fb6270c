//! Bending: C = θ − θ₀, the angle between the two triangles of a hinge (thesis, eq. 4.19 to 4.33).
//!
//! The thesis takes arccos(n₁·n₂), which is singular at flat and blind to the side; here the angle
//! is signed, by atan2. Its gradients are those of Bridson, Marino and Fedkiw 2003, "Simulation of
//! clothing with folds and wrinkles": with the edge e from x₁ to x₂ and the triangles' normals N₁,
//! N₂ not normalised, ∇₃ = −|e| N₁/|N₁|², ∇₄ = −|e| N₂/|N₂|², and the edge's ends take what keeps
//! both momenta. The correction is scaled by the gradients and masses (thesis, eq. 4.13 and 4.14:
//! its 4.34 holds for equal masses only).

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::constants::{LEAST_AREA_SQUARED, LEAST_LENGTH};
use crate::fabric::Fabric;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Projects every hinge once.
    pub fn solve_dihedral(&mut self, accumulate: bool) {
        let solve = Dihedral {
            fabric: &self.fabric,
            compliance: &self.parameters.hinge_compliance,
            multiplier: &mut self.hinge_multiplier,
            position: &mut self.position,
            accumulate,
        };
        P::run(solve);
    }
}

/// A hinge's angle and the angle's gradients, in the order of its particles.
struct Fold<L> {
    angle: L,
    gradient: [V3<L>; 4],
}

/// Angle and gradients; both zero where a triangle has collapsed.
#[inline(always)]
fn fold<L: Lane>(token: L::Token, [a, b, c, d]: [V3<L>; 4]) -> Fold<L> {
    let zero = L::splat(token, 0.0);
    let one = L::splat(token, 1.0);
    let least = L::splat(token, LEAST_AREA_SQUARED);
    let edge = b - a;
    let length = edge.dot(edge).sqrt().max(L::splat(token, LEAST_LENGTH));
    let (ac, ad) = (c - a, d - a);
    let (first, second) = (edge.cross(ac), ad.cross(edge));
    let (first_squared, second_squared) = (first.dot(first), second.dot(second));
    let whole = least.lt(first_squared) & least.lt(second_squared);

    let per_first = -length / first_squared.max(least);
    let per_second = -length / second_squared.max(least);
    let at_c = first * per_first;
    let at_d = second * per_second;
    // How far along the edge c and d lie, as parts of it: what the ends a and b must balance.
    let per_edge = one / (length * length);
    let (c_part, d_part) = (ac.dot(edge) * per_edge, ad.dot(edge) * per_edge);
    let at_b = at_c * -c_part + at_d * -d_part;
    let at_a = at_c * (c_part - one) + at_d * (d_part - one);

    let sine = first.cross(second).dot(edge) / length;
    let cosine = first.dot(second);
    let angle = atan2(token, sine, cosine);
    let none = V3 { x: zero, y: zero, z: zero };
    Fold {
        angle: angle.or_where_not(whole, zero),
        gradient: [
            at_a.or_where_not(whole, none),
            at_b.or_where_not(whole, none),
            at_c.or_where_not(whole, none),
            at_d.or_where_not(whole, none),
        ],
    }
}

/// atan2 by a polynomial in lanes, exact to 2e-7 rad: coefficients of a least-maximum fit to
/// atan(x)/x in x² on [0, 1].
#[inline(always)]
fn atan2<L: Lane>(token: L::Token, y: L, x: L) -> L {
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

struct Dihedral<'a, P: Pack> {
    fabric: &'a Fabric,
    compliance: &'a [P],
    multiplier: &'a mut [P],
    position: &'a mut [Pack3<P>],
    accumulate: bool,
}

impl<P: Pack> Kernel<P> for Dihedral<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let weights = self.fabric.inverse_areas();
        for (hinge, multiplier) in self.fabric.hinges().iter().zip(self.multiplier) {
            let mut at = [V3::<L>::splat(token, 0.0); 4];
            let mut weight = [L::splat(token, 0.0); 4];
            for (corner, &particle) in hinge.particles.iter().enumerate() {
                at[corner] = V3::load(token, &self.position[particle as usize]);
                weight[corner] = L::splat(token, weights[particle as usize]);
            }
            let Fold { angle, gradient } = fold(token, at);
            let compliance = L::load(token, &self.compliance[hinge.class as usize]);
            let mut excess = shortest_turn(token, angle - L::splat(token, hinge.rest_angle));
            if self.accumulate {
                excess = excess + compliance * L::load(token, multiplier);
            }
            let mut stiffness = compliance;
            for (w, g) in weight.into_iter().zip(gradient) {
                stiffness = stiffness + w * g.dot(g);
            }
            // A collapsed hinge has no gradient; with no compliance either it is left alone.
            let step = -excess / stiffness.max(L::splat(token, f32::MIN_POSITIVE));
            if self.accumulate {
                (L::load(token, multiplier) + step).store(multiplier);
            }
            for ((particle, x), (w, g)) in
                hinge.particles.into_iter().zip(at).zip(weight.into_iter().zip(gradient))
            {
                (x + g * (w * step)).store(&mut self.position[particle as usize]);
            }
        }
    }
}

/// The same angle within a half turn of zero, so that a hinge folded past π opens the short way.
#[inline(always)]
fn shortest_turn<L: Lane>(token: L::Token, angle: L) -> L {
    let half = L::splat(token, core::f32::consts::PI);
    let full = L::splat(token, core::f32::consts::TAU);
    let angle = (angle - full).or_where_not(half.lt(angle), angle);
    (angle + full).or_where_not(angle.lt(-half), angle)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::simd::lane::Pack1;
    use crate::simd::vec3::{lane3, splat3};

    /// Runs a function of lanes on single floats.
    struct OnSingles<'a> {
        corners: [Vec3; 4],
        angle: &'a mut Pack1,
        gradient: &'a mut [Pack3<Pack1>; 4],
    }

    impl Kernel<Pack1> for OnSingles<'_> {
        fn run<L: Lane<Pack = Pack1>>(self, token: L::Token) {
            let Fold { angle, gradient } =
                fold(token, self.corners.map(|corner| V3::<L>::load(token, &splat3(corner))));
            angle.store(self.angle);
            gradient.into_iter().zip(self.gradient).for_each(|(g, into)| g.store(into));
        }
    }

    fn fold_of(corners: [Vec3; 4]) -> (f32, [Vec3; 4]) {
        let (mut angle, mut gradient) = (Pack1::splat(0.0), [splat3(Vec3::ZERO); 4]);
        Pack1::run(OnSingles { corners, angle: &mut angle, gradient: &mut gradient });
        (angle.lanes()[0], gradient.map(|g| lane3(&g, 0)))
    }

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

    /// A fold in general position, some flat, some sharp, on either side.
    fn folds() -> Vec<[Vec3; 4]> {
        [0.0_f32, 0.4, -0.4, 2.5, -2.9]
            .into_iter()
            .map(|angle| {
                let turned = Vec3::new(0.2, libm::cosf(angle), libm::sinf(angle));
                [Vec3::ZERO, Vec3::new(1.1, 0.1, 0.0), Vec3::new(0.6, -0.8, 0.1), turned]
            })
            .collect()
    }

    #[test]
    fn angle_agrees_with_the_fabrics() {
        for corners in folds() {
            let rest = crate::fabric::hinge_angle(corners);
            let (found, _) = fold_of(corners);
            assert!((rest - found).abs() < 1e-6, "{rest} {found}");
        }
    }

    #[test]
    fn gradient_agrees_with_finite_differences() {
        const STEP: f32 = 1e-3;
        for corners in folds() {
            let (_, gradient) = fold_of(corners);
            for (corner, g) in gradient.iter().enumerate() {
                for (axis, exact) in [(Vec3::X, g.x), (Vec3::Y, g.y), (Vec3::Z, g.z)] {
                    let angle_at = |offset: f32| {
                        let mut moved = corners;
                        moved[corner] += axis * offset;
                        fold_of(moved).0
                    };
                    let difference = (angle_at(STEP) - angle_at(-STEP)) / (2.0 * STEP);
                    assert!((difference - exact).abs() < 2e-3, "{corner}: {difference} {exact}");
                }
            }
        }
    }

    #[test]
    fn gradient_neither_pushes_nor_turns() {
        for corners in folds() {
            let (_, gradient) = fold_of(corners);
            let push: Vec3 = gradient.iter().sum();
            let turn: Vec3 = corners.iter().zip(&gradient).map(|(x, g)| x.cross(*g)).sum();
            assert!(push.length() < 1e-5 && turn.length() < 1e-5, "{push} {turn}");
        }
    }

    #[test]
    fn a_collapsed_fold_is_left_alone() {
        let (angle, gradient) = fold_of([Vec3::ZERO, Vec3::X, Vec3::X * 0.5, Vec3::Y]);
        assert_eq!(angle, 0.0);
        assert!(gradient.iter().all(|g| *g == Vec3::ZERO));
    }
}
