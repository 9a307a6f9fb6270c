//! Boxes around paths, one in each lane.

use fearless_simd::{Simd, SimdInto, f32x4};
use glam::Vec4;

use crate::contact::itself::features::FeaturePack;
use crate::contact::itself::swept::{End, Swept};
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::transpose::joined;
use crate::simd::vec3::{Pack3, V3, set_lane3};

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

    /// Sets the boxes around the paths of features of `COUNT` particles each, given positions of all particles at the start and at the end
    /// of the substep, m.
    #[inline(always)]
    pub fn set_around<S: Simd, const COUNT: usize>(
        &mut self,
        token: S,
        features: &FeaturePack,
        positions: [&[Pack4]; 2],
    ) {
        for (end, positions) in positions.into_iter().enumerate() {
            let mut low = [<f32x4<S> as Lane>::splat(token, 0.0); Pack8::WIDTH];
            let mut high = low;
            for lane in 0..Pack8::WIDTH {
                let at = |corner: usize| {
                    let particle = features.particles[corner][lane];
                    Vec4::from_array(positions[particle as usize].vector())
                };
                let (mut l, mut h) = (at(0), at(0));
                for corner in 1..COUNT {
                    let at = at(corner);
                    (l, h) = (l.min(at), h.max(at));
                }
                low[lane] = l.to_array().simd_into(token);
                high[lane] = h.to_array().simd_into(token);
            }
            joined(low).store(&mut self.low[end]);
            joined(high).store(&mut self.high[end]);
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
    /// The box, widened by a distance in all lanes, m.
    #[inline(always)]
    pub fn widened(&self, by: V3<L>) -> Self {
        Self {
            low: [self.low[0] - by, self.low[1] - by],
            high: [self.high[0] + by, self.high[1] + by],
        }
    }

    /// Whether it meets others at an end of the substep.
    #[inline(always)]
    pub fn meets_at(&self, token: L::Token, end: End, others: &Boxes) -> L::Mask {
        let at = end as usize;
        let (low, high) = (&self.low[at], &self.high[at]);
        let others_low = V3::<L>::load(token, &others.low[at]);
        let others_high = V3::<L>::load(token, &others.high[at]);
        (low.x.lt(others_high.x) & low.y.lt(others_high.y) & low.z.lt(others_high.z))
            & (others_low.x.lt(high.x) & others_low.y.lt(high.y) & others_low.z.lt(high.z))
    }

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
        let splat = self.one.lane::<L>(token, self.lane);
        for (index, boxes) in self.others.iter().enumerate() {
            let meets = splat.meets(token, boxes);
            let mut bits = meets.bits();
            while bits != 0 {
                let lane = bits.trailing_zeros() as usize;
                self.found.push(self.first + index * Pack8::WIDTH + lane);
                bits &= bits - 1;
            }
        }
    }
}
