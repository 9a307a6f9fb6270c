//! A vector for each particle of a grid, coordinate by coordinate.

use fearless_simd::{Simd, SimdBase, f32x4};

use super::grid_shape::MARGIN;
use crate::simd::lane::{Lane, Pack};
use crate::simd::level::dispatch;
use crate::simd::vec3::{Pack3, V3};

/// Number of places in the tiles in which a grid is transposed: four registers.
const TILE: usize = 4;

/// Number of lines in these tiles.
const LINES: usize = 2 * TILE;

/// A vector for each particle of a grid: arrays of x, y and z.
#[derive(Clone, Debug)]
pub(crate) struct VectorGrid([Vec<f32>; 3]);

impl VectorGrid {
    /// Zero for each particle.
    pub fn new(lines: usize, stride: usize) -> Self {
        let numbers = vec![0.0; lines * stride + 2 * MARGIN];
        Self([numbers.clone(), numbers.clone(), numbers])
    }

    /// The arrays.
    pub fn coordinates_mut(&mut self) -> [&mut [f32]; 3] {
        let Self([x, y, z]) = self;
        [x, y, z]
    }

    /// The vectors of consecutive particles from index `at` on.
    #[inline(always)]
    pub fn load<L: Lane>(&self, token: L::Token, at: usize) -> V3<L> {
        let Self([x, y, z]) = self;
        V3 { x: L::load_at(token, x, at), y: L::load_at(token, y, at), z: L::load_at(token, z, at) }
    }

    /// Overwrites the vectors of consecutive particles from index `at` on.
    #[inline(always)]
    pub fn store<L: Lane>(&mut self, at: usize, vector: V3<L>) {
        let Self([x, y, z]) = self;
        vector.x.store_at(x, at);
        vector.y.store_at(y, at);
        vector.z.store_at(z, at);
    }

    /// Overwrites all vectors in row-major order by those of packs.
    pub fn read<P: Pack>(&mut self, packs: &[Pack3<P>]) {
        let [x, y, z] = self.0.each_mut().map(|axis| axis[MARGIN..].chunks_exact_mut(P::WIDTH));
        for (((x, y), z), pack) in x.zip(y).zip(z).zip(packs) {
            x.copy_from_slice(pack[0].lanes());
            y.copy_from_slice(pack[1].lanes());
            z.copy_from_slice(pack[2].lanes());
        }
    }

    /// Overwrites packs by the vectors in row-major order.
    pub fn write<P: Pack>(&self, packs: &mut [Pack3<P>]) {
        let [x, y, z] = self.0.each_ref().map(|axis| axis[MARGIN..].chunks_exact(P::WIDTH));
        for (((x, y), z), pack) in x.zip(y).zip(z).zip(packs) {
            pack[0].lanes_mut().copy_from_slice(x);
            pack[1].lanes_mut().copy_from_slice(y);
            pack[2].lanes_mut().copy_from_slice(z);
        }
    }

    /// Sets all vectors to zero.
    pub fn clear(&mut self) {
        for coordinate in &mut self.0 {
            coordinate.fill(0.0);
        }
    }

    /// Copies the vectors from the other order. `extent` is the length and the number of its lines, `strides`
    /// the distances between its lines and between these lines.
    pub fn transpose_from(&mut self, other: &Self, strides: [usize; 2], extent: [usize; 2]) {
        dispatch!(token => transpose_all(token, &other.0, &mut self.0, strides, extent));
    }
}

/// Transposes each coordinate.
#[inline(always)]
fn transpose_all<S: Simd>(
    token: S,
    from: &[Vec<f32>; 3],
    into: &mut [Vec<f32>; 3],
    strides: [usize; 2],
    extent: [usize; 2],
) {
    for (into, from) in into.iter_mut().zip(from) {
        transpose(token, &from[MARGIN..], &mut into[MARGIN..], strides, extent);
    }
}

/// Transposes `lines` lines of `length` numbers, tile by tile. Both strides are multiples of [`LINES`], and all lines of the
/// tiles lie in the arrays, so that a tile has whole lines of fixed length: what is left of checks of bounds are four
/// for a tile.
#[inline(always)]
fn transpose<S: Simd>(
    token: S,
    from: &[f32],
    into: &mut [f32],
    [from_stride, into_stride]: [usize; 2],
    [length, lines]: [usize; 2],
) {
    debug_assert!(from_stride.is_multiple_of(LINES) && into_stride.is_multiple_of(LINES));
    let into = into.as_chunks_mut::<LINES>().0;
    let (blocks, tiles) = (lines.div_ceil(LINES), length.div_ceil(TILE));
    let into_stride = into_stride / LINES;
    for block in 0..blocks {
        let from = &from[block * LINES * from_stride..][..LINES * from_stride];
        let (low, high) = from.split_at(TILE * from_stride);
        let (low, high) =
            (four_lines(low, from_stride, tiles), four_lines(high, from_stride, tiles));
        for tile in 0..tiles {
            let low = transposed(token, [low[0][tile], low[1][tile], low[2][tile], low[3][tile]]);
            let high =
                transposed(token, [high[0][tile], high[1][tile], high[2][tile], high[3][tile]]);
            let first = tile * TILE * into_stride + block;
            for place in 0..TILE {
                let (low_half, high_half) = into[first + place * into_stride].split_at_mut(TILE);
                low[place].store_slice(low_half);
                high[place].store_slice(high_half);
            }
        }
    }
}

/// The first tiles of four lines.
#[inline(always)]
fn four_lines(lines: &[f32], stride: usize, tiles: usize) -> [&[[f32; TILE]]; TILE] {
    let (ab, cd) = lines.split_at(2 * stride);
    let ((a, b), (c, d)) = (ab.split_at(stride), cd.split_at(stride));
    [
        &a.as_chunks().0[..tiles],
        &b.as_chunks().0[..tiles],
        &c.as_chunks().0[..tiles],
        &d.as_chunks().0[..tiles],
    ]
}

/// The columns of a tile, given its lines.
#[inline(always)]
fn transposed<S: Simd>(token: S, [a, b, c, d]: [[f32; TILE]; TILE]) -> [f32x4<S>; TILE] {
    let a = f32x4::from_slice(token, &a);
    let b = f32x4::from_slice(token, &b);
    let c = f32x4::from_slice(token, &c);
    let d = f32x4::from_slice(token, &d);
    let (ac_low, ac_high) = (a.zip_low(c), a.zip_high(c));
    let (bd_low, bd_high) = (b.zip_low(d), b.zip_high(d));
    [
        ac_low.zip_low(bd_low),
        ac_low.zip_high(bd_low),
        ac_high.zip_low(bd_high),
        ac_high.zip_high(bd_high),
    ]
}
