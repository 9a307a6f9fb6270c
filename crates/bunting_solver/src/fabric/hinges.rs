//! Bending of any mesh: hinges, each an edge and the two corners opposite to it.

use glam::Vec3;

use super::clamp::CLAMP_FACTOR;
use super::classes::{Classes, rounded_bits};
use super::colour::colour;
use super::material::FabricMaterial;
use super::mesh::RestMesh;
use super::regions::Variation;
use super::topology::Edge;

/// A bending constraint between two triangles that share an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hinge {
    /// The two ends of the edge, then the corners opposite to it.
    pub particles: [u32; 4],
    /// Signed angle between the triangles' normals at rest, rad; zero is flat.
    pub rest_angle: f32,
    /// Index into [`Hinges::classes`].
    pub class: u32,
}

/// Stiffness of a hinge for any material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HingeClass {
    /// Factor of the material's bending stiffness (N·m) in the hinge's stiffness (N·m/rad²).
    pub coefficient: f32,
}

impl HingeClass {
    /// Stiffness of the hinge for a material, N·m/rad².
    pub fn stiffness(&self, material: &FabricMaterial) -> f32 {
        self.coefficient * material.bend_stiffness
    }
}

/// Factor of |e|²/(A₁+A₂) in a hinge's stiffness. The usual energy, ½ B · 3|e|²/(A₁+A₂) θ², is three times
/// that of a bent cylinder on equilateral meshes and on grids along their axes, at every resolution: hence 1
/// and not 3.
const CALIBRATION: f32 = 1.0;

/// The hinges of a fabric.
#[derive(Clone, Debug)]
pub(crate) struct Hinges {
    /// Hinges, colour by colour.
    pub list: Vec<Hinge>,
    /// Table of stiffnesses that hinges refer to.
    pub classes: Vec<HingeClass>,
}

impl Hinges {
    /// One hinge at each edge between two triangles, unless all four particles are pinned.
    pub fn of(mesh: &RestMesh, edges: &[Edge], variation: &Variation) -> Self {
        let mut table = Vec::new();
        let mut classes = Classes::new();
        let hinge = |edge: &Edge| {
            let ([a, b], c, d) = (edge.ends, edge.side.opposite, edge.other_side?.opposite);
            let particles = [a, b, c, d];
            if particles.iter().all(|&particle| mesh.is_pinned(particle)) {
                return None;
            }
            let corners = mesh.positions_of(particles);
            let at_clamp =
                mesh.is_pinned(a) && mesh.is_pinned(b) && (mesh.is_pinned(c) || mesh.is_pinned(d));
            let coefficient = coefficient(corners, at_clamp) * variation.of_hinge(edge.ends);
            let (class, is_new) = classes.class_of([rounded_bits(coefficient)]);
            if is_new {
                table.push(HingeClass { coefficient });
            }
            Some(Hinge { particles, rest_angle: angle(corners), class })
        };
        let hinges = edges.iter().filter_map(hinge).collect();
        let (list, _) =
            colour(mesh.positions.len(), hinges, |hinge: &Hinge| &hinge.particles, |_| 0);
        Self { list, classes: table }
    }
}

/// |e|²/(A₁+A₂) of the triangles (a, b, c) and (b, a, d), with the clamp's factor.
fn coefficient([a, b, c, d]: [Vec3; 4], at_clamp: bool) -> f32 {
    let areas = 0.5 * ((b - a).cross(c - a).length() + (b - a).cross(d - a).length());
    let clamp = if at_clamp { CLAMP_FACTOR } else { 1.0 };
    clamp * CALIBRATION * a.distance_squared(b) / areas
}

/// Signed angle between the normals of the triangles (a, b, c) and (b, a, d), rad, by atan2 of sine and
/// cosine: the arccos of the thesis (eq. 4.19) is singular at a flat hinge and has no sign.
pub(crate) fn angle([a, b, c, d]: [Vec3; 4]) -> f32 {
    let edge = (b - a).normalize();
    let normal = edge.cross(c - a).normalize();
    let other = (d - a).cross(edge).normalize();
    libm::atan2f(normal.cross(other).dot(edge), normal.dot(other))
}
