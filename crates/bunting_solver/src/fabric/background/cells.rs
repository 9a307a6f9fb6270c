//! The cell of a grid that a place lies in, and its weights there.

use glam::{IVec2, Mat2, Vec2};

use super::interpolation::{Interpolation, Term};
use super::laid_nodes::LaidNodes;
use crate::fabric::grid::Grid;

/// Steps of Newton's method. Fewer: places in cells that are no parallelograms are off.
const NEWTON_STEPS: usize = 6;

/// How far a place may lie outside of a cell in which it counts, in cells. Smaller: rounding puts places on a line of nodes beside
/// the cloth.
const ON_LINE: f32 = 1e-3;

/// A place within a cell.
pub(super) struct InCell {
    /// The corners of the cell, row by row.
    pub corners: [u32; 4],
    /// The place between them: zero at the first, one at the last.
    at: Vec2,
}

impl InCell {
    /// The cell of a place, m. It has cloth around all of its corners if one at the place has.
    pub fn of(place: Vec2, grid: &Grid, laid: &LaidNodes) -> Self {
        let at = place / Vec2::from(grid.spacing());
        let cell = at.floor().as_ivec2().clamp(IVec2::ZERO, last_cell(grid));
        let straight = |cell: IVec2| Self { corners: corners(cell, grid), at: at - cell.as_vec2() };
        let has_cloth = |it: &Self| laid.have_cloth(&it.corners);
        let first = straight(cell);
        if !laid.are_moved && has_cloth(&first) {
            return first;
        }
        let cells = cells_around(cell, grid);
        if !laid.are_moved {
            let mut touching = cells.map(straight).filter(|it| it.outside() < ON_LINE);
            return touching.find(has_cloth).unwrap_or(first);
        }
        let between = |cell: IVec2| {
            let corners = corners(cell, grid);
            let at = coordinates(place, corners.map(|node| laid.places[node as usize]))?;
            Some(Self { corners, at })
        };
        // Most places lie well within the first cell, and so in no other.
        if let Some(within) = between(cell).filter(|it| it.inside() > ON_LINE && has_cloth(it)) {
            return within;
        }
        let found: Vec<Self> = cells.filter_map(between).collect();
        let nearest = |it: &Self| it.outside() + if has_cloth(it) { 0.0 } else { ON_LINE };
        let nearest = found.into_iter().min_by(|a, b| nearest(a).total_cmp(&nearest(b)));
        nearest.unwrap_or(first)
    }

    /// The corners of the cell, or of the nearest one with cloth around all of its corners; none if there is none near.
    pub fn corners_with_cloth(&self, grid: &Grid, laid: &LaidNodes) -> Option<[u32; 4]> {
        if laid.have_cloth(&self.corners) {
            return Some(self.corners);
        }
        let [first, ..] = self.corners;
        let cell = IVec2::new((first % grid.columns) as i32, (first / grid.columns) as i32);
        let distance = |other: &IVec2| (self.at - 0.5).distance((*other - cell).as_vec2());
        let with_cloth = cells_around(cell, grid).filter(|it| laid.have_cloth(&corners(*it, grid)));
        let nearest = with_cloth.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some(corners(nearest, grid))
    }

    /// How far the place lies outside, in cells.
    fn outside(&self) -> f32 {
        self.at.distance(self.at.clamp(Vec2::ZERO, Vec2::ONE))
    }

    /// How far the place lies inside, in cells; below zero outside.
    fn inside(&self) -> f32 {
        self.at.min(1.0 - self.at).min_element()
    }

    /// The weights of the corners: bilinear.
    fn terms(&self) -> impl Iterator<Item = Term> {
        let Vec2 { x, y } = self.at;
        let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
        self.corners.into_iter().zip(weights).map(|(from, weight)| Term { from, weight })
    }
}

/// Weights of the nodes at each place of a free particle.
pub(super) fn particles_from_nodes(
    positions: &[Vec2],
    is_free: &[bool],
    grid: &Grid,
    laid: &LaidNodes,
) -> Interpolation {
    let mut weights = Interpolation::default();
    for (&place, &is_free) in positions.iter().zip(is_free) {
        if is_free {
            weights.push(InCell::of(place, grid, laid).terms());
        } else {
            weights.push([]);
        }
    }
    weights
}

/// The last column and row of cells.
fn last_cell(grid: &Grid) -> IVec2 {
    IVec2::new(grid.columns as i32 - 2, grid.rows as i32 - 2)
}

/// The cell and those around it; at the border some more than once.
fn cells_around(cell: IVec2, grid: &Grid) -> impl Iterator<Item = IVec2> {
    let last = last_cell(grid);
    let around = (-1..=1).flat_map(|down| (-1..=1).map(move |right| IVec2::new(right, down)));
    around.map(move |by| (cell + by).clamp(IVec2::ZERO, last))
}

/// The corners of a cell, row by row.
fn corners(cell: IVec2, grid: &Grid) -> [u32; 4] {
    let corner = |right, down| grid.index(cell.x as u32 + right, cell.y as u32 + down);
    [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)]
}

/// Coordinates of a place between the corners of a cell, row by row, by Newton's method; none if it fails, as it may for places far
/// outside.
fn coordinates(place: Vec2, [a, b, c, d]: [Vec2; 4]) -> Option<Vec2> {
    let mut at = Vec2::splat(0.5);
    let mut step = Vec2::ZERO;
    for _ in 0..NEWTON_STEPS {
        let off = a.lerp(b, at.x).lerp(c.lerp(d, at.x), at.y) - place;
        let by_x = (b - a).lerp(d - c, at.y);
        let by_y = (c - a).lerp(d - b, at.x);
        step = Mat2::from_cols(by_x, by_y).inverse() * off;
        at -= step;
    }
    (step.abs().max_element() < ON_LINE).then_some(at)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::coordinates;

    /// Corners of a cell of which one is moved.
    const CELL: [Vec2; 4] =
        [Vec2::ZERO, Vec2::new(0.999, 0.051), Vec2::new(0.419, 0.595), Vec2::new(1.05, 1.05)];

    #[test]
    fn a_place_within_a_cell_has_its_coordinates() {
        let [a, b, c, d] = CELL;
        let at = Vec2::new(0.3, 0.8);
        let found = coordinates(a.lerp(b, at.x).lerp(c.lerp(d, at.x), at.y), CELL);
        assert!(found.is_some_and(|found| found.distance(at) < 1e-5), "{found:?}");
    }

    #[test]
    fn a_place_beside_a_cell_does_not_count_as_within() {
        let found = coordinates(Vec2::new(-0.2554, 1.1809), CELL);
        let is_within = |at: Vec2| at.cmpge(Vec2::ZERO).all() && at.cmple(Vec2::ONE).all();
        assert!(!found.is_some_and(is_within), "{found:?}");
    }
}
