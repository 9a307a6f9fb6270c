//! How finely a cloth is simulated.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::Resolution;

/// How finely a [`ClothMesh`](crate::ClothMesh) of triangles is simulated.
///
/// Triangles are made for the eye, and seldom good for cloth: those of a game's cape are too coarse to drape, those of a
/// garment too fine, and loads do not run along their edges. Such a mesh is simulated with particles of the simulation's own,
/// on lines along warp and weft at about the same distance everywhere, and its vertices follow. Coarser levels of detail have
/// cells twice as large each. A [`ClothMesh::grid`](crate::ClothMesh::grid) is simulated as it is, whatever the resolution; if it is
/// held at [points](crate::AttachedVertices::Points) beside its vertices, with about as many particles of its own.
///
/// What is drawn has the triangles of the mesh; a `ClothSubdivision` (feature `render`) halves those that are larger than the cells of the
/// simulation, whose folds they would hide.
///
/// The numbers of the vertices stay those of the mesh wherever vertices are named, as in
/// [`AttachedVertices::List`](crate::AttachedVertices::List); [`ClothState::vertex_position`](crate::ClothState::vertex_position)
/// reads them.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// fn spawn(mut commands: Commands, cape: ClothMesh) {
///     // Cells of three centimetres, whatever the triangles of the cape.
///     commands.spawn((cape, ClothResolution::CellSize(0.03), Attachment::in_place(ClothEdge::Top)));
/// }
/// ```
///
/// # Errors
///
/// A [`ClothFailed`](crate::ClothFailed) event tells that the mesh can't be divided into cells, or that there would be too
/// many.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub enum ClothResolution {
    /// About a thousand particles.
    #[default]
    Auto,
    /// Size of the cells between particles, m in the world.
    CellSize(f32),
    /// About this number of particles.
    Particles(u32),
}

impl ClothResolution {
    /// That of the solver.
    pub(crate) fn of_solver(self) -> Resolution {
        match self {
            Self::Auto => Resolution::Auto,
            Self::CellSize(size) => Resolution::CellSize(size),
            Self::Particles(count) => Resolution::Particles(count),
        }
    }

    /// A key that tells it from others.
    pub(crate) fn key(self) -> [u32; 2] {
        match self {
            Self::Auto => [0, 0],
            Self::CellSize(size) => [1, size.to_bits()],
            Self::Particles(count) => [2, count],
        }
    }
}
