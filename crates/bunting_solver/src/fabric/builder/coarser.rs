//! The next coarser mesh of a chain of levels of detail.

use super::source::FabricBuilder;
use crate::fabric::grid::Grid;

/// A mesh with some of the vertices of a finer mesh, from [`FabricBuilder::coarser`].
///
/// ```
/// use bunting_solver::{FabricBuilder, Grid};
///
/// let fine = FabricBuilder::grid(Grid::new(9, 5, 2.0, 1.0)).pin([0]);
/// let coarse = fine.coarser().expect("the grid can be halved");
/// // The second vertex of the coarser grid is the third one of the finer grid.
/// assert_eq!(coarse.vertices[1], 2);
/// assert_eq!(coarse.builder.build()?.particle_count(), 5 * 3);
/// # Ok::<(), bunting_solver::FabricError>(())
/// ```
#[derive(Clone, Debug)]
pub struct CoarserMesh {
    /// The mesh, with those pins that remain.
    pub builder: FabricBuilder,
    /// For each vertex of the coarser mesh, the vertex of the finer mesh at the same position.
    pub vertices: Vec<u32>,
}

impl FabricBuilder {
    /// Builds the next coarser level: every second column and row of a grid; of other meshes about a quarter
    /// of the triangles, with all vertices of the border and all pinned vertices (simplification by quadric
    /// error metrics with `meshoptimizer`, which takes the texture into account). Without the feature `mesh_levels` only
    /// grids have coarser levels.
    ///
    /// None if a grid cannot be halved, or if hardly any triangle can be removed.
    #[must_use]
    pub fn coarser(&self) -> Option<CoarserMesh> {
        match &self.grid {
            Some(grid) => self.every_second(grid),
            #[cfg(feature = "mesh_levels")]
            None => self.simplified(),
            #[cfg(not(feature = "mesh_levels"))]
            None => None,
        }
    }

    /// The same shape with at most this number of vertices, as far as all pinned vertices can stay and hardly any
    /// triangle is turned over: for a mesh that is drawn in more detail than it is simulated. Unlike in
    /// [`coarser`](Self::coarser) the border has fewer vertices, too. None if the mesh has no more than this number, is
    /// invalid, or cannot be simplified, and without the feature `mesh_levels`.
    ///
    /// ```
    /// use bunting_solver::{FabricBuilder, Grid};
    ///
    /// let grid = FabricBuilder::grid(Grid::new(65, 65, 1.0, 1.0));
    /// let dense = FabricBuilder::new(grid.positions().to_vec(), grid.indices().to_vec());
    /// let simple = dense.pin([0, 64]).decimated(600).expect("it has 4,225 vertices");
    /// assert!((400..=600).contains(&simple.vertices.len()));
    /// ```
    #[must_use]
    #[cfg_attr(
        not(feature = "mesh_levels"),
        expect(unused_variables, reason = "by meshoptimizer only")
    )]
    pub fn decimated(&self, vertices: usize) -> Option<CoarserMesh> {
        #[cfg(feature = "mesh_levels")]
        let decimated = self.simplified_to(vertices);
        #[cfg(not(feature = "mesh_levels"))]
        let decimated = None;
        decimated
    }

    fn every_second(&self, grid: &Grid) -> Option<CoarserMesh> {
        let halved = grid.halved()?;
        let vertices: Vec<u32> = (0..halved.rows)
            .flat_map(|row| (0..halved.columns).map(move |column| (column, row)))
            .map(|(column, row)| grid.index(2 * column, 2 * row))
            .collect();
        let pins = self.pins_among(&vertices);
        let builder = Self::grid(halved).pin(pins).tethered(self.tethered);
        Some(CoarserMesh { builder, vertices })
    }

    /// Indices of the pinned vertices within a list of vertices.
    pub(super) fn pins_among(&self, vertices: &[u32]) -> impl Iterator<Item = u32> {
        (0..).zip(vertices).filter(|(_, vertex)| self.pinned.contains(vertex)).map(|(at, _)| at)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use glam::{Vec2, Vec3};

    use super::*;

    /// A curtain with a hole, as a mesh of triangles.
    fn curtain() -> FabricBuilder {
        let grid = Grid::new(25, 21, 1.2, 1.0);
        let hole = |at: &Vec3| at.distance(Vec3::new(0.6, -0.5, 0.0)) < 0.2;
        let positions = grid.positions();
        let all = grid.triangles(false);
        let kept: Vec<u32> = all
            .iter()
            .filter(|triangle| !triangle.iter().any(|&corner| hole(&positions[corner as usize])))
            .flatten()
            .copied()
            .collect();
        let mut used = kept.clone();
        used.sort_unstable();
        used.dedup();
        let index = |vertex: &u32| used.binary_search(vertex).expect("it is used") as u32;
        let uv: Vec<Vec2> = grid.uvs();
        FabricBuilder::new(
            used.iter().map(|&vertex| positions[vertex as usize]).collect(),
            kept.iter().map(index).collect(),
        )
        .uv(used.iter().map(|&vertex| uv[vertex as usize]).collect())
        .pin_where(|_, uv| uv.y == 0.0)
    }

    fn border(indices: &[u32]) -> Vec<u32> {
        let mut edges = BTreeMap::new();
        for corners in indices.chunks_exact(3) {
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let (a, b) = (corners[a], corners[b]);
                *edges.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
            }
        }
        let mut ends: Vec<u32> =
            edges.into_iter().filter(|(_, uses)| *uses == 1).flat_map(|(ends, _)| ends).collect();
        ends.sort_unstable();
        ends.dedup();
        ends
    }

    #[test]
    fn a_mesh_keeps_its_border_and_its_pins() {
        let fine = curtain();
        let CoarserMesh { builder, vertices } = fine.coarser().expect("a level");
        assert!(builder.indices.len() < fine.indices.len() / 2);
        for (vertex, &of) in vertices.iter().enumerate() {
            assert_eq!(builder.positions[vertex], fine.positions[of as usize]);
            assert_eq!(builder.uv[vertex], fine.uv[of as usize]);
        }
        assert!(border(&fine.indices).iter().all(|vertex| vertices.contains(vertex)));
        assert_eq!(builder.pinned.len(), fine.pinned.len());
        let area = |builder: &FabricBuilder| builder.clone().build().expect("a cloth").area();
        assert!((area(&builder) / area(&fine) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_decimated_mesh_has_the_shape_with_fewer_vertices_also_on_the_border() {
        let fine = curtain();
        assert!(fine.decimated(fine.positions.len()).is_none(), "it has no more");
        let CoarserMesh { builder, vertices } = fine.decimated(120).expect("it has some 500");
        assert!((90..=120).contains(&vertices.len()), "{}", vertices.len());
        for (vertex, &of) in vertices.iter().enumerate() {
            assert_eq!(builder.positions[vertex], fine.positions[of as usize]);
            assert_eq!(builder.uv[vertex], fine.uv[of as usize]);
        }
        assert!(border(&builder.indices).len() < border(&fine.indices).len());
        assert_eq!(builder.pinned.len(), fine.pinned.len());
        let area = |builder: &FabricBuilder| builder.clone().build().expect("a cloth").area();
        assert!((area(&builder) / area(&fine) - 1.0).abs() < 0.05);
    }

    #[test]
    fn an_untethered_fabric_has_no_tethers_at_any_level() {
        let grid = FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0)).pin([0, 8]);
        for builder in [grid, curtain()] {
            let coarser = builder.tethered(false).coarser().expect("a level").builder;
            let fabric = coarser.build().expect("a cloth");
            assert!(fabric.has_pins() && fabric.tethers().is_empty());
        }
    }

    #[test]
    fn a_strip_without_inner_vertices_has_no_coarser_level() {
        let strip = Grid::new(9, 2, 1.0, 0.1);
        let triangles = strip.triangles(false).into_iter().flatten().collect();
        assert!(FabricBuilder::new(strip.positions(), triangles).coarser().is_none());
        assert!(FabricBuilder::grid(Grid::new(4, 5, 1.0, 1.0)).coarser().is_none());
    }
}
