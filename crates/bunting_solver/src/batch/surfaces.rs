//! What the lanes of a batch show, out of the lanes.
//!
//! A cloth's particle is three numbers in three packs. They are put together in registers, for four lanes at
//! once: that takes a third of the time of fetching each by itself.

use fearless_simd::{Simd, SimdBase, dispatch, f32x4};
use glam::Vec3;

use crate::batch::LaneSurface;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::simd::lane::Pack;
use crate::simd::level::level;
use crate::simd::vec3::Pack3;

/// Particles whose positions and normals in all lanes fit into the nearest cache, at 384 bytes each.
const BLOCK: usize = 32;

/// Lanes that are read at once.
const QUAD: usize = 4;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    pub fn copy_surfaces(&self, into: &mut [LaneSurface]) {
        let particles = self.fabric.particle_count();
        let surfaces = &mut into[..self.slots.len()];
        for (cloth, surface) in surfaces.iter_mut().enumerate() {
            if self.slots[cloth].is_some() {
                surface.is_finite = true;
                surface.positions.resize(particles, Vec3::ZERO);
                surface.normals.resize(particles, Vec3::ZERO);
            }
        }
        if surfaces.len().is_multiple_of(QUAD) {
            dispatch!(level(), token => self.copy_by_quads(token, surfaces));
        } else if self.slots[0].is_some() {
            let LaneSurface { positions, normals, is_finite } = &mut surfaces[0];
            self.copy_positions(0, positions);
            self.copy_normals(0, normals);
            *is_finite = positions.iter().sum::<Vec3>().is_finite();
        }
    }

    /// Particles by the block, so that each is fetched once for all lanes.
    #[inline(always)]
    fn copy_by_quads<S: Simd>(&self, token: S, into: &mut [LaneSurface]) {
        let mut unseen = [[Vec3::ZERO; BLOCK]; QUAD];
        let blocks = self.position.chunks(BLOCK).zip(self.scratch.chunks(BLOCK));
        for (index, (positions, normals)) in blocks.enumerate() {
            let part = index * BLOCK..index * BLOCK + positions.len();
            for (quad, surfaces) in into.chunks_exact_mut(QUAD).enumerate() {
                let lane = quad * QUAD;
                let slots = &self.slots[lane..lane + QUAD];
                if slots.iter().all(Option::is_none) {
                    continue;
                }
                let [a, b, c, d] = &mut unseen;
                let mut of_positions: [&mut [Vec3]; QUAD] = [a, b, c, d];
                for (lane, surface) in surfaces.iter_mut().enumerate() {
                    if slots[lane].is_some() {
                        of_positions[lane] = &mut surface.positions[part.clone()];
                    }
                }
                let sums = unpack(token, positions, lane, of_positions);
                let [a, b, c, d] = &mut unseen;
                let mut of_normals: [&mut [Vec3]; QUAD] = [a, b, c, d];
                for (lane, surface) in surfaces.iter_mut().enumerate() {
                    if slots[lane].is_some() {
                        // What is not finite makes the sum so.
                        surface.is_finite &= sums[lane].is_finite();
                        of_normals[lane] = &mut surface.normals[part.clone()];
                    }
                }
                unpack(token, normals, lane, of_normals);
            }
        }
    }
}

/// Reads particles in four lanes from a lane on, and adds up the coordinates in each.
#[inline(always)]
fn unpack<S: Simd, P: Pack>(
    token: S,
    packs: &[Pack3<P>],
    first: usize,
    [a, b, c, d]: [&mut [Vec3]; QUAD],
) -> [f32; QUAD] {
    let mut sum = f32x4::splat(token, 0.0);
    let lanes = a.iter_mut().zip(b).zip(c).zip(d);
    for ((((a, b), c), d), [x, y, z]) in lanes.zip(packs) {
        let x = f32x4::from_slice(token, &x.lanes()[first..first + QUAD]);
        let y = f32x4::from_slice(token, &y.lanes()[first..first + QUAD]);
        let z = f32x4::from_slice(token, &z.lanes()[first..first + QUAD]);
        sum = sum + x + y + z;
        // The fourth number of each is not used.
        let (xz, also_xz) = (x.zip_low(z), x.zip_high(z));
        let (yy, also_yy) = (y.zip_low(y), y.zip_high(y));
        *a = Vec3::from_slice(xz.zip_low(yy).as_slice());
        *b = Vec3::from_slice(xz.zip_high(yy).as_slice());
        *c = Vec3::from_slice(also_xz.zip_low(also_yy).as_slice());
        *d = Vec3::from_slice(also_xz.zip_high(also_yy).as_slice());
    }
    sum.into()
}
