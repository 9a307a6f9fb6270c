//! Links of a background grid whose lines are curved and unevenly far apart, or whose cells have different warps: each has the width
//! of the cells beside it, and the moduli of the material along it.

use super::edge_sums::EdgeSums;
use super::grid::Grid;
use super::links::{LinkClass, LinkFamily, Links};
use super::mesh::RestMesh;

/// Least difference of cos² of an angle to the warp in two cells of pieces with different warps. Larger: links at seams shear as if
/// they were cut on the bias.
const UNLIKE_WARPS: f32 = 0.2;

impl Links {
    /// Links of a grid with cells of different warps, given how much of each cell is cloth, and cos² of the angle between
    /// its rows and the warp. A link along a line stands for half of each cell beside it.
    pub fn of_cells_with_warps(
        mesh: &RestMesh,
        grid: &Grid,
        coverage: &[f32],
        warps: &[f32],
        is_closed: bool,
    ) -> Self {
        let mut sums = EdgeSums::new(mesh.positions.len());
        let cells = grid.cells().zip(coverage).zip(warps).filter(|((_, part), _)| **part > 0.0);
        for (((corners, _), &part), &warp) in cells {
            let [top_left, top_right, bottom_left, bottom_right] = corners;
            let [a, b, c, d] = mesh.positions_of(corners);
            let area = 0.5 * (d - a).cross(c - b).length();
            let mut add = |ends: [u32; 2], family| {
                let squared = {
                    let [one, other] = mesh.positions_of(ends);
                    one.distance_squared(other)
                };
                let sum = sums.at(ends, || CellSum::none(family));
                sum.coefficient += part
                    * match family {
                        // G γ² A/2 in both diagonals, whose lengths change by γ A/d.
                        LinkFamily::Diagonal => 0.5 * squared / area,
                        _ => 0.5 * area / squared,
                    };
                sum.warp.add(warp);
            };
            add([top_left, top_right], LinkFamily::Warp);
            add([bottom_left, bottom_right], LinkFamily::Warp);
            add([top_left, bottom_left], LinkFamily::Weft);
            add([top_right, bottom_right], LinkFamily::Weft);
            add([top_left, bottom_right], LinkFamily::Diagonal);
            add([top_right, bottom_left], LinkFamily::Diagonal);
        }
        let links = sums.sorted().map(|(ends, sum)| (ends, sum.class(), sum.family));
        Self::of_classes(mesh, links, Some(grid).filter(|_| is_closed))
    }
}

/// Sums over the cells beside a link.
struct CellSum {
    family: LinkFamily,
    /// Factor of the family's modulus.
    coefficient: f32,
    /// cos² of the angle between rows and warp.
    warp: MeanWarp,
}

impl CellSum {
    fn none(family: LinkFamily) -> Self {
        Self { family, coefficient: 0.0, warp: MeanWarp::default() }
    }

    fn class(&self) -> LinkClass {
        LinkClass::of_family(self.family, self.coefficient, self.warp.mean())
    }
}

/// The mean of cos² of an angle to the warp over the cells beside a link. At seams a link has the warp of one piece: in between
/// there would be cloth that is cut on the bias.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MeanWarp {
    sum: f32,
    cells: f32,
}

impl MeanWarp {
    /// Counts a cell, unless its piece has another warp than those counted before.
    pub fn add(&mut self, cos2: f32) {
        if self.cells == 0.0 || (self.mean() - cos2).abs() < UNLIKE_WARPS {
            self.sum += cos2;
            self.cells += 1.0;
        }
    }

    pub fn mean(&self) -> f32 {
        self.sum / self.cells
    }
}
