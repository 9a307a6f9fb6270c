//! Distance constraints: which particles they join, and how stiff they are.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3, Vec2, Vec3};

use super::colour::{Classes, Colours, colour, rounded_bits};
use super::material::FabricMaterial;

/// A distance constraint between two particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// The two particles.
    pub particles: [u32; 2],
    /// Distance at rest, m.
    pub rest_length: f32,
    /// Index into [`Fabric::link_classes`](super::Fabric::link_classes).
    pub class: u32,
    /// Direction in the cloth.
    pub family: LinkFamily,
}

/// The direction of a link in the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LinkFamily {
    /// Within 22.5° of the warp (u).
    Warp,
    /// Within 22.5° of the weft (v).
    Weft,
    /// In between: carries shear.
    Bias,
}

/// How stiff a link is, as weights of the material's moduli.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkClass {
    /// Stiffness in N/m is the sum of these times
    /// [`FabricMaterial::lattice_moduli`](super::FabricMaterial::lattice_moduli).
    pub weights: [f32; 3],
    /// Least stiffness, as a part of the material's softer stretch stiffness.
    pub floor: f32,
}

impl LinkClass {
    /// Stiffness of the link in a material, N/m.
    #[must_use]
    pub fn stiffness(&self, material: &FabricMaterial) -> f32 {
        // Zero weights are skipped: an inextensible material's moduli are infinite.
        self.of_moduli(material.lattice_moduli(), |weight| weight != 0.0).max(self.least(material))
    }

    /// The same where the bias carries shear alone (`constraints/bias.rs`), so that what warp and weft
    /// leave to it is theirs.
    pub(crate) fn stiffness_beside_shear(&self, material: &FabricMaterial) -> f32 {
        let FabricMaterial { warp_stiffness, weft_stiffness, shear_stiffness, .. } = *material;
        let moduli = [warp_stiffness, weft_stiffness, shear_stiffness];
        self.of_moduli(moduli, |weight| weight > 0.0).max(self.least(material))
    }

    fn of_moduli(&self, moduli: [f32; 3], counts: fn(f32) -> bool) -> f32 {
        let weights = self.weights.iter().zip(moduli).filter(|(weight, _)| counts(**weight));
        let sum: f32 = weights.map(|(weight, modulus)| weight * modulus).sum();
        // An infinite modulus of either sign leaves no number behind; it means inextensible.
        if sum.is_nan() { f32::INFINITY } else { sum }
    }

    fn least(&self, material: &FabricMaterial) -> f32 {
        self.floor * material.warp_stiffness.min(material.weft_stiffness)
    }
}

/// Least stiffness of a link as a part of that which an isotropic mesh would give it (Van Gelder
/// 1998): a lattice cannot hold its shape on links that weigh nothing or less.
const LEAST_LINK_STIFFNESS: f64 = 0.02;

/// Relative size of the term that picks the smallest solution where a triangle's three directions
/// do not tell the moduli apart (an equilateral one, say).
const RIDGE: f64 = 1e-7;

/// A weight below this is the ridge's rounding, not geometry.
const NO_WEIGHT: f64 = 1e-4;

/// cos² of the angle to the warp above which a link counts as warp: 22.5°.
const FAMILY_COS2: f64 = 0.853_553_390_6;

/// A link before its class is known.
pub(crate) struct LinkGeometry {
    particles: [u32; 2],
    weights: [f64; 3],
    isotropic: f64,
    cos2: f64,
    share: f64,
}

/// A mesh at rest, whose triangles are spread over links.
pub(crate) struct Sheet<'a> {
    pub rest: &'a [Vec3],
    pub uv: &'a [Vec2],
}

impl Sheet<'_> {
    /// Adds a triangle's share to its three edges, such that links whose directions are those of
    /// the triangle reproduce C₁₁, C₂₂ and G: Σ q c⁴ = A C₁₁, Σ q s⁴ = A C₂₂, Σ q c²s² = A G with
    /// q = k l² and (c, s) an edge's direction in the material. On a grid this gives k = Y × width /
    /// length to warp and weft and G L²/(2 Δx Δy) to the diagonals, exactly.
    pub fn add_links(
        &self,
        links: &mut BTreeMap<[u32; 2], LinkGeometry>,
        triangle: [u32; 3],
        share: f64,
    ) {
        let [a, b, c] = triangle;
        let corners = triangle.map(|corner| self.rest[corner as usize]);
        let area =
            0.5 * f64::from((corners[1] - corners[0]).cross(corners[2] - corners[0]).length());
        let edges = [[a, b], [b, c], [c, a]];
        let warp = self.warp_direction(triangle);
        let rows = edges.map(|[from, to]| {
            let edge = self.rest[to as usize] - self.rest[from as usize];
            let cos2 = f64::from(edge.dot(warp).powi(2) / edge.length_squared()).clamp(0.0, 1.0);
            DVec3::new(cos2 * cos2, (1.0 - cos2).powi(2), cos2 * (1.0 - cos2))
        });
        // Least squares for q with three columns of right sides, one a modulus.
        let system = DMat3::from_cols(rows[0], rows[1], rows[2]);
        let normal = system.transpose() * system + DMat3::from_diagonal(DVec3::splat(RIDGE));
        let solution = normal.inverse() * system.transpose();
        for (index, [from, to]) in edges.into_iter().enumerate() {
            let ends = [from.min(to), from.max(to)];
            let length2 =
                f64::from(self.rest[to as usize].distance_squared(self.rest[from as usize]));
            let scale = share * area / length2;
            let link = links.entry(ends).or_insert(LinkGeometry {
                particles: ends,
                weights: [0.0; 3],
                isotropic: 0.0,
                cos2: 0.0,
                share: 0.0,
            });
            let weights = solution.row(index) * scale;
            link.weights[0] += weights.x;
            link.weights[1] += weights.y;
            link.weights[2] += weights.z;
            link.isotropic += scale;
            link.cos2 += share * (rows[index].x + rows[index].z);
            link.share += share;
        }
    }

    /// The direction in which u grows, in the triangle's plane; along its first edge if the texture
    /// does not say.
    fn warp_direction(&self, [a, b, c]: [u32; 3]) -> Vec3 {
        let (a, b, c) = (a as usize, b as usize, c as usize);
        let (e1, e2) = (self.rest[b] - self.rest[a], self.rest[c] - self.rest[a]);
        let (t1, t2) = (self.uv[b] - self.uv[a], self.uv[c] - self.uv[a]);
        let along_u = (e1 * t2.y - e2 * t1.y) * t1.perp_dot(t2).signum();
        along_u.try_normalize().unwrap_or_else(|| e1.normalize_or_zero())
    }
}

/// Colours the links, warp first, and gathers their stiffnesses into classes. A link between two
/// pinned particles has nothing to move and is left out.
pub(crate) fn finish(
    rest: &[Vec3],
    pinned: &[bool],
    geometry: impl Iterator<Item = LinkGeometry>,
) -> (Vec<Link>, Vec<LinkClass>, Colours) {
    let mut table = Vec::new();
    let mut classes = Classes::new();
    let links = geometry
        .filter(|link| !link.particles.iter().all(|&particle| pinned[particle as usize]))
        .map(|link| {
            let weights = link
                .weights
                .map(|weight| if weight.abs() < NO_WEIGHT { 0.0 } else { weight as f32 });
            let floor = (LEAST_LINK_STIFFNESS * link.isotropic) as f32;
            let (class, is_new) =
                classes.class_of([weights[0], weights[1], weights[2], floor].map(rounded_bits));
            if is_new {
                table.push(LinkClass { weights, floor });
            }
            let cos2 = link.cos2 / link.share;
            let family = if cos2 > FAMILY_COS2 {
                LinkFamily::Warp
            } else if cos2 < 1.0 - FAMILY_COS2 {
                LinkFamily::Weft
            } else {
                LinkFamily::Bias
            };
            let [a, b] = link.particles;
            let rest_length = rest[a as usize].distance(rest[b as usize]);
            Link { particles: link.particles, rest_length, class, family }
        })
        .collect();
    let (links, colours) =
        colour(rest.len(), links, |link: &Link| &link.particles, |link| link.family as u32);
    (links, table, colours)
}

/// Length of the shortest link of warp and weft, m.
pub(super) fn shortest(links: &[Link]) -> f32 {
    let stretching = links.iter().filter(|link| link.family != LinkFamily::Bias);
    stretching.map(|link| link.rest_length).fold(f32::INFINITY, f32::min)
}
