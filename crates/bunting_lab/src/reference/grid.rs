//! The discrete cloth: a rectangular grid of springs calibrated to a continuum.
//!
//! Warp, weft and both diagonals of every cell are linear springs ½k(|d|−l)². A diagonal of length L
//! has k = G L²/(2 dx dy), so that two of them store ½G∫γ². They also resist stretch; the stiffness of
//! the warp and weft links is lowered for that, so that a uniaxial test of the sheet measures the
//! fabric's own modulus. Bending is the quadratic energy ½B∫(|x_uu|² + 2|x_uv|² + |x_vv|²) of Bergou
//! et al. 2006 ("A quadratic bending model for inextensible surfaces") on a regular grid: three points
//! along rows and columns, four points for the twist.

use glam::{DVec3, UVec3, uvec3};

use crate::scenes::{Fabric, Scene};

/// Direction of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along a row.
    Warp,
    /// Along a column.
    Weft,
    /// Across a cell.
    Diagonal,
}

/// A linear spring between two vertices.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// First vertex.
    pub a: usize,
    /// Second vertex.
    pub b: usize,
    /// Length at rest, m.
    pub rest: f64,
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Direction of the link.
    pub direction: Direction,
}

/// Bending along a yarn: energy ½ stiffness |a − 2b + c|².
#[derive(Clone, Copy, Debug)]
pub struct Bend {
    /// Vertices a, b, c in order.
    pub vertices: [usize; 3],
    /// Stiffness, N/m.
    pub stiffness: f64,
}

/// Twist of a cell: energy ½ stiffness |a − b − c + d|².
#[derive(Clone, Copy, Debug)]
pub struct Twist {
    /// Vertices (i, j), (i+1, j), (i, j+1), (i+1, j+1).
    pub vertices: [usize; 4],
    /// Stiffness, N/m.
    pub stiffness: f64,
}

/// The grid cloth of a scene.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Lumped masses, kg: a quarter of each bordering cell.
    pub masses: Vec<f64>,
    /// Reciprocal masses, 1/kg; zero where pinned.
    pub inverse_masses: Vec<f64>,
    /// Stretch and shear springs.
    pub links: Vec<Link>,
    /// Bending along rows and columns.
    pub bends: Vec<Bend>,
    /// Twist of the cells.
    pub twists: Vec<Twist>,
    /// Triangles, two a cell; the diagonal alternates from cell to cell.
    pub triangles: Vec<UVec3>,
    /// Corners of the cells.
    pub cells: Vec<[usize; 4]>,
}

impl Grid {
    /// The grid of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let cells: Vec<[usize; 4]> = cells(scene).map(|(_, corners)| corners).collect();
        let masses = lumped_masses(scene, &cells);
        let inverse_masses = masses
            .iter()
            .enumerate()
            .map(|(v, m)| if scene.is_pinned(v) { 0.0 } else { 1.0 / m })
            .collect();
        Self {
            masses,
            inverse_masses,
            links: links(scene),
            bends: bends(scene),
            twists: twists(scene),
            triangles: triangles(scene),
            cells,
        }
    }

    /// Length of each warp and weft link over its length at rest, less one.
    pub fn strains<'a>(&'a self, positions: &'a [DVec3]) -> impl Iterator<Item = f64> + 'a {
        self.links
            .iter()
            .filter(|link| link.direction != Direction::Diagonal)
            .map(|link| positions[link.a].distance(positions[link.b]) / link.rest - 1.0)
    }

    /// An upper bound of the highest angular frequency, rad/s, by Gershgorin's circles.
    #[must_use]
    pub fn highest_frequency(&self) -> f64 {
        let mut rows = vec![0.0; self.masses.len()];
        for link in &self.links {
            rows[link.a] += 2.0 * link.stiffness;
            rows[link.b] += 2.0 * link.stiffness;
        }
        for bend in &self.bends {
            for (vertex, weight) in bend.vertices.into_iter().zip([1.0, 2.0, 1.0]) {
                rows[vertex] += 4.0 * weight * bend.stiffness;
            }
        }
        for twist in &self.twists {
            for vertex in twist.vertices {
                rows[vertex] += 4.0 * twist.stiffness;
            }
        }
        rows.iter().zip(&self.inverse_masses).map(|(row, w)| row * w).fold(0.0, f64::max).sqrt()
    }
}

/// Stiffness per metre of width of the warp and weft links, N/m, such that links and diagonals
/// together have the fabric's uniaxial moduli.
fn link_moduli(fabric: &Fabric, [dx, dy]: [f64; 2]) -> [f64; 2] {
    let ([warp, weft], shear) = (fabric.stretch, fabric.shear);
    let a = 0.5 * warp * (1.0 + (1.0 + 4.0 * shear * shear / (warp * weft)).sqrt());
    [a - shear * (dx / dy).powi(2), a * weft / warp - shear * (dy / dx).powi(2)]
}

/// Width in cells that belongs to line `k` of `count`: a half on the border.
fn tributary(k: usize, count: usize) -> f64 {
    if k == 0 || k + 1 == count { 0.5 } else { 1.0 }
}

fn links(scene: &Scene) -> Vec<Link> {
    let (columns, rows) = (scene.columns, scene.rows);
    let [dx, dy] = scene.spacing();
    let [warp, weft] = link_moduli(&scene.fabric, [dx, dy]);
    let diagonal = dx.hypot(dy);
    let diagonal_stiffness = scene.fabric.shear * diagonal * diagonal / (2.0 * dx * dy);
    let mut links = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let a = j * columns + i;
            if i + 1 < columns {
                let stiffness = warp * tributary(j, rows) * dy / dx;
                links.push(Link { a, b: a + 1, rest: dx, stiffness, direction: Direction::Warp });
            }
            if j + 1 < rows {
                let stiffness = weft * tributary(i, columns) * dx / dy;
                links.push(Link {
                    a,
                    b: a + columns,
                    rest: dy,
                    stiffness,
                    direction: Direction::Weft,
                });
            }
            if i + 1 < columns && j + 1 < rows && diagonal_stiffness > 0.0 {
                for (a, b) in [(a, a + columns + 1), (a + 1, a + columns)] {
                    let direction = Direction::Diagonal;
                    links.push(Link {
                        a,
                        b,
                        rest: diagonal,
                        stiffness: diagonal_stiffness,
                        direction,
                    });
                }
            }
        }
    }
    links
}

/// Curvature along rows and columns. At a clamp (two neighbours pinned, the third free) the hinge
/// covers half a cell and has twice the stiffness.
fn bends(scene: &Scene) -> Vec<Bend> {
    let (columns, rows) = (scene.columns, scene.rows);
    let [dx, dy] = scene.spacing();
    let mut bends = Vec::new();
    let mut push = |vertices: [usize; 3], stiffness: f64| {
        let [a, b, c] = vertices.map(|v| scene.is_pinned(v));
        let clamp = if b && a != c { 2.0 } else { 1.0 };
        if stiffness > 0.0 {
            bends.push(Bend { vertices, stiffness: clamp * stiffness });
        }
    };
    for j in 0..rows {
        for i in 0..columns {
            let b = j * columns + i;
            if i > 0 && i + 1 < columns {
                push(
                    [b - 1, b, b + 1],
                    scene.fabric.bending * tributary(j, rows) * dy / dx.powi(3),
                );
            }
            if j > 0 && j + 1 < rows {
                push(
                    [b - columns, b, b + columns],
                    scene.fabric.bending * tributary(i, columns) * dx / dy.powi(3),
                );
            }
        }
    }
    bends
}

fn twists(scene: &Scene) -> Vec<Twist> {
    let [dx, dy] = scene.spacing();
    let stiffness = 2.0 * scene.fabric.bending / (dx * dy);
    if stiffness == 0.0 {
        return Vec::new();
    }
    cells(scene).map(|(_, vertices)| Twist { vertices, stiffness }).collect()
}

fn triangles(scene: &Scene) -> Vec<UVec3> {
    cells(scene)
        .flat_map(|(even, corners)| {
            let [a, b, c, d] = corners.map(|v| v as u32);
            if even { [uvec3(a, c, d), uvec3(a, d, b)] } else { [uvec3(a, c, b), uvec3(b, c, d)] }
        })
        .collect()
}

/// Corners of every cell, and whether i + j is even.
fn cells(scene: &Scene) -> impl Iterator<Item = (bool, [usize; 4])> {
    let columns = scene.columns;
    (0..scene.rows - 1).flat_map(move |j| {
        (0..columns - 1).map(move |i| {
            let a = j * columns + i;
            ((i + j) % 2 == 0, [a, a + 1, a + columns, a + columns + 1])
        })
    })
}

fn lumped_masses(scene: &Scene, cells: &[[usize; 4]]) -> Vec<f64> {
    let [dx, dy] = scene.spacing();
    let corner_mass = scene.fabric.density * dx * dy / 4.0;
    let mut masses = vec![0.0; scene.vertices()];
    for &vertex in cells.as_flattened() {
        masses[vertex] += corner_mass;
    }
    masses
}
