//! Grids that reach beyond the border of a mesh, or across its holes.
//!
//! Cells that the border cuts stand for the part of them that is cloth, and cells without cloth for nothing. Nodes outside the
//! mesh hang by the cells that they share with it; those that share none do not move.

use super::chart::Chart;
use super::coverage::Coverage;
use super::interpolation::{Interpolation, Term};
use super::smooth::{PLANE, PlacesInCells, QUADRATIC, fit, sum_of_magnitudes};
use crate::fabric::grid::Grid;
use crate::fabric::topology::Edge;

/// Radius around a node outside the mesh within which a plane is fitted to the places there, in cells: the first that is
/// tried. Each further one is twice as large. Smaller: fits to few places.
const FIRST_RADIUS: f64 = 2.0;

/// The same for a quadratic on a curved mesh. Smaller: too few places.
const CURVED_RADIUS: f64 = 4.0;

/// Most places that a plane or a quadratic is fitted to. More: single weights are as small as rounding.
const MOST_TERMS: usize = 24;

/// Greatest sum of the magnitudes of the weights of a fit. Larger: a node moves by many times what the particles move by.
const GREATEST_SUM: f32 = 12.0;

/// Least part of the grid's cells with cloth. Smaller: most nodes cost time for nothing.
const LEAST_FILLED: f32 = 0.45;

/// How much farther than the cells around a node the ways between the triangles in these may run, in cells. Smaller: ragged borders
/// count as slits. Larger: short slits are closed.
const FARTHER: u32 = 1;

/// Whether a mesh can have a grid that it does not fill: what of it lies in the cells around a node hangs together in them and
/// in the next ones. The two sides of a slit would hang together by the nodes between them.
pub(super) fn is_whole(chart: &Chart, coverage: &Coverage, grid: &Grid, edges: &[Edge]) -> bool {
    // The two sides of a seam would not hang together.
    if chart.is_closed || chart.has_seam() {
        return false;
    }
    let with_cloth = coverage.has_cloth.iter().filter(|has_cloth| **has_cloth).count();
    if (with_cloth as f32) < LEAST_FILLED * coverage.parts.len() as f32 {
        return false;
    }
    let neighbours = neighbours(chart.triangles.len(), edges);
    let is_at_border = |triangle: &u32| neighbours[*triangle as usize].len() < 3;
    let has_border: Vec<bool> =
        coverage.triangles.iter().map(|triangles| triangles.iter().any(is_at_border)).collect();
    let cells_within = |(column, row): (u32, u32), reach: u32| {
        let around = |at: u32, count: u32| at.saturating_sub(reach)..(at + reach).min(count - 1);
        let columns = around(column, grid.columns);
        around(row, grid.rows).flat_map(move |row| {
            columns.clone().map(move |column| (row * (grid.columns - 1) + column) as usize)
        })
    };
    let triangles_within = |place: (u32, u32), reach: u32| {
        let cells = cells_within(place, reach);
        let mut triangles: Vec<u32> =
            cells.flat_map(|cell| &coverage.triangles[cell]).copied().collect();
        triangles.sort_unstable();
        triangles.dedup();
        triangles
    };
    let mut is_near = vec![false; neighbours.len()];
    let mut places = (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |at| (at, row)));
    places.all(|place| {
        if !cells_within(place, 1 + FARTHER).any(|cell| has_border[cell]) {
            return true;
        }
        let around = triangles_within(place, 1);
        let Some(&first) = around.first() else { return true };
        let near = triangles_within(place, 1 + FARTHER);
        near.iter().for_each(|&triangle| is_near[triangle as usize] = true);
        let mut next = vec![first];
        while let Some(triangle) = next.pop() {
            if core::mem::replace(&mut is_near[triangle as usize], false) {
                next.extend(&neighbours[triangle as usize]);
            }
        }
        let is_whole = !around.iter().any(|&triangle| is_near[triangle as usize]);
        near.iter().for_each(|&triangle| is_near[triangle as usize] = false);
        is_whole
    })
}

/// The triangles beside each triangle.
fn neighbours(triangles: usize, edges: &[Edge]) -> Vec<Vec<u32>> {
    let mut neighbours = vec![Vec::new(); triangles];
    for edge in edges {
        if let Some(other) = edge.other_side {
            let [one, other] = [edge.side.triangle, other.triangle];
            neighbours[one as usize].push(other);
            neighbours[other as usize].push(one);
        }
    }
    neighbours
}

/// The rows, and where they are empty those of fits to the free places nearby, as pins have no velocity of their own: of a plane,
/// and on curved meshes of a quadratic, as nodes on tangents would lie off the surface. Where free places determine no fit, pins
/// count as well. Nodes without cloth are read from any place. None if a node of a curved mesh has no fit.
pub(super) fn extrapolated(
    rows: Interpolation,
    chart: &Chart,
    is_free: &[bool],
    has_cloth: &[bool],
    grid: &Grid,
) -> Option<Interpolation> {
    let any = || vec![Term { from: 0, weight: 1.0 }];
    let places = PlacesInCells::new(&chart.positions, grid);
    let farthest = f64::from(grid.columns + grid.rows);
    let mut all = Interpolation::default();
    for (node, row) in rows.rows().enumerate() {
        if !row.is_empty() {
            all.push(row.iter().copied());
            continue;
        }
        if !has_cloth[node] {
            all.push(any());
            continue;
        }
        let radii = core::iter::successors(Some(FIRST_RADIUS), |radius| Some(2.0 * radius));
        let radii = radii.take_while(|radius| *radius < 2.0 * farthest);
        let near = |radius: f64, counts: &dyn Fn(u32) -> bool| {
            let mut near = places.around(node as u32, radius);
            near.retain(|(place, _)| counts(*place));
            let distance = near.len().div_ceil(MOST_TERMS).max(1);
            near.into_iter().step_by(distance).collect::<Vec<_>>()
        };
        let is_small = |terms: &Vec<Term>| sum_of_magnitudes(terms) < GREATEST_SUM;
        let free = |place: u32| is_free[place as usize];
        let quadratic = || fit::<QUADRATIC>(&near(CURVED_RADIUS, &free)).filter(is_small);
        let plane = |counts: &dyn Fn(u32) -> bool| {
            let fit = |radius| fit::<PLANE>(&near(radius, counts)).filter(is_small);
            radii.clone().find_map(fit)
        };
        let is_curved = chart.plane.is_none();
        let found = is_curved.then(quadratic).flatten();
        match found.or_else(|| plane(&free)).or_else(|| plane(&|_| true)) {
            Some(terms) => all.push(terms),
            None if is_curved => return None,
            None => all.push(any()),
        }
    }
    Some(all)
}
