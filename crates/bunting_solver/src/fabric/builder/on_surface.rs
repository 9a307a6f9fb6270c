//! What is simulated of a surface.

use crate::fabric::fabric::Fabric;
use crate::fabric::interpolation::Term;
use crate::fabric::remesh::OnNodes;

/// A fabric, and how the places of the mesh that it was made from follow.
pub(super) struct OnSurface {
    pub fabric: Fabric,
    /// How places follow the particles.
    pub on_nodes: OnNodes,
    /// The particle at each place, or one near it.
    pub particles: Vec<u32>,
    /// The places around each particle with their weights.
    pub corners: Vec<Vec<Term>>,
}
