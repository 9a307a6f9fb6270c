//! Where particles were at the start of a substep.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Position of a particle at the start of the substep, in the coordinates of the cloth's frame at its end, m. A pin has
    /// moved with the frame, and in it, since.
    pub(super) fn start_of(&self, cloth: usize, particle: u32) -> Vec3 {
        let (pack, lane) = self.layout.locate(particle as usize, cloth);
        if self.fabric_of(cloth).fabric.is_pinned(particle as usize) {
            let way = lane3(&self.velocity[pack], lane) * self.clock.step;
            self.position(cloth, particle) - way
        } else {
            lane3(&self.scratch[pack], lane)
        }
    }

    /// Present position of a particle, m.
    pub(super) fn position(&self, cloth: usize, particle: u32) -> Vec3 {
        let (pack, lane) = self.layout.locate(particle as usize, cloth);
        lane3(&self.positions.packs()[pack], lane)
    }
}
