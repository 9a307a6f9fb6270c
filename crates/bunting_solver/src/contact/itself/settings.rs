//! How a cloth keeps its layers apart.

/// How a cloth keeps its layers apart: particles and triangles, and edges and edges, that are not neighbours. Friction
/// between them is that of the material.
///
/// ```
/// use bunting_solver::SelfCollision;
///
/// let layers = SelfCollision { thickness: 0.005 };
/// # assert!(layers.thickness > 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfCollision {
    /// Distance that layers keep, m: particles from triangles, and edges from edges. Less where the fabric's own
    /// layers are nearer at rest.
    pub thickness: f32,
}

impl SelfCollision {
    /// Whether the thickness is finite and greater than zero.
    pub(crate) fn is_valid(&self) -> bool {
        self.thickness.is_finite() && self.thickness > 0.0
    }
}
