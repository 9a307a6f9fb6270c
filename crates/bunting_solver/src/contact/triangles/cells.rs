//! A sparse grid of cells, each with the triangles near it.

use core::fmt;
use core::hash::{BuildHasherDefault, Hasher};
use core::ops::Range;
use std::collections::HashMap;

use glam::{IVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::query::PointQuery;
use parry3d::shape::{SharedShape, Triangle};

use super::block::{Block, first_met, nearest, within};
use super::surface::TriangleSurface;

/// Distance from its edges, in widths of a cell, within which a cell knows the triangles. At least half of the diagonal, so that a point without a
/// triangle within this distance is on the same side of the surface as the middle of its cell.
const REACH: f32 = 1.0;

/// Width of a cell in lengths of the shortest link. Larger: each cell has more triangles. Smaller: particles come to new cells more often.
const WIDTH: f32 = 0.25;

/// Least width of a cell in distances at which particles touch: the reach of a cell must be longer than these.
const LEAST_WIDTH: f32 = 2.0;

/// Greatest width of a cell in widths of a triangle. Larger: the many triangles of each cell take more time than a search in the whole surface.
const GREATEST_WIDTH: f32 = 4.0;

/// Numbers of cells and of blocks for each particle from which on a grid is begun anew. Less: a cloth that lies on a mesh of much smaller
/// triangles finds them again in each tick. More: memory of cloth that is carried far over a ground.
const MOST_CELLS: usize = 8;
const MOST_BLOCKS: usize = 8;

/// Where a point is relative to the surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) enum Near {
    /// The surface is within reach.
    At {
        /// From the nearest point of the surface, m.
        away: Vec3,
        is_inside: bool,
    },
    /// It is not, and the point is outside.
    Outside,
    /// It is not, and the point is inside.
    Inside,
}

/// The triangles of a shape near the places where a cloth has come. What it tells does not depend on where that was before.
#[derive(Clone)]
pub(crate) struct TriangleCells {
    shape: SharedShape,
    /// Width of a cell, m.
    width: f32,
    cells: Cells,
    blocks: Vec<Block>,
    /// Triangles of the cell that is made.
    found: Vec<(u32, Triangle)>,
}

type Cells = HashMap<IVec3, Cell, BuildHasherDefault<PlaceHasher>>;

#[derive(Clone, Debug)]
struct Cell {
    blocks: Range<u32>,
    /// Whether the middle is inside, once that has been asked for.
    is_inside: Option<bool>,
}

impl Cell {
    fn of<'a>(&self, blocks: &'a [Block]) -> &'a [Block] {
        &blocks[self.blocks.start as usize..self.blocks.end as usize]
    }
}

/// A hash of three whole numbers, for which the default one takes as long as all else that is done with a cell.
#[derive(Default)]
struct PlaceHasher(u64);

impl Hasher for PlaceHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_i32(i32::from(*byte)));
    }

    fn write_i32(&mut self, number: i32) {
        /// 2⁶⁴ over the golden ratio (Knuth 1998, "Sorting and searching", 6.4).
        const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
        self.0 = (self.0.rotate_left(23) ^ u64::from(number.cast_unsigned())).wrapping_mul(FACTOR);
    }
}

impl fmt::Debug for TriangleCells {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { width, cells, blocks, .. } = self;
        write!(formatter, "{} cells of {width} m, {} blocks", cells.len(), blocks.len())
    }
}

impl TriangleCells {
    /// Begins a tick with a shape for a cloth of a number of particles, given the distance at which they touch and the shortest link, m: keeps cells of
    /// the same shape and width; none of a shape that does not consist of triangles, or of too small ones.
    pub fn begin_tick(
        cells: &mut Option<Self>,
        shape: &SharedShape,
        [distance, link]: [f32; 2],
        particles: usize,
    ) {
        let Some(surface) = TriangleSurface::of(&*shape.0) else {
            *cells = None;
            return;
        };
        let of_triangle = surface.width_of_triangle();
        let width = (WIDTH * link).min(of_triangle).max(LEAST_WIDTH * distance);
        let is_kept = |cells: &Self| {
            core::ptr::addr_eq(&raw const *cells.shape.0, &raw const *shape.0)
                && cells.width == width
                && cells.cells.len() <= MOST_CELLS * particles
                && cells.blocks.len() <= MOST_BLOCKS * particles
        };
        if cells.as_ref().is_some_and(is_kept) {
            return;
        }
        *cells = (width <= GREATEST_WIDTH * of_triangle).then(|| Self {
            shape: shape.clone(),
            width,
            cells: Cells::default(),
            blocks: Vec::new(),
            found: Vec::new(),
        });
    }

    /// Distance within which the surface is found, m.
    pub fn reach(&self) -> f32 {
        REACH * self.width
    }

    /// Where a point is relative to the surface.
    pub(in crate::contact) fn nearest(&mut self, at: Vec3) -> Near {
        let reach = self.reach();
        let Self { shape, width, cells, blocks, found } = self;
        let Some(surface) = TriangleSurface::of(&*shape.0) else { return Near::Outside };
        let (cell, middle) = cell_at(at, surface, *width, cells, blocks, found);
        cell.nearest(surface, middle, blocks, reach, at)
    }

    /// Adds all triangles within a distance of a point, m, at most the reach. Returns the distance within which the surface is known then; a negative one if
    /// the point is so far inside that there is no triangle.
    pub fn within(&mut self, at: Vec3, distance: f32, found: &mut Vec<Triangle>) -> f32 {
        let Self { shape, width, cells, blocks, found: new } = self;
        let Some(surface) = TriangleSurface::of(&*shape.0) else { return distance };
        let (cell, middle) = cell_at(at, surface, *width, cells, blocks, new);
        let before = found.len();
        within(cell.of(blocks), at, distance, found);
        let is_near = found.len() > before;
        let mut is_inside = || match cell.nearest(surface, middle, blocks, REACH * *width, at) {
            Near::At { is_inside, .. } => is_inside,
            Near::Inside => true,
            Near::Outside => false,
        };
        if !is_near && is_inside() { -1.0 } else { distance }
    }

    /// Whether the surface has an inside.
    pub fn is_closed(&self) -> bool {
        TriangleSurface::of(&*self.shape.0).is_some_and(TriangleSurface::is_closed)
    }

    /// The first point of the surface on a path that is not longer than the reach, m, and the unit normal there, against the path.
    pub fn entry(&mut self, from: Vec3, to: Vec3) -> Option<(Vec3, Vec3)> {
        let Self { shape, width, cells, blocks, found } = self;
        let surface = TriangleSurface::of(&*shape.0)?;
        let (cell, _) = cell_at(to, surface, *width, cells, blocks, found);
        let (part, triangle) = first_met(cell.of(blocks), from, to)?;
        let normal = triangle.normal()?;
        let faces = if normal.dot(to - from) < 0.0 { normal } else { -normal };
        Some((from.lerp(to, part), faces))
    }
}

impl Cell {
    fn nearest(
        &mut self,
        surface: TriangleSurface,
        middle: Vec3,
        blocks: &[Block],
        reach: f32,
        at: Vec3,
    ) -> Near {
        if let Some(nearest) = nearest(self.of(blocks), at, reach) {
            let is_inside = surface.is_inside(at, &nearest);
            return Near::At { away: nearest.away, is_inside };
        }
        let is_inside = match surface {
            // Below the border of ground, and of holes in it, sides change where there is no triangle.
            TriangleSurface::Field(_) => surface.contains(at),
            _ => *self.is_inside.get_or_insert_with(|| surface.contains(middle)),
        };
        if is_inside { Near::Inside } else { Near::Outside }
    }
}

/// The cell around a point, and its middle.
fn cell_at<'a>(
    at: Vec3,
    surface: TriangleSurface,
    width: f32,
    cells: &'a mut Cells,
    blocks: &mut Vec<Block>,
    found: &mut Vec<(u32, Triangle)>,
) -> (&'a mut Cell, Vec3) {
    let place = floor(at / width);
    let middle = (place.as_vec3() + 0.5) * width;
    let cell = cells.entry(place).or_insert_with(|| {
        let around = Aabb::from_half_extents(middle, Vec3::splat((0.5 + REACH) * width));
        found.clear();
        surface.near(&around, found);
        // The corners of that box are farther away than the reach of a point in the cell.
        let farthest = (0.75_f32.sqrt() + REACH) * width;
        found.retain(|(_, triangle)| triangle.distance_to_local_point(middle, true) <= farthest);
        found.sort_unstable_by_key(|(index, _)| *index);
        let first = blocks.len() as u32;
        blocks.extend(Block::all_of(found));
        Cell { blocks: first..blocks.len() as u32, is_inside: None }
    });
    (cell, middle)
}

/// The greatest whole numbers that are not greater than these.
fn floor(of: Vec3) -> IVec3 {
    let cut = of.as_ivec3();
    cut - IVec3::select(of.cmplt(cut.as_vec3()), IVec3::ONE, IVec3::ZERO)
}
