//! Normals of the surface: each particle's is the area-weighted mean of its triangles'.

use glam::Vec3;

use crate::constants::LEAST_AREA_SQUARED;
use crate::fabric::Patch;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3, splat3};

impl<P: Pack> LaneBatch<P> {
    /// Recomputes all normals.
    pub fn compute_normals(&mut self) {
        self.normal.fill(splat3(Vec3::ZERO));
        P::run(Normals {
            patches: self.fabric.patches(),
            position: &self.position,
            normal: &mut self.normal,
        });
    }
}

struct Normals<'a, P: Pack> {
    patches: &'a [Patch],
    position: &'a [Pack3<P>],
    normal: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Normals<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        for patch in self.patches {
            let corners = patch.corners.map(|corner| corner as usize);
            let [a, b, c, d]: [V3<L>; 4] =
                corners.map(|corner| V3::load(token, &self.position[corner]));
            let (ab, ac, ad) = (b - a, c - a, d - a);
            let (first, second) = (ab.cross(ac), ac.cross(ad));
            let both = first + second;
            for (corner, doubled) in corners.into_iter().zip([both, first, both, second]) {
                let sum: V3<L> = V3::load(token, &self.normal[corner]);
                (sum + doubled).store(&mut self.normal[corner]);
            }
        }
        let least = L::splat(token, LEAST_AREA_SQUARED);
        let one = L::splat(token, 1.0);
        for normal in self.normal {
            let sum: V3<L> = V3::load(token, normal);
            let length = sum.dot(sum).max(least).sqrt();
            (sum * (one / length)).store(normal);
        }
    }
}
