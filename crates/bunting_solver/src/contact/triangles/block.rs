//! Eight triangles: the nearest to a point, and the first that a path meets, are found at once.

use glam::Vec3;
use parry3d::shape::Triangle;

use crate::constants::LEAST_AREA_SQUARED;
use crate::contact::itself::closest::{OnBorder, Over};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::registers::Pack8;
use crate::simd::vec3::{Pack3, V3, lane3, set_lane3, splat3};

/// Least barycentric coordinate of a point at which a path meets a triangle: less than zero, so that rounding leaves no gap between two triangles.
const INSIDE: f32 = -1e-5;

#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    corners: [Pack3<Pack8>; 3],
    /// The index of each triangle in the surface, in ascending order.
    indices: [u32; Pack8::WIDTH],
}

impl Block {
    /// Blocks of triangles in ascending order. The last triangle fills what is left of the last block.
    pub fn all_of(triangles: &[(u32, Triangle)]) -> impl Iterator<Item = Self> {
        triangles.chunks(Pack8::WIDTH).map(|chunk| {
            let zero = Pack8::splat(0.0);
            let mut block = Self { corners: [[zero; 3]; 3], indices: [0; Pack8::WIDTH] };
            let filled = chunk.iter().chain(core::iter::repeat(&chunk[chunk.len() - 1]));
            for (lane, (index, triangle)) in filled.take(Pack8::WIDTH).enumerate() {
                block.indices[lane] = *index;
                for (pack, at) in block.corners.iter_mut().zip(triangle.vertices()) {
                    set_lane3(pack, lane, *at);
                }
            }
            block
        })
    }

    fn triangle(&self, lane: usize) -> Triangle {
        Triangle::from(self.corners.map(|pack| lane3(&pack, lane)))
    }
}

/// The point of some triangles that is nearest to another point.
pub(super) struct Nearest {
    /// The index of its triangle.
    pub index: u32,
    pub triangle: Triangle,
    /// Barycentric coordinates. On the border of the triangle some are exactly zero.
    pub coordinates: [f32; 3],
    /// From the nearest point to the other one, m.
    pub away: Vec3,
}

/// The point of some triangles that is nearest to another one, if it is within a distance, m. Of equally near triangles the first one has it.
pub(super) fn nearest(blocks: &[Block], at: Vec3, within: f32) -> Option<Nearest> {
    let zero = Pack8::splat(0.0);
    let mut least = Least::more_than(within * within);
    let (mut coordinates, mut away) = ([zero; 3], [zero; 3]);
    Pack8::run(FindNearest {
        blocks,
        at,
        least: &mut least,
        coordinates: &mut coordinates,
        away: &mut away,
    });
    let (block, lane) = least.of_all(blocks)?;
    Some(Nearest {
        index: block.indices[lane],
        triangle: block.triangle(lane),
        coordinates: coordinates.map(|of_corner| of_corner.lanes()[lane]),
        away: lane3(&away, lane),
    })
}

/// Adds all triangles within a distance of a point, m.
pub(super) fn within(blocks: &[Block], at: Vec3, distance: f32, found: &mut Vec<Triangle>) {
    for block in blocks {
        let mut squared = Pack8::splat(0.0);
        Pack8::run(SquareDistances { block, at, squared: &mut squared });
        let mut before = None;
        for (lane, squared) in squared.lanes().iter().enumerate() {
            let index = block.indices[lane];
            if *squared <= distance * distance && before != Some(index) {
                found.push(block.triangle(lane));
            }
            before = Some(index);
        }
    }
}

/// The first triangle that a path meets, of equals the one with the least index, and the part of the path before it.
pub(super) fn first_met(blocks: &[Block], from: Vec3, to: Vec3) -> Option<(f32, Triangle)> {
    let mut least = Least::more_than(1.0);
    Pack8::run(FindFirstMet { blocks, from, to, least: &mut least });
    let (block, lane) = least.of_all(blocks)?;
    Some((least.number.lanes()[lane], block.triangle(lane)))
}

/// In each lane the least number that has been found, and its block.
struct Least {
    number: Pack8,
    block: Pack8,
    limit: f32,
}

impl Least {
    /// No number that is not greater than a limit has been found.
    fn more_than(limit: f32) -> Self {
        Self { number: Pack8::splat(f32::INFINITY), block: Pack8::splat(0.0), limit }
    }

    /// The block and lane of the least number of all lanes, if it is not greater than the limit.
    fn of_all<'a>(&self, blocks: &'a [Block]) -> Option<(&'a Block, usize)> {
        let mut first: Option<((f32, u32), &Block, usize)> = None;
        for (lane, (&number, at)) in self.number.lanes().iter().zip(self.block.lanes()).enumerate()
        {
            if number > self.limit {
                continue;
            }
            let block = &blocks[*at as usize];
            let order = (number, block.indices[lane]);
            if first.is_none_or(|(than, ..)| order < than) {
                first = Some((order, block, lane));
            }
        }
        first.map(|(_, block, lane)| (block, lane))
    }
}

/// From the point of each triangle that is nearest to another point, m, and its barycentric coordinates.
#[inline(always)]
fn away_from<L: Lane<Pack = Pack8>>(token: L::Token, block: &Block, at: V3<L>) -> (V3<L>, [L; 3]) {
    let [a, b, c] = &block.corners;
    let points = [at, V3::load(token, a), V3::load(token, b), V3::load(token, c)];
    let (over, border) = (Over::new(token, &points), OnBorder::new(token, &points));
    let away = (over.normal * over.height).or_where_not(over.is_inside, border.away);
    let ([a, b, c], [d, e, f]) = (over.coordinates, border.coordinates);
    let of_a = a.or_where_not(over.is_inside, d);
    let of_b = b.or_where_not(over.is_inside, e);
    let of_c = c.or_where_not(over.is_inside, f);
    (away, [of_a, of_b, of_c])
}

struct SquareDistances<'a> {
    block: &'a Block,
    at: Vec3,
    /// Squares of distances, m².
    squared: &'a mut Pack8,
}

impl Kernel<Pack8> for SquareDistances<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let (away, _) = away_from::<L>(token, self.block, V3::load(token, &splat3(self.at)));
        away.dot(away).store(self.squared);
    }
}

struct FindNearest<'a> {
    blocks: &'a [Block],
    at: Vec3,
    /// Squares of distances, m².
    least: &'a mut Least,
    /// Barycentric coordinates of the nearest point.
    coordinates: &'a mut [Pack8; 3],
    /// From the nearest point, m.
    away: &'a mut Pack3<Pack8>,
}

impl Kernel<Pack8> for FindNearest<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let at: V3<L> = V3::load(token, &splat3(self.at));
        let one = L::splat(token, 1.0);
        let mut least = L::load(token, &self.least.number);
        let mut found = L::load(token, &self.least.block);
        let mut index = found;
        let [mut of_a, mut of_b, mut of_c] = [index; 3];
        let mut away = at;
        for block in self.blocks {
            let (here, [a, b, c]) = away_from::<L>(token, block, at);
            let squared = here.dot(here);
            let is_nearer = squared.lt(least);
            least = squared.or_where_not(is_nearer, least);
            found = index.or_where_not(is_nearer, found);
            away = here.or_where_not(is_nearer, away);
            of_a = a.or_where_not(is_nearer, of_a);
            of_b = b.or_where_not(is_nearer, of_b);
            of_c = c.or_where_not(is_nearer, of_c);
            index = index + one;
        }
        least.store(&mut self.least.number);
        found.store(&mut self.least.block);
        away.store(self.away);
        of_a.store(&mut self.coordinates[0]);
        of_b.store(&mut self.coordinates[1]);
        of_c.store(&mut self.coordinates[2]);
    }
}

struct FindFirstMet<'a> {
    blocks: &'a [Block],
    from: Vec3,
    to: Vec3,
    /// Parts of the path.
    least: &'a mut Least,
}

impl Kernel<Pack8> for FindFirstMet<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let from: V3<L> = V3::load(token, &splat3(self.from));
        let back: V3<L> = V3::load(token, &splat3(self.from - self.to));
        let one = L::splat(token, 1.0);
        let inside = L::splat(token, INSIDE);
        let smallest = L::splat(token, LEAST_AREA_SQUARED);
        let mut least = L::load(token, &self.least.number);
        let mut found = L::load(token, &self.least.block);
        let mut index = found;
        for Block { corners: [a, b, c], .. } in self.blocks {
            // Cramer's rule (Ericson 2005, "Real-time collision detection", 5.3.6), for both sides of a triangle.
            let a: V3<L> = V3::load(token, a);
            let (first, second) = (V3::load(token, b) - a, V3::load(token, c) - a);
            let (normal, start) = (first.cross(second), from - a);
            let approach = back.dot(normal);
            let moment = back.cross(start);
            let inverse = one / approach;
            let part = start.dot(normal) * inverse;
            let (of_b, of_c) = (second.dot(moment) * inverse, -(first.dot(moment) * inverse));
            let of_a = one - of_b - of_c;
            let is_met = inside.lt(of_a.min(of_b).min(of_c))
                & inside.lt(part)
                & part.lt(least)
                & smallest.lt(normal.dot(normal));
            least = part.max(L::splat(token, 0.0)).or_where_not(is_met, least);
            found = index.or_where_not(is_met, found);
            index = index + one;
        }
        least.store(&mut self.least.number);
        found.store(&mut self.least.block);
    }
}
