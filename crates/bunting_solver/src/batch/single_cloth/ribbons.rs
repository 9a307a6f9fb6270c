//! Ribbons of a single cloth, in packs of neighbouring ribbons.
//!
//! Neighbouring ribbons share particles. Therefore the even lanes of all packs are solved first, and then the
//! odd ones; the factors of the other lanes are zero, which makes their moments zero.

use core::array;

use super::grid_shape::GridShape;
use super::lane_indices::{LaneIndices, NO_INDEX};
use crate::batch::layout::Order;
use crate::fabric::{Fabric, Ribbon};
use crate::simd::lane::Pack;

/// Packs of ribbons.
#[derive(Clone, Debug)]
pub(super) struct RibbonPacks {
    /// Order in which neighbouring ribbons are consecutive.
    pub order: Order,
    /// The `profile` of a pack is an index into `profiles`.
    pub ribbons: Vec<Ribbon>,
    /// For each pack, the fabric's profile in each lane.
    pub profiles: Vec<LaneIndices>,
}

impl RibbonPacks {
    pub fn new<P: Pack>(fabric: &Fabric, shape: GridShape) -> Self {
        let mut sorted: Vec<&Ribbon> = fabric.ribbons().iter().collect();
        sorted.sort_by_key(|ribbon| ribbon.pairs[0][0]);
        let Some(pairs) = sorted.first().map(|ribbon| &ribbon.pairs) else {
            return Self { order: Order::RowMajor, ribbons: Vec::new(), profiles: Vec::new() };
        };
        let [first, second] = pairs[0];
        let order = if second == first + 1 { Order::RowMajor } else { Order::ColumnMajor };
        let pairs = pairs.len();
        let (mut ribbons, mut profiles) = (Vec::new(), Vec::new());
        for parity in 0..2 {
            for (pack, side_by_side) in sorted.chunks(P::WIDTH).enumerate() {
                let of_lane = |lane: usize| {
                    let ribbon = side_by_side.get(lane).filter(|_| lane % 2 == parity);
                    ribbon.map_or(NO_INDEX, |ribbon| ribbon.profile)
                };
                let of_lanes: LaneIndices = array::from_fn(of_lane);
                if of_lanes.iter().all(|&index| index == NO_INDEX) {
                    continue;
                }
                let first = (pack * P::WIDTH) as isize;
                let at = |line: usize| shape.index(order, line, first);
                let pairs = (0..pairs).map(|line| [at(line), at(line) + 1]).collect();
                ribbons.push(Ribbon { pairs, profile: profiles.len() as u32 });
                profiles.push(of_lanes);
            }
        }
        Self { order, ribbons, profiles }
    }
}
