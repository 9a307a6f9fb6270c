//! Triangles near the particles of packs, in each lane others.

use core::ops::Range;

use glam::Vec3;
use parry3d::shape::Triangle;

use crate::constants::{LEAST_AREA_SQUARED, LEAST_LENGTH};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3, set_lane3};

/// Part by which the squares of the distances of two triangles differ that share the nearest point. Larger: the side of a surface is told by a triangle
/// beside it. Smaller: by rounding, the side is told by the one of two triangles that is seen from behind.
const SAME: f32 = 1e-4;

/// Coordinate of triangles that are near nothing, m.
const FAR: f32 = 1e15;

/// The triangles near one particle.
#[derive(Clone, Debug)]
struct OfLane {
    /// Index of the particle's pack among those near the collider.
    pack: u32,
    lane: u32,
    triangles: Range<usize>,
}

/// The triangles near the particles of a set of packs.
#[derive(Clone, Debug)]
pub(in crate::contact) struct LaneTriangles<P: Pack> {
    /// Those of one pack after those of another: in each lane a triangle.
    triangles: Vec<InLanes<P>>,
    packs: Vec<OfPack<P>>,
    of_lanes: Vec<OfLane>,
    found: Vec<Triangle>,
}

/// A triangle in each lane.
#[derive(Clone, Copy, Debug)]
struct InLanes<P: Pack> {
    corners: [Pack3<P>; 3],
    /// Unit normals, zero of collapsed triangles.
    normal: Pack3<P>,
    /// One over the squares of the edges that begin at the corners, 1/m².
    inverse_squares: [P; 3],
}

/// The triangles near the particles of a pack.
#[derive(Clone, Debug)]
struct OfPack<P: Pack> {
    triangles: Range<usize>,
    /// The places around which all triangles are known, in the collider's frame, and the distances up to which they are, m.
    middle: Pack3<P>,
    radius: P,
    /// One in lanes of surfaces that have an inside.
    is_closed: P,
    /// The substep of which the starts of paths are known, their distances from the surface, m, and the normals there.
    start_of: u32,
    start: (P, Pack3<P>),
}

impl<P: Pack> LaneTriangles<P> {
    pub fn new() -> Self {
        Self { triangles: Vec::new(), packs: Vec::new(), of_lanes: Vec::new(), found: Vec::new() }
    }

    /// Adds what is near a particle, given the index of its pack among those near the collider, its lane, and its place in the collider's frame: `find`
    /// adds all triangles up to a distance, m, which it returns; a negative one if none is known.
    pub fn add(
        &mut self,
        (pack, lane): (usize, usize),
        at: Vec3,
        is_closed: bool,
        find: impl FnOnce(&mut Vec<Triangle>) -> f32,
    ) {
        let zero = P::splat(0.0);
        let nothing = OfPack {
            triangles: 0..0,
            middle: [zero; 3],
            radius: zero,
            is_closed: zero,
            start_of: 0,
            start: (zero, [zero; 3]),
        };
        if self.packs.len() <= pack {
            self.packs.resize(pack + 1, nothing);
        }
        let first = self.found.len();
        let of_pack = &mut self.packs[pack];
        of_pack.radius.lanes_mut()[lane] = find(&mut self.found);
        of_pack.is_closed.lanes_mut()[lane] = f32::from(is_closed);
        set_lane3(&mut of_pack.middle, lane, at);
        let triangles = first..self.found.len();
        self.of_lanes.push(OfLane { pack: pack as u32, lane: lane as u32, triangles });
    }

    /// Puts all triangles into lanes.
    pub fn pack(&mut self) {
        for of_lane in &self.of_lanes {
            let of_pack = &mut self.packs[of_lane.pack as usize].triangles;
            of_pack.end = of_pack.end.max(of_lane.triangles.len());
        }
        let mut first = 0;
        for of_pack in &mut self.packs {
            let count = of_pack.triangles.len();
            of_pack.triangles = first..first + count;
            first += count;
        }
        let zero = P::splat(0.0);
        let nowhere = InLanes {
            corners: [[P::splat(FAR); 3]; 3],
            normal: [zero; 3],
            inverse_squares: [zero; 3],
        };
        self.triangles.clear();
        self.triangles.resize(first, nowhere);
        for OfLane { pack, lane, triangles } in self.of_lanes.drain(..) {
            let into = &mut self.triangles[self.packs[pack as usize].triangles.clone()];
            for (into, triangle) in into.iter_mut().zip(&self.found[triangles]) {
                for (pack, at) in into.corners.iter_mut().zip(triangle.vertices()) {
                    set_lane3(pack, lane as usize, *at);
                }
            }
        }
        self.found.clear();
        P::run(Prepare(&mut self.triangles));
    }

    /// One in lanes of surfaces that have an inside.
    pub fn is_closed(&self, pack: usize) -> &P {
        &self.packs[pack].is_closed
    }

    /// [`nearest`](Self::nearest) of the starts of the paths of a substep, which is counted from one: computed once.
    #[inline(always)]
    pub fn nearest_start<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        (pack, substep): (usize, u32),
        at: V3<L>,
        within: L,
    ) -> (L, V3<L>) {
        if self.packs[pack].start_of != substep {
            let near = self.nearest(token, pack, at, within);
            let of_pack = &mut self.packs[pack];
            of_pack.start_of = substep;
            near.0.store(&mut of_pack.start.0);
            near.1.store(&mut of_pack.start.1);
        }
        let (distance, normal) = &self.packs[pack].start;
        (L::load(token, distance), V3::load(token, normal))
    }

    /// Distances of points from the triangles near the particles of a pack, m, negative inside of closed surfaces, and the unit normals of the
    /// surface, towards points outside. `within`: the least distance, m, up to which triangles must be known; the distance is negative where they
    /// are not, and may be too small where nothing is nearer than that.
    #[inline(always)]
    pub fn nearest<L: Lane<Pack = P>>(
        &self,
        token: L::Token,
        pack: usize,
        at: V3<L>,
        within: L,
    ) -> (L, V3<L>) {
        let OfPack { triangles, middle, radius, is_closed, .. } = &self.packs[pack];
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let [less, more] = [L::splat(token, 1.0 - SAME), L::splat(token, 1.0 + SAME)];
        let mut squared = L::splat(token, f32::INFINITY);
        let mut height = zero;
        let mut away = V3 { x: zero, y: zero, z: zero };
        for triangle in &self.triangles[triangles.clone()] {
            let (here, of_this, over) = triangle.nearest(token, at);
            // Of triangles that share the nearest point, the one that faces it most tells the side.
            let is_nearer = of_this.lt(squared * less)
                | (of_this.lt(squared * more) & height.abs().lt(over.abs()));
            squared = of_this.min(squared);
            height = over.or_where_not(is_nearer, height);
            away = here.or_where_not(is_nearer, away);
        }
        let length = squared.sqrt();
        let is_inside = height.lt(zero) & zero.lt(L::load(token, is_closed));
        let sign = (-one).or_where_not(is_inside, one);
        let from_middle = at - V3::load(token, middle);
        let known = L::load(token, radius) - from_middle.dot(from_middle).sqrt();
        // What is beyond the triangles that are known is not in the way.
        let is_known = length.lt(known);
        let distance = (length * sign).or_where_not(is_known, known);
        let is_unknown = known.lt(within) & known.lt(length);
        let normal = away * (sign / length.max(L::splat(token, LEAST_LENGTH)));
        ((-one).or_where_not(is_unknown, distance), normal)
    }
}

impl<P: Pack> InLanes<P> {
    /// From the nearest points of the triangles to other points, m, the squares of these ways, and the heights of the points above the planes.
    #[inline(always)]
    fn nearest<L: Lane<Pack = P>>(&self, token: L::Token, at: V3<L>) -> (V3<L>, L, L) {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let [a, b, c] = &self.corners;
        let [a, b, c]: [V3<L>; 3] = [V3::load(token, a), V3::load(token, b), V3::load(token, c)];
        let normal: V3<L> = V3::load(token, &self.normal);
        let (mut away, mut squared) = (at, L::splat(token, f32::INFINITY));
        let mut least = one;
        for (from, to, inverse) in [
            (a, b, &self.inverse_squares[0]),
            (b, c, &self.inverse_squares[1]),
            (c, a, &self.inverse_squares[2]),
        ] {
            let (along, start) = (to - from, at - from);
            // Positive on the inner side of the edge.
            least = least.min(along.cross(start).dot(normal));
            let part = (start.dot(along) * L::load(token, inverse)).max(zero).min(one);
            let here = start.minus_scaled(along, part);
            let of_this = here.dot(here);
            let is_nearer = of_this.lt(squared);
            squared = of_this.or_where_not(is_nearer, squared);
            away = here.or_where_not(is_nearer, away);
        }
        let height = (at - a).dot(normal);
        let is_inside = zero.lt(least);
        let squared = (height * height).or_where_not(is_inside, squared);
        ((normal * height).or_where_not(is_inside, away), squared, height)
    }
}

/// Computes normals and inverse squares of triangles from their corners.
struct Prepare<'a, P: Pack>(&'a mut [InLanes<P>]);

impl<P: Pack> Kernel<P> for Prepare<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let one = L::splat(token, 1.0);
        let least = L::splat(token, LEAST_LENGTH * LEAST_LENGTH);
        let smallest = L::splat(token, LEAST_AREA_SQUARED);
        for InLanes { corners: [a, b, c], normal, inverse_squares } in self.0 {
            let [a, b, c]: [V3<L>; 3] =
                [V3::load(token, a), V3::load(token, b), V3::load(token, c)];
            let edges = [b - a, c - b, a - c];
            for (edge, inverse) in edges.into_iter().zip(inverse_squares) {
                (one / edge.dot(edge).max(least)).store(inverse);
            }
            let area = edges[0].cross(c - a);
            let squared = area.dot(area);
            let inverse = (one / squared.max(smallest)).sqrt();
            let inverse = inverse.or_where_not(smallest.lt(squared), L::splat(token, 0.0));
            (area * inverse).store(normal);
        }
    }
}
