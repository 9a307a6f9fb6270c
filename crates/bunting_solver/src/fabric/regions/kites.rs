//! Samples of the parts of cells that belong to particles: of each corner the kite to the middles of its two sides and of the cell.

use glam::{Vec2, Vec3};

use crate::fabric::mesh::RestMesh;

/// Number of samples along each side of a kite. Fewer: the edges of images are frayed. More: fabrics take longer to build.
const SAMPLES: usize = 4;

/// Change of the texture along a side of a cell, in units of that along most sides, from which on the side crosses a seam of the texture.
/// Smaller: stretched textures count as seams. Larger: regions leak across seams.
const SEAM: f32 = 4.0;

/// A sample of a cell.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub uv: Vec2,
    /// Changes of texture coordinates to the next samples in two directions.
    pub uv_steps: [Vec2; 2],
    /// Vectors to the next samples, m.
    pub steps: [Vec3; 2],
}

/// The part of a cell that belongs to one of its corners.
pub(super) struct Kite {
    pub particle: u32,
    /// Area, m².
    pub area: f32,
    /// Texture coordinates and positions at the particle, the middle of the next side, the middle of the cell and that of the side before.
    corners: [(Vec2, Vec3); 4],
}

impl Kite {
    /// The kites of all cells but those across seams of the texture.
    pub fn all(mesh: &RestMesh, cells: &[Vec<u32>]) -> Vec<Self> {
        let stretch = |cell: &Vec<u32>| {
            let of_side = |at: usize| {
                let [from, to] = [cell[at], cell[(at + 1) % cell.len()]].map(|at| at as usize);
                let length = mesh.positions[from].distance(mesh.positions[to]);
                mesh.uv[from].distance(mesh.uv[to]) / length.max(f32::MIN_POSITIVE)
            };
            (0..cell.len()).map(of_side).fold(0.0, f32::max)
        };
        let stretches: Vec<f32> = cells.iter().map(stretch).collect();
        let mut sorted = stretches.clone();
        sorted.sort_by(f32::total_cmp);
        let usual = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
        let whole = cells.iter().zip(&stretches).filter(|(_, stretch)| **stretch <= SEAM * usual);
        whole.flat_map(|(cell, _)| Self::of_cell(mesh, cell)).collect()
    }

    fn of_cell(mesh: &RestMesh, cell: &[u32]) -> impl Iterator<Item = Self> {
        let corners: Vec<(Vec2, Vec3)> =
            cell.iter().map(|&at| (mesh.uv[at as usize], mesh.positions[at as usize])).collect();
        let count = corners.len();
        let mean = |of: &[usize]| {
            let sum = of.iter().fold((Vec2::ZERO, Vec3::ZERO), |sum, &at| {
                (sum.0 + corners[at].0, sum.1 + corners[at].1)
            });
            (sum.0 / of.len() as f32, sum.1 / of.len() as f32)
        };
        let middle = mean(&(0..count).collect::<Vec<_>>());
        let fan = (1..count - 1).map(|at| {
            let [one, other] = [at, at + 1].map(|at| corners[at].1 - corners[0].1);
            0.5 * one.cross(other)
        });
        let area = fan.sum::<Vec3>().length() / count as f32;
        let kites: Vec<Self> = (0..count)
            .map(|at| {
                let (next, before) = ((at + 1) % count, (at + count - 1) % count);
                let corners = [mean(&[at]), mean(&[at, next]), middle, mean(&[at, before])];
                Self { particle: cell[at], area, corners }
            })
            .collect();
        kites.into_iter()
    }

    /// Samples, evenly spread.
    pub fn samples(&self) -> impl Iterator<Item = Sample> {
        let [a, b, c, d] = self.corners;
        let per_step = 1.0 / SAMPLES as f32;
        let uv_steps = [b.0 - a.0, d.0 - a.0].map(|side| side * per_step);
        let steps = [b.1 - a.1, d.1 - a.1].map(|side| side * per_step);
        let part = move |at: usize| (at as f32 + 0.5) * per_step;
        (0..SAMPLES * SAMPLES).map(move |at| {
            let (x, y) = (part(at % SAMPLES), part(at / SAMPLES));
            let uv = a.0.lerp(b.0, x).lerp(d.0.lerp(c.0, x), y);
            Sample { uv, uv_steps, steps }
        })
    }
}
