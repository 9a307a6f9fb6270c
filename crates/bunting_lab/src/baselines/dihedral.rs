//! Bending by the angle between two triangles (thesis, equations 4.19 to 4.33; Müller et al. 2007,
//! "Position based dynamics", appendix A).
//!
//! The thesis's final correction (4.34) holds for equal masses only; the step here is the general one
//! of its equations 4.13 and 4.14.

use glam::Vec3;

/// Sine of the angle below which a hinge counts as flat, since the gradient of the arc cosine is singular
/// there.
const FLAT: f32 = 1e-3;

/// Two triangles that share the edge between the first two vertices.
#[derive(Clone, Copy, Debug)]
pub struct Hinge {
    /// Ends of the shared edge, then the two opposite vertices.
    pub vertices: [usize; 4],
}

/// The hinges of a triangle list.
#[must_use]
pub fn hinges(triangles: &[[usize; 3]]) -> Vec<Hinge> {
    let mut edges: Vec<([usize; 2], usize)> = triangles
        .iter()
        .flat_map(|[a, b, c]| [([*a, *b], *c), ([*b, *c], *a), ([*c, *a], *b)])
        .map(|([a, b], opposite)| ([a.min(b), a.max(b)], opposite))
        .collect();
    edges.sort_unstable();
    edges
        .windows(2)
        .filter(|pair| pair[0].0 == pair[1].0)
        .map(|pair| Hinge { vertices: [pair[0].0[0], pair[0].0[1], pair[0].1, pair[1].1] })
        .collect()
}

impl Hinge {
    /// Moves the four vertices a fraction `stiffness` of the way to the flat shape, whose normals
    /// (2, 3) and (2, 4) point in opposite directions (thesis, figure 4.7).
    pub fn project(&self, stiffness: f32, positions: &mut [Vec3], inverse_masses: &[f32]) {
        let [p1, p2, p3, p4] = self.vertices.map(|v| positions[v]);
        let (p2, p3, p4) = (p2 - p1, p3 - p1, p4 - p1);
        let (cross3, cross4) = (p2.cross(p3), p2.cross(p4));
        let (size3, size4) = (cross3.length_squared().sqrt(), cross4.length_squared().sqrt());
        if size3 == 0.0 || size4 == 0.0 {
            return;
        }
        let (n1, n2) = (cross3 / size3, cross4 / size4);
        let cosine = n1.dot(n2).clamp(-1.0, 1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        if sine < FLAT {
            return;
        }
        let q3 = (p2.cross(n2) + n1.cross(p2) * cosine) / size3;
        let q4 = (p2.cross(n1) + n2.cross(p2) * cosine) / size4;
        let q2 = -(p3.cross(n2) + n1.cross(p3) * cosine) / size3
            - (p4.cross(n1) + n2.cross(p4) * cosine) / size4;
        let gradients = [-q2 - q3 - q4, q2, q3, q4];
        let inverse = self.vertices.map(|v| inverse_masses[v]);
        let mobility: f32 =
            gradients.iter().zip(inverse).map(|(q, w)| w * q.length_squared()).sum();
        if mobility == 0.0 {
            return;
        }
        let scale = stiffness * sine * (cosine.acos() - std::f32::consts::PI) / mobility;
        for ((v, q), w) in self.vertices.into_iter().zip(gradients).zip(inverse) {
            positions[v] -= q * (w * scale);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Angle in radians left after repeated projections of a right angle.
    const ANGLE_TOLERANCE: f32 = 0.01;

    #[test]
    fn a_folded_hinge_unfolds() {
        let mut positions =
            [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1.0, 0.0), Vec3::new(0.5, 0.0, 1.0)];
        let [hinge] = hinges(&[[0, 1, 2], [1, 0, 3]])[..] else { panic!("one hinge") };
        for _ in 0..40 {
            hinge.project(1.0, &mut positions, &[1.0, 1.0, 2.0, 0.5]);
        }
        let [a, b, c, d] = hinge.vertices.map(|v| positions[v]);
        let angle = (b - a).cross(c - a).angle_between((d - a).cross(b - a));
        assert!(angle < ANGLE_TOLERANCE, "{angle} rad");
    }
}
