//! Functions on a mesh whose gradients come nearest to wanted ones.

use glam::DVec3;

use super::laplacian::Laplacian;

/// Square of the residual that is left, relative to the integral of the squared gradients.
const ACCURATE: f64 = 1e-10;

/// The functions that are linear on each triangle.
pub(super) struct GradientFit<'a> {
    triangles: &'a [[u32; 3]],
    /// Areas of the triangles, m².
    areas: &'a [f32],
    /// For each triangle the gradients of the functions that are one at a corner and zero at the others, 1/m.
    gradients: Vec<[DVec3; 3]>,
    laplacian: Laplacian,
}

impl<'a> GradientFit<'a> {
    /// Of triangles, given as indices of values, with the places of their corners in space, m.
    pub fn new(
        triangles: &'a [[u32; 3]],
        corners: impl Iterator<Item = [DVec3; 3]>,
        areas: &'a [f32],
        count: usize,
    ) -> Self {
        let gradients: Vec<[DVec3; 3]> = corners.map(gradients_of).collect();
        // The integral of the product of the gradients at both ends of a side.
        let weights = |triangle: usize| {
            let gradients = &gradients[triangle];
            let weight = |at: usize| -gradients[(at + 1) % 3].dot(gradients[(at + 2) % 3]);
            [0, 1, 2].map(|at| f64::from(areas[triangle]) * weight(at))
        };
        let laplacian = Laplacian::of(triangles, weights, count);
        Self { triangles, areas, gradients, laplacian }
    }

    /// The gradient in a triangle of the function with these values at its corners, 1/m.
    pub fn gradient(&self, triangle: usize, values: [f64; 3]) -> DVec3 {
        combined(self.gradients[triangle], values)
    }

    /// The function u with the least integral of |∇u − `wanted`|², the wanted gradient of each triangle, from one near it.
    /// Some of its values are fixed. None if it is not found.
    pub fn solved(
        &self,
        mut values: Vec<f64>,
        is_fixed: impl Fn(usize) -> bool,
        wanted: impl Fn(usize) -> DVec3,
    ) -> Option<Vec<f64>> {
        let mut right_side = vec![0.0; values.len()];
        let mut scale = 0.0;
        for (triangle, corners) in self.triangles.iter().enumerate() {
            let area = f64::from(self.areas[triangle]);
            let present = self.gradient(triangle, corners.map(|corner| values[corner as usize]));
            let wanted = wanted(triangle);
            for (&corner, gradient) in corners.iter().zip(&self.gradients[triangle]) {
                right_side[corner as usize] += area * gradient.dot(wanted - present);
            }
            scale += area * (present.length_squared() + wanted.length_squared());
        }
        let change = self.laplacian.solve(right_side, is_fixed, ACCURATE * scale)?;
        values.iter_mut().zip(change).for_each(|(value, change)| *value += change);
        Some(values)
    }
}

/// The gradient in a triangle of the function with these values at its corners, 1/m.
pub(super) fn gradient(corners: [DVec3; 3], values: [f64; 3]) -> DVec3 {
    combined(gradients_of(corners), values)
}

/// The sum of the corners' gradients times their values.
fn combined([a, b, c]: [DVec3; 3], values: [f64; 3]) -> DVec3 {
    a * values[0] + b * values[1] + c * values[2]
}

/// The gradients of the functions that are one at a corner of a triangle and zero at the others, 1/m.
fn gradients_of([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let normal = (b - a).cross(c - a);
    let scaled = normal / normal.length_squared();
    [c - b, a - c, b - a].map(|opposite| scaled.cross(opposite))
}
