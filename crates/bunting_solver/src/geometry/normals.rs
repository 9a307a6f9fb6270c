//! Normals of the surface: each particle's normal is the area-weighted mean of its triangles' normals.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::constants::LEAST_AREA_SQUARED;
use crate::fabric::{Fabric, Patch};
use crate::geometry::corners::{Giver, sum_corners};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Recomputes all normals.
    pub fn compute_normals(&mut self) {
        if C::SIDE > 1
            && let Some(weave) = &mut self.weave
        {
            weave.compute_normals(&self.position, &mut self.scratch);
            return;
        }
        P::run(Normals {
            fabric: &self.fabric,
            position: &self.position,
            below: &mut self.below,
            normal: &mut self.scratch,
        });
    }
}

struct Normals<'a, P: Pack> {
    fabric: &'a Fabric,
    position: &'a [Pack3<P>],
    below: &'a mut [Pack3<P>],
    normal: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Normals<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { fabric, position, below, normal } = self;
        sum_corners::<L, _>(token, fabric, &Faces { position }, below, normal);
    }
}

struct Faces<'a, P: Pack> {
    position: &'a [Pack3<P>],
}

impl<L: Lane> Giver<L> for Faces<'_, L::Pack> {
    #[inline(always)]
    fn give(&self, token: L::Token, patch: &Patch) -> [V3<L>; 2] {
        face(patch.load(token, self.position))
    }

    #[inline(always)]
    fn finish(&self, token: L::Token, sum: V3<L>) -> V3<L> {
        normalised(token, sum)
    }
}

/// Normals of the triangles (a, b, c) and (a, c, d), each as long as twice the triangle's area, m².
#[inline(always)]
pub(crate) fn face<L: Lane>([a, b, c, d]: [V3<L>; 4]) -> [V3<L>; 2] {
    let (ab, ac, ad) = (b - a, c - a, d - a);
    [ab.cross(ac), ac.cross(ad)]
}

/// A unit vector along a sum of normals; nearly zero where the triangles have no area.
#[inline(always)]
pub(crate) fn normalised<L: Lane>(token: L::Token, sum: V3<L>) -> V3<L> {
    let least = L::splat(token, LEAST_AREA_SQUARED);
    let length = sum.dot(sum).max(least).sqrt();
    sum * (L::splat(token, 1.0) / length)
}
