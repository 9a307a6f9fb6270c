//! Reasons why a seam cannot be sewn.

/// Defect of a [`Seam`](crate::Seam); the message says what to do.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SeamError {
    /// A side has no vertices.
    #[error(
        "its {} side has no vertices: name some; an edge of a mesh without uv has none",
        if *.side == 0 { "first" } else { "second" }
    )]
    Empty {
        /// Index of the side, 0 or 1.
        side: usize,
    },
    /// A side names a vertex that is not simulated.
    #[error(
        "vertex {vertex} is not simulated: name vertices that the ClothMesh has, with weights greater than 0"
    )]
    Vertex {
        /// The vertex.
        vertex: u32,
    },
    /// A place on the way of a side is not finite.
    #[error("a place on its way is not finite: give finite places in the mesh's frame")]
    Place,
    /// A number cannot be.
    #[error(
        "its {name} cannot be {value}: give a finite number that is not negative, and for closed at most 1"
    )]
    Number {
        /// Name of the field.
        name: &'static str,
        /// Its value.
        value: f32,
    },
}
