//! Reading of a batch's state, cloth by cloth.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::batch::snapshot::{ClothSnapshot, SnapshotHistory};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, lane3};
use crate::step::bdf::IntegratorHistory;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// The state of a lane, with its history if the integrator has one.
    pub fn snapshot(&self, lane: usize) -> ClothSnapshot {
        let integrator = self.lanes[lane]
            .as_ref()
            .map_or_else(IntegratorHistory::default, |cloth| cloth.history);
        let read = |packs: &Vec<Pack3<P>>| self.read(packs, lane);
        let history = integrator.exists().then(|| SnapshotHistory {
            integrator,
            displacements: [&self.displacement, &self.older_displacement].map(read),
            older_velocities: [&self.older_velocity, &self.oldest_velocity].map(read),
            relaxation: self.relaxation_of(lane),
        });
        ClothSnapshot { history, ..self.snapshot_without_history(lane) }
    }

    /// The state of a lane, without its history.
    pub fn snapshot_without_history(&self, lane: usize) -> ClothSnapshot {
        ClothSnapshot::new(self.read(self.positions.packs(), lane), self.read(&self.velocity, lane))
    }

    /// Positions and velocities of some of a lane's particles.
    pub fn snapshot_of(&self, lane: usize, particles: &[u32]) -> ClothSnapshot {
        let read = |packs: &[Pack3<P>]| {
            let located = particles.iter().map(|&at| self.layout.locate(at as usize, lane));
            located.map(|(pack, lane)| lane3(&packs[pack], lane)).collect()
        };
        ClothSnapshot::new(read(self.positions.packs()), read(&self.velocity))
    }

    fn read(&self, packs: &[Pack3<P>], lane: usize) -> Vec<Vec3> {
        let mut vectors = Vec::new();
        self.layout.read(packs, lane, &mut vectors);
        vectors
    }

    /// Positions of a lane's particles, m.
    pub fn copy_positions(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.layout.read(self.positions.packs(), lane, into);
    }

    /// Velocities of a lane's particles, m/s.
    pub fn copy_velocities(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.layout.read(&self.velocity, lane, into);
    }

    /// Unit normals of a lane's particles.
    pub fn copy_normals(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.layout.read(&self.scratch, lane, into);
    }

    /// Whether all positions and velocities of a lane are finite.
    pub fn is_finite(&self, lane: usize) -> bool {
        let lanes = Y::lanes(lane);
        let is_finite = |pack: &P| {
            pack.lanes()[lanes.clone()].iter().fold(true, |all, number| all & number.is_finite())
        };
        let vectors = self.positions.packs().iter().chain(&self.velocity);
        vectors.flatten().all(is_finite)
    }

    /// The vectors of one cloth, particle by particle.
    pub fn of_cloth(&self, packs: &[Pack3<P>], cloth: usize) -> impl Iterator<Item = Vec3> {
        (0..self.fabric.particle_count()).map(move |particle| {
            let (pack, lane) = self.layout.locate(particle, cloth);
            lane3(&packs[pack], lane)
        })
    }
}
