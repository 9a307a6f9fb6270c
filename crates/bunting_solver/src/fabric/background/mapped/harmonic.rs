//! Functions on a mesh with the smallest gradients.

use glam::Vec3;

use super::Cut;
use crate::fabric::mesh::RestMesh;

/// Most steps of conjugate gradients.
const STEPS: usize = 3000;

/// Square of the residual, relative to that at first, that is left.
const ACCURATE: f64 = 1e-16;

/// The Laplacian of linear functions on the triangles of a mesh.
pub(super) struct Laplacian {
    /// For each triangle half the cotangents of its angles.
    weights: Vec<[f64; 3]>,
    particles: Vec<[u32; 3]>,
    count: usize,
}

impl Laplacian {
    pub fn of(mesh: &RestMesh) -> Self {
        let weights = |corners: &[u32; 3]| {
            let corners = mesh.positions_of(*corners).map(Vec3::as_dvec3);
            [0, 1, 2].map(|at| {
                let [to, from] = [1, 2].map(|by| corners[(at + by) % 3] - corners[at]);
                0.5 * to.dot(from) / to.cross(from).length()
            })
        };
        Self {
            weights: mesh.triangles.iter().map(weights).collect(),
            particles: mesh.triangles.clone(),
            count: mesh.positions.len(),
        }
    }

    /// The function of the particles with the least integral of its squared gradient, where some have fixed values; on a
    /// mesh that is cut open the values of places differ by their turns. By conjugate gradients (Hestenes and Stiefel
    /// 1952); none if they do not converge.
    pub fn solved(
        &self,
        fixed: &[Option<f64>],
        triangles: &[[u32; 3]],
        cut: Option<&Cut>,
    ) -> Option<Vec<f64>> {
        let turns: Vec<[f64; 3]> = match cut {
            Some(cut) => {
                triangles.iter().map(|at| at.map(|place| cut.turns[place as usize])).collect()
            }
            None => vec![[0.0; 3]; triangles.len()],
        };
        let no_turns = vec![[0.0; 3]; triangles.len()];
        let conditioner: Vec<f64> = {
            let mut diagonal = vec![0.0; self.count];
            for (particles, weights) in self.particles.iter().zip(&self.weights) {
                for (at, weight) in weights.iter().enumerate() {
                    diagonal[particles[(at + 1) % 3] as usize] += weight;
                    diagonal[particles[(at + 2) % 3] as usize] += weight;
                }
            }
            diagonal.iter().map(|value| if *value > 0.0 { 1.0 / value } else { 1.0 }).collect()
        };
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let conditioned = |residual: &[f64]| -> Vec<f64> {
            residual.iter().zip(&conditioner).map(|(value, scale)| value * scale).collect()
        };
        let mut values: Vec<f64> = fixed.iter().map(|fixed| fixed.unwrap_or(0.5)).collect();
        let mut residual = self.pull(&values, &turns, fixed);
        residual.iter_mut().for_each(|value| *value = -*value);
        let mut step = conditioned(&residual);
        let mut size = dot(&residual, &step);
        let accurate = ACCURATE * size;
        for _ in 0..STEPS {
            if size <= accurate {
                return Some(values);
            }
            let change = self.pull(&step, &no_turns, fixed);
            let length = size / dot(&step, &change);
            for (value, step) in values.iter_mut().zip(&step) {
                *value += step * length;
            }
            for (residual, change) in residual.iter_mut().zip(&change) {
                *residual -= change * length;
            }
            let scaled = conditioned(&residual);
            let before = core::mem::replace(&mut size, dot(&residual, &scaled));
            for (step, scaled) in step.iter_mut().zip(scaled) {
                *step = scaled + *step * (size / before);
            }
        }
        None
    }

    /// The derivatives of half the integral of the squared gradient by the values that are free.
    fn pull(&self, values: &[f64], turns: &[[f64; 3]], fixed: &[Option<f64>]) -> Vec<f64> {
        let mut pull = vec![0.0; values.len()];
        for ((particles, weights), turns) in self.particles.iter().zip(&self.weights).zip(turns) {
            for (at, weight) in weights.iter().enumerate() {
                let [from, to] = [1, 2].map(|by| (at + by) % 3);
                let value = |corner: usize| values[particles[corner] as usize] + turns[corner];
                let of_edge = weight * (value(to) - value(from));
                pull[particles[to] as usize] += of_edge;
                pull[particles[from] as usize] -= of_edge;
            }
        }
        for (pull, fixed) in pull.iter_mut().zip(fixed) {
            if fixed.is_some() {
                *pull = 0.0;
            }
        }
        pull
    }
}
