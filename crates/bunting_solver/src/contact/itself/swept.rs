//! Boxes around paths.

use glam::Vec3A;

/// Positions of a particle at the start and at the end of a substep, m.
pub(in crate::contact) type Path = [Vec3A; 2];

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
            let path = &paths[particle as usize];
            swept = swept.merged(Self { low: *path, high: *path });
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
