//! Bending constraints: an edge, and the two corners that fold about it.

use glam::Vec3;

use super::colour::{Classes, Colours, colour, rounded_bits};
use super::topology::Edge;

/// A bending constraint between two triangles that share an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hinge {
    /// The edge's two ends, then the corners opposite to it.
    pub particles: [u32; 4],
    /// Signed angle between the triangles' normals at rest, rad; zero is flat.
    pub rest_angle: f32,
    /// Index into [`Fabric::hinge_classes`](super::Fabric::hinge_classes).
    pub class: u32,
}

/// How stiff a hinge is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HingeClass {
    /// Stiffness in N·m/rad² is this times the material's bending stiffness.
    pub weight: f32,
}

impl HingeClass {
    /// Stiffness of the hinge in a material, N·m.
    #[must_use]
    pub fn stiffness(&self, material: &super::FabricMaterial) -> f32 {
        self.weight * material.bend_stiffness
    }
}

/// The usual hinge energy ½ B · 3|e|²/(A₁+A₂) θ² overrates a cylinder's bending threefold on
/// equilateral meshes and on grids along their axes, at every resolution: so no 3 here.
const HINGE_CALIBRATION: f32 = 1.0;

/// A hinge at a clamp, where the cloth leaves pinned ground, covers half a cell: with a weight of
/// two a heavy cantilever converges at second order instead of first.
const CLAMP_WEIGHT: f32 = 2.0;

/// Makes a hinge of each edge between two triangles, except where nothing can move.
pub(crate) fn hinges(
    rest: &[Vec3],
    edges: &[Edge],
    pinned: &[bool],
) -> (Vec<Hinge>, Vec<HingeClass>, Colours) {
    let mut table = Vec::new();
    let mut classes = Classes::new();
    let is_pinned = |particle: u32| pinned[particle as usize];
    let hinges = edges
        .iter()
        .filter_map(|edge| {
            let ([a, b], c, d) = (edge.ends, edge.opposite, edge.other_opposite?);
            let particles = [a, b, c, d];
            if particles.iter().all(|&particle| is_pinned(particle)) {
                return None;
            }
            let corners = particles.map(|particle| rest[particle as usize]);
            let [pa, pb, pc, pd] = corners;
            let edge_squared = pa.distance_squared(pb);
            let areas =
                0.5 * ((pb - pa).cross(pc - pa).length() + (pb - pa).cross(pd - pa).length());
            let at_clamp = is_pinned(a) && is_pinned(b) && (is_pinned(c) || is_pinned(d));
            let clamp = if at_clamp { CLAMP_WEIGHT } else { 1.0 };
            let weight = clamp * HINGE_CALIBRATION * edge_squared / areas;
            let (class, is_new) = classes.class_of([rounded_bits(weight)]);
            if is_new {
                table.push(HingeClass { weight });
            }
            Some(Hinge { particles, rest_angle: angle(corners), class })
        })
        .collect();
    let (hinges, colours) = colour(rest.len(), hinges, |hinge: &Hinge| &hinge.particles, |_| 0);
    (hinges, table, colours)
}

/// Signed angle between the normals of the triangles (a, b, c) and (b, a, d), rad: atan2 of sine
/// and cosine, since arccos (thesis, eq. 4.19) is singular at flat and blind to the side.
pub(crate) fn angle([a, b, c, d]: [Vec3; 4]) -> f32 {
    let edge = (b - a).normalize();
    let normal = edge.cross(c - a).normalize();
    let other = (d - a).cross(edge).normalize();
    libm::atan2f(normal.cross(other).dot(edge), normal.dot(other))
}
