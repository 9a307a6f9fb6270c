//! Boxes around paths, one in each lane.

use fearless_simd::{Simd, f32x8};

use crate::contact::itself::swept::{End, Swept};
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::registers::Pack8;
use crate::simd::vec3::{Pack3, V3, set_lane3};

/// Corners of the triangles of a cell, one triangle in each lane; the last in those without one.
pub(in crate::contact) type Corners = [Pack3<Pack8>; 3];

/// Boxes around paths, like [`Swept`], one in each lane.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Boxes {
    low: [Pack3<Pack8>; 2],
    high: [Pack3<Pack8>; 2],
}

impl Boxes {
    /// Boxes that meet nothing.
    pub fn empty() -> Self {
        let [low, high] = [f32::INFINITY, f32::NEG_INFINITY].map(|it| [[Pack8::splat(it); 3]; 2]);
        Self { low, high }
    }

    /// Sets the box of a lane.
    pub fn set(&mut self, lane: usize, swept: &Swept) {
        for at in 0..2 {
            set_lane3(&mut self.low[at], lane, swept.low[at].into());
            set_lane3(&mut self.high[at], lane, swept.high[at].into());
        }
    }

    /// The box of a lane, in all lanes.
    #[inline(always)]
    pub fn lane<L: Lane<Pack = Pack8>>(&self, token: L::Token, lane: usize) -> Splat<L> {
        Splat {
            low: [
                V3::splat_lane(token, &self.low[0], lane),
                V3::splat_lane(token, &self.low[1], lane),
            ],
            high: [
                V3::splat_lane(token, &self.high[0], lane),
                V3::splat_lane(token, &self.high[1], lane),
            ],
        }
    }
}

/// A box around paths, in all lanes.
pub(in crate::contact) struct Splat<L> {
    low: [V3<L>; 2],
    high: [V3<L>; 2],
}

impl<L: Lane<Pack = Pack8>> Splat<L> {
    #[inline(always)]
    pub fn of(token: L::Token, swept: &Swept) -> Self {
        Self {
            low: [V3::splat3(token, swept.low[0]), V3::splat3(token, swept.low[1])],
            high: [V3::splat3(token, swept.high[0]), V3::splat3(token, swept.high[1])],
        }
    }

    /// Whether it meets others, see [`Swept::meets`].
    #[inline(always)]
    pub fn meets(&self, token: L::Token, others: &Boxes) -> L::Mask {
        let low = [V3::load(token, &others.low[0]), V3::load(token, &others.low[1])];
        let high = [V3::load(token, &others.high[0]), V3::load(token, &others.high[1])];
        overlap(&self.low, &high) & overlap(&low, &self.high)
    }
}

/// Whether the lower ends are below the upper ends along each axis, at the start or at the end of the substep.
#[inline(always)]
fn overlap<L: Lane>(low: &[V3<L>; 2], high: &[V3<L>; 2]) -> L::Mask {
    (low[0].x.lt(high[0].x) | low[1].x.lt(high[1].x))
        & (low[0].y.lt(high[0].y) | low[1].y.lt(high[1].y))
        & (low[0].z.lt(high[0].z) | low[1].z.lt(high[1].z))
}

/// Sets boxes around triangles, given an end of their corners' paths, m, and the distance by which the boxes are widened, m.
#[inline(always)]
pub(in crate::contact) fn set_around<S: Simd>(
    token: S,
    [a, b, c]: &[V3<f32x8<S>>; 3],
    end: End,
    by: f32,
    boxes: &mut Boxes,
) {
    let by = V3::splat(token, by);
    (a.min(*b).min(*c) - by).store(&mut boxes.low[end as usize]);
    (a.max(*b).max(*c) + by).store(&mut boxes.high[end as usize]);
}

/// Finds the boxes that meet another.
pub(in crate::contact) struct FindMeeting<'a> {
    pub one: &'a Boxes,
    /// The lane of the box.
    pub lane: usize,
    pub others: &'a [Boxes],
    /// Index of the others' first lane.
    pub first: usize,
    /// Indices of lanes, in order.
    pub found: &'a mut Vec<usize>,
}

impl Kernel<Pack8> for FindMeeting<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let [zero, one] = [L::splat(token, 0.0), L::splat(token, 1.0)];
        let splat = self.one.lane::<L>(token, self.lane);
        for (index, boxes) in self.others.iter().enumerate() {
            let meets = splat.meets(token, boxes);
            if meets.any() {
                let mut lanes = Pack8::splat(0.0);
                one.or_where_not(meets, zero).store(&mut lanes);
                for (lane, &meets) in lanes.lanes().iter().enumerate() {
                    if meets != 0.0 {
                        self.found.push(self.first + index * Pack8::WIDTH + lane);
                    }
                }
            }
        }
    }
}
