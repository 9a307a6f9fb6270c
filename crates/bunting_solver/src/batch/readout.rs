//! What is read out of a batch, cloth by cloth.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::batch::snapshot::{ClothSnapshot, History};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, lane3};
use crate::step::bdf::Past;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// The state of a lane, past and all.
    pub fn snapshot(&self, lane: usize) -> ClothSnapshot {
        let past = self.slots[lane].as_ref().map_or_else(Past::default, |slot| slot.past);
        let read = |packs| self.read(packs, lane);
        let history = past.exists().then(|| History {
            past,
            displacements: [read(&self.displacement), read(&self.older_displacement)],
            older_velocities: [read(&self.older_velocity), read(&self.oldest_velocity)],
            memory: read(&self.memory),
            shares: self.shares(lane),
        });
        ClothSnapshot { history, ..self.forgetful_snapshot(lane) }
    }

    /// The state of a lane without its past.
    pub fn forgetful_snapshot(&self, lane: usize) -> ClothSnapshot {
        ClothSnapshot::new(self.read(&self.position, lane), self.read(&self.velocity, lane))
    }

    /// Positions and velocities of some of a lane's particles.
    pub fn snapshot_of(&self, lane: usize, particles: &[u32]) -> ClothSnapshot {
        let read = |packs: &[Pack3<P>]| {
            let seats = particles.iter().map(|&at| self.seating.seat(at as usize, lane));
            seats.map(|(pack, lane)| lane3(&packs[pack], lane)).collect()
        };
        ClothSnapshot::new(read(&self.position), read(&self.velocity))
    }

    fn read(&self, packs: &[Pack3<P>], lane: usize) -> Vec<Vec3> {
        let mut vectors = Vec::new();
        self.seating.read::<P, C>(packs, lane, &mut vectors);
        vectors
    }

    pub fn copy_positions(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.seating.read::<P, C>(&self.position, lane, into);
    }

    pub fn copy_velocities(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.seating.read::<P, C>(&self.velocity, lane, into);
    }

    pub fn copy_normals(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.seating.read::<P, C>(&self.scratch, lane, into);
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
