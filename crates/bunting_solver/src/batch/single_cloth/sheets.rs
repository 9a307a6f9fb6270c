//! The particles of a grid as a kernel of yarns finds them: coordinate by coordinate, with those of a
//! row side by side, or those of a column.

use fearless_simd::{Simd, SimdBase, dispatch, f32x4};

use crate::batch::places::Places;
use crate::fabric::Grid;
use crate::simd::lane::{Lane, Pack};
use crate::simd::level::level;
use crate::simd::vec3::{Pack3, V3};

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
    /// Particles in a row, and in a column.
    extent: [usize; 2],
    sheets: [Sheet; 2],
}

/// Lines of particles, drawn out to whole packs by particles that are pinned to the origin.
#[derive(Clone, Debug)]
struct Sheet {
    /// Numbers from one line to the next.
    stride: usize,
    /// m.
    position: Plane,
    /// As the batch's, 1/m².
    weights: Vec<f32>,
}

/// A vector for each particle of a sheet, coordinate by coordinate.
#[derive(Clone, Debug)]
pub(crate) struct Plane([Vec<f32>; 3]);

/// Numbers before the first line and after the last: a pack of diagonals sticks out of the sheet by all
/// lanes but one.
pub(crate) const MARGIN: usize = 16;

/// Tiles by which a sheet is turned.
const TILE: usize = 4;

impl Plane {
    pub fn new(lines: usize, stride: usize) -> Self {
        let numbers = vec![0.0; lines * stride + 2 * MARGIN];
        Self([numbers.clone(), numbers.clone(), numbers])
    }

    #[inline(always)]
    pub fn load<L: Lane>(&self, token: L::Token, at: usize) -> V3<L> {
        let Self([x, y, z]) = self;
        V3 { x: L::load_at(token, x, at), y: L::load_at(token, y, at), z: L::load_at(token, z, at) }
    }

    #[inline(always)]
    pub fn store<L: Lane>(&mut self, at: usize, vector: V3<L>) {
        let Self([x, y, z]) = self;
        vector.x.store_at(x, at);
        vector.y.store_at(y, at);
        vector.z.store_at(z, at);
    }

    /// Overwrites a straight sheet, given its packs row by row.
    pub fn read<P: Pack>(&mut self, packs: &[Pack3<P>]) {
        let [x, y, z] = self.0.each_mut().map(|axis| axis[MARGIN..].chunks_exact_mut(P::WIDTH));
        for (((x, y), z), pack) in x.zip(y).zip(z).zip(packs) {
            x.copy_from_slice(pack[0].lanes());
            y.copy_from_slice(pack[1].lanes());
            z.copy_from_slice(pack[2].lanes());
        }
    }

    /// Overwrites packs, row by row, by what a straight sheet holds.
    fn write<P: Pack>(&self, packs: &mut [Pack3<P>]) {
        let [x, y, z] = self.0.each_ref().map(|axis| axis[MARGIN..].chunks_exact(P::WIDTH));
        for (((x, y), z), pack) in x.zip(y).zip(z).zip(packs) {
            pack[0].lanes_mut().copy_from_slice(x);
            pack[1].lanes_mut().copy_from_slice(y);
            pack[2].lanes_mut().copy_from_slice(z);
        }
    }
}

impl Sheets {
    pub fn new<P: Pack>(grid: &Grid) -> Self {
        let extent = [grid.columns, grid.rows].map(|count| count as usize);
        let [wide, high] = extent.map(|count| count.next_multiple_of(P::WIDTH));
        Self {
            facing: Facing::Straight,
            extent,
            sheets: [Sheet::new(high, wide), Sheet::new(wide, high)],
        }
    }

    /// Numbers from one row to the next.
    pub fn stride(&self) -> usize {
        self.sheets[0].stride
    }

    /// The positions, row by row.
    pub fn straight(&self) -> &Plane {
        &self.sheets[0].position
    }

    /// Room for another vector for each particle, row by row.
    pub fn plane(&self) -> Plane {
        self.straight().clone()
    }

    /// Where a pack of a row begins, all rows' one after the other.
    pub fn pack<P: Pack>(index: usize) -> u32 {
        (MARGIN + index * P::WIDTH) as u32
    }

    /// Where a pack begins, given its line and the place of its first lane on it.
    pub fn at(&self, facing: Facing, line: usize, place: isize) -> u32 {
        let first = (MARGIN + line * self.sheets[facing as usize].stride) as isize;
        (first + place) as u32
    }

    /// Forgets all positions.
    pub fn clear(&mut self) {
        for coordinate in self.sheets.iter_mut().flat_map(|sheet| &mut sheet.position.0) {
            coordinate.fill(0.0);
        }
    }

    pub fn set_weights(&mut self, weights: &[f32]) {
        for (row, weights) in weights.chunks(self.extent[0]).enumerate() {
            for (column, &weight) in weights.iter().enumerate() {
                let [straight, turned] = &mut self.sheets;
                straight.weights[MARGIN + row * straight.stride + column] = weight;
                turned.weights[MARGIN + column * turned.stride + row] = weight;
            }
        }
    }

    /// Reads the positions of a batch.
    pub fn read<P: Pack>(&mut self, position: &[Pack3<P>]) {
        self.facing = Facing::Straight;
        self.sheets[0].position.read(position);
    }

    /// Writes the positions of a batch.
    pub fn write<P: Pack>(&mut self, position: &mut [Pack3<P>]) {
        self.turn(Facing::Straight);
        self.sheets[0].position.write(position);
    }

    /// Lets the particles of rows lie side by side, or those of columns.
    pub fn turn(&mut self, facing: Facing) {
        if self.facing != facing {
            self.facing = facing;
            let [columns, rows] = self.extent;
            let [straight, turned] = &mut self.sheets;
            match facing {
                Facing::Straight => straight.turn_from(turned, [rows, columns]),
                Facing::Turned => turned.turn_from(straight, [columns, rows]),
            }
        }
    }

    /// The particles as they face us. `present` is one in the lanes that have a link of a class.
    pub fn threads<'a, P: Pack>(&'a mut self, present: &'a [P]) -> Threads<'a, P> {
        let Sheet { position, weights, .. } = &mut self.sheets[self.facing as usize];
        let Plane([x, y, z]) = position;
        Threads { position: [x, y, z], weights, present }
    }
}

impl Sheet {
    fn new(lines: usize, stride: usize) -> Self {
        let position = Plane::new(lines, stride);
        Self { stride, weights: position.0[0].clone(), position }
    }

    /// Takes over the positions of the other sheet, whose lines are so long and so many.
    fn turn_from(&mut self, other: &Self, extent: [usize; 2]) {
        let strides = [other.stride, self.stride];
        for (into, from) in self.position.0.iter_mut().zip(&other.position.0) {
            let (into, from) = (&mut into[MARGIN..], &from[MARGIN..]);
            dispatch!(level(), token => turn(token, from, into, strides, extent));
        }
    }
}

/// Transposes `many` lines of `long` numbers, tile by tile.
#[inline(always)]
fn turn<S: Simd>(
    token: S,
    from: &[f32],
    into: &mut [f32],
    [wide, high]: [usize; 2],
    [long, many]: [usize; 2],
) {
    for line in (0..many).step_by(TILE) {
        for place in (0..long).step_by(TILE) {
            let from = &from[line * wide + place..][..3 * wide + TILE];
            let a = f32x4::from_slice(token, &from[..TILE]);
            let b = f32x4::from_slice(token, &from[wide..wide + TILE]);
            let c = f32x4::from_slice(token, &from[2 * wide..2 * wide + TILE]);
            let d = f32x4::from_slice(token, &from[3 * wide..3 * wide + TILE]);
            let (ac, also_ac) = (a.zip_low(c), a.zip_high(c));
            let (bd, also_bd) = (b.zip_low(d), b.zip_high(d));
            let into = &mut into[place * high + line..][..3 * high + TILE];
            ac.zip_low(bd).store_slice(&mut into[..TILE]);
            ac.zip_high(bd).store_slice(&mut into[high..high + TILE]);
            also_ac.zip_low(also_bd).store_slice(&mut into[2 * high..2 * high + TILE]);
            also_ac.zip_high(also_bd).store_slice(&mut into[3 * high..3 * high + TILE]);
        }
    }
}

/// Yarns of one cloth, one in each lane.
pub(crate) struct Threads<'a, P: Pack> {
    position: [&'a mut [f32]; 3],
    weights: &'a [f32],
    present: &'a [P],
}

impl<P: Pack> Places<P> for Threads<'_, P> {
    type Constant = P;

    #[inline(always)]
    fn position<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> V3<L> {
        let ([x, y, z], at) = (&self.position, at as usize);
        V3 { x: L::load_at(token, x, at), y: L::load_at(token, y, at), z: L::load_at(token, z, at) }
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = P>>(&mut self, at: u32, position: V3<L>) {
        let ([x, y, z], at) = (&mut self.position, at as usize);
        position.x.store_at(x, at);
        position.y.store_at(y, at);
        position.z.store_at(z, at);
    }

    #[inline(always)]
    fn weight<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> L {
        L::load_at(token, self.weights, at as usize)
    }

    #[inline(always)]
    fn one<L: Lane<Pack = P>>(&self, token: L::Token, class: u32) -> L {
        L::load(token, &self.present[class as usize])
    }
}
