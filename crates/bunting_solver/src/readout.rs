//! What is read out of a batch, cloth by cloth.

use glam::Vec3;

use crate::batch::LaneSurface;
use crate::lane_batch::LaneBatch;
use crate::lanes::Pack;
use crate::places::Constant;
use crate::vector::{Pack3, lane3};

/// Particles whose positions and normals in all lanes fit into the nearest cache, at 384 bytes each.
const BLOCK: usize = 32;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    pub fn copy_positions(&self, lane: usize, into: &mut Vec<Vec3>) {
        into.clear();
        into.extend(self.of_cloth(&self.position, lane));
    }

    pub fn copy_velocities(&self, lane: usize, into: &mut Vec<Vec3>) {
        into.clear();
        into.extend(self.of_cloth(&self.velocity, lane));
    }

    pub fn copy_normals(&self, lane: usize, into: &mut Vec<Vec3>) {
        into.clear();
        into.extend(self.of_cloth(&self.normal, lane));
    }

    pub fn copy_surfaces(&self, into: &mut [LaneSurface]) {
        let particles = self.fabric.particle_count();
        let into = &mut into[..self.slots.len()];
        let sums = sums(&self.position);
        for (cloth, surface) in into.iter_mut().enumerate() {
            if self.slots[cloth].is_some() {
                // What is not finite makes the sum so.
                surface.is_finite = sums.lanes()[C::lanes(cloth)].iter().all(|sum| sum.is_finite());
                surface.positions.resize(particles, Vec3::ZERO);
                surface.normals.resize(particles, Vec3::ZERO);
            }
        }
        if C::SIDE > 1 {
            for (cloth, surface) in
                into.iter_mut().enumerate().filter(|(cloth, _)| self.slots[*cloth].is_some())
            {
                self.copy_positions(cloth, &mut surface.positions);
                self.copy_normals(cloth, &mut surface.normals);
            }
            return;
        }
        // Particles by the block, so that each is fetched once for all lanes.
        let mut first = 0;
        for (positions, normals) in self.position.chunks(BLOCK).zip(self.normal.chunks(BLOCK)) {
            for (lane, surface) in into.iter_mut().enumerate() {
                if self.slots[lane].is_some() {
                    read(positions, lane, &mut surface.positions[first..]);
                    read(normals, lane, &mut surface.normals[first..]);
                }
            }
            first += positions.len();
        }
    }

    pub fn is_finite(&self, lane: usize) -> bool {
        let finite = |packs| self.of_cloth(packs, lane).all(Vec3::is_finite);
        finite(&self.position) && finite(&self.velocity)
    }

    /// The vectors of one cloth, particle by particle.
    pub fn of_cloth(&self, packs: &[Pack3<P>], cloth: usize) -> impl Iterator<Item = Vec3> {
        (0..self.fabric.particle_count()).map(move |particle| {
            let (pack, lane) = self.seating.seat(particle, cloth);
            lane3(&packs[pack], lane)
        })
    }
}

/// The sum of all coordinates, for each lane.
fn sums<P: Pack>(packs: &[Pack3<P>]) -> P {
    let mut sums = P::splat(0.0);
    for coordinate in packs.iter().flatten() {
        for (sum, value) in sums.lanes_mut().iter_mut().zip(coordinate.lanes()) {
            *sum += value;
        }
    }
    sums
}

/// Reads one lane of a vector for each particle.
fn read<P: Pack>(packs: &[Pack3<P>], lane: usize, into: &mut [Vec3]) {
    // Once, and not for every number.
    assert!(lane < P::WIDTH, "a lane of the batch");
    for (value, pack) in into.iter_mut().zip(packs) {
        *value = lane3(pack, lane);
    }
}
