//! Normals of the surface: each particle's is the area-weighted mean of its triangles'.

use crate::constants::LEAST_AREA_SQUARED;
use crate::fabric::Patch;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::places::Constant;
use crate::vector::{Pack3, V3};

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
            patches: self.fabric.patches(),
            position: &self.position,
            normal: &mut self.scratch,
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
        for sum in self.normal.iter_mut() {
            V3::<L>::splat(token, 0.0).store(sum);
        }
        for patch in self.patches {
            let [a, b, c, d] = patch.corners;
            let (a, b, c, d) = (a as usize, b as usize, c as usize, d as usize);
            let [first, second] = face::<L>([
                V3::load(token, &self.position[a]),
                V3::load(token, &self.position[b]),
                V3::load(token, &self.position[c]),
                V3::load(token, &self.position[d]),
            ]);
            let both = first + second;
            both.add_to(token, &mut self.normal[a]);
            first.add_to(token, &mut self.normal[b]);
            both.add_to(token, &mut self.normal[c]);
            second.add_to(token, &mut self.normal[d]);
        }
        for normal in self.normal {
            normalised(token, V3::<L>::load(token, normal)).store(normal);
        }
    }
}

/// Normals, of twice the triangles' areas, of a patch with these corners.
#[inline(always)]
pub(crate) fn face<L: Lane>([a, b, c, d]: [V3<L>; 4]) -> [V3<L>; 2] {
    let (ab, ac, ad) = (b - a, c - a, d - a);
    [ab.cross(ac), ac.cross(ad)]
}

#[inline(always)]
pub(crate) fn normalised<L: Lane>(token: L::Token, sum: V3<L>) -> V3<L> {
    let least = L::splat(token, LEAST_AREA_SQUARED);
    let length = sum.dot(sum).max(least).sqrt();
    sum * (L::splat(token, 1.0) / length)
}
