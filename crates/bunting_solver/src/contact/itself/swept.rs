//! Paths of particles in a substep, and boxes around them.

use fearless_simd::{Simd, f32x4, f32x8};
use glam::{Vec3, Vec3A, Vec4};

use crate::contact::itself::patches::Cell;
use crate::simd::lane::{Lane, Pack};
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::transpose::joined;
use crate::simd::vec3::V3;

/// Positions of a particle at the start and at the end of a substep, m, and zeros.
pub(in crate::contact) type Path = [Pack4; 2];

/// An end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::contact) enum End {
    First,
    Last,
}

/// An end of a path at a position, m.
#[inline]
pub(in crate::contact) fn end_at(position: Vec3) -> Pack4 {
    let mut end = Pack4::splat(0.0);
    end.lanes_mut()[..3].copy_from_slice(&position.to_array());
    end
}

/// The position of an end of a path, m.
#[inline]
pub(in crate::contact) fn position_of(end: &Pack4) -> Vec3A {
    Vec3A::from_vec4(Vec4::from_array(end.vector()))
}

/// The corners of a cell's triangles at an end of their paths, m.
#[inline(always)]
pub(in crate::contact) fn gather<S: Simd>(
    token: S,
    cell: &Cell,
    paths: &[Path],
    end: End,
) -> [V3<f32x8<S>>; 3] {
    let zero = V3::<f32x8<S>>::splat(token, 0.0);
    let mut corners = [zero; 3];
    for (corner, particles) in corners.iter_mut().zip(&cell.corners) {
        let mut at = [<f32x4<S> as Lane>::splat(token, 0.0); Pack8::WIDTH];
        for (at, &particle) in at.iter_mut().zip(particles) {
            *at = Lane::load(token, &paths[particle as usize][end as usize]);
        }
        *corner = joined(at);
    }
    corners
}

/// Boxes around some particles at the start and at the end of a substep, m. Particles move along straight lines.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Swept {
    pub low: [Vec3A; 2],
    pub high: [Vec3A; 2],
}

impl Swept {
    pub const EMPTY: Self = Self { low: [Vec3A::INFINITY; 2], high: [Vec3A::NEG_INFINITY; 2] };

    /// Boxes around the paths of some particles, given those of all.
    pub fn around(particles: &[u32], paths: &[Path]) -> Self {
        let mut swept = Self::EMPTY;
        for &particle in particles {
            let [first, last] = &paths[particle as usize];
            let path = [position_of(first), position_of(last)];
            swept = swept.merged(Self { low: path, high: path });
        }
        swept
    }

    pub fn merged(self, other: Self) -> Self {
        Self {
            low: [self.low[0].min(other.low[0]), self.low[1].min(other.low[1])],
            high: [self.high[0].max(other.high[0]), self.high[1].max(other.high[1])],
        }
    }

    pub fn widened(self, by: f32) -> Self {
        let by = Vec3A::splat(by);
        Self { low: self.low.map(|it| it - by), high: self.high.map(|it| it + by) }
    }

    /// Whether the particles may meet: unless the boxes are apart along an axis, on the same side at the start and at the
    /// end.
    pub fn meets(&self, other: &Self) -> bool {
        let above = |one: &Self, other: &Self| {
            one.low[0].cmpgt(other.high[0]) & one.low[1].cmpgt(other.high[1])
        };
        !(above(self, other) | above(other, self)).any()
    }
}
