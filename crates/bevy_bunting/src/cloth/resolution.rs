//! How finely a cloth is simulated.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::Resolution;

/// How finely a [`ClothMesh`](crate::ClothMesh) of triangles is simulated: with its own vertices, or with particles of the
/// simulation's own.
///
/// Triangles are made for the eye, and seldom good for cloth: those of a game's cape are too coarse to drape, those of a
/// garment too fine, and loads do not run along their edges. A cloth with a cell size or a number of particles is simulated
/// on lines along warp and weft, at about the same distance everywhere, and its mesh follows. Coarser levels of detail have
/// cells twice as large each.
///
/// What is drawn has the triangles of the mesh: folds that are narrower than these are simulated, and not seen.
///
/// The numbers of the vertices stay those of the mesh wherever vertices are named, as in
/// [`AttachedVertices::List`](crate::AttachedVertices::List); [`ClothState::vertex_position`](crate::ClothState::vertex_position)
/// reads them. A [`ClothMesh::grid`](crate::ClothMesh::grid) is simulated as it is.
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
    /// Each vertex is simulated.
    #[default]
    Vertices,
    /// Size of the cells between particles, m in the world.
    CellSize(f32),
    /// About this number of particles.
    Particles(u32),
}

impl ClothResolution {
    /// That of the solver; none if the vertices are simulated.
    pub(crate) fn of_solver(self) -> Option<Resolution> {
        match self {
            Self::Vertices => None,
            Self::CellSize(size) => Some(Resolution::CellSize(size)),
            Self::Particles(count) => Some(Resolution::Particles(count)),
        }
    }

    /// A key that tells it from others.
    pub(crate) fn key(self) -> [u32; 2] {
        match self {
            Self::Vertices => [0, 0],
            Self::CellSize(size) => [1, size.to_bits()],
            Self::Particles(count) => [2, count],
        }
    }
}
