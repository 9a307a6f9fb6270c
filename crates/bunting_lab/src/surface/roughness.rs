//! Angles between the normals of neighbouring triangles, before and after smoothing.

use std::collections::HashMap;

use glam::DVec3;

use crate::stats::mean;

/// Rounds of smoothing: a zigzag from vertex to vertex is less than a tenth as high after two, a fold of ten vertices
/// two thirds as high.
const ROUNDS: usize = 2;
/// Part of the way to the mean of its neighbours that a point goes in a round.
const PART: f64 = 0.5;

/// What lies beside what in a mesh of triangles.
#[derive(Clone, Debug)]
pub(super) struct Neighbours {
    /// Points of each triangle.
    triangles: Vec<[usize; 3]>,
    /// Pairs of triangles with a common edge.
    pairs: Vec<[usize; 2]>,
    /// Points to whose mean each point is drawn: on the border those beside it on the border.
    around: Vec<Vec<usize>>,
}

impl Neighbours {
    pub fn new(triangles: &[[usize; 3]]) -> Self {
        let mut beside: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
            for [a, b] in [[a, b], [b, c], [c, a]] {
                beside.entry([a.min(b), a.max(b)]).or_default().push(triangle);
            }
        }
        // In an order that is the same in every run.
        let mut edges: Vec<([usize; 2], Vec<usize>)> = beside.into_iter().collect();
        edges.sort_unstable();
        let points = triangles.iter().flatten().max().map_or(0, |last| last + 1);
        let mut is_border = vec![false; points];
        for ([a, b], _) in edges.iter().filter(|(_, triangles)| triangles.len() == 1) {
            (is_border[*a], is_border[*b]) = (true, true);
        }
        let mut around = vec![Vec::new(); points];
        for ([a, b], triangles) in &edges {
            let is_outer = triangles.len() == 1;
            for (from, to) in [(*a, *b), (*b, *a)] {
                if is_outer || !is_border[from] {
                    around[from].push(to);
                }
            }
        }
        let pairs = edges.iter().filter_map(|(_, triangles)| triangles[..].try_into().ok());
        Self { triangles: triangles.to_vec(), pairs: pairs.collect(), around }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.around.len()
    }

    /// Angle between the normals of neighbouring triangles, ° RMS.
    pub fn turn(&self, positions: &[DVec3]) -> f64 {
        let normal = |&[a, b, c]: &[usize; 3]| {
            (positions[b] - positions[a]).cross(positions[c] - positions[a])
        };
        let normals: Vec<DVec3> = self.triangles.iter().map(normal).collect();
        // Rounding may not make an angle of two normals that are the same, as an arc cosine would.
        let angle = |[one, other]: &[usize; 2]| {
            let (one, other) = (normals[*one], normals[*other]);
            one.cross(other).length().atan2(one.dot(other)).to_degrees()
        };
        let squares: Vec<f64> = self.pairs.iter().map(|pair| angle(pair).powi(2)).collect();
        mean(&squares).sqrt()
    }

    /// The positions, smoothed.
    pub fn smoothed(&self, positions: &[DVec3]) -> Vec<DVec3> {
        let mut positions = positions.to_vec();
        for _ in 0..ROUNDS {
            let drawn = |(at, around): (&DVec3, &Vec<usize>)| {
                let sum: DVec3 = around.iter().map(|beside| positions[*beside]).sum();
                if around.is_empty() { *at } else { at.lerp(sum / around.len() as f64, PART) }
            };
            positions = positions.iter().zip(&self.around).map(drawn).collect();
        }
        positions
    }
}
