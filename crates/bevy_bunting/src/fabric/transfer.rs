//! Transfers between the levels of a cloth: of states, and of values at particles.

use bevy_math::Vec3;
use bunting_solver::{ClothSnapshot, FabricMaterial, LevelTransfer};

use crate::fabric::levels::ClothLevels;

impl ClothLevels {
    /// Transfers a state from one level to another, for a cloth with a material and gravity along the axes of
    /// its frame, m/s².
    pub fn transfer(
        &self,
        mut snapshot: ClothSnapshot,
        (from, to): (usize, usize),
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        // Cloths that were never on a screen are still at rest, as are most cloths of a crowd.
        if snapshot.is_at_rest(self.fabric(from)) {
            return ClothSnapshot::at_rest(self.fabric(to));
        }
        let restrictions = self.between(from, to);
        if !restrictions.is_empty() {
            return LevelTransfer::restrict_through(restrictions, &snapshot, material, gravity);
        }
        for transfer in self.between(to, from).iter().rev() {
            snapshot = transfer.prolong(&snapshot, material, gravity);
        }
        snapshot
    }

    /// For each particle of a coarse level, the particle of a finer level that it shares a vertex with.
    pub fn shared(&self, fine: usize, coarse: usize) -> Vec<u32> {
        let mut particles = (0..self.fabric(coarse).particle_count() as u32).collect::<Vec<_>>();
        for transfer in self.between(fine, coarse).iter().rev() {
            for particle in &mut particles {
                *particle = transfer.shared()[*particle as usize];
            }
        }
        particles
    }

    /// Relaxes a state of a level whose positions and velocities were copied from a finer level: removes the
    /// strain that leaving out the other particles brings.
    pub fn relax(&self, snapshot: ClothSnapshot, level: usize) -> ClothSnapshot {
        match self.between(0, level).last() {
            Some(transfer) if !snapshot.is_at_rest(self.fabric(level)) => transfer.relax(snapshot),
            _ => snapshot,
        }
    }

    /// Values at the particles of a level, interpolated linearly over its triangles at the particles of a
    /// finer level.
    pub fn interpolate(&self, mut values: Vec<Vec3>, from: usize, to: usize) -> Vec<Vec3> {
        for transfer in self.between(to, from).iter().rev() {
            values = transfer.spread(&values).collect();
        }
        values
    }

    /// Transfers unit vectors at the particles of one level to those of another: copied from shared
    /// particles, or interpolated and normalised.
    pub fn transfer_directions(&self, vectors: &[Vec3], from: usize, to: usize) -> Vec<Vec3> {
        let mut vectors = vectors.to_vec();
        for transfer in self.between(from, to) {
            vectors = transfer.pick(&vectors);
        }
        if to < from {
            vectors = self.interpolate(vectors, from, to);
            vectors.iter_mut().for_each(|vector| *vector = vector.normalize_or_zero());
        }
        vectors
    }

    /// The transfers between a level and a coarser one; empty if it is not coarser.
    fn between(&self, fine: usize, coarse: usize) -> &[LevelTransfer] {
        let end = coarse.min(self.transfers.len());
        &self.transfers[fine.min(end)..end]
    }
}
