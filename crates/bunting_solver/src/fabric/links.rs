//! Distance constraints ("links"): the particles that they join, and their stiffnesses.
//!
//! Each triangle of a grid gives its three edges the stiffnesses with which links in those directions reproduce the
//! material's moduli: Σ q c⁴ = A C₁₁, Σ q s⁴ = A C₂₂ and Σ q c²s² = A G, with q = k l² for an edge of
//! stiffness k and length l, (c, s) its direction in the material and A the triangle's area. If a triangle's
//! directions do not determine q, least squares selects the smallest solution. On a grid, whose cells are
//! split both ways, this is the textbook k = Y × width / length for warp and weft and G L²/(2 Δx Δy) for
//! diagonals, exactly.

use glam::{DMat3, DVec3, Vec2, Vec3};

use super::classes::{Classes, rounded_bits};
use super::colour::colour;
use super::edge_sums::EdgeSums;
use super::grid::Grid;
use super::material::FabricMaterial;
use super::mesh::RestMesh;
use super::regions::Variation;

/// A distance constraint between two particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// The two particles.
    pub particles: [u32; 2],
    /// Distance at rest, m.
    pub rest_length: f32,
    /// Index into [`Links::classes`].
    pub(crate) class: u32,
    /// Direction in the cloth.
    pub family: LinkFamily,
}

/// A link by which the motion of a cloth is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Probe {
    pub particles: [u32; 2],
    /// One over the square of its length at rest, 1/m².
    pub inverse_length_squared: f32,
}

/// Most [`Probe`]s of a fabric. Fewer: the root mean square over all links is missed by more than a tenth. More: a
/// tick takes longer.
const MOST_PROBES: usize = 128;

/// Least distance of two [`Probe`]s in the list of links: of small cloths, which are many, every third link is enough.
const LEAST_PROBE_DISTANCE: usize = 3;

/// The direction of a link in the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LinkFamily {
    /// Along the warp (u).
    Warp,
    /// Along the weft (v).
    Weft,
    /// Across a cell: the link resists shear.
    Diagonal,
}

impl LinkFamily {
    /// That of a link between two particles of a cell. Of two columns a diagonal joins consecutive particles, too.
    fn on_grid(grid: &Grid, ends: [u32; 2]) -> Self {
        let [one, other] = ends.map(|end| (end % grid.columns, end / grid.columns));
        if one.1 == other.1 {
            Self::Warp
        } else if one.0 == other.0 {
            Self::Weft
        } else {
            Self::Diagonal
        }
    }
}

/// Stiffness of a link for any material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinkClass {
    /// Factors of the material's C₁₁, C₂₂ and G, whose sum is the stiffness in N/m.
    pub coefficients: [f32; 3],
    /// Least stiffness, as a fraction of the material's smaller stretch stiffness.
    pub floor: f32,
    /// cos² of the angle between the rows of the grid and the warp, where it varies from link to link; else one.
    pub warp_cos2: f32,
    /// Factor on the stiffness by regions in which the material differs.
    pub factor: f32,
}

impl LinkClass {
    /// Of a family's modulus alone.
    pub fn of_family(family: LinkFamily, coefficient: f32, warp_cos2: f32) -> Self {
        let mut coefficients = [0.0; 3];
        coefficients[family as usize] = coefficient;
        let floor = LEAST_STIFFNESS as f32 * coefficient;
        Self { coefficients, floor, warp_cos2, factor: 1.0 }
    }

    /// Stiffness of the link for a material, N/m, if diagonals resist stretch, too: with
    /// [`FabricMaterial::lattice_moduli`].
    pub fn stiffness(&self, material: &FabricMaterial) -> f32 {
        // Coefficients of zero are skipped: an inextensible material's moduli are infinite.
        let material = &material.turned(self.warp_cos2);
        let moduli = material.lattice_moduli();
        let stiffness = self.combined(moduli, |coefficient| coefficient != 0.0);
        stiffness.max(self.least(material)) * self.factor
    }

    /// Stiffness of the link for a material, N/m, if diagonals resist shear alone (`constraints/shear.rs`).
    /// Warp and weft then carry all of the stretch: the material's own moduli hold, and negative
    /// coefficients, which compensate for the diagonals, are left out.
    pub fn uncoupled_stiffness(&self, material: &FabricMaterial) -> f32 {
        let material = &material.turned(self.warp_cos2);
        let FabricMaterial { warp_stiffness, weft_stiffness, shear_stiffness, .. } = *material;
        let moduli = [warp_stiffness, weft_stiffness, shear_stiffness];
        let stiffness = self.combined(moduli, |coefficient| coefficient > 0.0);
        stiffness.max(self.least(material)) * self.factor
    }

    /// The sum of the moduli times those coefficients for which `counts` holds.
    fn combined(&self, moduli: [f32; 3], counts: fn(f32) -> bool) -> f32 {
        let terms = self.coefficients.iter().zip(moduli).filter(|(factor, _)| counts(**factor));
        // The library's sum of no terms is −0, of which the compliance would be −∞.
        let sum = terms.fold(0.0, |sum, (factor, modulus)| sum + factor * modulus);
        // A sum of ∞ − ∞ is not a number; the link is then inextensible.
        if sum.is_nan() { f32::INFINITY } else { sum }
    }

    fn least(&self, material: &FabricMaterial) -> f32 {
        self.floor * material.warp_stiffness.min(material.weft_stiffness)
    }
}

/// Least stiffness of a link, as a fraction of its stiffness in an isotropic mesh (Van Gelder 1998). Smaller:
/// a mesh cannot hold its shape on links whose stiffness is zero or negative. Larger: shear-soft materials
/// shear too little.
pub(super) const LEAST_STIFFNESS: f64 = 0.02;

/// Size, relative to the normal equations, of the term that selects the smallest solution if a triangle's
/// three directions do not determine it (as for an equilateral triangle). Smaller: the inverse is dominated
/// by rounding. Larger: stiffnesses of other triangles are off by as much.
const RIDGE: f64 = 1e-7;

/// Magnitude below which coefficients are rounding errors of the ridge, and count as zero. Larger:
/// coefficients of triangles nearly along the warp are lost.
const LEAST_COEFFICIENT: f64 = 1e-4;

/// The links of a fabric.
#[derive(Clone, Debug)]
pub(crate) struct Links {
    /// Links of warp, weft and diagonals in this order; within each, colour by colour.
    pub list: Vec<Link>,
    /// Table of stiffnesses that links refer to.
    pub classes: Vec<LinkClass>,
}

impl Links {
    /// Links along the rows, columns and both diagonals of a grid, given cos² of the angle between its rows and the warp, and how the
    /// material varies. A link between two pinned particles moves nothing and is left out.
    pub fn of(mesh: &RestMesh, grid: &Grid, warp_cos2: f32, variation: &Variation) -> Self {
        let mut sums = EdgeSums::new(mesh.positions.len());
        let along_rows = grid.uvs();
        // A cell is split both ways, and each way contributes half.
        for flipped in [false, true] {
            for triangle in grid.triangles(flipped) {
                let uv = triangle.map(|corner| along_rows[corner as usize]);
                add_triangle(&mut sums, mesh, triangle, uv, 0.5);
            }
        }
        let links = sums.sorted().map(|(ends, sum)| {
            let factor = variation.of_link(ends);
            let class = LinkClass { warp_cos2, factor, ..sum.class() };
            (ends, class, LinkFamily::on_grid(grid, ends))
        });
        Self::of_classes(mesh, links)
    }

    /// Links between particles, with their stiffnesses and families.
    pub(super) fn of_classes(
        mesh: &RestMesh,
        links: impl Iterator<Item = ([u32; 2], LinkClass, LinkFamily)>,
    ) -> Self {
        let is_free = |ends: &[u32; 2]| !ends.iter().all(|&end| mesh.is_pinned(end));
        let links = links.filter(|(ends, ..)| is_free(ends));
        let mut table = Vec::new();
        let mut classes = Classes::new();
        let links = links.map(|(particles, value, family)| {
            let [a, b, c] = value.coefficients;
            let key = [a, b, c, value.floor, value.warp_cos2, value.factor];
            let (class, is_new) = classes.class_of(key.map(rounded_bits));
            if is_new {
                table.push(value);
            }
            let [a, b] = mesh.positions_of(particles);
            Link { particles, rest_length: a.distance(b), class, family }
        });
        let (list, _) = colour(
            mesh.positions.len(),
            links.collect(),
            |link: &Link| &link.particles,
            |link| link.family as u32,
        );
        Self { list, classes: table }
    }

    /// Length of the shortest link of warp and weft, m.
    pub fn shortest(&self) -> f32 {
        let straight = self.list.iter().filter(|link| link.family != LinkFamily::Diagonal);
        straight.map(|link| link.rest_length).fold(f32::INFINITY, f32::min)
    }

    /// Links of warp and weft, evenly spread over the list of them.
    pub fn probes(&self) -> Vec<Probe> {
        let straight: Vec<&Link> =
            self.list.iter().filter(|link| link.family != LinkFamily::Diagonal).collect();
        // An odd distance, so that rows of an even number of links are not met at the same column.
        let distance = straight.len().div_ceil(MOST_PROBES).max(LEAST_PROBE_DISTANCE) | 1;
        let probe = |link: &&Link| Probe {
            particles: link.particles,
            inverse_length_squared: 1.0 / (link.rest_length * link.rest_length),
        };
        straight.iter().step_by(distance).map(probe).collect()
    }
}

/// Sums over the triangles on both sides of an edge, for its link.
#[derive(Default)]
struct LinkSum {
    /// Factors of C₁₁, C₂₂ and G.
    coefficients: [f64; 3],
    /// Factor of Young's modulus in an isotropic mesh.
    isotropic: f64,
}

impl LinkSum {
    fn class(&self) -> LinkClass {
        LinkClass {
            coefficients: self.coefficients.map(|coefficient| {
                if coefficient.abs() < LEAST_COEFFICIENT { 0.0 } else { coefficient as f32 }
            }),
            floor: (LEAST_STIFFNESS * self.isotropic) as f32,
            warp_cos2: 1.0,
            factor: 1.0,
        }
    }
}

/// Adds the contributions of a fraction `part` of a triangle to the links along its edges.
fn add_triangle(
    sums: &mut EdgeSums<LinkSum>,
    mesh: &RestMesh,
    triangle: [u32; 3],
    uv: [Vec2; 3],
    part: f64,
) {
    let [a, b, c] = triangle;
    let corners = mesh.positions_of(triangle);
    let area = 0.5 * f64::from((corners[1] - corners[0]).cross(corners[2] - corners[0]).length());
    let edges = [[a, b], [b, c], [c, a]];
    let warp = warp_direction(corners, uv);
    // Rows of c⁴, s⁴ and c²s², one for each edge.
    let rows = edges.map(|ends| {
        let [from, to] = mesh.positions_of(ends);
        let edge = to - from;
        let cos2 = f64::from(edge.dot(warp).powi(2) / edge.length_squared()).clamp(0.0, 1.0);
        DVec3::new(cos2 * cos2, (1.0 - cos2).powi(2), cos2 * (1.0 - cos2))
    });
    // Least squares for q with three columns of right sides, one for each modulus.
    let system = DMat3::from_cols(rows[0], rows[1], rows[2]);
    let normal = system.transpose() * system + DMat3::from_diagonal(DVec3::splat(RIDGE));
    let solution = normal.inverse() * system.transpose();
    for (index, ends) in edges.into_iter().enumerate() {
        let [one, other] = mesh.positions_of(ends);
        let scale = part * area / f64::from(other.distance_squared(one));
        let sum = sums.at(ends, LinkSum::default);
        let found = (solution.row(index) * scale).to_array();
        for (coefficient, found) in sum.coefficients.iter_mut().zip(found) {
            *coefficient += found;
        }
        sum.isotropic += scale;
    }
}

/// Direction in which u grows, in the triangle's plane; the direction of its first edge if the texture does
/// not determine it.
pub(super) fn warp_direction(corners: [Vec3; 3], uv: [Vec2; 3]) -> Vec3 {
    along_u(corners, uv).unwrap_or_else(|| (corners[1] - corners[0]).normalize_or_zero())
}

/// Direction in which u grows, in the triangle's plane; none if the texture does not determine it.
pub(super) fn along_u([a, b, c]: [Vec3; 3], [uv_a, uv_b, uv_c]: [Vec2; 3]) -> Option<Vec3> {
    let (e1, e2) = (b - a, c - a);
    let (t1, t2) = (uv_b - uv_a, uv_c - uv_a);
    ((e1 * t2.y - e2 * t1.y) * t1.perp_dot(t2).signum()).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::FabricBuilder;

    #[test]
    fn grid_links_have_the_textbook_stiffness() {
        let grid = Grid::new(4, 5, 0.9, 2.0);
        let (dx, dy) = (0.3, 0.5);
        let fabric = FabricBuilder::grid(grid).build().expect("a good fabric");
        let material = FabricMaterial {
            warp_stiffness: 900.0,
            weft_stiffness: 700.0,
            shear_stiffness: 40.0,
            ..FabricMaterial::DENIM
        };
        let [c11, c22, g] = material.lattice_moduli();
        for link in fabric.links() {
            let [a, b] = link.particles;
            let on_border = |count: u32, at: u32| at == 0 || at == count - 1;
            let (width, height) = (grid.columns, grid.rows);
            let expected = match link.family {
                LinkFamily::Warp => {
                    (c11 - g * dx * dx / (dy * dy)) * dy / dx
                        * if on_border(height, a / width) { 0.5 } else { 1.0 }
                }
                LinkFamily::Weft => {
                    (c22 - g * dy * dy / (dx * dx)) * dx / dy
                        * if on_border(width, a % width) { 0.5 } else { 1.0 }
                }
                LinkFamily::Diagonal => g * (dx * dx + dy * dy) / (2.0 * dx * dy),
            };
            let stiffness = fabric.link_stiffness(link, &material);
            assert!((stiffness / expected - 1.0).abs() < 2e-3, "{a}–{b}: {stiffness} {expected}");
        }
        assert!(fabric.link_classes().len() <= 6, "{:?}", fabric.link_classes());
    }
}
