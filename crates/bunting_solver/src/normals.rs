//! Normals of the surface: each particle's is the area-weighted mean of its triangles'.

use glam::Vec3;

use crate::constants::LEAST_AREA_SQUARED;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3, splat3};

impl<P: Pack> LaneBatch<P> {
    /// Recomputes all normals.
    pub fn compute_normals(&mut self) {
        self.normal.fill(splat3(Vec3::ZERO));
        P::run(Normals {
            triangles: self.fabric.triangles(),
            position: &self.position,
            normal: &mut self.normal,
        });
    }
}

struct Normals<'a, P: Pack> {
    triangles: &'a [[u32; 3]],
    position: &'a [Pack3<P>],
    normal: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Normals<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        for corners in self.triangles {
            let [a, b, c] = corners.map(|corner| corner as usize);
            let at: [V3<L>; 3] = [a, b, c].map(|corner| V3::load(token, &self.position[corner]));
            let doubled = (at[1] - at[0]).cross(at[2] - at[0]);
            for corner in [a, b, c] {
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
