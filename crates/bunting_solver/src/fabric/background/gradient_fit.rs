//! Functions on a mesh whose gradients come nearest to wanted ones.

use glam::{BVec2, DVec2, DVec3};

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

    /// The two functions u with the least integrals of |∇u − `wanted`|², the wanted gradients of each triangle, from two near them.
    /// Some of their values are fixed. None if they are not found, or not wanted after they are known roughly.
    pub fn solved(
        &self,
        values: &[DVec2],
        is_fixed: impl Fn(usize) -> BVec2,
        wanted: impl Fn(usize) -> [DVec3; 2],
        goes_on: impl FnOnce(Vec<DVec2>) -> bool,
    ) -> Option<Vec<DVec2>> {
        let mut right_sides = vec![DVec2::ZERO; values.len()];
        let mut scales = DVec2::ZERO;
        for (triangle, corners) in self.triangles.iter().enumerate() {
            let area = f64::from(self.areas[triangle]);
            for (axis, wanted) in wanted(triangle).into_iter().enumerate() {
                let of_corners = corners.map(|corner| values[corner as usize][axis]);
                let present = self.gradient(triangle, of_corners);
                for (&corner, gradient) in corners.iter().zip(&self.gradients[triangle]) {
                    right_sides[corner as usize][axis] += area * gradient.dot(wanted - present);
                }
                scales[axis] += area * (present.length_squared() + wanted.length_squared());
            }
        }
        let changed = |by: &[DVec2]| values.iter().zip(by).map(|(value, by)| value + by).collect();
        let goes_on = |by: &[DVec2]| goes_on(changed(by));
        let by = self.laplacian.solve(right_sides, is_fixed, ACCURATE * scales, goes_on)?;
        Some(changed(&by))
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
