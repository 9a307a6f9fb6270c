//! The farthest of many places, as of a mesh's pins from each of its particles.

use glam::Vec3;

/// Places whose distances are compared at once. Fewer: vectors of processors are not filled. More: of few places, most are compared
/// in vain.
const AT_ONCE: usize = 16;

/// Coordinates of places, m: x, then y, then z.
type Block = [[f32; AT_ONCE]; 3];

/// Some places.
pub(super) struct Places {
    /// The last block is filled up with the last place.
    blocks: Vec<Block>,
    count: usize,
}

impl Places {
    pub fn new(places: &[Vec3]) -> Self {
        let block = |places: &[Vec3]| {
            let at = |index: usize| places[index.min(places.len() - 1)].to_array();
            [0, 1, 2].map(|axis| core::array::from_fn(|index| at(index)[axis]))
        };
        Self { blocks: places.chunks(AT_ONCE).map(block).collect(), count: places.len() }
    }

    /// The index of the place that is farthest from another, of several the last. There is at least one place.
    pub fn farthest(&self, from: Vec3) -> usize {
        let (mut farthest, mut found) = (0, 0);
        for (index, block) in self.blocks.iter().enumerate() {
            let greatest = distances(block, from).into_iter().fold(0, i32::max);
            if greatest >= farthest {
                (farthest, found) = (greatest, index);
            }
        }
        let within = distances(&self.blocks[found], from);
        let last = within.iter().rposition(|distance| *distance == farthest).unwrap_or_default();
        (AT_ONCE * found + last).min(self.count - 1)
    }
}

/// Squares of distances as bits, which are ordered as the squares are. Greatest integers are found at once, greatest floats one by
/// one, as these may be no numbers.
fn distances([x, y, z]: &Block, from: Vec3) -> [i32; AT_ONCE] {
    core::array::from_fn(|index| {
        let away = Vec3::new(x[index], y[index], z[index]) - from;
        away.length_squared().to_bits().cast_signed()
    })
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::Places;

    #[test]
    fn of_places_as_far_away_the_last_is_found() {
        for count in 1..40 {
            let places: Vec<Vec3> = (0..count).map(|at| Vec3::X * (at % 7) as f32).collect();
            let found = Places::new(&places).farthest(Vec3::NEG_X);
            let farthest = places.iter().map(|at| at.x).fold(0.0, f32::max);
            let last = places.iter().rposition(|at| at.x == farthest);
            assert_eq!(Some(found), last);
        }
    }
}
