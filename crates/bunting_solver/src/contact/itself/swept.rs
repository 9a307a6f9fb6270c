//! Paths of particles in a substep, and boxes around them.

use glam::Vec3A;

use crate::contact::itself::points::{Points, vector_of};

/// An end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::contact) enum End {
    First,
    Last,
}

/// Boxes around some particles at the start and at the end of a substep, m. Particles move along straight lines.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Swept {
    pub low: [Vec3A; 2],
    pub high: [Vec3A; 2],
}

impl Swept {
    pub const EMPTY: Self = Self { low: [Vec3A::INFINITY; 2], high: [Vec3A::NEG_INFINITY; 2] };

    /// Boxes around the paths of some particles in a substep.
    #[inline]
    pub fn around(particles: &[u32], points: &Points) -> Self {
        let mut swept = Self::EMPTY;
        for &particle in particles {
            let [start, end] =
                [&points.start, &points.end].map(|at| vector_of(&at[particle as usize]));
            swept.low = [swept.low[0].min(start), swept.low[1].min(end)];
            swept.high = [swept.high[0].max(start), swept.high[1].max(end)];
        }
        swept
    }

    /// Whether the boxes at an end of the substep meet.
    pub fn meets_at(&self, end: End, other: &Self) -> bool {
        let at = end as usize;
        !(self.low[at].cmpgt(other.high[at]) | other.low[at].cmpgt(self.high[at])).any()
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
