//! A particle that joints move, by linear blend skinning.

use bevy_math::{Affine3A, Mat3A, Vec3, Vec3A};
use bunting_solver::Backstop;

/// A particle and the joints that move it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkinnedParticle {
    /// Position at rest, m.
    pub rest: Vec3,
    /// Unit normal at rest.
    pub normal: Vec3,
    pub joints: [u16; 4],
    /// Weights of the joints, whose sum is 1.
    pub weights: [f32; 4],
    /// m.
    pub max_distance: f32,
    pub backstop: Backstop,
    /// Weight of the simulated position where the particle is shown.
    pub simulated: f32,
}

/// The animated place of a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// In the cloth's frame, m.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
}

impl SkinnedParticle {
    /// The matrix from the space of the mesh to the cloth's frame.
    pub fn matrix(&self, matrices: &[Affine3A]) -> Affine3A {
        if self.weights == [0.0; 4] {
            return Affine3A::IDENTITY;
        }
        let mut sum = Affine3A { matrix3: Mat3A::ZERO, translation: Vec3A::ZERO };
        for (&joint, &weight) in self.joints.iter().zip(&self.weights) {
            if weight > 0.0 {
                let matrix = &matrices[joint as usize];
                sum.matrix3 += matrix.matrix3 * weight;
                sum.translation += matrix.translation * weight;
            }
        }
        sum
    }

    pub fn place(&self, matrices: &[Affine3A]) -> Place {
        let matrix = self.matrix(matrices);
        Place {
            position: matrix.transform_point3(self.rest),
            normal: matrix.transform_vector3(self.normal).normalize_or_zero(),
        }
    }
}
