//! Meshes that are no grids, by default settings: closed forms where there are some; elsewhere bounds, and the grid of
//! as many particles, as this group asks whether a mesh is as good as a grid.

mod cloth;
mod curved;
mod flags;
mod graded;
mod limits;
mod materials;
mod rest;
mod square;
mod swing;

use self::square::TRIANGULATIONS;
use crate::{oracles::Case, specimen::Mount};

/// Everything that a mesh should do as a grid does.
pub fn cases(_: &Mount) -> Vec<Case> {
    let of_each = TRIANGULATIONS.into_iter().flat_map(rest::cases);
    let arcs = TRIANGULATIONS.into_iter().flat_map(curved::cases);
    of_each
        .chain(arcs)
        .chain(graded::cases())
        .chain(swing::cases())
        .chain([6.0, 25.0].into_iter().flat_map(flags::cases))
        .collect()
}
