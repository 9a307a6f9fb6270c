//! Links of a background grid whose lines are curved and unevenly far apart, or whose cells have different warps: each has the width
//! of the cells beside it, and the moduli of the material along it.

use super::edge_sums::EdgeSums;
use super::grid::Grid;
use super::links::{LEAST_STIFFNESS, LinkClass, LinkFamily, Links};
use super::mesh::RestMesh;

/// Least difference of cos² of the angle between rows and warp in two cells of pieces with different warps. Larger: links at seams
/// shear as if they were cut on the bias.
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
                // At seams, links have the warp of one piece: in between there would be cloth that is cut on the bias.
                if sum.cells == 0.0 || (sum.warps / sum.cells - warp).abs() < UNLIKE_WARPS {
                    sum.warps += warp;
                    sum.cells += 1.0;
                }
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
    /// Sum of cos² of the angles between rows and warp.
    warps: f32,
    cells: f32,
}

impl CellSum {
    fn none(family: LinkFamily) -> Self {
        Self { family, coefficient: 0.0, warps: 0.0, cells: 0.0 }
    }

    fn class(&self) -> LinkClass {
        let of = |family| if self.family == family { self.coefficient } else { 0.0 };
        LinkClass {
            coefficients: [LinkFamily::Warp, LinkFamily::Weft, LinkFamily::Diagonal].map(of),
            floor: LEAST_STIFFNESS as f32 * self.coefficient,
            warp_cos2: self.warps / self.cells,
        }
    }
}
