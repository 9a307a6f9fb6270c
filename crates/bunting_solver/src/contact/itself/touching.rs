//! The contacts among the pairs that a search has found: those nearer than some distance at the end of the substep, and those that have
//! passed through each other in it.

use core::marker::PhantomData;

use glam::Vec3;

use crate::contact::itself::near::{EdgeEdge, FAR, Features, ParticleTriangle};
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::points::{Points, gather};
use crate::contact::itself::rules::{Keep, Rules};
use crate::contact::itself::untangle::Tangles;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::registers::{Pack1, Pack8};
use crate::simd::vec3::{V3, splat3};

/// Speed at which features that are too near at the start of a substep move apart, m/s. Smaller: layers stay pressed
/// together for long. Larger: links beside them are stretched.
const RECOVERY: f32 = 0.5;

/// Part of the distance at rest that features keep which are nearer than the thickness at rest. Larger: such features
/// are pushed by rounding errors.
const REST_PART: f32 = 0.8;

/// Two features that touch, or may touch in later sweeps.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Touching {
    pub particles: [u32; 4],
    /// Distance that the features keep, m.
    pub distance: f32,
    /// Coulomb friction coefficient.
    pub friction: f32,
    /// Sign of the height, or of the volume, at the start of the substep, if the features have passed through one
    /// another since; else zero.
    pub passed: f32,
}

/// How the contacts of a substep are found.
pub(in crate::contact) struct FindTouching<'a, R> {
    pub rules: &'a R,
    /// Greatest distance that any layers keep, m.
    pub thickness: f32,
    /// Length of the substep, s.
    pub step: f32,
    /// Features that pass through one another at the start of the substep.
    pub tangles: &'a Tangles,
}

impl<R: Rules> FindTouching<'_, R> {
    /// Finds the particles and triangles, and the edges, that touch.
    pub fn find(
        &self,
        pairs: &Pairs,
        points: &Points,
        into: &mut [Vec<Touching>; 2],
        near: &mut Vec<NearPair>,
    ) {
        let [triangles, edges] = into;
        self.of_kind::<ParticleTriangle>(&pairs.particles_triangles, points, triangles, near);
        self.of_kind::<EdgeEdge>(&pairs.edges_edges, points, edges, near);
    }

    fn of_kind<F: Features>(
        &self,
        pairs: &[[u32; 4]],
        points: &Points,
        into: &mut Vec<Touching>,
        near: &mut Vec<NearPair>,
    ) {
        near.clear();
        into.clear();
        let far = FAR * F::PART * self.thickness;
        Pack8::run(FindNear::<F> { pairs, points, far, near, kind: PhantomData });
        into.extend(near.iter().filter_map(|pair| self.touching::<F>(pair)));
    }

    /// The contact of two features; none if they are tangled, or keep a smaller distance than others from which they are far.
    fn touching<F: Features>(&self, near: &NearPair) -> Option<Touching> {
        // Tangled features must pass through others to come apart.
        if self.tangles.contain_any(&near.particles) {
            return None;
        }
        let Keep { distance, friction, rest } = self.rules.keep(near.particles);
        let distance = F::PART * distance;
        if near.gap >= FAR * distance {
            return None;
        }
        let at_rest =
            rest.map_or(f32::INFINITY, |rest| distance_at_rest::<F>(&rest, distance / REST_PART));
        let distance = distance.min(REST_PART * at_rest).min(near.start + RECOVERY * self.step);
        Some(Touching { particles: near.particles, distance, friction, passed: near.passed })
    }
}

/// Distance of features at rest, m, if it is less than another; else infinite.
fn distance_at_rest<F: Features>(rest: &[Vec3; 4], within: f32) -> f32 {
    let mut distance = f32::INFINITY;
    if F::are_within(rest, within) {
        let kind = PhantomData;
        Pack1::run(AtRest::<F> { rest, distance: &mut distance, kind });
    }
    distance
}

struct AtRest<'a, F> {
    rest: &'a [Vec3; 4],
    distance: &'a mut f32,
    kind: PhantomData<F>,
}

impl<F: Features> Kernel<Pack1> for AtRest<'_, F> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack1>>(self, token: L::Token) {
        let [a, b, c, d] = self.rest;
        let at = [
            V3::load(token, &splat3(*a)),
            V3::load(token, &splat3(*b)),
            V3::load(token, &splat3(*c)),
            V3::load(token, &splat3(*d)),
        ];
        let mut distance = Pack1::splat(0.0);
        distance_of::<F, L>(token, &at).store(&mut distance);
        *self.distance = distance.lanes()[0];
    }
}

/// Distance of features, m; infinite where they do not face each other.
#[inline(always)]
fn distance_of<F: Features, L: Lane>(token: L::Token, at: &[V3<L>; 4]) -> L {
    let near = F::near(token, at, L::splat(token, 0.0));
    near.gap.or_where_not(near.faces, L::splat(token, f32::INFINITY))
}

/// Two features that are near.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct NearPair {
    particles: [u32; 4],
    /// Signed distance at the end of the substep, m.
    gap: f32,
    /// Distance at its start, m.
    start: f32,
    passed: f32,
}

/// Finds the pairs that are near.
struct FindNear<'a, F> {
    pairs: &'a [[u32; 4]],
    points: &'a Points,
    /// Distance from which on pairs are left out, m.
    far: f32,
    near: &'a mut Vec<NearPair>,
    kind: PhantomData<F>,
}

impl<F: Features> Kernel<Pack8> for FindNear<'_, F> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let Self { pairs, points, far, near, .. } = self;
        let far = L::splat(token, far);
        let apart = L::splat(token, f32::INFINITY);
        for pairs in pairs.chunks(Pack8::WIDTH) {
            let at = &indices(pairs);
            let (start, end) =
                (gather::<L>(token, &points.start, at), gather::<L>(token, &points.end, at));
            let passed = F::passed(token, &start, &end);
            let now = F::near(token, &end, passed);
            let is_near = now.faces & now.gap.lt(far);
            if !is_near.any() {
                continue;
            }
            let [mut gaps, mut starts, mut sides] = [Pack8::splat(0.0); 3];
            now.gap.or_where_not(is_near, apart).store(&mut gaps);
            distance_of::<F, L>(token, &start).store(&mut starts);
            passed.store(&mut sides);
            for (lane, &particles) in pairs.iter().enumerate() {
                let gap = gaps.lanes()[lane];
                if gap < f32::INFINITY {
                    let (start, passed) = (starts.lanes()[lane], sides.lanes()[lane]);
                    near.push(NearPair { particles, gap, start, passed });
                }
            }
        }
    }
}

/// The particles of up to eight pairs, one pair in each lane; the last in those without one.
#[inline(always)]
pub(in crate::contact) fn indices(pairs: &[[u32; 4]]) -> [[u32; Pack8::WIDTH]; 4] {
    let mut indices = [[0; Pack8::WIDTH]; 4];
    for lane in 0..Pack8::WIDTH {
        let pair = &pairs[lane.min(pairs.len() - 1)];
        for (of_lanes, &particle) in indices.iter_mut().zip(pair) {
            of_lanes[lane] = particle;
        }
    }
    indices
}
