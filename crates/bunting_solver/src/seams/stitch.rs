//! What is sewn to what.

use core::ops::Range;

/// A particle that is sewn to a point between two others, see [`Seams::new`](crate::Seams::new).
///
/// ```
/// use bunting_solver::Stitch;
///
/// // Particle 3 is sewn to particle 20, and particle 4 halfway between 20 and 21.
/// let stitches = [Stitch::to_particle(3, 20), Stitch { particle: 4, onto: [20, 21], part: 0.5 }];
/// # assert_eq!(stitches[0].part, 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stitch {
    /// Index of the particle.
    pub particle: u32,
    /// The two particles between which it is sewn.
    pub onto: [u32; 2],
    /// How far from the first to the second one, from 0 to 1.
    pub part: f32,
}

impl Stitch {
    /// A particle that is sewn to another one.
    #[must_use]
    pub const fn to_particle(particle: u32, other: u32) -> Self {
        Self { particle, onto: [other; 2], part: 0.0 }
    }
}

/// Stitches that are closed in a tick, and how far; all others are open.
///
/// ```
/// use bunting_solver::Lacing;
///
/// // The first ten stitches are closed, and the next ten are drawn together within a second.
/// let lacings = [Lacing::closed(0..10), Lacing { closing: 1.0, ..Lacing::closed(10..20) }];
/// # assert_eq!(lacings[1].length, 0.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lacing {
    /// Indices of the stitches, of which those that are not there are left out.
    pub stitches: Range<usize>,
    /// Greatest distance of the two sides, m: zero for a seam.
    pub length: f32,
    /// Time that is left at the start of the tick until they are closed, s. Until then each gap becomes shorter evenly.
    pub closing: f32,
}

impl Lacing {
    /// Stitches that are closed.
    #[must_use]
    pub const fn closed(stitches: Range<usize>) -> Self {
        Self { stitches, length: 0.0, closing: 0.0 }
    }

    /// Whether every number is finite and not negative.
    pub(crate) fn is_valid(&self) -> bool {
        [self.length, self.closing].iter().all(|number| number.is_finite() && *number >= 0.0)
    }
}
