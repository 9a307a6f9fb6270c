//! Grids some of whose nodes are moved: the nearest node to a pin that lies between nodes is moved to it.

use std::collections::BTreeMap;

use glam::Vec2;

use super::chart::{Chart, node_positions};
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
    let mut pins: BTreeMap<u32, u32> =
        nearest.iter().map(|(&node, &(_, place))| (node, place)).collect();
    if chart.is_closed {
        for ends in grid.ends_of_columns() {
            pins.retain(|node, _| !ends.contains(node));
            let found = ends.map(|node| nearest.get(&node).copied());
            if let Some(places) = at_both_ends(chart, grid, found) {
                pins.extend(ends.into_iter().zip(places));
            }
        }
    }
    pins
}

/// The places in the first and in the last row of a closed chart of the nearer of two pins, given their distances and places.
fn at_both_ends(
    chart: &Chart,
    grid: &Grid,
    [first, last]: [Option<(f32, u32)>; 2],
) -> Option<[u32; 2]> {
    let is_first = first.is_some_and(|(near, _)| last.is_none_or(|(other, _)| near <= other));
    let (_, place) = if is_first { first? } else { last? };
    let turn = if is_first { chart.extent.y } else { -chart.extent.y };
    let opposite = chart.positions[place as usize] + Vec2::Y * turn;
    let close = 0.01 * grid.spacing()[1];
    let mut places = (0..).zip(&chart.positions).zip(&chart.particles);
    let is_opposite = |at: &Vec2, particle: u32| {
        particle == chart.particles[place as usize] && at.distance(opposite) < close
    };
    let (other, _) = places.find(|((_, at), particle)| is_opposite(at, **particle))?.0;
    Some(if is_first { [place, other] } else { [other, place] })
}

/// The places of all nodes, those of moved ones given by their pins.
pub(super) fn places(chart: &Chart, grid: &Grid, pins: &BTreeMap<u32, u32>) -> Vec<Vec2> {
    let mut places = node_positions(grid);
    pins.iter().for_each(|(&node, &pin)| places[node as usize] = chart.positions[pin as usize]);
    places
}

/// The rows, where each moved node is read from the place of its pin alone.
pub(super) fn rows(rows: Interpolation, pins: &BTreeMap<u32, u32>) -> Interpolation {
    let mut all = Interpolation::default();
    for (node, row) in (0..).zip(rows.rows()) {
        match pins.get(&node) {
            Some(&from) => all.push([Term { from, weight: 1.0 }]),
            None => all.push(row.iter().copied()),
        }
    }
    all
}
