//! Which batches hold the cloths of a group.

use std::sync::Arc;

use bunting_solver::{Fabric, LaneCount, Scheme};

use crate::batch::group::FabricCount;

/// A kind of batch of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BatchKind {
    /// Index in the group of the fabric of all its cloths; none for cloths of different fabrics.
    pub fabric: Option<usize>,
    /// Its lanes.
    pub width: LaneCount,
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
        width.unwrap_or_else(|| LaneCount::first_of(cloths, &fabrics[0].fabric, scheme))
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
        let width = first_of(rest);
        match (only, width) {
            (None, LaneCount::One) => lone += 1,
            _ => wanted.push(BatchKind { fabric: only, width }),
        }
        rest = rest.saturating_sub(width.get());
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
