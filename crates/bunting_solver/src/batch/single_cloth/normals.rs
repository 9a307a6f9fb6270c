//! Normals of a cloth whose cells lie in the lanes.

use super::Weave;
use super::cells::{Cells, Corners, Giver};
use super::sheets::Plane;
use crate::geometry::normals::{face, normalised};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack> Weave<P> {
    /// Recomputes all normals.
    pub fn compute_normals(&mut self, position: &[Pack3<P>], normal: &mut [Pack3<P>]) {
        self.sheets.read(position);
        P::run(Normals { cells: &mut self.cells, position: self.sheets.straight(), normal });
    }
}

struct Normals<'a, P: Pack> {
    cells: &'a mut Cells<P>,
    position: &'a Plane,
    normal: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Normals<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { cells, position, normal } = self;
        cells.sum::<L, _>(token, &mut Faces { position, normal });
    }
}

struct Faces<'a, P: Pack> {
    position: &'a Plane,
    normal: &'a mut [Pack3<P>],
}

impl<L: Lane> Giver<L> for Faces<'_, L::Pack> {
    #[inline(always)]
    fn give(&self, token: L::Token, corners: Corners<L>, [share, _]: [L; 2]) -> [V3<L>; 2] {
        let [first, second] = face(corners.of(token, self.position));
        let nothing = V3::splat(token, 0.0);
        let exists = L::splat(token, 0.0).lt(share);
        [first.or_where_not(exists, nothing), second.or_where_not(exists, nothing)]
    }

    #[inline(always)]
    fn put(&mut self, token: L::Token, pack: usize, sum: V3<L>) {
        normalised(token, sum).store(&mut self.normal[pack]);
    }
}
