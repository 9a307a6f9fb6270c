//! Copies of the surfaces in all lanes of a batch: positions and normals, cloth by cloth.
//!
//! The vector of a cloth's particle is spread over three packs. Four lanes at once are transposed in
//! registers, which takes a third of the time of reading each vector by itself.

use fearless_simd::{Simd, SimdBase, f32x4};
use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::level::dispatch;
use crate::simd::vec3::Pack3;

/// The surface of the cloth in a lane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaneSurface {
    /// Positions of the particles in the cloth's frame, m.
    pub positions: Vec<Vec3>,
    /// Unit normals of the particles, as of the last
    /// [`compute_normals`](crate::ClothBatch::compute_normals).
    pub normals: Vec<Vec3>,
    /// Whether all positions and their sum are finite.
    pub is_finite: bool,
    /// Acceleration of links that turned in the last tick, see [`Loads::of_motion`](crate::Loads::of_motion), m/s².
    pub motion: f32,
    /// Acceleration by tension, see [`ClothBatch::tension_load`](crate::ClothBatch::tension_load), m/s².
    pub tension: f32,
    /// Load by colliders that pressed the cloth in the last tick, see
    /// [`ClothBatch::contact_load`](crate::ClothBatch::contact_load), m/s².
    pub contacts: f32,
}

/// Number of particles whose positions and normals in all lanes fit into the nearest cache, at 384 bytes
/// each.
const BLOCK: usize = 32;

/// Number of lanes that are transposed at once.
const QUAD: usize = 4;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Copies positions and normals of all cloths.
    pub fn copy_surfaces(&self, into: &mut [LaneSurface]) {
        let particles = self.fabric.particle_count();
        let surfaces = &mut into[..self.lanes.len()];
        for ((cloth, surface), motion) in surfaces.iter_mut().enumerate().zip(self.motion_loads()) {
            if let Some(state) = &self.lanes[cloth] {
                surface.motion = motion;
                surface.tension = self.tension_load(cloth, state);
                surface.contacts = self.contact_load(cloth, state);
                surface.is_finite = true;
                surface.positions.resize(particles, Vec3::ZERO);
                surface.normals.resize(particles, Vec3::ZERO);
            }
        }
        if surfaces.len().is_multiple_of(QUAD) {
            dispatch!(token => self.copy_by_quads(token, surfaces));
        } else if self.lanes[0].is_some() {
            let LaneSurface { positions, normals, is_finite, .. } = &mut surfaces[0];
            self.copy_positions(0, positions);
            self.copy_normals(0, normals);
            *is_finite = positions.iter().sum::<Vec3>().is_finite();
        }
    }

    /// Copies particles block by block, so that each pack is fetched once for all lanes.
    #[inline(always)]
    fn copy_by_quads<S: Simd>(&self, token: S, into: &mut [LaneSurface]) {
        // Empty lanes of a quad are written here.
        let mut discarded = [[Vec3::ZERO; BLOCK]; QUAD];
        let blocks = self.positions.packs().chunks(BLOCK).zip(self.scratch.chunks(BLOCK));
        for (index, (positions, normals)) in blocks.enumerate() {
            let block = index * BLOCK..index * BLOCK + positions.len();
            for (quad, surfaces) in into.chunks_exact_mut(QUAD).enumerate() {
                let first = quad * QUAD;
                let lanes = &self.lanes[first..first + QUAD];
                if lanes.iter().all(Option::is_none) {
                    continue;
                }
                let [a, b, c, d] = &mut discarded;
                let mut to_positions: [&mut [Vec3]; QUAD] = [a, b, c, d];
                for (lane, surface) in surfaces.iter_mut().enumerate() {
                    if lanes[lane].is_some() {
                        to_positions[lane] = &mut surface.positions[block.clone()];
                    }
                }
                let sums = transpose(token, positions, first, to_positions);
                let [a, b, c, d] = &mut discarded;
                let mut to_normals: [&mut [Vec3]; QUAD] = [a, b, c, d];
                for (lane, surface) in surfaces.iter_mut().enumerate() {
                    if lanes[lane].is_some() {
                        // A coordinate that is not finite makes the sum not finite.
                        surface.is_finite &= sums[lane].is_finite();
                        to_normals[lane] = &mut surface.normals[block.clone()];
                    }
                }
                transpose(token, normals, first, to_normals);
            }
        }
    }
}

/// Reads the vectors of four lanes from `first` on, and adds up the coordinates of each lane.
#[inline(always)]
fn transpose<S: Simd, P: Pack>(
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
        // The fourth number of each transposed vector is unused.
        let (xz_low, xz_high) = (x.zip_low(z), x.zip_high(z));
        let (yy_low, yy_high) = (y.zip_low(y), y.zip_high(y));
        *a = Vec3::from_slice(xz_low.zip_low(yy_low).as_slice());
        *b = Vec3::from_slice(xz_low.zip_high(yy_low).as_slice());
        *c = Vec3::from_slice(xz_high.zip_low(yy_high).as_slice());
        *d = Vec3::from_slice(xz_high.zip_high(yy_high).as_slice());
    }
    sum.into()
}
