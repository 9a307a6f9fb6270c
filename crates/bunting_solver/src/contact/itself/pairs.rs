//! The pairs of features whose paths come near one another in a substep: features of two cells are compared in lanes, as boxes.

use core::ops::Range;

use fearless_simd::Simd;

use crate::contact::itself::boxes::{Boxes, Splat};
use crate::contact::itself::cell_pairs::CellPairs;
use crate::contact::itself::features::{FeaturePack, FeaturesOfCell};
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::near::{EdgeEdge, FAR, Features, ParticleTriangle};
use crate::contact::itself::points::Points;
use crate::contact::itself::swept::{End, Swept};
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::level::dispatch;
use crate::simd::registers::Pack8;
use crate::simd::vec3::V3;

/// Distance by which boxes are widened, m: more than their coordinates are rounded by.
const ROUNDING: f32 = 1e-6;

/// An edge and a triangle.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct EdgeTriangle {
    /// Index of the edge.
    pub index: u32,
    pub edge: [u32; 2],
    pub triangle: [u32; 3],
}

impl EdgeTriangle {
    pub fn particles(&self) -> [u32; 5] {
        let ([a, b], [c, d, e]) = (self.edge, self.triangle);
        [a, b, c, d, e]
    }
}

/// Pairs of features whose paths come near one another in a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Pairs {
    /// A particle, then the corners of a triangle.
    pub particles_triangles: Vec<[u32; 4]>,
    /// The ends of one edge, then those of another.
    pub edges_edges: Vec<[u32; 4]>,
    pub edges_triangles: Vec<EdgeTriangle>,
    /// Boxes around the paths of each pack of features, and of each cell.
    boxes: Vec<Boxes>,
    around: Vec<Swept>,
    found: Vec<Found>,
}

impl Pairs {
    /// Finds the features of cells whose paths come near one another, given the distance of layers, m. Their boxes have been computed
    /// before.
    pub fn find(&mut self, mesh: &ContactMesh, cells: &CellPairs, thickness: f32) {
        self.particles_triangles.clear();
        self.edges_edges.clear();
        let far = [ParticleTriangle::PART, EdgeEdge::PART].map(|part| FAR * part * thickness);
        Pack8::run(FindNear { mesh, cells, far, pairs: self });
    }

    /// Finds the edges and triangles of cells that may pass through one another at an end of the substep. Their boxes have been computed
    /// before.
    pub fn find_crossings(&mut self, mesh: &ContactMesh, cells: &CellPairs, end: End) {
        self.edges_triangles.clear();
        Pack8::run(FindCrossings { mesh, cells, end, pairs: self });
    }

    /// Computes the boxes around the paths of cells and of their features.
    pub fn bound(&mut self, mesh: &ContactMesh, cells: &CellPairs, points: &Points) {
        self.boxes.resize(mesh.packs.len(), Boxes::empty());
        self.around.resize(mesh.cells.len(), Swept::EMPTY);
        for &cell in &cells.members {
            let around = Swept::around(&mesh.cells[cell as usize].particles, points);
            self.around[cell as usize] = around;
        }
        let boxes = &mut self.boxes;
        dispatch!(token => bound(token, mesh, cells, points, boxes));
    }

    /// Drops the pairs of features that seams join, given the particles that they join, in both orders, ascending.
    pub fn drop_sewn(&mut self, sewn: &[[u32; 2]]) {
        if sewn.is_empty() {
            return;
        }
        let are_joined = |one: &[u32], other: &[u32]| {
            let is_joined = |at: u32| other.iter().any(|&to| sewn.binary_search(&[at, to]).is_ok());
            one.iter().any(|&at| is_joined(at))
        };
        self.particles_triangles.retain(|pair| !are_joined(&pair[..1], &pair[1..]));
        self.edges_edges.retain(|pair| !are_joined(&pair[..2], &pair[2..]));
        self.edges_triangles.retain(|pair| !are_joined(&pair.edge, &pair.triangle));
    }
}

/// Computes the boxes around the paths of the features of cells.
#[inline(always)]
fn bound<S: Simd>(
    token: S,
    mesh: &ContactMesh,
    cells: &CellPairs,
    points: &Points,
    boxes: &mut [Boxes],
) {
    let positions = [&points.start[..], &points.end[..]];
    for &cell in &cells.members {
        let FeaturesOfCell { triangles, edges, particles } = &mesh.features[cell as usize];
        for (boxes, features) in of_packs(boxes, mesh, triangles) {
            boxes.set_around::<S, 3>(token, features, positions);
        }
        for (boxes, features) in of_packs(boxes, mesh, edges) {
            boxes.set_around::<S, 2>(token, features, positions);
        }
        for (boxes, features) in of_packs(boxes, mesh, particles) {
            boxes.set_around::<S, 1>(token, features, positions);
        }
    }
}

/// The boxes and the features of some packs.
#[inline(always)]
fn of_packs<'a>(
    boxes: &'a mut [Boxes],
    mesh: &'a ContactMesh,
    packs: &Range<u32>,
) -> impl Iterator<Item = (&'a mut Boxes, &'a FeaturePack)> {
    let range = packs.start as usize..packs.end as usize;
    boxes[range.clone()].iter_mut().zip(&mesh.packs[range])
}

struct FindNear<'a> {
    mesh: &'a ContactMesh,
    cells: &'a CellPairs,
    /// Distances of particles from triangles and of edges within which they are found, m.
    far: [f32; 2],
    pairs: &'a mut Pairs,
}

impl Kernel<Pack8> for FindNear<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let Self { mesh, cells, far: [of_triangles, of_edges], pairs } = self;
        let Pairs { particles_triangles, edges_edges, boxes, around, found, .. } = pairs;
        for &[one, other] in &cells.pairs {
            let [first, second] = [&mesh.features[one as usize], &mesh.features[other as usize]];
            let mut compare =
                Compare { packs: &mesh.packs, boxes, found, around: &around[other as usize] };
            compare.run::<L>(token, [&first.particles, &second.triangles], of_triangles);
            add_particles(compare.found, &mesh.packs, particles_triangles);
            compare.run::<L>(token, [&first.edges, &second.edges], of_edges);
            add_edges(compare.found, &mesh.packs, one == other, edges_edges);
            if one != other {
                compare.around = &around[one as usize];
                compare.run::<L>(token, [&second.particles, &first.triangles], of_triangles);
                add_particles(compare.found, &mesh.packs, particles_triangles);
            }
        }
    }
}

struct FindCrossings<'a> {
    mesh: &'a ContactMesh,
    cells: &'a CellPairs,
    end: End,
    pairs: &'a mut Pairs,
}

impl Kernel<Pack8> for FindCrossings<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let Self { mesh, cells, end, pairs } = self;
        let Pairs { edges_triangles, boxes, around, .. } = pairs;
        let packs = &mesh.packs[..];
        // Edges that lie in the sides of boxes meet them: sheets that lie upon one another, vertex on vertex.
        let far = V3::<L>::splat(token, ROUNDING);
        for &[one, other] in &cells.pairs {
            if !around[one as usize].meets_at(end, &around[other as usize]) {
                continue;
            }
            let [first, second] = [&mesh.features[one as usize], &mesh.features[other as usize]];
            let mut turn = 0;
            while turn < if one == other { 1 } else { 2 } {
                let (edges, triangles, cell) = if turn == 0 {
                    (&first.edges, &second.triangles, other)
                } else {
                    (&second.edges, &first.triangles, one)
                };
                let around = Splat::<L>::of(token, &around[cell as usize]).widened(far);
                for edge in edges.start as usize..edges.end as usize {
                    let meets = around.meets_at(token, end, &boxes[edge]);
                    let mut lanes = meets.bits() & packs[edge].lanes();
                    while lanes != 0 {
                        let lane = lanes.trailing_zeros();
                        lanes &= lanes - 1;
                        let around = boxes[edge].lane::<L>(token, lane as usize).widened(far);
                        for triangle in triangles.start as usize..triangles.end as usize {
                            let meets = around.meets_at(token, end, &boxes[triangle]);
                            let of_triangles = meets.bits() & packs[triangle].lanes();
                            let edge = (&packs[edge], lane as u8);
                            add_crossings(edge, &packs[triangle], of_triangles, edges_triangles);
                        }
                    }
                }
                turn += 1;
            }
        }
    }
}

/// Two features: the index of the pack and the lane of each.
type Found = [(u32, u8); 2];

/// A comparison of features of two cells.
struct Compare<'a> {
    packs: &'a [FeaturePack],
    /// Boxes around the paths of the features in each pack.
    boxes: &'a [Boxes],
    found: &'a mut Vec<Found>,
    /// Boxes around the second cell.
    around: &'a Swept,
}

impl Compare<'_> {
    /// Finds the features of some packs whose paths come nearer than a distance, m, to features of other packs, which are of the second
    /// cell.
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(
        &mut self,
        token: L::Token,
        [ones, others]: [&Range<u32>; 2],
        far: f32,
    ) {
        self.found.clear();
        let far = V3::<L>::splat(token, far);
        let around = Splat::<L>::of(token, self.around).widened(far);
        for one in ones.start..ones.end {
            let boxes = &self.boxes[one as usize];
            let mut lanes = around.meets(token, boxes).bits() & self.packs[one as usize].lanes();
            while lanes != 0 {
                let lane = lanes.trailing_zeros();
                lanes &= lanes - 1;
                let around = boxes.lane::<L>(token, lane as usize).widened(far);
                for other in others.start..others.end {
                    let meets = around.meets(token, &self.boxes[other as usize]);
                    let mut of_other = meets.bits() & self.packs[other as usize].lanes();
                    while of_other != 0 {
                        let second = of_other.trailing_zeros();
                        of_other &= of_other - 1;
                        self.found.push([(one, lane as u8), (other, second as u8)]);
                    }
                }
            }
        }
    }
}

/// Adds particles and triangles that have no particle in common.
fn add_particles(found: &[Found], packs: &[FeaturePack], pairs: &mut Vec<[u32; 4]>) {
    for &[(one, lane), (other, of_other)] in found {
        let [particle, ..] = packs[one as usize].of(lane);
        let [a, b, c] = packs[other as usize].of(of_other);
        if particle != a && particle != b && particle != c {
            pairs.push([particle, a, b, c]);
        }
    }
}

/// Adds edges that have no particle in common, those within one cell once.
fn add_edges(found: &[Found], packs: &[FeaturePack], is_one_cell: bool, pairs: &mut Vec<[u32; 4]>) {
    for &[(one, lane), (other, of_other)] in found {
        let [a, b, _] = packs[one as usize].of(lane);
        let [c, d, _] = packs[other as usize].of(of_other);
        let is_second = is_one_cell && (one, lane) > (other, of_other);
        if !is_second && a != c && a != d && b != c && b != d {
            pairs.push([a, b, c, d]);
        }
    }
}

/// Adds an edge with each of the triangles in some lanes that has no particle in common with it.
#[inline]
fn add_crossings(
    (edges, lane): (&FeaturePack, u8),
    triangles: &FeaturePack,
    mut lanes: u64,
    pairs: &mut Vec<EdgeTriangle>,
) {
    let [a, b, _] = edges.of(lane);
    while lanes != 0 {
        let triangle = triangles.of(lanes.trailing_zeros() as u8);
        lanes &= lanes - 1;
        if !triangle.contains(&a) && !triangle.contains(&b) {
            let index = edges.first + u32::from(lane);
            pairs.push(EdgeTriangle { index, edge: [a, b], triangle });
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::constants::LEAST_LENGTH;
    use crate::contact::itself::cloth::Cloth;
    use crate::contact::itself::crossing::crossing;
    use crate::contact::itself::particles::Particles;
    use crate::contact::itself::rules::OfOneCloth;
    use crate::contact::itself::search::Search;
    use crate::fabric::{Fabric, FabricBuilder, Grid};

    const THICKNESS: f32 = 0.02;

    /// A sheet that lies folded upon itself, and is pushed into itself along the fold.
    fn folded() -> (Fabric, Particles) {
        let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
        let fabric = grid.build().expect("a good grid");
        let mut particles = Particles::default();
        particles.resize(fabric.particle_count());
        let noise = |at: usize| libm::sinf(at as f32 * 12.9898) * 0.5;
        for (at, rest) in fabric.rest_positions().iter().enumerate() {
            let turn = (rest.x - 0.5) / 0.03;
            let (along, up) = if turn < 0.0 { (rest.x, 0.0) } else { (1.0 - rest.x, 0.015) };
            let folded = Vec3::new(along, up + 0.02 * noise(at), rest.y);
            particles.start[at] = folded;
            particles.end[at] = folded + Vec3::new(0.3, 0.02 * noise(3 * at + 1), 0.1);
        }
        (fabric, particles)
    }

    /// All pairs that are found, and the edges and triangles that may cross at the end.
    fn found(fabric: &Fabric, particles: &Particles) -> (ContactMesh, Pairs) {
        let mesh = ContactMesh::of(fabric);
        let mut points = Points::default();
        points.read_starts(particles);
        points.read_ends(particles);
        let (mut cells, mut pairs) = (CellPairs::default(), Pairs::default());
        let cloth = Cloth { mesh: &mesh, points: &points, thickness: THICKNESS };
        let rest = fabric.rest_positions();
        let rules = OfOneCloth { thickness: THICKNESS, friction: 0.0, rest, sewn: &[] };
        Search::default().find(&cloth, &rules, &mut cells);
        pairs.bound(&mesh, &cells, &points);
        pairs.find(&mesh, &cells, THICKNESS);
        pairs.find_crossings(&mesh, &cells, End::Last);
        (mesh, pairs)
    }

    #[test]
    fn particles_near_triangles_of_another_layer_are_found() {
        let (fabric, particles) = folded();
        let (_, pairs) = found(&fabric, &particles);
        let (mut near, rest) = (0, fabric.rest_positions());
        for triangle in fabric.triangles() {
            let [a, b, c] = triangle.map(|corner| particles.end[corner as usize]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            for particle in 0..fabric.particle_count() as u32 {
                let at = particles.end[particle as usize];
                let is_over = [[a, b], [b, c], [c, a]]
                    .iter()
                    .all(|[from, to]| (*to - *from).cross(at - *from).dot(normal) > LEAST_LENGTH);
                let is_far = rest[particle as usize].distance(rest[triangle[0] as usize]) > 0.3;
                if is_over && is_far && (at - a).dot(normal).abs() < THICKNESS {
                    near += 1;
                    let pair = [particle, triangle[0], triangle[1], triangle[2]];
                    assert!(pairs.particles_triangles.contains(&pair), "{pair:?}");
                }
            }
        }
        let count = pairs.particles_triangles.len();
        assert!(near > 100 && count < 20 * near, "{near} near, {count} found");
    }

    #[test]
    fn edges_that_pass_through_triangles_are_found_once() {
        let (fabric, particles) = folded();
        let (mesh, pairs) = found(&fabric, &particles);
        let passes = |pair: &EdgeTriangle| crossing(pair, &particles.end).is_some();
        let mut expected = 0;
        for (index, edge) in mesh.edges.iter().enumerate() {
            for &triangle in fabric.triangles() {
                let pair = EdgeTriangle { index: index as u32, edge: edge.ends, triangle };
                let apart = edge.ends.iter().all(|end| !triangle.contains(end));
                expected += usize::from(apart && passes(&pair));
            }
        }
        let count = pairs.edges_triangles.iter().filter(|pair| passes(pair)).count();
        assert!(expected > 20 && count == expected, "{count} of {expected}");
        let mut edges = pairs.edges_edges.clone();
        edges.iter_mut().for_each(|[a, b, c, d]| {
            (*a, *b) = (*a.min(b), *a.max(b));
            (*c, *d) = (*c.min(d), *c.max(d));
        });
        edges
            .iter_mut()
            .filter(|[a, b, c, d]| [a, b] > [c, d])
            .for_each(|pair| pair.rotate_left(2));
        edges.sort_unstable();
        let before = edges.len();
        edges.dedup();
        assert!(before > 100 && edges.len() == before, "{before} pairs, {} different", edges.len());
    }
}
