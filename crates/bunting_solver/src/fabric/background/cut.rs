//! Grids that reach beyond the border of a mesh, or across its holes.
//!
//! Cells that the border cuts stand for the part of them that is cloth, and cells without cloth for nothing. Nodes outside the
//! mesh hang by the cells that they share with it; those that share none do not move.

use super::chart::Chart;
use super::interpolation::{Interpolation, Term};
use super::smooth::{PLANE, PlacesInCells, QUADRATIC, fit, sum_of_magnitudes};
use crate::fabric::grid::Grid;

/// Radius around a node outside the mesh within which a plane is fitted to the places there, in cells: the first that is
/// tried. Each further one is twice as large. Smaller: fits to few places.
const FIRST_RADIUS: f64 = 2.0;

/// The same for a quadratic on a curved mesh. Smaller: too few places.
const CURVED_RADIUS: f64 = 4.0;

/// Most places that a plane or a quadratic is fitted to. More: single weights are as small as rounding.
const MOST_TERMS: usize = 24;

/// Greatest sum of the magnitudes of the weights of a fit. Larger: a node moves by many times what the particles move by.
const GREATEST_SUM: f32 = 12.0;

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
