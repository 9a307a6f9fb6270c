//! Subdivision of meshes: the modified butterfly scheme (Zorin, Schröder and Sweldens 1996), with the four-point
//! scheme along borders.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use crate::subdivision::stencils::Stencils;

/// Cosine of the angle by which a border turns at a corner (30°): the border is smooth on both sides of the corner only.
const CORNER: f32 = 0.866;

/// Triangles of points, which are subdivided.
#[derive(Clone, Debug)]
pub(super) struct Points {
    pub triangles: Vec<[u32; 3]>,
    /// Each point as a sum of the first ones.
    pub stencils: Stencils,
    /// The third corner of the triangle that has a directed edge.
    third: HashMap<[u32; 2], u32>,
    corners: HashSet<u32>,
    /// Whether middles lie on a smooth surface; else in the planes of the triangles.
    is_smooth: bool,
}

impl Points {
    /// The points of a mesh at rest.
    pub fn new(rest: &[Vec3], triangles: Vec<[u32; 3]>) -> Self {
        let third = thirds(&triangles);
        let corners = corners(rest, &third);
        let stencils = Stencils::identity(rest.len() as u32);
        Self { triangles, stencils, third, corners, is_smooth: true }
    }

    /// The same, which stay in the planes of their triangles.
    pub fn flat(rest: &[Vec3], triangles: Vec<[u32; 3]>) -> Self {
        Self { is_smooth: false, ..Self::new(rest, triangles) }
    }

    /// Splits each triangle into four.
    pub fn subdivide(&mut self) {
        let border = Border::new(&self.third);
        let mut middles = HashMap::new();
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for index in 0..self.triangles.len() {
            let [a, b, c] = self.triangles[index];
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                let key = [from.min(to), from.max(to)];
                if let Some(&known) = middles.get(&key) {
                    return known;
                }
                let middle = match self.is_smooth {
                    true => self.middle([from, to], &border),
                    false => vec![(from, 0.5), (to, 0.5)],
                };
                let row = self.stencils.expand(&middle);
                let point = self.stencils.rows().len() as u32;
                self.stencils.push(row);
                middles.insert(key, point);
                point
            });
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        self.third = thirds(&triangles);
        self.triangles = triangles;
    }

    /// Weights of the points at the middle of an edge.
    fn middle(&self, [a, b]: [u32; 2], border: &Border) -> Vec<(u32, f32)> {
        let (Some(&c), Some(&d)) = (self.third.get(&[a, b]), self.third.get(&[b, a])) else {
            let forward = if self.third.contains_key(&[a, b]) { [a, b] } else { [b, a] };
            return self.middle_of_border(forward, border);
        };
        let rings = [self.ring(a, b), self.ring(b, a)];
        let irregular = |ring: &Option<Vec<u32>>| ring.as_ref().is_some_and(|ring| ring.len() != 6);
        let by_ring = |centre: u32, ring: &[u32]| {
            let weights = irregular_weights(ring.len());
            let around = ring.iter().copied().zip(weights);
            around.chain([(centre, 0.75)]).collect::<Vec<_>>()
        };
        let [of_a, of_b] = &rings;
        match (of_a, of_b, irregular(of_a), irregular(of_b)) {
            (Some(at_a), Some(at_b), true, true) => {
                let both = by_ring(a, at_a).into_iter().chain(by_ring(b, at_b));
                both.map(|(point, weight)| (point, 0.5 * weight)).collect()
            }
            (Some(at_a), _, true, _) => by_ring(a, at_a),
            (_, Some(at_b), _, true) => by_ring(b, at_b),
            _ => self.butterfly([a, b], [c, d]),
        }
    }

    /// The butterfly of eight points. A wing beyond the border is its triangle's parallelogram.
    fn butterfly(&self, [a, b]: [u32; 2], [c, d]: [u32; 2]) -> Vec<(u32, f32)> {
        let mut row = vec![(a, 0.5), (b, 0.5), (c, 0.125), (d, 0.125)];
        // The edges between the body and each wing, and the corner that faces the wing.
        for (edge, facing) in [([a, c], b), ([c, b], a), ([d, a], b), ([b, d], a)] {
            match self.third.get(&edge) {
                Some(&wing) => row.push((wing, -0.0625)),
                None => row.extend([(edge[0], -0.0625), (edge[1], -0.0625), (facing, 0.0625)]),
            }
        }
        row
    }

    /// The neighbours of an inner point in turn, from one of them on; none for a point of the border.
    fn ring(&self, centre: u32, first: u32) -> Option<Vec<u32>> {
        let mut ring = vec![first];
        loop {
            let next = *self.third.get(&[centre, ring[ring.len() - 1]])?;
            if next == first {
                return Some(ring);
            }
            ring.push(next);
        }
    }

    /// The middle of a directed edge of the border.
    fn middle_of_border(&self, [a, b]: [u32; 2], border: &Border) -> Vec<(u32, f32)> {
        let beyond = |end: u32, along: &HashMap<u32, u32>| {
            along.get(&end).copied().filter(|_| !self.corners.contains(&end))
        };
        match (beyond(a, &border.before), beyond(b, &border.after)) {
            (Some(before), Some(after)) => {
                vec![(before, -0.0625), (a, 0.5625), (b, 0.5625), (after, -0.0625)]
            }
            (None, Some(after)) => vec![(a, 0.375), (b, 0.75), (after, -0.125)],
            (Some(before), None) => vec![(before, -0.125), (a, 0.75), (b, 0.375)],
            (None, None) => vec![(a, 0.5), (b, 0.5)],
        }
    }
}

/// Weights of the neighbours of an irregular point, from the one at the other end of the edge on.
fn irregular_weights(valence: usize) -> Vec<f32> {
    match valence {
        3 => vec![5.0 / 12.0, -1.0 / 12.0, -1.0 / 12.0],
        4 => vec![0.375, 0.0, -0.125, 0.0],
        _ => {
            let turn = 2.0 * core::f32::consts::PI / valence as f32;
            let weight = |at: usize| {
                let angle = turn * at as f32;
                (0.25 + libm::cosf(angle) + 0.5 * libm::cosf(2.0 * angle)) / valence as f32
            };
            (0..valence).map(weight).collect()
        }
    }
}

/// The neighbours along the border of each point that has one of each.
struct Border {
    before: HashMap<u32, u32>,
    after: HashMap<u32, u32>,
}

impl Border {
    fn new(third: &HashMap<[u32; 2], u32>) -> Self {
        let mut border = Self { before: HashMap::new(), after: HashMap::new() };
        let mut pinched = HashSet::new();
        for &[from, to] in third.keys().filter(|[from, to]| !third.contains_key(&[*to, *from])) {
            if border.after.insert(from, to).is_some() || border.before.insert(to, from).is_some() {
                pinched.extend([from, to]);
            }
        }
        border.before.retain(|point, _| !pinched.contains(point));
        border.after.retain(|point, _| !pinched.contains(point));
        border
    }
}

fn thirds(triangles: &[[u32; 3]]) -> HashMap<[u32; 2], u32> {
    let edges = |&[a, b, c]: &[u32; 3]| [([a, b], c), ([b, c], a), ([c, a], b)];
    triangles.iter().flat_map(edges).collect()
}

/// The points at which the border turns sharply at rest.
fn corners(rest: &[Vec3], third: &HashMap<[u32; 2], u32>) -> HashSet<u32> {
    let Border { before, after } = Border::new(third);
    let turns = |(&point, &to): (&u32, &u32)| {
        let at = rest[point as usize];
        let from = rest[*before.get(&point)? as usize];
        let [come, go] = [at - from, rest[to as usize] - at].map(Vec3::normalize_or_zero);
        (come.dot(go) < CORNER).then_some(point)
    };
    after.iter().filter_map(turns).collect()
}
