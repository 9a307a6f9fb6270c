//! Which batches hold the cloths of a group.

use std::sync::Arc;

use bunting_solver::{Fabric, LaneCount, Scheme};

/// A fabric of a group, and the number of its cloths.
#[derive(Debug)]
pub(crate) struct FabricCount {
    pub fabric: Arc<Fabric>,
    /// Cloths in lanes, and cloths that wait for one.
    pub cloths: usize,
}

/// A kind of batch of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BatchKind {
    /// Index in the group of the fabric of all its cloths; none for cloths of different fabrics, in eight lanes.
    pub fabric: Option<usize>,
    /// Its lanes.
    pub width: LaneCount,
}

impl BatchKind {
    /// Cloths of different fabrics.
    pub const MIXED: Self = Self { fabric: None, width: LaneCount::Eight };
}

/// The batches that hold the cloths of each fabric, and in what is left the cloths of several fabrics.
///
/// Cloths that fill half of a batch or more lie in batches of their own fabric. What is left of each fabric is put
/// together in mixed batches, where it is of more than one fabric. `singles` are the fabrics of the present batches of
/// one lane, which are kept as far as such batches are wanted.
pub(crate) fn wanted_batches<'a>(
    fabrics: &[FabricCount],
    width: Option<LaneCount>,
    scheme: Scheme,
    singles: impl Iterator<Item = &'a Arc<Fabric>>,
) -> Vec<BatchKind> {
    let first_of = |cloths: usize| {
        let best = || LaneCount::first_of(cloths, &fabrics[0].fabric, scheme);
        width.map_or_else(best, |width| width.min(LaneCount::widest()))
    };
    let mut wanted = Vec::new();
    let mut left: Vec<usize> = fabrics.iter().map(|it| it.cloths).collect();
    for (index, left) in left.iter_mut().enumerate() {
        while *left > 0 {
            let width = first_of(*left);
            if width == LaneCount::One || 2 * *left < width.get() {
                break;
            }
            wanted.push(BatchKind { fabric: Some(index), width });
            *left = left.saturating_sub(width.get());
        }
    }
    let mut with_rest = left.iter().enumerate().filter(|(_, left)| **left > 0);
    let only = match (with_rest.next(), with_rest.next()) {
        (Some((fabric, _)), None) => Some(fabric),
        _ => None,
    };
    let mut rest: usize = left.iter().sum();
    let mut lone = 0;
    while rest > 0 {
        let kind = match (only, first_of(rest)) {
            (None, LaneCount::One) => {
                lone += 1;
                rest -= 1;
                continue;
            }
            (None, _) => BatchKind::MIXED,
            (Some(_), width) => BatchKind { fabric: only, width },
        };
        wanted.push(kind);
        rest = rest.saturating_sub(kind.width.get());
    }
    wanted.extend(lone_cloths(fabrics, left, lone, singles));
    wanted
}

/// Batches of one lane for some of the cloths that are left of several fabrics: for those that have one, and then for
/// the last.
fn lone_cloths<'a>(
    fabrics: &[FabricCount],
    mut left: Vec<usize>,
    count: usize,
    singles: impl Iterator<Item = &'a Arc<Fabric>>,
) -> Vec<BatchKind> {
    if count == 0 {
        return Vec::new();
    }
    let index_of =
        |fabric: &Arc<Fabric>| fabrics.iter().position(|it| Arc::ptr_eq(&it.fabric, fabric));
    let last = (0..fabrics.len()).rev().flat_map(|index| vec![index; left[index]]);
    let candidates: Vec<usize> = singles.filter_map(index_of).chain(last).collect();
    let mut lone = Vec::new();
    for fabric in candidates {
        if lone.len() < count && left[fabric] > 0 {
            left[fabric] -= 1;
            lone.push(BatchKind { fabric: Some(fabric), width: LaneCount::One });
        }
    }
    lone
}

#[cfg(test)]
mod tests {
    use bunting_solver::{ClothBatch, FabricBuilder, Grid, with_every_instruction_set};

    use super::*;

    /// The batches for so many cloths of each fabric: how many of one fabric and how many mixed ones of each width.
    fn batches(columns: u32, cloths: &[usize]) -> [[usize; 2]; 2] {
        let fabric = |index: usize| {
            let grid = Grid::new(columns, columns, 1.0 + 0.01 * index as f32, 1.0);
            Arc::new(FabricBuilder::grid(grid).build().expect("a good fabric"))
        };
        let counts = cloths.iter().enumerate();
        let counts = counts.map(|(index, &cloths)| FabricCount { fabric: fabric(index), cloths });
        let fabrics: Vec<FabricCount> = counts.collect();
        let wanted = wanted_batches(&fabrics, None, Scheme::Yarns, core::iter::empty());
        let lanes_of = |index: usize| {
            let of_fabric = wanted.iter().filter(move |kind| kind.fabric == Some(index));
            of_fabric.map(|kind| kind.width.get()).sum::<usize>()
        };
        let mixed = wanted.iter().filter(|kind| kind.fabric.is_none());
        let mixed: usize = mixed.map(|kind| kind.width.get()).sum();
        let over = cloths.iter().enumerate();
        let over: usize = over.map(|(index, &cloths)| cloths.saturating_sub(lanes_of(index))).sum();
        assert!(over <= mixed, "all cloths have a lane: {wanted:?}");
        [false, true].map(|is_mixed| {
            [1, 8].map(|least| {
                let of_kind = wanted.iter().filter(|kind| kind.fabric.is_none() == is_mixed);
                of_kind.filter(|kind| (kind.width.get() > 1) == (least > 1)).count()
            })
        })
    }

    #[test]
    fn sixteen_lanes_are_eight_on_machines_that_have_no_more() {
        let grid = FabricBuilder::grid(Grid::new(5, 5, 1.0, 1.0));
        let fabric = Arc::new(grid.build().expect("a good fabric"));
        let fabrics = [FabricCount { fabric, cloths: 16 }];
        let lanes = with_every_instruction_set(|| {
            let none = core::iter::empty();
            let wanted = wanted_batches(&fabrics, Some(LaneCount::Sixteen), Scheme::Yarns, none);
            let lanes_of = |kind: &BatchKind| {
                ClothBatch::new(fabrics[0].fabric.clone(), kind.width).lane_count()
            };
            wanted.iter().map(lanes_of).sum::<usize>()
        });
        assert!(lanes.iter().all(|&lanes| lanes == 16), "{lanes:?}");
    }

    #[test]
    fn cloths_of_one_fabric_stay_among_themselves() {
        assert_eq!(batches(5, &[1]), [[1, 0], [0, 0]]);
        assert_eq!(batches(5, &[3]), [[0, 1], [0, 0]]);
        assert_eq!(batches(33, &[3]), [[3, 0], [0, 0]]);
        assert_eq!(batches(5, &[8, 7]), [[0, 2], [0, 0]]);
    }

    #[test]
    fn what_is_left_of_several_fabrics_shares_batches() {
        assert_eq!(batches(5, &[1; 8]), [[0, 0], [0, 1]]);
        assert_eq!(batches(5, &[8, 1, 2, 1]), [[0, 1], [0, 1]]);
        // Cloths with long rows get a batch each as long as they are few.
        assert_eq!(batches(33, &[1; 3]), [[3, 0], [0, 0]]);
        assert_eq!(batches(33, &[1; 4]), [[0, 0], [0, 1]]);
        assert_eq!(batches(33, &[1; 10]), [[2, 0], [0, 1]]);
        assert_eq!(batches(5, &[1; 18]), [[0, 0], [0, 3]]);
    }
}
