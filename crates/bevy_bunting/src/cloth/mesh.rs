//! What a cloth is: its shape at rest and what it is made of.

use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use bunting_solver::{FabricBuilder, FabricMaterial, Grid};

use crate::cloth::activity::{ClothRest, ClothWatch};
use crate::cloth::instance::ClothInstance;
use crate::cloth::reflect::FabricMaterialReflect;
use crate::cloth::state::ClothState;
use crate::lod::LodSet;
use crate::motion::pose::PoseHistory;

/// The shape of a cloth at rest. This component alone makes an entity a cloth: the others that it
/// needs come with it.
///
/// Positions are in the cloth's frame: the entity's own [`Transform`] or, with an
/// [`Attachment`](crate::Attachment), the pose of its target. A frame has no scale: bake it into
/// the mesh.
///
/// What cannot be simulated is reported in a [`ClothFailed`](crate::ClothFailed) event.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Debug, PartialEq, Clone)]
#[require(
    Transform,
    ClothMaterial,
    LodSet,
    ClothState,
    ClothInstance,
    ClothWatch,
    ClothRest,
    PoseHistory
)]
pub enum ClothMesh {
    /// A rectangle of particles. The origin is its top left corner, the front faces +z; u grows
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
        /// Texture coordinates, one a vertex or none: the warp runs along u.
        uv: Vec<Vec2>,
        /// How far each vertex is simulated, from 0 to 1, one a vertex or none: all of it. See
        /// [`with_weights`](ClothMesh::with_weights).
        weights: Vec<f32>,
    },
}

impl ClothMesh {
    /// A grid of `columns` × `rows` particles over `width` × `height` metres.
    #[must_use]
    pub const fn grid(columns: u32, rows: u32, width: f32, height: f32) -> Self {
        Self::Grid { columns, rows, width, height }
    }

    /// A mesh of triangles: positions in metres, three indices a triangle, and texture coordinates,
    /// one a vertex or none.
    #[must_use]
    pub const fn triangles(positions: Vec<Vec3>, indices: Vec<u32>, uv: Vec<Vec2>) -> Self {
        Self::Triangles { positions, indices, uv, weights: Vec::new() }
    }

    /// Simulates only what moves: a weight for each vertex, from 0 to 1.
    ///
    /// | Weight | |
    /// | --- | --- |
    /// | 1 | simulated |
    /// | between | simulated, and shown between there and its place: that part of the way |
    /// | 0 | rigid: stays in its place in the cloth's frame, to the last bit |
    ///
    /// Triangles of which all vertices have weight 0 are no cloth: they have no particles and cost
    /// no tick anything. A vertex of weight 0 on other triangles is pinned, so that the simulated
    /// part hangs on the rigid one.
    ///
    /// A grid becomes triangles, which bend less exactly. Weights that cannot be used are reported in
    /// a [`ClothFailed`](crate::ClothFailed) event.
    #[must_use]
    pub fn with_weights(self, weights: Vec<f32>) -> Self {
        let builder = self.builder();
        if builder.positions().is_empty() {
            // A grid that is none, to be reported as such.
            return self;
        }
        Self::Triangles {
            positions: builder.positions().to_vec(),
            indices: builder.indices().to_vec(),
            uv: self.uvs(),
            weights,
        }
    }

    /// Weights of all vertices; none where everything is simulated.
    pub(crate) fn weights(&self) -> &[f32] {
        match self {
            Self::Grid { .. } => &[],
            Self::Triangles { weights, .. } => weights,
        }
    }

    /// The grid, if it is one.
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

    /// Texture coordinates of all vertices; none for triangles without.
    pub(crate) fn uvs(&self) -> Vec<Vec2> {
        match self {
            Self::Grid { columns, rows, .. } => {
                let fraction = |index: u32, count: u32| index as f32 / (count.max(2) - 1) as f32;
                (0..*rows)
                    .flat_map(|row| (0..*columns).map(move |column| (column, row)))
                    .map(|(column, row)| {
                        Vec2::new(fraction(column, *columns), fraction(row, *rows))
                    })
                    .collect()
            }
            Self::Triangles { uv, .. } => uv.clone(),
        }
    }

    /// The builder of the fabric that it is cut from, without pins.
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

/// What a cloth is made of; flag polyester by default. It may be changed at any time: each cloth
/// has its own, whatever it shares a fabric with.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothMaterial(
    /// The material's values, in SI units.
    #[reflect(remote = FabricMaterialReflect)]
    pub FabricMaterial,
);

impl ClothMaterial {
    /// [`FabricMaterial::FLAG_POLYESTER`].
    pub const FLAG_POLYESTER: Self = Self(FabricMaterial::FLAG_POLYESTER);
    /// [`FabricMaterial::NYLON`].
    pub const NYLON: Self = Self(FabricMaterial::NYLON);
    /// [`FabricMaterial::COTTON`].
    pub const COTTON: Self = Self(FabricMaterial::COTTON);
    /// [`FabricMaterial::SILK`].
    pub const SILK: Self = Self(FabricMaterial::SILK);
    /// [`FabricMaterial::DENIM`].
    pub const DENIM: Self = Self(FabricMaterial::DENIM);
}

/// Stops a cloth while it is there: the cloth keeps its shape, goes with its frame, and costs
/// nothing. Removed, the cloth goes on from where it was.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothPaused;
