//! Grids some of whose nodes are moved: the nearest node to a pin that lies between nodes is moved to it.

use std::collections::BTreeMap;

use glam::{IVec2, Mat2, Vec2};

use super::chart::{Chart, node_positions};
use super::interpolation::{Interpolation, Term};
use crate::fabric::grid::Grid;

/// Steps of Newton's method. Fewer: places in cells that are no parallelograms are off.
const NEWTON_STEPS: usize = 6;

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

/// Weights of the nodes at each place of a free particle: bilinear in the cell between nodes at their places.
pub(super) fn particles_from_nodes(
    positions: &[Vec2],
    is_free: &[bool],
    grid: &Grid,
    places: &[Vec2],
) -> Interpolation {
    let spacing = Vec2::from(grid.spacing());
    let last = IVec2::new(grid.columns as i32 - 2, grid.rows as i32 - 2);
    let mut weights = Interpolation::default();
    for (&position, &is_free) in positions.iter().zip(is_free) {
        if !is_free {
            weights.push([]);
            continue;
        }
        let straight = (position / spacing).floor().as_ivec2().clamp(IVec2::ZERO, last);
        let around = (-1..=1).flat_map(|down| (-1..=1).map(move |right| IVec2::new(right, down)));
        let cells = around.map(|by| (straight + by).clamp(IVec2::ZERO, last));
        let of_cell = |cell: IVec2| {
            let corner = |right, down| grid.index(cell.x as u32 + right, cell.y as u32 + down);
            let corners = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
            let at = within(position, corners.map(|node| places[node as usize]));
            (corners, at)
        };
        // How far outside of the cell.
        let outside = |at: Vec2| (at - at.clamp(Vec2::ZERO, Vec2::ONE)).length();
        let nearest = cells.map(of_cell).min_by(|a, b| outside(a.1).total_cmp(&outside(b.1)));
        let (corners, Vec2 { x, y }) = nearest.expect("nine cells");
        let shares = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
        weights.push(corners.into_iter().zip(shares).map(|(from, weight)| Term { from, weight }));
    }
    weights
}

/// Coordinates of a place between the corners of a cell: the two in its first row, then those below, by Newton's method.
fn within(place: Vec2, [a, b, c, d]: [Vec2; 4]) -> Vec2 {
    let mut at = Vec2::splat(0.5);
    for _ in 0..NEWTON_STEPS {
        let off = a.lerp(b, at.x).lerp(c.lerp(d, at.x), at.y) - place;
        let by_x = (b - a).lerp(d - c, at.y);
        let by_y = (c - a).lerp(d - b, at.x);
        let step = Mat2::from_cols(by_x, by_y).inverse() * off;
        if !step.is_finite() {
            return Vec2::INFINITY;
        }
        at -= step;
    }
    at
}
