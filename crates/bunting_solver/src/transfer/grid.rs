//! Interpolation between a grid and the grid of its every second column and row.

use super::interpolation::Interpolation;
use crate::fabric::Grid;

/// Smooth interpolation: the four-point scheme along columns and rows (Dyn, Levin and Gregory 1987). It reproduces
/// cubics, so that folds are not flattened.
pub(super) fn smooth(fine: &Grid, coarse: &Grid) -> Interpolation {
    let columns: Vec<_> = (0..fine.columns).map(|at| four_point(at, coarse.columns)).collect();
    let mut interpolation = Interpolation::default();
    for down in (0..fine.rows).map(|at| four_point(at, coarse.rows)) {
        for across in &columns {
            interpolation.push(down.iter().flat_map(|&(row, by)| {
                across.iter().map(move |&(column, weight)| (coarse.index(column, row), weight * by))
            }));
        }
    }
    interpolation
}

/// Linear interpolation over the displayed coarse triangles.
pub(super) fn flat(fine: &Grid, coarse: &Grid) -> Interpolation {
    let mut interpolation = Interpolation::default();
    for row in 0..fine.rows {
        for column in 0..fine.columns {
            let (left, top) = (column / 2, row / 2);
            let (right, bottom) = (column.div_ceil(2), row.div_ceil(2));
            // The centre of a coarse cell lies on its diagonal, which alternates from cell to cell.
            let ends = if (left + top).is_multiple_of(2) || left == right || top == bottom {
                [(left, top), (right, bottom)]
            } else {
                [(right, top), (left, bottom)]
            };
            let [one, other] = ends.map(|(column, row)| coarse.index(column, row));
            if one == other {
                interpolation.push([(one, 1.0)]);
            } else {
                interpolation.push([(one, 0.5), (other, 0.5)]);
            }
        }
    }
    interpolation
}

/// Weights of coarse nodes at a fine node of a line of `coarse` nodes. In the first and the last interval a
/// parabola replaces the cubic.
fn four_point(fine: u32, coarse: u32) -> Vec<(u32, f32)> {
    let (left, last) = (fine / 2, coarse - 1);
    let weighted = |weights: &[f32], first: u32| -> Vec<(u32, f32)> {
        (first..).zip(weights.iter().copied()).collect()
    };
    match left {
        left if fine.is_multiple_of(2) => vec![(left, 1.0)],
        _ if coarse == 2 => weighted(&[0.5, 0.5], 0),
        0 => weighted(&[0.375, 0.75, -0.125], 0),
        left if left + 1 == last => weighted(&[-0.125, 0.75, 0.375], left - 1),
        left => weighted(&[-0.0625, 0.5625, 0.5625, -0.0625], left - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smooth_stencil_reproduces_parabolas_everywhere_and_cubics_inside() {
        let (fine, coarse) = (Grid::new(17, 9, 1.0, 1.0), Grid::new(9, 5, 1.0, 1.0));
        let at = |grid: &Grid, index: usize| {
            let columns = grid.columns as usize;
            let step = |count: u32| 1.0 / (count - 1) as f32;
            (
                (index % columns) as f32 * step(grid.columns),
                (index / columns) as f32 * step(grid.rows),
            )
        };
        let rows = smooth(&fine, &coarse);
        let parabola = |(u, v): (f32, f32)| u * u - 3.0 * u * v + v * v + 1.0;
        let cubic = |(u, v): (f32, f32)| u.powi(3) - 2.0 * v.powi(3);
        for (degree, field) in [(2, &parabola as &dyn Fn((f32, f32)) -> f32), (3, &cubic)] {
            let values: Vec<f32> = (0..45).map(|index| field(at(&coarse, index))).collect();
            for (index, value) in rows.interpolate(&values).enumerate() {
                let (column, row) = (index % 17, index / 17);
                let inside = (2..15).contains(&column) && (2..7).contains(&row);
                if degree == 2 || inside {
                    assert!((value - field(at(&fine, index))).abs() < 1e-5, "{column}, {row}");
                }
            }
        }
    }

    /// The displayed surface has a crease along the diagonal of a coarse cell; the fine surface must contain
    /// it.
    #[test]
    fn the_flat_stencil_follows_the_triangles() {
        let (fine, coarse) = (Grid::new(9, 9, 1.0, 1.0), Grid::new(5, 5, 1.0, 1.0));
        let rows: Vec<Vec<(u32, f32)>> = flat(&fine, &coarse).rows().map(<[_]>::to_vec).collect();
        let triangles = coarse.triangles(false);
        for row in &rows {
            let holds = |triangle: &[u32; 3]| row.iter().all(|(node, _)| triangle.contains(node));
            assert!(triangles.iter().any(holds), "{row:?} is on no triangle");
        }
        // Every fine triangle lies on one coarse triangle.
        for triangle in fine.triangles(false) {
            let corners = triangle.map(|corner| &rows[corner as usize]);
            let holds = |coarse: &[u32; 3]| {
                corners.iter().all(|row| row.iter().all(|(node, _)| coarse.contains(node)))
            };
            assert!(triangles.iter().any(holds), "{triangle:?}");
        }
    }
}
