//! Errors of regions.

/// Reason why a [`MaterialRegion`](crate::MaterialRegion) cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegionError {
    /// A factor is too small, too large or not a number.
    #[error(
        "its factor {name} is {value}: give one from {least} to {most}, or 0 to a bending that is to vanish",
        least = super::factors::LEAST,
        most = super::factors::GREATEST
    )]
    Factor {
        /// The field's name.
        name: &'static str,
        /// Value of the field.
        value: f32,
    },
    /// The number of weights of vertices differs from the number of vertices.
    #[error("it has {weights} weights for {vertices} vertices: give one per vertex")]
    WeightCount {
        /// Number of weights given.
        weights: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A weight is not a number from 0 to 1.
    #[error("weight {index} is {weight}: give one from 0, outside of the region, to 1, within it")]
    Weight {
        /// Index of the weight in its list.
        index: usize,
        /// The weight.
        weight: f32,
    },
    /// The pixels of an image don't make whole rows, or a depth has no values.
    #[error(
        "{weights} weights in rows of {columns} make no image or curve: give whole rows, at least one"
    )]
    Rows {
        /// Number of weights given.
        weights: usize,
        /// Number of weights in a row.
        columns: u32,
    },
    /// A coordinate of a box or a line is not finite, or a line has no length or no width.
    #[error(
        "its place in the texture has a {name} of {value}: give finite coordinates, two different ends to a line, and a positive width"
    )]
    Place {
        /// Name of what is wrong.
        name: &'static str,
        /// Its value.
        value: f32,
    },
    /// The region is given by texture coordinates, which the mesh lacks.
    #[error(
        "it is given by texture coordinates, which the mesh lacks: give the mesh some, or give the region weights of vertices"
    )]
    NoUv,
}
