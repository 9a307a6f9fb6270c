//! What a group of cloths reads from batches of any width and layout, and writes into them.

use glam::Vec3;

use crate::batch::cloth_batch::{ClothBatch, Lanes, with_batch};
use crate::contact::cloths::lane::LaneShape;
use crate::contact::cloths::member::Member;
use crate::contact::itself::particles::Particles;

impl ClothBatch {
    pub(crate) fn lane_shape(&mut self, lane: usize) -> LaneShape {
        with_batch!(&mut self.0, batch => batch.lane_shape(lane))
    }

    pub(crate) fn begin_grouped(
        &mut self,
        lane: usize,
        member: &mut Member,
        origin: Vec3,
        start: &mut [Vec3],
    ) {
        with_batch!(&mut self.0, batch => batch.begin_grouped(lane, member, origin, start));
    }

    pub(crate) fn read_grouped(
        &mut self,
        lane: usize,
        member: &mut Member,
        origin: Vec3,
        particles: &mut Particles,
    ) -> [f32; 2] {
        with_batch!(&mut self.0, batch => batch.read_grouped(lane, member, origin, particles))
    }

    pub(crate) fn read_velocities(
        &mut self,
        lane: usize,
        member: &Member,
        particles: &mut Particles,
    ) {
        with_batch!(&mut self.0, batch => batch.read_velocities(lane, member, particles));
    }

    pub(crate) fn write_grouped(&mut self, lane: usize, member: &Member, particles: &Particles) {
        with_batch!(&mut self.0, batch => batch.write_grouped(lane, member, particles));
    }

    pub(crate) fn touch_colliders(
        &mut self,
        lane: usize,
        member: &Member,
        particles: &mut Particles,
    ) -> bool {
        with_batch!(&mut self.0, batch => batch.touch_colliders_grouped(lane, member, particles))
    }

    pub(crate) fn end_grouped(&mut self, lane: usize, pressed: impl Iterator<Item = usize>) {
        with_batch!(&mut self.0, batch => batch.end_grouped(lane, pressed));
    }
}
