//! The boxes that particles may reach in a tick, eight beside one another, so that a collider's box is compared with
//! eight at once.

use glam::Vec3;
use parry3d::bounding_volume::Aabb;

use crate::simd::level::dispatch;

/// Number of boxes in a block.
const WIDTH: usize = 8;

/// The boxes of a cloth's particles, m.
#[derive(Debug, Default)]
pub(super) struct SweptBoxes {
    blocks: Vec<Block>,
    count: usize,
    around: Option<Aabb>,
}

/// Least and greatest coordinates of eight boxes, axis by axis, m. A box that is missing meets no other.
#[derive(Clone, Copy, Debug)]
struct Block {
    least: [[f32; WIDTH]; 3],
    greatest: [[f32; WIDTH]; 3],
}

impl Block {
    const EMPTY: Self =
        Self { least: [[f32::INFINITY; WIDTH]; 3], greatest: [[f32::NEG_INFINITY; WIDTH]; 3] };

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
    /// Removes all boxes.
    pub fn clear(&mut self) {
        self.blocks.clear();
        self.count = 0;
        self.around = None;
    }

    /// Adds the box of the next particle: all places within a distance along each axis, m.
    pub fn push(&mut self, at: Vec3, reach: f32) {
        let place = self.count % WIDTH;
        if place == 0 {
            self.blocks.push(Block::EMPTY);
        }
        self.count += 1;
        let (least, greatest) = (at - reach, at + reach);
        let Some(block) = self.blocks.last_mut() else { return };
        for axis in 0..3 {
            block.least[axis][place] = least[axis];
            block.greatest[axis][place] = greatest[axis];
        }
        let around = self.around.get_or_insert(Aabb::new(least, greatest));
        around.mins = around.mins.min(least);
        around.maxs = around.maxs.max(greatest);
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
    use super::*;

    #[test]
    fn boxes_that_touch_or_overlap_meet() {
        let mut boxes = SweptBoxes::default();
        assert!(boxes.around().is_none());
        (0..11).for_each(|at| boxes.push(Vec3::new(at as f32, 0.0, 0.0), 0.25));
        assert_eq!(boxes.around().map(|all| all.maxs.x), Some(10.25));
        boxes.push(Vec3::NAN, 0.25);
        let mut found = Vec::new();
        let other = Aabb::new(Vec3::new(2.25, -1.0, 0.0), Vec3::new(9.0, 1.0, 0.1));
        boxes.meeting(&other, &mut found);
        assert_eq!(found, [2, 3, 4, 5, 6, 7, 8, 9]);
        found.clear();
        boxes.meeting(&Aabb::new(Vec3::new(0.0, 0.3, 0.0), Vec3::splat(20.0)), &mut found);
        assert!(found.is_empty());
        let box_of_ten = Aabb::new(Vec3::new(9.75, -0.25, -0.25), Vec3::new(10.25, 0.25, 0.25));
        assert_eq!(boxes.get(10), box_of_ten);
    }
}
