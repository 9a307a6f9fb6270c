//! Meshes with fewer triangles: the next coarser level of one that is not a grid, and one of a given size.

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

/// Fraction of the triangles that are asked for when a mesh still has too many vertices.
const FEWER: f32 = 0.75;

/// Greatest number of attempts to reach a number of vertices.
const ATTEMPTS: usize = 8;

impl FabricBuilder {
    /// A mesh of at most this number of vertices, if it can be reached. None if the mesh has no more than this number, is
    /// invalid, or cannot be simplified.
    pub(super) fn simplified_to(&self, vertices: usize) -> Option<CoarserMesh> {
        if self.positions.len() <= vertices {
            return None;
        }
        self.validate().ok()?;
        // Twice as many triangles as vertices, by Euler's formula.
        let mut triangles = 2.0 * vertices as f32;
        let mut least: Option<CoarserMesh> = None;
        for _ in 0..ATTEMPTS {
            let kept =
                self.simplified_triangles(3 * triangles as usize, SimplifyOptions::Regularize);
            let Some(simple) = kept.map(|kept| self.with_triangles(&kept)) else { break };
            let count = simple.vertices.len();
            if least.as_ref().is_some_and(|least| least.vertices.len() <= count) {
                break;
            }
            least = Some(simple);
            if count <= vertices {
                break;
            }
            triangles *= FEWER;
        }
        least
    }

    /// About a quarter of the triangles, with the whole border and all pins. None if hardly any can be removed.
    pub(super) fn simplified(&self) -> Option<CoarserMesh> {
        self.validate().ok()?;
        let options = SimplifyOptions::LockBorder | SimplifyOptions::Regularize;
        let kept = self.simplified_triangles(self.indices.len() / REDUCTION, options)?;
        Some(self.with_triangles(&kept))
    }

    /// The mesh of some triangles, three vertices each.
    fn with_triangles(&self, kept: &[u32]) -> CoarserMesh {
        let mut vertices = kept.to_vec();
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
        CoarserMesh { builder, vertices }
    }

    /// Triangles of a mesh simplified to some number of corners, as three vertices of this mesh each. None if hardly any
    /// can be removed.
    fn simplified_triangles(&self, corners: usize, options: SimplifyOptions) -> Option<Vec<u32>> {
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
            corners,
            f32::MAX,
            options,
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
