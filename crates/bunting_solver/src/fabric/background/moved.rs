//! Grids some of whose nodes are moved: the nearest node to a pin that lies between nodes is moved to it.

use std::collections::BTreeMap;

use glam::Vec2;

use super::chart::Chart;
use super::interpolation::{Interpolation, Term};
use crate::fabric::grid::Grid;

/// The place of the pin that each moved node is moved to, of several the nearest.
pub(super) fn to_pins(chart: &Chart, grid: &Grid, is_free: &[bool]) -> BTreeMap<u32, u32> {
    let spacing = Vec2::from(grid.spacing());
    let last = Vec2::new((grid.columns - 1) as f32, (grid.rows - 1) as f32);
    let mut nearest: BTreeMap<u32, (f32, u32)> = BTreeMap::new();
    let places = (0..).zip(&chart.positions).zip(is_free).take(chart.own_places);
    for ((place, &at), _) in places.filter(|(_, is_free)| !**is_free) {
        let node = (at / spacing).round().clamp(Vec2::ZERO, last);
        let distance = node.distance(at / spacing);
        let found = nearest.entry(grid.index(node.x as u32, node.y as u32));
        let best = found.or_insert((distance, place));
        if distance < best.0 {
            *best = (distance, place);
        }
    }
    nearest.into_iter().map(|(node, (_, place))| (node, place)).collect()
}

/// The rows, where each moved node is read from the place of its pin alone.
pub(super) fn rows(rows: Interpolation, places: &BTreeMap<u32, u32>) -> Interpolation {
    let mut all = Interpolation::default();
    for (node, row) in (0..).zip(rows.rows()) {
        match places.get(&node) {
            Some(&from) => all.push([Term { from, weight: 1.0 }]),
            None => all.push(row.iter().copied()),
        }
    }
    all
}

/// Makes each part of an evenly spaced cell a part of the cell between the nodes at their places, with the same area of cloth
/// but no more than the cell's.
pub(super) fn rescale(parts: &mut [f32], grid: &Grid, places: &[Vec2]) {
    let [dx, dy] = grid.spacing();
    for ((corners, _), part) in grid.cells().zip(parts) {
        let [a, b, c, d] = corners.map(|at| places[at as usize]);
        let size = 0.5 * (d - a).perp_dot(c - b) / (dx * dy);
        if *part > size {
            *part = 1.0;
        } else {
            *part /= size;
        }
    }
}
