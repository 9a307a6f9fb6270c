//! Weights of a mesh's vertices: which of them are simulated, and which are rigid.

/// Why the weights of a [`ClothMesh`](crate::ClothMesh) cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WeightsError {
    /// The number of weights differs from the number of vertices and is not zero.
    #[error("{weights} weights for {vertices} vertices: give one a vertex, or none")]
    Count {
        /// Number of weights given.
        weights: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A weight is not a number from 0 to 1.
    #[error("vertex {vertex} has the weight {weight}: give it one from 0, rigid, to 1, simulated")]
    OutOfRange {
        /// Index of the vertex in the mesh.
        vertex: usize,
        /// The invalid weight.
        weight: f32,
    },
    /// All weights are 0, so that nothing would be simulated.
    #[error(
        "all weights are 0: give the vertices that should move a weight above 0, or leave out the ClothMesh"
    )]
    AllRigid,
}

/// Checks the weights of a mesh with the given number of vertices; an empty list is valid.
///
/// # Errors
///
/// The number of weights differs from that of the vertices, a weight is not within 0 to 1, or all are 0.
pub(crate) fn check_weights(weights: &[f32], vertices: usize) -> Result<(), WeightsError> {
    if weights.is_empty() {
        return Ok(());
    }
    if weights.len() != vertices {
        return Err(WeightsError::Count { weights: weights.len(), vertices });
    }
    if let Some(vertex) = weights.iter().position(|weight| !(0.0..=1.0).contains(weight)) {
        return Err(WeightsError::OutOfRange { vertex, weight: weights[vertex] });
    }
    if weights.iter().all(|&weight| weight == 0.0) {
        return Err(WeightsError::AllRigid);
    }
    Ok(())
}
