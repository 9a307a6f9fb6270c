//! Regions of the material on the vertices and particles of a builder.

use super::source::FabricBuilder;
use crate::fabric::grid::Grid;
use crate::fabric::interpolation::Term;
use crate::fabric::mesh::{RestMesh, Surface};
use crate::fabric::regions::{Ground, MaterialRegion, Variation};

impl FabricBuilder {
    /// The regions on a mesh with other vertices, each a copy of one of this mesh.
    pub(super) fn regions_of(&self, vertices: &[u32]) -> Vec<MaterialRegion> {
        let of_vertices = |weights: &[f32]| {
            vertices.iter().map(|&vertex| weights[vertex as usize]).collect::<Vec<f32>>()
        };
        self.regions.iter().map(|region| region.map_vertices(of_vertices)).collect()
    }

    /// The regions on the grid of every second column and row, whose vertices have the means of those around them.
    pub(super) fn halved_regions(&self, grid: &Grid, halved: &Grid) -> Vec<MaterialRegion> {
        let of_vertices = |weights: &[f32]| halved_weights(weights, grid, halved);
        self.regions.iter().map(|region| region.map_vertices(of_vertices)).collect()
    }

    /// How the regions vary the material of a grid, given the vertices around its nodes.
    pub(super) fn variation_of_grid(
        &self,
        mesh: &RestMesh,
        surface: &Surface,
        grid: &Grid,
        corners: impl FnOnce() -> Vec<Vec<Term>>,
    ) -> Variation {
        if self.regions.is_empty() {
            return Variation::default();
        }
        let around = |[top_left, top_right, bottom_left, bottom_right]: [u32; 4]| {
            vec![top_left, top_right, bottom_right, bottom_left]
        };
        let ground = Ground {
            mesh,
            edges: &surface.edges,
            is_flat: true,
            cells: grid.cells().map(|(corners, _)| around(corners)).collect(),
            corners: corners(),
        };
        ground.variation(&self.regions)
    }
}

/// Means of the weights of a grid's vertices around every second one, by the areas that these have in common: the sum over the grid
/// stays the same.
fn halved_weights(weights: &[f32], grid: &Grid, halved: &Grid) -> Vec<f32> {
    // The share of a vertex, and its width: at the border it stands for half a cell.
    let shares = |at: u32, count: u32| {
        let near = (2 * at).saturating_sub(1)..=(2 * at + 1).min(count - 1);
        near.map(move |it| {
            let width = if it == 0 || it + 1 == count { 0.5 } else { 1.0 };
            (it, if it == 2 * at { width } else { 0.5 * width })
        })
    };
    let of_vertex = |(column, row): (u32, u32)| {
        let (mut sum, mut total) = (0.0, 0.0);
        for (y, height) in shares(row, grid.rows) {
            for (x, width) in shares(column, grid.columns) {
                sum += width * height * weights[grid.index(x, y) as usize];
                total += width * height;
            }
        }
        sum / total
    };
    let vertices =
        (0..halved.rows).flat_map(|row| (0..halved.columns).map(move |column| (column, row)));
    vertices.map(of_vertex).collect()
}

#[cfg(test)]
mod tests {
    use crate::fabric::{Fabric, FabricBuilder, Grid, MaterialRegion};

    #[test]
    fn a_coarser_grid_is_as_heavy() {
        let weights = (0..9 * 5).map(|at: u32| if at % 9 > 6 || at < 9 { 1.0 } else { 0.0 });
        let hem = MaterialRegion::vertices(weights.collect()).density(4.0);
        let fine = FabricBuilder::grid(Grid::new(9, 5, 1.6, 1.0)).regions([hem]);
        let coarse = fine.coarser().expect("a level").builder;
        let [fine, coarse] = [fine, coarse].map(|it| it.build().expect("a fabric"));
        let masses = |fabric: &Fabric| fabric.particle_areas().iter().sum::<f32>();
        assert!((masses(&fine) / masses(&coarse) - 1.0).abs() < 1e-5, "{}", masses(&coarse));
        assert!(masses(&fine) > 1.5 * fine.area());
        assert!((fine.area() - 1.6).abs() < 1e-5);
    }

    #[test]
    fn copies_of_vertices_keep_their_weights() {
        // Two triangles that touch in one vertex, which a repair splits, and a vertex without triangles.
        let grid = Grid::new(3, 3, 1.0, 1.0);
        let positions = FabricBuilder::grid(grid).positions().to_vec();
        let weights: Vec<f32> = (0..9_u8).map(|at| 0.1 * f32::from(at)).collect();
        let mesh = FabricBuilder::new(positions, vec![0, 3, 4, 4, 7, 8]);
        let mesh = mesh.regions([MaterialRegion::vertices(weights.clone()).bending(2.0)]);
        let (repaired, report) = mesh.repair().expect("a mesh");
        let kept: Vec<f32> = report.vertices.iter().map(|&at| weights[at as usize]).collect();
        let expected = MaterialRegion::vertices(kept).bending(2.0);
        assert_eq!(repaired.regions, [expected]);
    }
}
