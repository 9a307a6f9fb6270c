//! Neighbouring cells between which cloth bends sharply, but which planes keep apart.

use glam::Vec3A;

use crate::contact::itself::near::{EdgeEdge, FAR, Features, ParticleTriangle};
use crate::contact::itself::patches::{Cell, LARGEST_CELL};
use crate::contact::itself::points::{Points, vector_of};
use crate::simd::registers::Pack4;

/// Greatest strained length of an edge, as a multiple of its length at rest. Larger: fewer cells are apart. Smaller: edges of cloth that is
/// overstretched meet unnoticed where they begin beside each other.
const STRETCH: f32 = 1.5;

/// Most particles of a cell: the corners of its triangles.
const MOST_PARTICLES: usize = 3 * LARGEST_CELL;

/// Whether no features of neighbouring cells come near one another in a substep, if neither cell touches itself, given the distance of
/// layers, m.
///
/// Along a direction, let the particles that both cells share lie within a slab of the width w, those of one cell alone above it and those
/// of the other alone below it, each by a gap g at least. Then a particle of one cell alone is farther than g from each triangle of the
/// other cell, and so is an edge of two such particles. What is left are two edges that end at different shared particles, which are a
/// spacing L apart. Their points at the parts u and v of these edges, whose length is at most l, are (u + v) g − w apart along the direction
/// and L − (u + v) l at least, so that their distance is at least (L g − w l)/(g + l).
pub(in crate::contact) fn are_apart(cells: [&Cell; 2], points: &Points, thickness: f32) -> bool {
    let parts = &Parts::of(cells);
    let longest = STRETCH * cells[0].longest_edge.max(cells[1].longest_edge);
    let [of_triangles, of_edges] =
        [ParticleTriangle::PART, EdgeEdge::PART].map(|part| FAR * part * thickness);
    let [first, _, second] = [0, 1, 2].map(|part| parts.mean(part, &points.end));
    let axis = (first - second).normalize_or_zero();
    [&points.end, &points.start].into_iter().all(|positions| {
        let [first, shared, second] = [0, 1, 2].map(|part| parts.heights(part, axis, positions));
        let [low, high] = shared;
        let gap = (first[0] - high).min(low - second[1]);
        gap > of_triangles
            && parts.spacing(positions) * gap - (high - low) * longest > of_edges * (gap + longest)
    })
}

/// The particles of the first cell alone, those that both share, and those of the second alone.
struct Parts {
    particles: [[u32; MOST_PARTICLES]; 3],
    counts: [usize; 3],
}

impl Parts {
    fn of([one, other]: [&Cell; 2]) -> Self {
        let mut parts = Self { particles: [[0; MOST_PARTICLES]; 3], counts: [0; 3] };
        // Both are in ascending order.
        let (mut first, mut second) = (&one.particles[..], &other.particles[..]);
        while let ([one, of_first @ ..], [other, of_second @ ..]) = (first, second) {
            if one <= other {
                first = of_first;
            }
            if other <= one {
                second = of_second;
            }
            parts.add(1 + usize::from(other < one) - usize::from(one < other), *one.min(other));
        }
        first.iter().for_each(|&particle| parts.add(0, particle));
        second.iter().for_each(|&particle| parts.add(2, particle));
        parts
    }

    #[inline]
    fn add(&mut self, part: usize, particle: u32) {
        self.particles[part][self.counts[part]] = particle;
        self.counts[part] += 1;
    }

    /// Positions of a part's particles, m.
    #[inline]
    fn positions<'a>(
        &'a self,
        part: usize,
        of: &'a [Pack4],
    ) -> impl Iterator<Item = Vec3A> + Clone + 'a {
        let particles = &self.particles[part][..self.counts[part]];
        particles.iter().map(|&at| vector_of(&of[at as usize]))
    }

    fn mean(&self, part: usize, positions: &[Pack4]) -> Vec3A {
        self.positions(part, positions).sum::<Vec3A>() / self.counts[part] as f32
    }

    /// The least and the greatest height of a part along a direction, m.
    fn heights(&self, part: usize, axis: Vec3A, positions: &[Pack4]) -> [f32; 2] {
        let heights = self.positions(part, positions).map(|at| at.dot(axis));
        heights
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], it| [low.min(it), high.max(it)])
    }

    /// Least distance between two shared particles, m; infinite of a single one.
    fn spacing(&self, positions: &[Pack4]) -> f32 {
        let mut least = f32::INFINITY;
        let mut shared = self.positions(1, positions);
        while let Some(one) = shared.next() {
            least =
                shared.clone().fold(least, |least, other| least.min(one.distance_squared(other)));
        }
        least.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::contact::itself::mesh::ContactMesh;
    use crate::contact::itself::points::vector;
    use crate::fabric::{FabricBuilder, Grid};

    const THICKNESS: f32 = 8e-3;
    /// Distance of neighbouring particles at rest, m.
    const SPACING: f32 = 0.03;

    /// A sheet that is folded by an angle, rad, along an arc of a radius, m, across a direction.
    fn folded(rest: &[Vec3], across: Vec3, angle: f32, radius: f32) -> Vec<Vec3> {
        let (along, middle) = (Vec3::Z.cross(across), Vec3::new(4.0, 4.0, 0.0) * SPACING);
        let fold = |at: Vec3| {
            let (kept, length) = (at.dot(along), (at - middle).dot(across));
            let turned = (length / radius).clamp(0.0, angle);
            let (sin, cos) = (libm::sinf(turned), libm::cosf(turned));
            let straight = length - turned * radius;
            let (x, z) = (radius * sin + straight * cos, radius * (1.0 - cos) + straight * sin);
            along * kept + across * x + Vec3::Z * z
        };
        rest.iter().map(|&at| fold(at)).collect()
    }

    /// Least distance of an edge and a triangle, m, in samples of both.
    fn distance(edge: [Vec3; 2], triangle: [Vec3; 3]) -> f32 {
        const PARTS: usize = 12;
        let mut least = f32::INFINITY;
        for one in 0..=PARTS {
            let point = edge[0].lerp(edge[1], one as f32 / PARTS as f32);
            for first in 0..=PARTS {
                for second in 0..=PARTS - first {
                    let [u, v] = [first, second].map(|part| part as f32 / PARTS as f32);
                    let [a, b, c] = triangle;
                    least = least.min(point.distance(a + (b - a) * u + (c - a) * v));
                }
            }
        }
        least
    }

    #[test]
    fn features_of_cells_that_planes_keep_apart_are_far_from_one_another() {
        let size = 8.0 * SPACING;
        let fabric = FabricBuilder::grid(Grid::new(9, 9, size, size)).build().expect("a good grid");
        let mesh = ContactMesh::of(&fabric);
        let triangles_of = |cell: &Cell| {
            let lanes = 0..cell.triangles.len();
            let corners = cell.corners;
            lanes.map(move |lane| corners.map(|corner| corner[lane])).collect::<Vec<_>>()
        };
        let [mut apart, mut near] = [0, 0];
        let folds = [(1.8, 0.01), (2.4, 0.01), (2.9, 0.012), (3.1, 0.002), (3.1, 0.004)];
        let both = |fold| [(Vec3::X, fold), (Vec3::new(0.8, -0.6, 0.0), fold)];
        for (across, (angle, radius)) in folds.into_iter().flat_map(both) {
            let at = folded(fabric.rest_positions(), across, angle, radius);
            let end: Vec<Pack4> = at.iter().map(|&at| vector(at)).collect();
            let points = Points { start: end.clone(), end, ..Points::default() };
            for (index, one) in mesh.cells.iter().enumerate() {
                for other in one.neighbours.iter().filter(|it| it.index as usize > index) {
                    let other = &mesh.cells[other.index as usize];
                    if !are_apart([one, other], &points, THICKNESS) {
                        near += 1;
                        continue;
                    }
                    apart += 1;
                    let has_all =
                        |cell: &Cell, of: &[u32]| of.iter().all(|at| cell.particles.contains(at));
                    for triangle in triangles_of(other) {
                        for [a, b, c] in triangles_of(one) {
                            for edge in [[a, b], [b, c], [c, a]] {
                                let is_own = edge.iter().any(|at| triangle.contains(at))
                                    || has_all(one, &triangle)
                                    || has_all(other, &edge);
                                if !is_own {
                                    let of = |particle: u32| at[particle as usize];
                                    let distance = distance(edge.map(of), triangle.map(of));
                                    let far = FAR * EdgeEdge::PART * THICKNESS;
                                    assert!(distance > far, "{distance} m, {angle} rad");
                                }
                            }
                        }
                    }
                }
            }
        }
        assert!(apart > 100 && near > 5, "{apart} apart, {near} near");
    }
}
