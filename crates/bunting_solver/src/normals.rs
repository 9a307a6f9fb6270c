//! Normals of the surface: each particle's is the area-weighted mean of its triangles'.

use crate::constants::LEAST_AREA_SQUARED;
use crate::fabric::Patch;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Recomputes all normals.
    pub fn compute_normals(&mut self) {
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
        for sum in self.normal.iter_mut() {
            V3::<L>::splat(token, 0.0).store(sum);
        }
        for patch in self.patches {
            let [a, b, c, d] = patch.corners;
            let (a, b, c, d) = (a as usize, b as usize, c as usize, d as usize);
            let at: V3<L> = V3::load(token, &self.position[a]);
            let ab = V3::load(token, &self.position[b]) - at;
            let ac = V3::load(token, &self.position[c]) - at;
            let ad = V3::load(token, &self.position[d]) - at;
            let (first, second) = (ab.cross(ac), ac.cross(ad));
            let both = first + second;
            both.add_to(token, &mut self.normal[a]);
            first.add_to(token, &mut self.normal[b]);
            both.add_to(token, &mut self.normal[c]);
            second.add_to(token, &mut self.normal[d]);
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
