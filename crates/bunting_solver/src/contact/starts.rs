//! Where particles were at the start of a substep.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Position of a particle at the start of the substep, in the coordinates of the cloth's frame at its end, m. A pin has
    /// moved with the frame, and in it, since.
    pub(crate) fn start_of(&self, cloth: usize, particle: u32) -> Vec3 {
        if self.fabric_of(cloth).fabric.is_pinned(particle as usize) {
            let velocity = self.vector(&self.velocity, particle as usize, cloth);
            self.position_of(cloth, particle) - velocity * self.clock.step
        } else {
            self.vector(&self.scratch, particle as usize, cloth)
        }
    }

    /// Present position of a particle, m.
    pub(super) fn position_of(&self, cloth: usize, particle: u32) -> Vec3 {
        self.vector(self.positions.packs(), particle as usize, cloth)
    }
}
