//! The angle between the two triangles of a hinge, and its gradients.
//!
//! The thesis takes arccos(n₁·n₂), which is singular where the hinge is flat and has no sign; here the angle is
//! signed, by atan2. The gradients are those of Bridson, Marino and Fedkiw 2003, "Simulation of clothing with
//! folds and wrinkles": with the edge e from x₁ to x₂ and the triangles' normals N₁ and N₂, not normalised,
//! ∇₃ = −|e| N₁/|N₁|² and ∇₄ = −|e| N₂/|N₂|²; those of the edge's ends follow from both momenta.

use super::atan2::atan2;
use crate::constants::{LEAST_AREA_SQUARED, LEAST_LENGTH};
use crate::simd::lane::Lane;
use crate::simd::vec3::V3;

/// A hinge's angle and the angle's gradients, in the order of its particles.
pub(super) struct Fold<L> {
    /// Angle, rad.
    pub angle: L,
    /// Gradient for each particle, rad/m.
    pub gradient: [V3<L>; 4],
}

/// Angle and gradients, given the positions of the edge's ends and of the two corners beside it, m. Both are
/// zero where a triangle has collapsed.
#[inline(always)]
pub(super) fn fold<L: Lane>(token: L::Token, [a, b, c, d]: [V3<L>; 4]) -> Fold<L> {
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
    // Projections of c and d on the edge, as fractions of its length: they distribute the opposite of the
    // gradients at c and d over the ends a and b.
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

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::{Fold, fold};
    use crate::simd::lane::{Kernel, Lane, Pack};
    use crate::simd::registers::Pack1;
    use crate::simd::vec3::{Pack3, V3, lane3, splat3};

    /// [`fold`] in a single lane.
    struct OneFold<'a> {
        corners: [Vec3; 4],
        angle: &'a mut Pack1,
        gradient: &'a mut [Pack3<Pack1>; 4],
    }

    impl Kernel<Pack1> for OneFold<'_> {
        fn run<L: Lane<Pack = Pack1>>(self, token: L::Token) {
            let Fold { angle, gradient } =
                fold(token, self.corners.map(|corner| V3::<L>::load(token, &splat3(corner))));
            angle.store(self.angle);
            gradient.into_iter().zip(self.gradient).for_each(|(g, into)| g.store(into));
        }
    }

    fn fold_of(corners: [Vec3; 4]) -> (f32, [Vec3; 4]) {
        let (mut angle, mut gradient) = (Pack1::splat(0.0), [splat3(Vec3::ZERO); 4]);
        Pack1::run(OneFold { corners, angle: &mut angle, gradient: &mut gradient });
        (angle.lanes()[0], gradient.map(|g| lane3(&g, 0)))
    }

    /// Hinges in general position, flat and sharp, folded to either side.
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
    fn angle_agrees_with_that_of_the_fabric() {
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
    fn gradient_has_neither_force_nor_moment() {
        for corners in folds() {
            let (_, gradient) = fold_of(corners);
            let force: Vec3 = gradient.iter().sum();
            let moment: Vec3 = corners.iter().zip(&gradient).map(|(x, g)| x.cross(*g)).sum();
            assert!(force.length() < 1e-5 && moment.length() < 1e-5, "{force} {moment}");
        }
    }

    #[test]
    fn a_collapsed_hinge_has_no_gradient() {
        let (angle, gradient) = fold_of([Vec3::ZERO, Vec3::X, Vec3::X * 0.5, Vec3::Y]);
        assert_eq!(angle, 0.0);
        assert!(gradient.iter().all(|g| *g == Vec3::ZERO));
    }
}
