//! What lies within reach of a place.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

/// Lists of indices of places for boxes of twice their reach, so that each place is in eight of them at most.
pub(super) struct Boxes {
    reach: f64,
    of: HashMap<IVec3, Vec<u32>>,
}

impl Boxes {
    /// None yet, for a reach in m.
    pub fn new(reach: f64) -> Self {
        Self { reach, of: HashMap::new() }
    }

    /// Adds a place to all boxes within its reach.
    pub fn add(&mut self, at: DVec3, index: u32) {
        let [least, most] = [at - self.reach, at + self.reach].map(|at| self.index(at));
        for x in least.x..=most.x {
            for y in least.y..=most.y {
                for z in least.z..=most.z {
                    self.of.entry(IVec3::new(x, y, z)).or_default().push(index);
                }
            }
        }
    }

    /// The indices of all places within reach, and of some others, in the order in which they were added.
    pub fn near(&self, at: DVec3) -> &[u32] {
        self.of.get(&self.index(at)).map_or(&[], |list| &list[..])
    }

    fn index(&self, at: DVec3) -> IVec3 {
        (at / (2.0 * self.reach)).floor().as_ivec3()
    }
}
