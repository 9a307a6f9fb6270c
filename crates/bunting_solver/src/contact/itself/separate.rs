//! Features that come nearer than the thickness are moved apart, in sweeps over all their contacts.
//!
//! A contact is C = n·Σ wᵢ xᵢ − d ≥ 0, with Coulomb friction, of four particles with factors wᵢ: one and the negative barycentric
//! coordinates of a particle over a triangle, or those of the closest points of two edges. A feature that has passed through another in
//! the substep returns to the side on which it began.

use core::marker::PhantomData;

use crate::constants::LEAST_LENGTH;
use crate::contact::itself::contact_packs::ContactPack;
use crate::contact::itself::near::Features;
use crate::contact::itself::particles::LEAST_SHARE;
use crate::contact::itself::points::{Points, gather};
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::V3;

/// Depth that is left alone, m. Larger: layers at rest tremble. Smaller: rounding errors cost sweeps.
const LEAST_DEPTH: f32 = 1e-6;

/// Approach that is left alone, m/s. Larger: layers at rest tremble. Smaller: rounding errors cost sweeps.
const LEAST_APPROACH: f32 = 1e-4;

/// Moves features apart that are too near, once. Returns whether any were.
pub(in crate::contact) fn move_apart<F: Features>(
    packs: &mut [ContactPack],
    points: &mut Points,
) -> bool {
    let mut any = false;
    Pack8::run(MoveApart::<F> { packs, points, any: &mut any, kind: PhantomData });
    any
}

/// Stops the approach of features that were moved apart, once. Returns whether any did.
pub(in crate::contact) fn stop(packs: &mut [ContactPack], points: &mut Points) -> bool {
    let mut any = false;
    Pack8::run(Stop { packs, points, any: &mut any });
    any
}

struct MoveApart<'a, F> {
    packs: &'a mut [ContactPack],
    points: &'a mut Points,
    any: &'a mut bool,
    kind: PhantomData<F>,
}

impl<F: Features> Kernel<Pack8> for MoveApart<'_, F> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let Points { start, end, .. } = self.points;
        let [zero, one] = [L::splat(token, 0.0), L::splat(token, 1.0)];
        let least_depth = L::splat(token, LEAST_DEPTH);
        let least_length = L::splat(token, LEAST_LENGTH);
        for pack in self.packs {
            let ends = gather::<L>(token, end, &pack.particles);
            let near = F::near(token, &ends, L::load(token, &pack.passed));
            let before = L::load(token, &pack.depth);
            // What an earlier sweep gave is taken back where others have given too much.
            let depth = (L::load(token, &pack.distance) - near.gap).max(-before);
            let acts = near.faces & least_depth.lt(depth.abs());
            keep_where(token, near.faces, near.normal, &near.factors, pack);
            if !acts.any() {
                continue;
            }
            let weights = Weights::<L>::load(token, pack, &near.factors);
            let acts = acts & weights.are_free;
            let starts = gather::<L>(token, start, &pack.particles);
            let slide = relative(&near.factors, &ends) - relative(&near.factors, &starts);
            let slide = slide.minus_scaled(near.normal, slide.dot(near.normal));
            let length = slide.dot(slide).sqrt().max(least_length);
            let held = (L::load(token, &pack.friction) * depth.max(zero) / length).min(one);
            let by = (near.normal * depth).minus_scaled(slide, held) * weights.inverse_sum;
            let by = by.or_where_not(acts, V3::splat(token, 0.0));
            move_by(token, end, &pack.particles, &ends, by, &weights.of_particles);
            (before + depth).or_where_not(acts, before).store(&mut pack.depth);
            *self.any |= acts.any();
        }
    }
}

struct Stop<'a> {
    packs: &'a mut [ContactPack],
    points: &'a mut Points,
    any: &'a mut bool,
}

impl Kernel<Pack8> for Stop<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let Points { velocity, past_velocity, impact, .. } = self.points;
        let [zero, one] = [L::splat(token, 0.0), L::splat(token, 1.0)];
        let least_approach = L::splat(token, LEAST_APPROACH);
        let least_length = L::splat(token, LEAST_LENGTH);
        for pack in self.packs {
            let touches = zero.lt(L::load(token, &pack.depth));
            if !touches.any() {
                continue;
            }
            let factors = [
                L::load(token, &pack.factors[0]),
                L::load(token, &pack.factors[1]),
                L::load(token, &pack.factors[2]),
                L::load(token, &pack.factors[3]),
            ];
            let normal = V3::load(token, &pack.normal);
            let velocities = gather::<L>(token, velocity, &pack.particles);
            let relative_velocity = relative(&factors, &velocities);
            let stopped = L::load(token, &pack.stopped);
            // What an earlier sweep gave is taken back where others have given too much: else features would leave each other in each
            // substep, and layers at rest would tremble.
            let approach = (-relative_velocity.dot(normal)).max(-stopped);
            // As far as the features approached each other at the start of the substep, this is an impact.
            let past = relative(&factors, &gather::<L>(token, past_velocity, &pack.particles));
            let impacted = L::load(token, &pack.impact);
            let impact_now = (-past.dot(normal)).max(zero).min(stopped + approach);
            let changes = least_approach.lt(approach.abs().max((impact_now - impacted).abs()));
            let acts = touches & changes;
            if !acts.any() {
                continue;
            }
            let weights = Weights::<L>::load(token, pack, &factors);
            let acts = acts & weights.are_free;
            let slide = relative_velocity.minus_scaled(normal, relative_velocity.dot(normal));
            let length = slide.dot(slide).sqrt().max(least_length);
            let held = (L::load(token, &pack.friction) * approach.max(zero) / length).min(one);
            let change = (normal * approach).minus_scaled(slide, held) * weights.inverse_sum;
            let change = change.or_where_not(acts, V3::splat(token, 0.0));
            move_by(token, velocity, &pack.particles, &velocities, change, &weights.of_particles);
            let stopped_now = (stopped + approach).or_where_not(acts, stopped);
            let impact_change = normal * ((impact_now - impacted) * weights.inverse_sum);
            let impact_change = impact_change.or_where_not(acts, V3::splat(token, 0.0));
            let impacts = gather::<L>(token, impact, &pack.particles);
            move_by(token, impact, &pack.particles, &impacts, impact_change, &weights.of_particles);
            stopped_now.store(&mut pack.stopped);
            impact_now.or_where_not(acts, impacted).store(&mut pack.impact);
            *self.any |= acts.any();
        }
    }
}

/// How the particles of contacts share what moves them.
struct Weights<L: Lane> {
    /// Factor times inverse mass of each particle.
    of_particles: [L; 4],
    /// Mass of the relative motion of the features, m².
    inverse_sum: L,
    /// Whether any particle is not pinned.
    are_free: L::Mask,
}

impl<L: Lane<Pack = Pack8>> Weights<L> {
    #[inline(always)]
    fn load(token: L::Token, pack: &ContactPack, factors: &[L; 4]) -> Self {
        let zero = L::splat(token, 0.0);
        let mut of_particles = [zero; 4];
        let (mut sum, mut greatest) = (zero, zero);
        for at in 0..4 {
            let inverse = L::load(token, &pack.inverse_masses[at]);
            of_particles[at] = factors[at] * inverse;
            sum = sum.plus_product(of_particles[at], factors[at]);
            greatest = greatest.max(inverse);
        }
        let are_free = zero.lt(greatest);
        let one = L::splat(token, 1.0);
        let sum = sum.max(greatest * L::splat(token, LEAST_SHARE));
        Self { of_particles, inverse_sum: one / sum.or_where_not(are_free, one), are_free }
    }
}

/// Sum of four vectors with the factors of a contact.
#[inline(always)]
fn relative<L: Lane>(factors: &[L; 4], vectors: &[V3<L>; 4]) -> V3<L> {
    (vectors[0] * factors[0])
        .plus_scaled(vectors[1], factors[1])
        .plus_scaled(vectors[2], factors[2])
        .plus_scaled(vectors[3], factors[3])
}

/// Changes the vectors of the particles of eight contacts.
#[inline(always)]
fn move_by<L: Lane>(
    token: L::Token,
    vectors: &mut [Pack4],
    particles: &[[u32; Pack8::WIDTH]; 4],
    before: &[V3<L>; 4],
    by: V3<L>,
    weights: &[L; 4],
) {
    for at in 0..4 {
        before[at].plus_scaled(by, weights[at]).scatter(token, vectors, &particles[at]);
    }
}

/// Stores normals and factors where features face each other.
#[inline(always)]
fn keep_where<L: Lane<Pack = Pack8>>(
    token: L::Token,
    faces: L::Mask,
    normal: V3<L>,
    factors: &[L; 4],
    pack: &mut ContactPack,
) {
    let [no, yes] = [L::splat(token, 0.0), L::splat(token, 1.0)];
    yes.or_where_not(faces, no).store(&mut pack.faces);
    normal.or_where_not(faces, V3::load(token, &pack.normal)).store(&mut pack.normal);
    for (factor, kept) in factors.iter().zip(&mut pack.factors) {
        factor.or_where_not(faces, L::load(token, kept)).store(kept);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::contact::itself::contact_packs::Packing;
    use crate::contact::itself::near::ParticleTriangle;
    use crate::contact::itself::points::{vector, vector_of};
    use crate::contact::itself::touching::Touching;

    /// A particle lies near a corner of a triangle. Both, and another corner, are a thousand times as heavy as the third corner.
    #[test]
    fn a_light_particle_far_from_where_features_touch_is_not_thrown() {
        const THICKNESS: f32 = 5e-3;
        let at = [
            Vec3::new(1e-3, 0.0, 1e-3),
            Vec3::ZERO,
            Vec3::new(-0.03, 0.0, 0.03),
            Vec3::new(0.03, 0.0, 0.03),
        ];
        let inverse_masses = [1.0, 1.0, 1.0, 1e3];
        let end = at.map(vector).to_vec();
        let mut points = Points { start: end.clone(), end: end.clone(), ..Points::default() };
        let contact =
            Touching { particles: [0, 1, 2, 3], distance: THICKNESS, friction: 0.0, passed: 0.0 };
        let mut packs = Vec::new();
        Packing::default().pack(&[contact], end.len(), &mut packs);
        packs[0].read_masses(&inverse_masses);
        assert!(move_apart::<ParticleTriangle>(&mut packs, &mut points));
        let way = |(now, before)| vector_of(now).distance(vector_of(before));
        let moved = points.end.iter().zip(&end).map(way);
        let farthest = moved.fold(0.0, f32::max);
        assert!((0.01..1.0).contains(&(farthest / THICKNESS)), "{farthest} m");
    }
}
