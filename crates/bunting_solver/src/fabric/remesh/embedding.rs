//! The cell of nodes that a place lies in, and its weights there.

use glam::{DMat2, DVec2, DVec3, Vec3};

use super::triangle::{barycentric, nearest};
use crate::fabric::interpolation::{Height, Term};

/// Most steps from cell to cell.
const STEPS: usize = 20;

/// Steps of Newton's method.
const NEWTON_STEPS: usize = 6;

/// Least distance of a place from the surface between nodes that counts, in cells.
const LEAST_HEIGHT: f32 = 1e-5;

/// A place in a cell.
pub(super) struct InCell {
    /// The weights of the cell's nodes.
    pub terms: Vec<Term>,
    /// The place's distance from the surface between them, if it has one.
    pub height: Option<Height>,
}

/// Cells of three or four nodes.
pub(super) struct Cells<'a, 'b> {
    cells: Vec<&'a [u32]>,
    positions: &'b [Vec3],
    /// The cells around each node.
    around: Vec<Vec<u32>>,
    /// Size of a cell, m.
    size: f64,
}

impl<'a, 'b> Cells<'a, 'b> {
    pub fn new(cells: impl Iterator<Item = &'a [u32]>, positions: &'b [Vec3], size: f64) -> Self {
        let cells: Vec<&[u32]> = cells.collect();
        let mut around = vec![Vec::new(); positions.len()];
        for (index, cell) in (0..).zip(&cells) {
            cell.iter().for_each(|node| around[*node as usize].push(index));
        }
        Self { cells, positions, around, size }
    }

    /// The cell nearest to a place, given its normal and a node near it; none without cells.
    pub fn of(&self, place: u32, at: DVec3, normal: DVec3, node: u32) -> Option<InCell> {
        let cell = self.nearest(at, normal, node)?;
        let corners = self.corners(cell);
        let (weights, nodes) = match (*cell, &corners[..]) {
            (&[a, b, c, d], &[of_a, of_b, of_c, of_d]) => {
                (within_quad(at, [of_a, of_b, of_c, of_d]).to_vec(), [a, c, b, d])
            }
            (&[a, b, c], &[of_a, of_b, of_c]) => {
                let triangle = [of_a, of_b, of_c];
                (barycentric(nearest(at, triangle), triangle).to_vec(), [a, b, a, c])
            }
            _ => return None,
        };
        let below: DVec3 = corners.iter().zip(&weights).map(|(at, weight)| *at * *weight).sum();
        let terms = cell.iter().zip(&weights);
        Some(InCell {
            terms: terms.map(|(&from, &weight)| Term { from, weight: weight as f32 }).collect(),
            height: self.height(place, nodes, (at - below).as_vec3()),
        })
    }

    /// The nearest of the cells that are reached from a node step by step, so that none is found across a slit or a fold.
    fn nearest(&self, at: DVec3, normal: DVec3, node: u32) -> Option<&&'a [u32]> {
        let mut seen: Vec<u32> = Vec::new();
        let mut best: Option<(f64, u32)> = None;
        let mut front = self.around[node as usize].clone();
        for _ in 0..STEPS {
            front.retain(|cell| !seen.contains(cell));
            seen.extend(&front);
            let found = front.iter().map(|&cell| (self.distance(cell, at, normal), cell));
            let found = found.min_by(|one, other| one.0.total_cmp(&other.0));
            let Some(found) = found.filter(|it| best.is_none_or(|best| it.0 < best.0)) else {
                break;
            };
            best = Some(found);
            let nodes = self.cells[found.1 as usize].iter();
            front = nodes.flat_map(|node| &self.around[*node as usize]).copied().collect();
            front.sort_unstable();
            front.dedup();
        }
        best.map(|(_, cell)| &self.cells[cell as usize])
    }

    /// Distance of a place from a cell, m; farther if the cell faces another way.
    fn distance(&self, cell: u32, at: DVec3, normal: DVec3) -> f64 {
        let corners = self.cells[cell as usize];
        let corner = |node: u32| self.positions[node as usize].as_dvec3();
        let halves = corners[1..].windows(2).map(|ends| [corners[0], ends[0], ends[1]].map(corner));
        let of_half = |half: [DVec3; 3]| {
            let [a, b, c] = half;
            let is_alike = (b - a).cross(c - a).dot(normal) > 0.0;
            let away = nearest(at, half).distance(at);
            if is_alike { away } else { away + self.size }
        };
        halves.map(of_half).fold(f64::INFINITY, f64::min)
    }

    fn corners(&self, cell: &[u32]) -> Vec<DVec3> {
        cell.iter().map(|at| self.positions[*at as usize].as_dvec3()).collect()
    }

    fn height(&self, place: u32, nodes: [u32; 4], away: Vec3) -> Option<Height> {
        if away.length() < LEAST_HEIGHT * self.size as f32 {
            return None;
        }
        Height::of(place, nodes, nodes.map(|at| self.positions[at as usize]), away)
    }
}

/// Bilinear weights of the corners of a quad at the place in it nearest to a point.
fn within_quad(at: DVec3, corners: [DVec3; 4]) -> [f64; 4] {
    let [a, b, c, d] = corners;
    let x = (c - a).normalize_or_zero();
    let y = (c - a).cross(d - b).normalize_or_zero().cross(x);
    let [a, b, c, d, at] = [a, b, c, d, at].map(|point| DVec2::new(point.dot(x), point.dot(y)));
    let mut part = DVec2::splat(0.5);
    for _ in 0..NEWTON_STEPS {
        let off = a.lerp(b, part.x).lerp(d.lerp(c, part.x), part.y) - at;
        let by_x = (b - a).lerp(c - d, part.y);
        let by_y = (d - a).lerp(c - b, part.x);
        let step = DMat2::from_cols(by_x, by_y).inverse() * off;
        if step.is_finite() {
            // Steps from outside of a cell that is no parallelogram may lead far away.
            part = (part - step).clamp(DVec2::splat(-0.5), DVec2::splat(1.5));
        }
    }
    let DVec2 { x, y } = part.clamp(DVec2::ZERO, DVec2::ONE);
    [(1.0 - x) * (1.0 - y), x * (1.0 - y), x * y, (1.0 - x) * y]
}
