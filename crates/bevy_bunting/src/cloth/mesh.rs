//! The shape of a cloth at rest.

use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec2, Vec3};
use bevy_reflect::Reflect;
use bevy_transform::components::Transform;
use bunting_solver::{FabricBuilder, FabricError, Grid, MeshPoint, MeshRepair};

use crate::cloth::instance::ClothInstance;
use crate::cloth::material::ClothMaterial;
use crate::cloth::missing_plugins::tell_missing_plugins;
use crate::cloth::state::ClothState;
use crate::lod::effort::ClothEffort;
use crate::lod::lod_set::LodSet;
use crate::lod::record::LodRecord;
use crate::lod::rest_timer::RestTimer;
use crate::motion::pose::PoseHistory;

/// The shape of a cloth at rest. This component makes an entity a cloth: the other components that a cloth
/// needs are required by it and inserted with it.
///
/// Positions are in the cloth's frame: the entity's own [`Transform`] or, with an
/// [`Attachment`](crate::Attachment) to another entity, the pose of the target times the offset. The
/// scale of the entity and of all above it, or of the offset, is baked into the cloth when it is made, with shear by
/// turned non-uniform scales. A later change of scale by one factor in all directions makes the cloth grow, see
/// [`ClothState::scale`](crate::ClothState::scale); others are reported, and count when this component is inserted again. A
/// [`ClothSkin`](crate::ClothSkin) scales the cloth by its joints, and the mesh has the figure's size.
///
/// A mesh that cannot be simulated is reported in a [`ClothFailed`](crate::ClothFailed) event.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec3;
///
/// // A sheet of a metre by two, and a triangle.
/// let sheet = ClothMesh::grid(17, 33, 1.0, 2.0);
/// let pennant = ClothMesh::Triangles {
///     positions: vec![Vec3::ZERO, Vec3::new(1.0, -0.3, 0.0), 0.6 * Vec3::NEG_Y],
///     indices: vec![0, 2, 1],
///     uv: vec![],
///     weights: vec![],
///     merged: vec![],
/// };
/// # assert_eq!((sheet.vertex_count(), pennant.vertex_count()), (17 * 33, 3));
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Debug, PartialEq, Clone)]
#[component(on_add = tell_missing_plugins)]
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
    /// A rectangular grid of particles, which is simulated as it is. The origin is the top left corner and the front faces +z; u grows
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
    /// A rectangular grid of particles that lies flat, which is simulated as it is. The origin is the middle and the front faces +y; u
    /// grows along +x, v along +z.
    Sheet {
        /// Particles in a row, at least 2.
        columns: u32,
        /// Number of rows, at least 2.
        rows: u32,
        /// Extent along a row, m.
        width: f32,
        /// Extent across the rows, m.
        depth: f32,
    },
    /// A mesh of triangles. How finely it is simulated is said by a [`ClothResolution`](crate::ClothResolution).
    Triangles {
        /// Positions of the vertices, m.
        positions: Vec<Vec3>,
        /// Three vertices a triangle, counter-clockwise seen from the front.
        indices: Vec<u32>,
        /// Texture coordinates, one for each vertex or none at all: the warp runs along u.
        #[reflect(default)]
        uv: Vec<Vec2>,
        /// Weights from 0 (rigid) to 1 (simulated), one for each vertex. An empty list simulates all
        /// vertices. See [`with_weights`](ClothMesh::with_weights).
        #[reflect(default)]
        weights: Vec<f32>,
        /// For each vertex a number that it shares with those of the same particle. An empty list merges
        /// vertices at one position. A [repaired](ClothMesh::repaired) mesh has numbers: vertices that were
        /// split lie at one position.
        #[reflect(default)]
        merged: Vec<u32>,
    },
}

impl ClothMesh {
    /// A grid of `columns` × `rows` particles over `width` × `height` metres.
    #[must_use]
    pub const fn grid(columns: u32, rows: u32, width: f32, height: f32) -> Self {
        Self::Grid { columns, rows, width, height }
    }

    /// A grid of `columns` × `rows` particles over `width` × `depth` metres that lies flat: a tablecloth, a towel, a net. Its middle is
    /// the origin.
    ///
    /// ```
    /// use bevy_bunting::prelude::*;
    /// use bevy_transform::prelude::*;
    ///
    /// // A tablecloth falls onto the middle of a table.
    /// let cloth = (ClothMesh::sheet(33, 33, 1.6, 1.6), Transform::from_xyz(0.0, 0.8, 0.0));
    /// # assert_eq!(cloth.0.vertex_count(), 33 * 33);
    /// ```
    #[must_use]
    pub const fn sheet(columns: u32, rows: u32, width: f32, depth: f32) -> Self {
        Self::Sheet { columns, rows, width, depth }
    }

    /// A mesh of triangles: positions in metres, three indices for each triangle, and texture coordinates,
    /// one for each vertex or none at all.
    #[must_use]
    pub const fn triangles(positions: Vec<Vec3>, indices: Vec<u32>, uv: Vec<Vec2>) -> Self {
        Self::Triangles { positions, indices, uv, weights: Vec::new(), merged: Vec::new() }
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
    /// The method turns a grid into triangles, which are simulated with particles of their own, see
    /// [`ClothResolution`](crate::ClothResolution). Invalid weights are reported in a [`ClothFailed`](crate::ClothFailed) event.
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
            merged: builder.merged().to_vec(),
            uv: self.uvs(),
            weights,
        }
    }

    /// Repairs a mesh as artists ship them, and says what was done: triangles without area and duplicates are
    /// removed, edges of more than two triangles are split, and the winding is made consistent. Vertices
    /// without triangles are left out and split ones have copies, so that vertices are numbered anew:
    /// [`MeshRepair::vertices`] names the vertex that each comes from. Grids need no repair.
    ///
    /// # Errors
    ///
    /// [`FabricError::OneSided`] if a piece has no consistent winding, as a Möbius strip;
    /// [`FabricError::Empty`] if no triangle is left; the errors of lists that do not fit one another and of
    /// numbers that are not finite.
    pub fn repaired(self) -> Result<(Self, MeshRepair), FabricError> {
        let (builder, repair) = self.builder().repair()?;
        let Self::Triangles { uv, weights, .. } = self else { return Ok((self, repair)) };
        let vertices = || repair.vertices.iter().map(|&vertex| vertex as usize);
        let repaired = Self::Triangles {
            positions: builder.positions().to_vec(),
            indices: builder.indices().to_vec(),
            uv: vertices().filter_map(|vertex| uv.get(vertex).copied()).collect(),
            weights: vertices().filter_map(|vertex| weights.get(vertex).copied()).collect(),
            merged: builder.merged().to_vec(),
        };
        Ok((repaired, repair))
    }

    /// Weights of all vertices; empty where all vertices are simulated.
    pub(crate) fn weights(&self) -> &[f32] {
        match self {
            Self::Grid { .. } | Self::Sheet { .. } => &[],
            Self::Triangles { weights, .. } => weights,
        }
    }

    /// For each vertex a number that it shares with those of the same particle; empty where vertices at one
    /// position are merged.
    pub(crate) fn merged(&self) -> &[u32] {
        match self {
            Self::Grid { .. } | Self::Sheet { .. } => &[],
            Self::Triangles { merged, .. } => merged,
        }
    }

    /// The grid; none for triangles.
    pub(crate) fn as_grid(&self) -> Option<Grid> {
        match *self {
            Self::Grid { columns, rows, width, height } => {
                Some(Grid::new(columns, rows, width, height))
            }
            Self::Sheet { columns, rows, width, depth } => {
                Some(Grid::new(columns, rows, width, depth))
            }
            Self::Triangles { .. } => None,
        }
    }

    /// Number of vertices, by which an [`AttachedVertices::List`](crate::AttachedVertices::List) names them.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        match self {
            Self::Grid { columns, rows, .. } | Self::Sheet { columns, rows, .. } => {
                *columns as usize * *rows as usize
            }
            Self::Triangles { positions, .. } => positions.len(),
        }
    }

    /// The point of the mesh at rest nearest to a position in its own frame, m, for
    /// [`AttachedVertices::Points`](crate::AttachedVertices::Points); none without triangles.
    #[must_use]
    pub fn nearest_point(&self, to: Vec3) -> Option<MeshPoint> {
        self.builder().nearest_point(to)
    }

    /// Texture coordinates of all vertices; empty for triangles without.
    pub(crate) fn uvs(&self) -> Vec<Vec2> {
        match (self, self.as_grid()) {
            (Self::Triangles { uv, .. }, _) => uv.clone(),
            (_, grid) => grid.map_or_else(Vec::new, |grid| grid.uvs()),
        }
    }

    /// A builder of the fabric of the whole mesh, without pins.
    pub(crate) fn builder(&self) -> FabricBuilder {
        match self {
            Self::Grid { columns, rows, width, height } => {
                FabricBuilder::grid(Grid::new(*columns, *rows, *width, *height))
            }
            Self::Sheet { columns, rows, width, depth } => {
                let grid = FabricBuilder::grid(Grid::new(*columns, *rows, *width, *depth));
                // Its front from +z to +y, its middle to the origin.
                let lie = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
                grid.placed(lie, Vec3::new(-0.5 * width, 0.0, -0.5 * depth))
            }
            Self::Triangles { positions, indices, uv, merged, .. } => {
                FabricBuilder::new(positions.clone(), indices.clone())
                    .uv(uv.clone())
                    .merge(merged.clone())
            }
        }
    }
}

impl From<Grid> for ClothMesh {
    fn from(grid: Grid) -> Self {
        Self::grid(grid.columns, grid.rows, grid.width, grid.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::attached::Attached;
    use crate::fabric::simulated::SimulatedPart;

    #[test]
    fn a_repaired_mesh_stays_split_and_keeps_what_its_vertices_have() {
        // Two triangles that touch in vertex 2 only, and vertex 1 without triangles.
        let positions = [
            Vec3::ZERO,
            Vec3::splat(9.0),
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::X,
            Vec3::new(2.0, 1.0, 0.0),
            Vec3::new(2.0, 2.0, 0.0),
        ];
        let uv: Vec<Vec2> = positions.iter().map(|at| at.truncate()).collect();
        let given = ClothMesh::triangles(positions.to_vec(), vec![0, 3, 2, 2, 4, 5], uv);
        let given = given.with_weights(vec![1.0, 1.0, 0.0, 1.0, 0.5, 1.0]);
        let (mesh, repair) = given.repaired().expect("a mesh that can be repaired");
        assert_eq!((&repair.vertices[..], &repair.loose[..]), (&[0, 2, 3, 4, 5, 2][..], &[1][..]));
        assert_eq!(mesh.weights(), [1.0, 0.0, 1.0, 0.5, 1.0, 0.0]);
        assert_eq!(mesh.uvs()[5], Vec2::ONE);
        let places = |builder: &FabricBuilder| builder.particle_count();
        assert_eq!(places(&mesh.builder()), 6, "the split vertex is in two places");
        let part = SimulatedPart::of(&mesh, &Attached::default()).expect("a part");
        assert_eq!(places(&part.builder), 6, "in parts, too");
        let weighted = mesh.with_weights(vec![1.0; 6]);
        assert_eq!(places(&weighted.builder()), 6, "and stays in two");
        let grid = ClothMesh::grid(3, 3, 1.0, 1.0);
        assert_eq!(grid.clone().repaired().map(|(mesh, _)| mesh), Ok(grid));
    }
}
