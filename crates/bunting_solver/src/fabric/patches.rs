//! Triangles in pairs that share an edge, for what is summed triangle by triangle.
//!
//! A pair has four corners where two triangles have six, so air and normals load and add up a third
//! less. Neighbours in the list follow one another in space.

use std::collections::HashMap;

use super::Grid;
use crate::simd::lane::Lane;
use crate::simd::vec3::{Pack3, V3};

/// Two triangles (a, b, c) and (a, c, d).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Patch {
    /// a, b, c and d; a triangle that found no partner has d = c.
    pub corners: [u32; 4],
    /// A third of each triangle's area, m²: what falls to each of its corners.
    pub shares: [f32; 2],
}

impl Patch {
    /// Of what there is at each particle, that at its corners.
    #[inline(always)]
    pub fn load<L: Lane>(&self, token: L::Token, of: &[Pack3<L::Pack>]) -> [V3<L>; 4] {
        let [a, b, c, d] = self.corners;
        [
            V3::load(token, &of[a as usize]),
            V3::load(token, &of[b as usize]),
            V3::load(token, &of[c as usize]),
            V3::load(token, &of[d as usize]),
        ]
    }
}

/// Whether patches are the cells of a grid, row by row.
pub(crate) fn are_cells(patches: &[Patch], grid: &Grid) -> bool {
    let [across, down] = [grid.columns - 1, grid.rows - 1];
    let cells = (0..down).flat_map(|row| {
        (0..across).map(move |column| {
            let at = |right, below| grid.index(column + right, row + below);
            if (column + row) % 2 == 0 {
                [at(0, 0), at(0, 1), at(1, 1), at(1, 0)]
            } else {
                [at(1, 0), at(0, 0), at(0, 1), at(1, 1)]
            }
        })
    });
    cells.eq(patches.iter().map(|patch| patch.corners))
}

/// Pairs each triangle with the first of its neighbours that is free and faces the same way.
pub(crate) fn patches(triangles: &[[u32; 3]], areas: &[f32]) -> Vec<Patch> {
    let mut runs_along: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (index, &[a, b, c]) in triangles.iter().enumerate() {
        for edge in [[a, b], [b, c], [c, a]] {
            runs_along.entry(edge).or_default().push(index);
        }
    }
    let mut taken = vec![false; triangles.len()];
    let mut patches = Vec::with_capacity(triangles.len().div_ceil(2));
    for (index, &[p, q, r]) in triangles.iter().enumerate() {
        if taken[index] {
            continue;
        }
        taken[index] = true;
        let share = areas[index] / 3.0;
        // The edge from a to c is shared; the partner runs along it the same way that this one runs
        // back along it.
        let partner = [[p, q, r], [q, r, p], [r, p, q]]
            .into_iter()
            .flat_map(|corners| {
                let along = runs_along.get(&[corners[0], corners[2]]);
                along.into_iter().flatten().map(move |&partner| (partner, corners))
            })
            .filter(|&(partner, _)| !taken[partner])
            .min_by_key(|&(partner, _)| partner);
        patches.push(match partner {
            Some((partner, [a, b, c])) => {
                taken[partner] = true;
                let opposite =
                    triangles[partner].into_iter().find(|corner| ![a, c].contains(corner));
                let d = opposite.unwrap_or(c);
                Patch { corners: [a, b, c, d], shares: [share, areas[partner] / 3.0] }
            }
            None => Patch { corners: [p, q, r, r], shares: [share, 0.0] },
        });
    }
    patches
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::fabric::{Fabric, FabricBuilder, Grid};

    /// Area vectors of all triangles, by corners in a canonical order.
    fn faces(corners: impl Iterator<Item = [u32; 3]>) -> Vec<[u32; 3]> {
        let first = |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
        let mut faces: Vec<[u32; 3]> = corners.filter_map(first).collect();
        faces.sort_unstable();
        faces
    }

    fn covers_each_triangle_once(fabric: &Fabric) {
        let of_patches = fabric.patches().iter().flat_map(|patch| {
            let [a, b, c, d] = patch.corners;
            [Some([a, b, c]), (d != c).then_some([a, c, d])].into_iter().flatten()
        });
        assert_eq!(faces(of_patches), faces(fabric.triangles().iter().copied()));
        let area: f32 = fabric.patches().iter().flat_map(|patch| patch.shares).sum::<f32>() * 3.0;
        assert!((area / fabric.area() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_grid_falls_into_its_cells() {
        let fabric = FabricBuilder::grid(Grid::new(6, 5, 1.0, 1.0)).build().expect("good");
        assert_eq!(fabric.patches().len(), 20);
        covers_each_triangle_once(&fabric);
    }

    #[test]
    fn an_odd_triangle_stays_alone() {
        let fan = (0..5).map(|i| Vec3::new(libm::cosf(i as f32), libm::sinf(i as f32), 0.0));
        let positions = core::iter::once(Vec3::ZERO).chain(fan).collect();
        let indices = vec![0, 1, 2, 0, 2, 3, 0, 3, 4];
        let fabric = FabricBuilder::new(positions, [indices, vec![0, 4, 5]].concat()).build();
        covers_each_triangle_once(&fabric.expect("good"));
        let lone = patches(&[[0, 1, 2]], &[3.0]);
        assert_eq!(lone, [Patch { corners: [0, 1, 2, 2], shares: [1.0, 0.0] }]);
    }
}
