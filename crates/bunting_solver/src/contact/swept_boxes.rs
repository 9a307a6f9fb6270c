//! The boxes that particles may reach in a tick, eight beside one another, so that a collider's box is compared with
//! eight at once.

use glam::{Mat3, Vec3};
use parry3d::bounding_volume::Aabb;

use crate::simd::level::dispatch;
use crate::step::frame::FrameMotion;

/// Number of boxes in a block.
const WIDTH: usize = 8;

/// The boxes of a cloth's particles, m.
#[derive(Debug, Default)]
pub(super) struct SweptBoxes {
    blocks: Vec<Block>,
    around: Option<Aabb>,
}

/// What the particles of a cloth have in common in a tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    /// Motion of the cloth's frame.
    pub motion: FrameMotion,
    /// Length of the tick, s.
    pub tick: f32,
    /// Distance that each particle may reach besides its way, m.
    pub common: f32,
    /// Least length of the way of each particle, m: what drags the cloth moves those that rest, too.
    pub dragged: f32,
}

/// Least and greatest coordinates of eight boxes, axis by axis, m. A box that is missing has no numbers and meets no other, not even
/// one without end.
#[derive(Clone, Copy, Debug)]
struct Block {
    least: [[f32; WIDTH]; 3],
    greatest: [[f32; WIDTH]; 3],
}

impl Block {
    const EMPTY: Self = Self { least: [[f32::NAN; WIDTH]; 3], greatest: [[f32::NAN; WIDTH]; 3] };

    /// Overwrites the boxes by those of up to eight particles: all places as far from each, along any axis, as its way in the
    /// moving frame is long. Velocities are relative to the world.
    #[inline(always)]
    fn set(&mut self, positions: &[Vec3], velocities: &[Vec3], sweep: &Sweep) {
        let [x, y, z] = Mat3::from_quat(sweep.motion.rotation.inverse()).to_cols_array_2d();
        let translation = sweep.motion.translation.to_array();
        let (mut at, mut shifted) = ([[0.0; WIDTH]; 3], [[0.0; WIDTH]; 3]);
        for (place, (position, velocity)) in positions.iter().zip(velocities).enumerate() {
            let in_world = *position + *velocity * sweep.tick;
            for axis in 0..3 {
                at[axis][place] = position[axis];
                shifted[axis][place] = in_world[axis] - translation[axis];
            }
        }
        let mut squared = [0.0; WIDTH];
        for (axis, at) in at.iter().enumerate() {
            for (place, squared) in squared.iter_mut().enumerate() {
                let [sx, sy, sz] = [shifted[0][place], shifted[1][place], shifted[2][place]];
                let moved = x[axis] * sx + y[axis] * sy + z[axis] * sz - at[place];
                *squared += moved * moved;
            }
        }
        for (axis, at) in at.iter().enumerate() {
            for place in 0..positions.len().min(WIDTH) {
                let reach = sweep.common + squared[place].sqrt().max(sweep.dragged);
                self.least[axis][place] = at[place] - reach;
                self.greatest[axis][place] = at[place] + reach;
            }
        }
    }

    /// Grows each box so that it contains that of another block.
    fn merge(&mut self, other: &Self) {
        for axis in 0..3 {
            for place in 0..WIDTH {
                let (least, greatest) = (other.least[axis][place], other.greatest[axis][place]);
                self.least[axis][place] = self.least[axis][place].min(least);
                self.greatest[axis][place] = self.greatest[axis][place].max(greatest);
            }
        }
    }

    /// The box around all eight boxes.
    fn around(&self) -> Aabb {
        let least = self.least.map(|axis| axis.into_iter().fold(f32::INFINITY, f32::min));
        let greatest = self.greatest.map(|axis| axis.into_iter().fold(f32::NEG_INFINITY, f32::max));
        Aabb::new(least.into(), greatest.into())
    }

    /// One for each box that meets another box, and zero for all others.
    #[inline(always)]
    fn meets(&self, least: [f32; 3], greatest: [f32; 3]) -> [u32; WIDTH] {
        let mut all = [1; WIDTH];
        for axis in 0..3 {
            let ends = self.least[axis].iter().zip(&self.greatest[axis]);
            for (meets, (from, to)) in all.iter_mut().zip(ends) {
                *meets &= u32::from(*from <= greatest[axis]) & u32::from(*to >= least[axis]);
            }
        }
        all
    }
}

impl SweptBoxes {
    /// Overwrites all boxes by those of particles with the given positions (m) and velocities (m/s).
    pub fn set(&mut self, positions: &[Vec3], velocities: &[Vec3], sweep: &Sweep) {
        self.blocks.clear();
        self.blocks.resize(positions.len().div_ceil(WIDTH), Block::EMPTY);
        let moves = positions.chunks(WIDTH).zip(velocities.chunks(WIDTH));
        dispatch!(_ => {
            for (block, (positions, velocities)) in self.blocks.iter_mut().zip(moves) {
                block.set(positions, velocities, sweep);
            }
        });
        let mut all = Block::EMPTY;
        self.blocks.iter().for_each(|block| all.merge(block));
        self.around = (!positions.is_empty()).then(|| all.around());
    }

    /// The box around all boxes; none if there is none.
    pub fn around(&self) -> Option<Aabb> {
        self.around
    }

    /// The box of a particle.
    pub fn get(&self, particle: usize) -> Aabb {
        let (block, at) = (&self.blocks[particle / WIDTH], particle % WIDTH);
        let corner = |axes: &[[f32; WIDTH]; 3]| Vec3::from_array(axes.map(|axis| axis[at]));
        Aabb::new(corner(&block.least), corner(&block.greatest))
    }

    /// Adds the particles whose boxes meet a box to `found`.
    pub fn meeting(&self, other: &Aabb, found: &mut Vec<u32>) {
        let (least, greatest) = (other.mins.to_array(), other.maxs.to_array());
        dispatch!(_ => {
            for (index, block) in self.blocks.iter().enumerate() {
                let meets = block.meets(least, greatest);
                if meets == [0; WIDTH] {
                    continue;
                }
                let first = (index * WIDTH) as u32;
                for (particle, meets) in (first..).zip(meets) {
                    if meets != 0 {
                        found.push(particle);
                    }
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::FRAC_PI_2;

    use glam::Quat;

    use super::*;

    /// Boxes of particles at rest in a frame at rest, each as large as its thickness.
    fn resting(positions: &[Vec3]) -> SweptBoxes {
        let sweep = Sweep { motion: FrameMotion::NONE, tick: 0.1, common: 0.25, dragged: 0.0 };
        let mut boxes = SweptBoxes::default();
        boxes.set(positions, &vec![Vec3::ZERO; positions.len()], &sweep);
        boxes
    }

    #[test]
    fn boxes_that_touch_or_overlap_meet() {
        assert!(resting(&[]).around().is_none());
        let mut row: Vec<Vec3> = (0..11).map(|at| Vec3::new(at as f32, 0.0, 0.0)).collect();
        assert_eq!(resting(&row).around().map(|all| all.maxs.x), Some(10.25));
        row.push(Vec3::NAN);
        let boxes = resting(&row);
        let mut found = Vec::new();
        let other = Aabb::new(Vec3::new(2.25, -1.0, 0.0), Vec3::new(9.0, 1.0, 0.1));
        boxes.meeting(&other, &mut found);
        assert_eq!(found, [2, 3, 4, 5, 6, 7, 8, 9]);
        found.clear();
        boxes.meeting(&Aabb::new(Vec3::new(0.0, 0.3, 0.0), Vec3::splat(20.0)), &mut found);
        assert!(found.is_empty());
        let endless = Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY);
        boxes.meeting(&endless, &mut found);
        assert_eq!(found, (0..11).collect::<Vec<_>>(), "what is missing meets nothing");
        let box_of_ten = Aabb::new(Vec3::new(9.75, -0.25, -0.25), Vec3::new(10.25, 0.25, 0.25));
        assert_eq!(boxes.get(10), box_of_ten);
    }

    #[test]
    fn boxes_reach_as_far_as_particles_move_in_their_frame() {
        // The frame turns by 90° about z and moves on by 1 m; a particle that rests in the world, and one that goes along.
        let rotation = Quat::from_rotation_z(FRAC_PI_2);
        let motion = FrameMotion { rotation, translation: Vec3::X };
        let positions = [Vec3::new(2.0, 0.0, 0.0); 2];
        let goes_along = Vec3::X + rotation * positions[1] - positions[1];
        let tick = 0.5;
        let mut boxes = SweptBoxes::default();
        boxes.set(
            &positions,
            &[Vec3::ZERO, goes_along / tick],
            &Sweep { motion, tick, common: 0.1, dragged: 0.0 },
        );
        // The first one is at (0, −1) in the new frame.
        let reaches = [0, 1].map(|particle| boxes.get(particle).maxs.z);
        let expected = [5.0_f32.sqrt() + 0.1, 0.1];
        for (reach, expected) in reaches.iter().zip(expected) {
            assert!((reach - expected).abs() < 1e-6, "{reaches:?}");
        }
    }
}
