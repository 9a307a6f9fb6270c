//! The particles of a grid as a kernel of yarns finds them: coordinate by coordinate, with those of a
//! row side by side, or those of a column.

use fearless_simd::{Simd, SimdBase, dispatch, f32x4};

use super::SIDE;
use crate::fabric::Grid;
use crate::instruction_set::level;
use crate::lanes::{Lane, Pack, Pack8};
use crate::places::Places;
use crate::vector::{Pack3, V3};

/// Along what particles lie side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Facing {
    /// Along a row.
    Straight,
    /// Along a column.
    Turned,
}

/// A grid both ways. The positions are right in the sheet that faces us.
#[derive(Clone, Debug)]
pub(crate) struct Sheets {
    facing: Facing,
    columns: usize,
    sheets: [Sheet; 2],
}

/// Lines of particles, drawn out to whole packs by particles that are pinned to the origin.
#[derive(Clone, Debug)]
struct Sheet {
    /// Numbers from one line to the next.
    stride: usize,
    /// m.
    position: [Vec<f32>; 3],
    /// As the batch's, 1/m².
    weights: Vec<f32>,
}

/// Numbers before the first line and after the last: a pack of diagonals sticks out of the sheet.
const MARGIN: usize = SIDE;

/// Tiles by which a sheet is turned.
const TILE: usize = 4;

impl Sheets {
    pub fn new(grid: &Grid) -> Self {
        let [columns, rows] = [grid.columns, grid.rows].map(|count| count as usize);
        let [wide, high] = [columns, rows].map(|count| count.next_multiple_of(SIDE));
        Self {
            facing: Facing::Straight,
            columns,
            sheets: [Sheet::new(high, wide), Sheet::new(wide, high)],
        }
    }

    /// Where a pack begins, given its line and the place of its first lane on it.
    pub fn at(&self, facing: Facing, line: usize, place: isize) -> u32 {
        let first = (MARGIN + line * self.sheets[facing as usize].stride) as isize;
        (first + place) as u32
    }

    /// Forgets all positions.
    pub fn clear(&mut self) {
        for coordinate in self.sheets.iter_mut().flat_map(|sheet| &mut sheet.position) {
            coordinate.fill(0.0);
        }
    }

    pub fn set_weights(&mut self, weights: &[f32]) {
        for (row, weights) in weights.chunks(self.columns).enumerate() {
            for (column, &weight) in weights.iter().enumerate() {
                let [straight, turned] = &mut self.sheets;
                straight.weights[MARGIN + row * straight.stride + column] = weight;
                turned.weights[MARGIN + column * turned.stride + row] = weight;
            }
        }
    }

    /// Reads the positions of the only lane of a batch.
    pub fn read<P: Pack>(&mut self, position: &[Pack3<P>]) {
        self.facing = Facing::Straight;
        let Sheet { stride, position: [x, y, z], .. } = &mut self.sheets[0];
        for (row, particles) in position.chunks(self.columns).enumerate() {
            let first = MARGIN + row * *stride;
            let places = x[first..].iter_mut().zip(&mut y[first..]).zip(&mut z[first..]);
            for (((x, y), z), particle) in places.zip(particles) {
                (*x, *y, *z) =
                    (particle[0].lanes()[0], particle[1].lanes()[0], particle[2].lanes()[0]);
            }
        }
    }

    /// Writes the positions into the only lane of a batch.
    pub fn write<P: Pack>(&mut self, position: &mut [Pack3<P>]) {
        self.turn(Facing::Straight);
        let Sheet { stride, position: [x, y, z], .. } = &self.sheets[0];
        for (row, particles) in position.chunks_mut(self.columns).enumerate() {
            let first = MARGIN + row * stride;
            let (x, y, z) = (&x[first..], &y[first..], &z[first..]);
            for (((x, y), z), particle) in x.iter().zip(y).zip(z).zip(particles) {
                particle[0].lanes_mut()[0] = *x;
                particle[1].lanes_mut()[0] = *y;
                particle[2].lanes_mut()[0] = *z;
            }
        }
    }

    /// Lets the particles of rows lie side by side, or those of columns.
    pub fn turn(&mut self, facing: Facing) {
        if self.facing != facing {
            self.facing = facing;
            let [straight, turned] = &mut self.sheets;
            match facing {
                Facing::Straight => straight.turn_from(turned),
                Facing::Turned => turned.turn_from(straight),
            }
        }
    }

    /// The particles as they face us. `present` is one in the lanes that have a link of a class.
    pub fn threads<'a>(&'a mut self, present: &'a [Pack8]) -> Threads<'a> {
        let Sheet { position: [x, y, z], weights, .. } = &mut self.sheets[self.facing as usize];
        Threads { position: [x, y, z], weights, present }
    }
}

impl Sheet {
    fn new(lines: usize, stride: usize) -> Self {
        let numbers = vec![0.0; lines * stride + 2 * MARGIN];
        Self {
            stride,
            position: [numbers.clone(), numbers.clone(), numbers.clone()],
            weights: numbers,
        }
    }

    fn turn_from(&mut self, other: &Self) {
        let strides = [other.stride, self.stride];
        for (into, from) in self.position.iter_mut().zip(&other.position) {
            let (into, from) = (&mut into[MARGIN..], &from[MARGIN..]);
            dispatch!(level(), token => turn(token, from, into, strides));
        }
    }
}

/// Transposes lines of numbers, tile by tile.
#[inline(always)]
fn turn<S: Simd>(token: S, from: &[f32], into: &mut [f32], [wide, high]: [usize; 2]) {
    for line in (0..high).step_by(TILE) {
        for place in (0..wide).step_by(TILE) {
            let from = &from[line * wide + place..][..3 * wide + TILE];
            let a = f32x4::from_slice(token, &from[..TILE]);
            let b = f32x4::from_slice(token, &from[wide..][..TILE]);
            let c = f32x4::from_slice(token, &from[2 * wide..][..TILE]);
            let d = f32x4::from_slice(token, &from[3 * wide..][..TILE]);
            let (ac, also_ac) = (a.zip_low(c), a.zip_high(c));
            let (bd, also_bd) = (b.zip_low(d), b.zip_high(d));
            let into = &mut into[place * high + line..][..3 * high + TILE];
            ac.zip_low(bd).store_slice(&mut into[..TILE]);
            ac.zip_high(bd).store_slice(&mut into[high..][..TILE]);
            also_ac.zip_low(also_bd).store_slice(&mut into[2 * high..][..TILE]);
            also_ac.zip_high(also_bd).store_slice(&mut into[3 * high..][..TILE]);
        }
    }
}

/// Yarns of one cloth, one in each lane.
pub(crate) struct Threads<'a> {
    position: [&'a mut [f32]; 3],
    weights: &'a [f32],
    present: &'a [Pack8],
}

impl Places<Pack8> for Threads<'_> {
    type Constant = Pack8;

    #[inline(always)]
    fn position<L: Lane<Pack = Pack8>>(&self, token: L::Token, at: u32) -> V3<L> {
        let [x, y, z] = &self.position;
        let load = |axis: &[f32]| L::load_first(token, &axis[at as usize..]);
        V3 { x: load(x), y: load(y), z: load(z) }
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = Pack8>>(&mut self, at: u32, position: V3<L>) {
        let [x, y, z] = &mut self.position;
        position.x.store_first(&mut x[at as usize..]);
        position.y.store_first(&mut y[at as usize..]);
        position.z.store_first(&mut z[at as usize..]);
    }

    #[inline(always)]
    fn weight<L: Lane<Pack = Pack8>>(&self, token: L::Token, at: u32) -> L {
        L::load_first(token, &self.weights[at as usize..])
    }

    #[inline(always)]
    fn one<L: Lane<Pack = Pack8>>(&self, token: L::Token, class: u32) -> L {
        L::load(token, &self.present[class as usize])
    }
}
