//! The gradient of the volume behind the triangles, at each particle.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::geometry::corners::{Contribution, CornerSums, Corners};
use crate::geometry::face::face;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// A corner of a triangle has a third of its area, and the normal of [`face`] is twice as long as the area.
const OF_CORNER: f32 = 1.0 / 6.0;

/// Each corner of a grid's cell has a quarter of the areas of both triangles, as of their mass.
const OF_CELL_CORNER: f32 = 1.0 / 8.0;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Computes the gradients of all cloths at the present positions, m².
    pub(super) fn sum_gradient(&mut self, gradient: &mut [Pack3<P>]) {
        let has_cells = self.fabric.patch_grid_columns().is_some();
        P::run(SumGradient {
            triangles: self.layout.triangles(&self.fabric),
            position: self.positions.field(),
            part: if has_cells { OF_CELL_CORNER } else { OF_CORNER },
            gradient,
        });
    }
}

struct SumGradient<'a, P: Pack, S: CornerSums<P>> {
    triangles: S,
    /// Positions, m.
    position: &'a S::Field,
    /// Part of a triangle's normal that a corner has.
    part: f32,
    gradient: &'a mut [Pack3<P>],
}

impl<P: Pack, S: CornerSums<P>> Kernel<P> for SumGradient<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { triangles, position, part, gradient } = self;
        let part = L::splat(token, part);
        triangles.sum::<L, _>(token, &OfTriangles { position, part }, gradient);
    }
}

struct OfTriangles<'a, L: Lane, F: ?Sized> {
    position: &'a F,
    part: L,
}

impl<L: Lane, F: ?Sized> Contribution<L, F> for OfTriangles<'_, L, F> {
    #[inline(always)]
    fn of<C: Corners<L, Field = F>>(&self, token: L::Token, corners: &C) -> [V3<L>; 2] {
        let [first, second] = face(corners.load(token, self.position));
        [corners.where_present(token, first), corners.where_present(token, second)]
    }

    #[inline(always)]
    fn finish(&self, _: L::Token, sum: V3<L>) -> V3<L> {
        sum * self.part
    }
}
