//! The next coarser mesh of one that is not a grid.

use meshopt::{SimplifyOptions, VertexDataAdapter, typed_to_bytes};

use super::coarser::CoarserMesh;
use super::slivers::flip_slivers;
use super::source::FabricBuilder;

/// Number of triangles of the finer mesh for each triangle of the simplified one.
const REDUCTION: usize = 4;

/// Fraction of the triangles above which a simplified mesh is no level of its own.
const WORTHWHILE: f32 = 0.75;

/// Cost of the texture's distortion in the simplification, 1/m: units of texture coordinates that weigh as
/// much as a metre of shape.
const UV_COST: f32 = 1.0;

impl FabricBuilder {
    /// About a quarter of the triangles, with the whole border and all pins. None if hardly any can be removed.
    pub(super) fn simplified(&self) -> Option<CoarserMesh> {
        self.validate().ok()?;
        let kept = self.simplified_triangles()?;
        let mut vertices = kept.clone();
        vertices.sort_unstable();
        vertices.dedup();
        let index = |vertex: &u32| vertices.binary_search(vertex).ok().map(|at| at as u32);
        let finer = || vertices.iter().map(|&vertex| vertex as usize);
        let builder = Self {
            positions: finer().map(|vertex| self.positions[vertex]).collect(),
            indices: kept.iter().filter_map(index).collect(),
            uv: finer().filter_map(|vertex| self.uv.get(vertex).copied()).collect(),
            pinned: self.pins_among(&vertices).collect(),
            weld_distance: Some(self.effective_weld_distance()),
            merged: self
                .merged
                .as_ref()
                .map(|merged| finer().map(|vertex| merged[vertex]).collect()),
            pinned_before_uv: false,
            tethered: self.tethered,
            grid: None,
        };
        Some(CoarserMesh { builder, vertices })
    }

    /// Triangles of the simplified mesh, as three vertices of this mesh each.
    fn simplified_triangles(&self) -> Option<Vec<u32>> {
        let positions: Vec<[f32; 3]> = self.positions.iter().map(|at| at.to_array()).collect();
        let adapter =
            VertexDataAdapter::new(typed_to_bytes(&positions), size_of::<[f32; 3]>(), 0).ok()?;
        let uv: Vec<f32> = self.uv.iter().flat_map(|uv| uv.to_array()).collect();
        let costs = if uv.is_empty() { &[][..] } else { &[UV_COST; 2] };
        let locked: Vec<bool> =
            (0..positions.len()).map(|vertex| self.pinned.contains(&(vertex as u32))).collect();
        let kept = meshopt::simplify_with_attributes_and_locks(
            &self.indices,
            &adapter,
            &uv,
            costs,
            size_of_val(costs),
            &locked,
            self.indices.len() / REDUCTION,
            f32::MAX,
            SimplifyOptions::LockBorder | SimplifyOptions::Regularize,
            None,
        );
        if kept.is_empty() || kept.len() as f32 > WORTHWHILE * self.indices.len() as f32 {
            return None;
        }
        let corners = kept.chunks_exact(3);
        let mut triangles: Vec<[u32; 3]> = corners.map(|at| [at[0], at[1], at[2]]).collect();
        flip_slivers(&self.positions, &mut triangles);
        Some(triangles.into_flattened())
    }
}
