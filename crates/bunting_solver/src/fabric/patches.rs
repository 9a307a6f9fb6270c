//! Triangles in pairs that share an edge, for sums over all triangles (air, normals).
//!
//! A pair has four corners, two single triangles six, so that a third fewer positions are loaded and results
//! added. Neighbours in the list are neighbours in space.

use super::grid::Grid;
use crate::simd::lane::Lane;
use crate::simd::vec3::{Pack3, V3};

/// Two triangles (a, b, c) and (a, c, d).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Patch<C = f32> {
    /// a, b, c and d; d = c where a triangle found no partner.
    pub corners: [u32; 4],
    /// The part of each triangle's area that belongs to a corner, m²: a third to each of its own corners, or, in a
    /// cell of a grid, a quarter to each corner of the cell.
    pub corner_areas: [C; 2],
}

impl<C> Patch<C> {
    /// The values at the corners, of one per particle.
    #[inline(always)]
    pub fn load<L: Lane>(&self, token: L::Token, values: &[Pack3<L::Pack>]) -> [V3<L>; 4] {
        let [a, b, c, d] = self.corners;
        [
            V3::load(token, &values[a as usize]),
            V3::load(token, &values[b as usize]),
            V3::load(token, &values[c as usize]),
            V3::load(token, &values[d as usize]),
        ]
    }
}

/// Whether patches are the cells of a grid, row by row.
pub(super) fn are_cells(patches: &[Patch], grid: &Grid) -> bool {
    let cells = grid.cells().map(|([top_left, top_right, bottom_left, bottom_right], even)| {
        if even {
            [top_left, bottom_left, bottom_right, top_right]
        } else {
            [top_right, top_left, bottom_left, bottom_right]
        }
    });
    cells.eq(patches.iter().map(|patch| patch.corners))
}

/// Makes the corner areas of a grid's cells quarters.
pub(super) fn quarter(patches: &mut [Patch], grid: &Grid) {
    let cells = (grid.columns - 1) as f32 * (grid.rows - 1) as f32;
    let quarter = grid.width * grid.height / (8.0 * cells);
    patches.iter_mut().for_each(|patch| patch.corner_areas = [quarter; 2]);
}

/// Pairs each triangle with the first neighbour that has no partner yet and faces the same way, given the
/// areas of the triangles, m².
pub(super) fn patches(triangles: &[[u32; 3]], areas: &[f32]) -> Vec<Patch> {
    let sides = |(index, &[a, b, c]): (usize, &[u32; 3])| {
        [[a, b], [b, c], [c, a]].map(|edge| (edge, index))
    };
    let mut triangles_at: Vec<([u32; 2], usize)> =
        triangles.iter().enumerate().flat_map(sides).collect();
    triangles_at.sort_unstable();
    let mut taken = vec![false; triangles.len()];
    let mut patches = Vec::with_capacity(triangles.len().div_ceil(2));
    for (index, &[p, q, r]) in triangles.iter().enumerate() {
        if taken[index] {
            continue;
        }
        taken[index] = true;
        let corner_area = areas[index] / 3.0;
        // The shared edge runs from c to a in this triangle, and from a to c in one that faces the same way.
        let partner = [[p, q, r], [q, r, p], [r, p, q]]
            .into_iter()
            .flat_map(|corners| {
                let shared = [corners[0], corners[2]];
                let first = triangles_at.partition_point(|(edge, _)| *edge < shared);
                let across =
                    triangles_at[first..].iter().take_while(move |(edge, _)| *edge == shared);
                across.map(move |&(_, partner)| (partner, corners))
            })
            .filter(|&(partner, _)| !taken[partner])
            .min_by_key(|&(partner, _)| partner);
        patches.push(match partner {
            Some((partner, [a, b, c])) => {
                taken[partner] = true;
                let opposite =
                    triangles[partner].into_iter().find(|corner| ![a, c].contains(corner));
                let d = opposite.unwrap_or(c);
                Patch { corners: [a, b, c, d], corner_areas: [corner_area, areas[partner] / 3.0] }
            }
            None => Patch { corners: [p, q, r, r], corner_areas: [corner_area, 0.0] },
        });
    }
    patches
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::fabric::{Fabric, FabricBuilder, Grid};

    /// The triangles, sorted, each beginning with its lowest corner.
    fn faces(corners: impl Iterator<Item = [u32; 3]>) -> Vec<[u32; 3]> {
        let first = |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
        let mut faces: Vec<[u32; 3]> = corners.filter_map(first).collect();
        faces.sort_unstable();
        faces
    }

    fn covers_each_triangle_once(fabric: &Fabric, corners: f32) {
        let of_patches = fabric.patches().iter().flat_map(|patch| {
            let [a, b, c, d] = patch.corners;
            [Some([a, b, c]), (d != c).then_some([a, c, d])].into_iter().flatten()
        });
        assert_eq!(faces(of_patches), faces(fabric.triangles().iter().copied()));
        let area: f32 =
            fabric.patches().iter().flat_map(|patch| patch.corner_areas).sum::<f32>() * corners;
        assert!((area / fabric.area() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_grid_falls_into_its_cells() {
        let fabric = FabricBuilder::grid(Grid::new(6, 5, 1.0, 1.0)).build().expect("good");
        assert_eq!(fabric.patches().len(), 20);
        covers_each_triangle_once(&fabric, 4.0);
    }

    #[test]
    fn an_odd_triangle_stays_alone() {
        let fan = (0..5).map(|i| Vec3::new(libm::cosf(i as f32), libm::sinf(i as f32), 0.0));
        let positions = core::iter::once(Vec3::ZERO).chain(fan).collect();
        let indices = vec![0, 1, 2, 0, 2, 3, 0, 3, 4];
        let fabric = FabricBuilder::new(positions, [indices, vec![0, 4, 5]].concat()).build();
        covers_each_triangle_once(&fabric.expect("good"), 3.0);
        let lone = patches(&[[0, 1, 2]], &[3.0]);
        assert_eq!(lone, [Patch { corners: [0, 1, 2, 2], corner_areas: [1.0, 0.0] }]);
    }
}
