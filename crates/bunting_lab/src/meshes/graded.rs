//! Sheets whose triangles grow from one side to the other.

use glam::{DVec2, Vec3};

use super::{CANDIDATES, Random, Sheet, delaunay};

/// Area of an equilateral triangle's share of each vertex, over the square of its sides.
const VERTEX_AREA: f64 = 0.866;
/// Size of the sheet for its triangulation, so that coordinates are of the order of one to a hundred.
const SCALE: f64 = 60.0;

impl Sheet {
    /// A square metre of about `count` vertices, whose Delaunay triangles are `ratio` times as large at its right side as at
    /// its left side.
    #[must_use]
    pub fn graded(count: usize, ratio: f64) -> Self {
        let growth = ratio.ln();
        // The integral of one over the squared length, which is proportional to the number of vertices.
        let squares = (1.0 - ratio.powi(-2)) / (2.0 * growth);
        let shortest = (squares / (count as f64 * VERTEX_AREA)).sqrt();
        let length = |x: f64| shortest * (growth * x).exp();
        let mut random = Random(17);
        let mut points = border(&length);
        while points.len() < count {
            let mut candidate = || {
                // Distributed as vertices are.
                let part = random.next() * (1.0 - ratio.powi(-2));
                DVec2::new(-(1.0 - part).ln() / (2.0 * growth), random.next())
            };
            let is_inside = |at: &DVec2| {
                let within = at.min(1.0 - *at).min_element();
                within > 0.5 * length(at.x)
            };
            let candidates: Vec<DVec2> =
                (0..CANDIDATES).map(|_| candidate()).filter(is_inside).collect();
            let nearest = |at: &DVec2| {
                let away = |of: &DVec2| of.distance(*at) / (length(of.x) + length(at.x));
                points.iter().map(away).fold(f64::INFINITY, f64::min)
            };
            let farthest = candidates.iter().max_by(|a, b| nearest(a).total_cmp(&nearest(b)));
            points.extend(farthest.copied());
        }
        // Shifted a little, so that no four of them lie on one circle.
        let scaled = points.iter().map(|at| *at * SCALE + 1e-5 * random.place());
        let triangles = delaunay::triangulate(&scaled.collect::<Vec<_>>());
        let in_space = |at: &DVec2| Vec3::new(at.x as f32, -at.y as f32, 0.0);
        // The second axis points down, which turns the triangles over.
        let front = triangles.into_iter().flat_map(|[a, b, c]| [a, c, b]);
        Self {
            positions: points.iter().map(in_space).collect(),
            indices: front.map(|at| at as u32).collect(),
        }
    }
}

/// Points on the border of a unit square, as far apart as `length` says at each place.
fn border(length: &impl Fn(f64) -> f64) -> Vec<DVec2> {
    let mut along = vec![0.0];
    while let Some(&last) = along.last().filter(|last| **last < 1.0) {
        along.push(last + length(last));
    }
    let end = along[along.len() - 1];
    let level = along.iter().flat_map(|x| [0.0, 1.0].map(|y| DVec2::new(x / end, y)));
    let upright = [0.0, 1.0].into_iter().flat_map(|x| {
        let parts = (1.0 / length(x)).round() as usize;
        (1..parts).map(move |part| DVec2::new(x, part as f64 / parts as f64))
    });
    level.chain(upright).collect()
}
