//! Parts of a cloth that are bent so little that they do not touch themselves.

use fearless_simd::{Simd, SimdSplit, f32x8};
use glam::Vec3;

use crate::constants::LEAST_AREA_SQUARED;
use crate::contact::itself::patches::Cell;
use crate::simd::lane::{Lane, Pack};
use crate::simd::level::dispatch;
use crate::simd::registers::Pack4;
use crate::simd::transpose::vectors;
use crate::simd::vec3::V3;

/// Cosine of the greatest angle between a triangle's normal and the mean of a part's normals. Smaller: parts that are about
/// to fold upon themselves are skipped. Larger: more of them are compared in vain.
const LEAST_COSINE: f32 = 0.2;

/// Sine of the same angle.
const GREATEST_SINE: f32 = 0.979_795_9;

/// A cone that contains the normals of a part's triangles.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Cone {
    /// Sum of the triangles' unit normals.
    sum: Vec3,
    /// Unit direction of the sum; zero if the sum is.
    axis: Vec3,
    /// Cosine and sine of the angle between the axis and the farthest normal.
    cosine: f32,
    sine: f32,
    /// Square of the cosine of the angle by which the axis may differ from the mean of more normals, such that the farthest
    /// one is about that mean; infinite if the farthest one is not about the axis itself.
    squared_margin: f32,
}

impl Cone {
    /// A cone of all directions.
    pub const ALL: Self = Self {
        sum: Vec3::ZERO,
        axis: Vec3::ZERO,
        cosine: -1.0,
        sine: 0.0,
        squared_margin: f32::INFINITY,
    };

    /// The cone about an axis, given the sum of the normals and the cosine of the angle with the farthest one.
    #[inline(always)]
    pub fn new(sum: Vec3, axis: Vec3, cosine: f32) -> Self {
        if cosine < LEAST_COSINE {
            return Self { sum, ..Self::ALL };
        }
        let cosine = cosine.min(1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        // The difference of both angles.
        let margin = LEAST_COSINE * cosine + GREATEST_SINE * sine;
        Self { sum, axis, cosine, sine, squared_margin: margin * margin }
    }

    /// Whether no number differs by more than a tolerance.
    #[cfg(test)]
    pub fn is_near(&self, other: &Self, tolerance: f32) -> bool {
        let Self { sum, axis, cosine, sine, squared_margin: margin } = self;
        sum.abs_diff_eq(other.sum, tolerance)
            && axis.abs_diff_eq(other.axis, tolerance)
            && (cosine - other.cosine).abs() < tolerance
            && (sine - other.sine).abs() < tolerance
            && (*margin == other.squared_margin
                || (margin - other.squared_margin).abs() < tolerance)
    }

    /// A cone that contains others.
    pub fn around(cones: &[Self]) -> Self {
        let sum: Vec3 = cones.iter().map(|cone| cone.sum).sum();
        let axis = sum.normalize_or_zero();
        let cosines = cones.iter().map(|cone| cone.least_cosine(axis));
        Self::new(sum, axis, cosines.fold(f32::INFINITY, f32::min))
    }

    /// Whether a part with these normals, connected along edges, does not touch itself: whether all normals lie in one half
    /// space (Volino and Magnenat-Thalmann 1994, without their test of the contour).
    pub fn is_flat(&self) -> bool {
        self.squared_margin < f32::INFINITY
    }

    /// Whether parts that are connected along edges do not touch one another.
    pub fn are_flat(one: &Self, other: &Self, bridge: Option<&Self>) -> bool {
        let sum = one.sum + other.sum + bridge.map_or(Vec3::ZERO, |bridge| bridge.sum);
        let squared = sum.length_squared();
        let is_about = |cone: &Self| {
            let along = cone.axis.dot(sum);
            along > 0.0 && along * along >= cone.squared_margin * squared
        };
        is_about(one) && is_about(other) && bridge.is_none_or(is_about)
    }

    /// A lower bound of the cosine of the angle between a unit direction and any of the normals: the angle between the
    /// axes, and that within the cone, add up.
    fn least_cosine(&self, direction: Vec3) -> f32 {
        let cosine = self.axis.dot(direction).min(1.0);
        if cosine <= 0.0 {
            return -1.0;
        }
        cosine * self.cosine - (1.0 - cosine * cosine).sqrt() * self.sine
    }
}

/// Computes the cones of cells at the end of the substep, given the positions of all particles then, m.
pub(in crate::contact) fn compute_cones(cells: &[Cell], ends: &[Pack4], cones: &mut [Cone]) {
    dispatch!(token => compute(token, cells, ends, cones));
}

#[inline(always)]
fn compute<S: Simd>(token: S, cells: &[Cell], ends: &[Pack4], cones: &mut [Cone]) {
    let least = <f32x8<S> as Lane>::splat(token, LEAST_AREA_SQUARED);
    let one = <f32x8<S> as Lane>::splat(token, 1.0);
    for (cell, cone) in cells.iter().zip(cones) {
        let corner = |at: usize| V3::<f32x8<S>>::gather(token, ends, &cell.corners[at]);
        let [a, b, c] = [corner(0), corner(1), corner(2)];
        let normal = (b - a).cross(c - a);
        let length = Lane::sqrt(Lane::max(normal.dot(normal), least));
        let normal = normal * (one / length);
        let sum = total(token, normal);
        let axis = sum.normalize_or_zero();
        let (low, high) = normal.dot(V3::splat3(token, axis.into())).split();
        let mut cosines = Pack4::splat(0.0);
        Lane::min(low, high).store(&mut cosines);
        let [a, b, c, d] = cosines.vector();
        *cone = Cone::new(sum, axis, a.min(b).min(c.min(d)));
    }
}

/// Sum of eight vectors.
#[inline(always)]
fn total<S: Simd>(token: S, of: V3<f32x8<S>>) -> Vec3 {
    let ((x, x_high), (y, y_high), (z, z_high)) = (of.x.split(), of.y.split(), of.z.split());
    let [a, b, c, d] = vectors(token, [x + x_high, y + y_high, z + z_high]);
    let mut sum = Pack4::splat(0.0);
    Lane::store((a + b) + (c + d), &mut sum);
    let [x, y, z, _] = sum.vector();
    Vec3::new(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit vector within an angle of about `spread` from an axis.
    fn direction(index: u32, spread: f32) -> Vec3 {
        let noise = |index: u32| {
            let mixed = (index + 1).wrapping_mul(2_654_435_769);
            let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(2_246_822_519);
            (mixed >> 8) as f32 / (1 << 24) as f32 - 0.5
        };
        let at = 5 * index;
        (Vec3::Z + spread * Vec3::new(noise(at), noise(at + 1), noise(at + 2))).normalize()
    }

    /// The cone of some normals.
    fn cone(normals: &[Vec3]) -> Cone {
        let sum: Vec3 = normals.iter().sum();
        let axis = sum.normalize_or_zero();
        let cosines = normals.iter().map(|normal| normal.dot(axis));
        Cone::new(sum, axis, cosines.fold(f32::INFINITY, f32::min))
    }

    #[test]
    fn parts_are_flat_only_if_all_normals_are_about_their_mean() {
        let [mut found, mut missed] = [0, 0];
        for round in 0..600 {
            let spread = 4.0 * round as f32 / 600.0;
            let normals: Vec<Vec3> = (0..16).map(|it| direction(16 * round + it, spread)).collect();
            let mean = normals.iter().sum::<Vec3>().normalize();
            let least = normals.iter().map(|normal| normal.dot(mean)).fold(f32::INFINITY, f32::min);
            let parts = [cone(&normals[..8]), cone(&normals[8..])];
            let are_flat = Cone::are_flat(&parts[0], &parts[1], None);
            assert!(!are_flat || least > LEAST_COSINE - 1e-4, "{round}: {least}");
            assert_eq!(are_flat, Cone::around(&parts).is_flat(), "{round}: {least}");
            found += u32::from(are_flat);
            missed += u32::from(!are_flat && least > LEAST_COSINE);
        }
        assert!(found > 100 && missed < found, "{found} found, {missed} missed");
    }
}
