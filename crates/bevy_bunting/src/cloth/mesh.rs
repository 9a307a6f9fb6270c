//! The shape of a cloth at rest.

use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_reflect::Reflect;
use bevy_transform::components::Transform;
use bunting_solver::{FabricBuilder, Grid};

use crate::cloth::instance::ClothInstance;
use crate::cloth::material::ClothMaterial;
use crate::cloth::state::ClothState;
use crate::lod::effort::ClothEffort;
use crate::lod::lod_set::LodSet;
use crate::lod::record::{LodRecord, RestTimer};
use crate::motion::pose::PoseHistory;

/// The shape of a cloth at rest. This component makes an entity a cloth: the other components that a cloth
/// needs are required by it and inserted with it.
///
/// Positions are in the cloth's frame: the entity's own [`Transform`] or, with an
/// [`Attachment`](crate::Attachment), the pose of the target times the offset. A frame has no scale: bake a
/// scale into the mesh.
///
/// A mesh that cannot be simulated is reported in a [`ClothFailed`](crate::ClothFailed) event.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Debug, PartialEq, Clone)]
#[require(
    Transform,
    ClothMaterial,
    LodSet,
    ClothState,
    ClothInstance,
    ClothEffort,
    LodRecord,
    RestTimer,
    PoseHistory
)]
pub enum ClothMesh {
    /// A rectangular grid of particles. The origin is the top left corner and the front faces +z; u grows
    /// along +x, v along −y.
    Grid {
        /// Particles in a row, at least 2.
        columns: u32,
        /// Particles in a column, at least 2.
        rows: u32,
        /// Extent along a row, m.
        width: f32,
        /// Extent along a column, m.
        height: f32,
    },
    /// A mesh of triangles.
    Triangles {
        /// Positions of the vertices, m.
        positions: Vec<Vec3>,
        /// Three vertices a triangle, counter-clockwise seen from the front.
        indices: Vec<u32>,
        /// Texture coordinates, one for each vertex or none at all: the warp runs along u.
        uv: Vec<Vec2>,
        /// Weights from 0 (rigid) to 1 (simulated), one for each vertex. An empty list simulates all
        /// vertices. See [`with_weights`](ClothMesh::with_weights).
        weights: Vec<f32>,
    },
}

impl ClothMesh {
    /// A grid of `columns` × `rows` particles over `width` × `height` metres.
    #[must_use]
    pub const fn grid(columns: u32, rows: u32, width: f32, height: f32) -> Self {
        Self::Grid { columns, rows, width, height }
    }

    /// A mesh of triangles: positions in metres, three indices for each triangle, and texture coordinates,
    /// one for each vertex or none at all.
    #[must_use]
    pub const fn triangles(positions: Vec<Vec3>, indices: Vec<u32>, uv: Vec<Vec2>) -> Self {
        Self::Triangles { positions, indices, uv, weights: Vec::new() }
    }

    /// Simulates only a part of the mesh, by a weight from 0 to 1 for each vertex.
    ///
    /// | Weight w | Vertex |
    /// | --- | --- |
    /// | 1 | simulated |
    /// | between | simulated, and shown at (1 − w) × its position at rest + w × its simulated position |
    /// | 0 | rigid: stays where the mesh has it in the cloth's frame, exactly |
    ///
    /// Triangles whose vertices all have weight 0 are rigid: they have no particles and cost no time in a
    /// tick. A vertex of weight 0 on any other triangle is pinned, which attaches the simulated part to the
    /// rigid one.
    ///
    /// The method turns a grid into triangles, whose bending is less exact than a grid's. Invalid weights are
    /// reported in a [`ClothFailed`](crate::ClothFailed) event.
    #[must_use]
    pub fn with_weights(self, weights: Vec<f32>) -> Self {
        let builder = self.builder();
        if builder.positions().is_empty() {
            // An invalid grid stays a grid: the error is reported when its fabric is built.
            return self;
        }
        Self::Triangles {
            positions: builder.positions().to_vec(),
            indices: builder.indices().to_vec(),
            uv: self.uvs(),
            weights,
        }
    }

    /// Weights of all vertices; empty where all vertices are simulated.
    pub(crate) fn weights(&self) -> &[f32] {
        match self {
            Self::Grid { .. } => &[],
            Self::Triangles { weights, .. } => weights,
        }
    }

    /// The grid; none for triangles.
    pub(crate) fn as_grid(&self) -> Option<Grid> {
        match *self {
            Self::Grid { columns, rows, width, height } => {
                Some(Grid::new(columns, rows, width, height))
            }
            Self::Triangles { .. } => None,
        }
    }

    /// Number of vertices.
    pub(crate) fn vertex_count(&self) -> usize {
        match self {
            Self::Grid { columns, rows, .. } => *columns as usize * *rows as usize,
            Self::Triangles { positions, .. } => positions.len(),
        }
    }

    /// Texture coordinates of all vertices; empty for triangles without.
    pub(crate) fn uvs(&self) -> Vec<Vec2> {
        match self {
            Self::Grid { columns, rows, width, height } => {
                Grid::new(*columns, *rows, *width, *height).uvs()
            }
            Self::Triangles { uv, .. } => uv.clone(),
        }
    }

    /// A builder of the fabric of the whole mesh, without pins.
    pub(crate) fn builder(&self) -> FabricBuilder {
        match self {
            Self::Grid { columns, rows, width, height } => {
                FabricBuilder::grid(Grid::new(*columns, *rows, *width, *height))
            }
            Self::Triangles { positions, indices, uv, .. } => {
                FabricBuilder::new(positions.clone(), indices.clone()).uv(uv.clone())
            }
        }
    }
}

impl From<Grid> for ClothMesh {
    fn from(grid: Grid) -> Self {
        Self::grid(grid.columns, grid.rows, grid.width, grid.height)
    }
}
