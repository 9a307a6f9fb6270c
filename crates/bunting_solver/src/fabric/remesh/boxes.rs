//! What lies in each box of space.

use std::collections::BTreeMap;

use glam::{DVec3, IVec3};

/// Lists of indices for boxes of one size.
pub(super) struct Boxes {
    size: f64,
    of: BTreeMap<[i32; 3], Vec<u32>>,
}

impl Boxes {
    /// Boxes with sides of a length, m.
    pub fn new(size: f64) -> Self {
        Self { size, of: BTreeMap::new() }
    }

    /// Adds an index to all boxes between two corners.
    pub fn add(&mut self, corners: [DVec3; 2], index: u32) {
        let [least, most] = corners.map(|at| self.index(at));
        for x in least.x..=most.x {
            for y in least.y..=most.y {
                for z in least.z..=most.z {
                    self.of.entry([x, y, z]).or_default().push(index);
                }
            }
        }
    }

    /// The indices in the box at a place.
    pub fn at(&self, at: DVec3) -> &[u32] {
        self.of.get(&self.index(at).to_array()).map_or(&[], |list| &list[..])
    }

    fn index(&self, at: DVec3) -> IVec3 {
        (at / self.size).floor().as_ivec3()
    }
}
