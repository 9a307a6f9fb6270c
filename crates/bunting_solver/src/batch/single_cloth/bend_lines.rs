//! Bend lines of a single cloth, in packs of neighbouring lines.

use core::array;

use super::grid_shape::GridShape;
use super::lane_indices::{LaneIndices, NO_INDEX};
use crate::batch::layout::Order;
use crate::fabric::{BendLine, Fabric};
use crate::simd::lane::Pack;

/// Packs of lines of either direction.
#[derive(Clone, Debug)]
pub(super) struct BendLinePacks {
    /// The rows, one in each lane, then the columns. The `profile` of a pack is an index into `profiles`.
    pub lines: [(Order, Vec<BendLine>); 2],
    /// For each pack, the fabric's profile in each lane.
    pub profiles: Vec<LaneIndices>,
}

impl BendLinePacks {
    pub fn new<P: Pack>(fabric: &Fabric, shape: GridShape) -> Self {
        let mut profiles = Vec::new();
        // Neighbouring rows are consecutive in column-major order.
        let lines = [Order::ColumnMajor, Order::RowMajor].map(|order| {
            let parallel: Vec<&BendLine> = fabric
                .bend_lines()
                .iter()
                .filter(|line| line.is_row == (order == Order::ColumnMajor))
                .collect();
            let packs = parallel.chunks(P::WIDTH).enumerate().map(|(pack, lines)| {
                let profile =
                    |lane| lines.get(lane).map_or(NO_INDEX, |line: &&BendLine| line.profile);
                profiles.push(array::from_fn(profile));
                let first = (pack * P::WIDTH) as isize;
                BendLine {
                    is_row: lines[0].is_row,
                    particles: (0..lines[0].particles.len())
                        .map(|line| shape.index(order, line, first))
                        .collect(),
                    profile: profiles.len() as u32 - 1,
                }
            });
            (order, packs.collect())
        });
        Self { lines, profiles }
    }
}
