//! Normals of the surface: the normal of a particle is the area-weighted mean of its triangles' normals.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::constants::LEAST_AREA_SQUARED;
use crate::geometry::corners::{Contribution, CornerSums, Corners};
use crate::geometry::face::face;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Computes all normals and writes them into `scratch`.
    pub fn compute_normals(&mut self) {
        P::run(Normals {
            triangles: self.layout.triangles(&self.fabric),
            position: self.positions.field(),
            normal: &mut self.scratch,
        });
    }
}

struct Normals<'a, P: Pack, S: CornerSums<P>> {
    triangles: S,
    /// Positions, m.
    position: &'a S::Field,
    normal: &'a mut [Pack3<P>],
}

impl<P: Pack, S: CornerSums<P>> Kernel<P> for Normals<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { triangles, position, normal } = self;
        triangles.sum::<L, _>(token, &FaceNormals { position }, normal);
    }
}

struct FaceNormals<'a, F: ?Sized> {
    position: &'a F,
}

impl<L: Lane, F: ?Sized> Contribution<L, F> for FaceNormals<'_, F> {
    #[inline(always)]
    fn of<C: Corners<L, Field = F>>(&self, token: L::Token, corners: &C) -> [V3<L>; 2] {
        let [first, second] = face(corners.load(token, self.position));
        [corners.where_present(token, first), corners.where_present(token, second)]
    }

    /// The sum scaled to unit length.
    #[inline(always)]
    fn finish(&self, token: L::Token, sum: V3<L>) -> V3<L> {
        let least = L::splat(token, LEAST_AREA_SQUARED);
        let length = sum.dot(sum).max(least).sqrt();
        sum * (L::splat(token, 1.0) / length)
    }
}
