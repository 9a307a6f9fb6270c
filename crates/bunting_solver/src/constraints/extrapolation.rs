//! Extrapolation of the last two passes over a cut grid: positions and tensions go farther than the passes have moved them.
//!
//! A pass takes a part s of each error off, with s real and from zero to one where passes are self-adjoint (`both_ways.rs`), and
//! one that goes a times as far takes a s off. Three passes of a = 1, 1/0.4 and 1/0.7 leave (1 − s)(1 − s/0.4)(1 − s/0.7), which is
//! between −0.1 and 1: slow errors, as of load that a border hands on by shear, lose 4.9 s in place of 3 s, and no error grows. These
//! are Richardson's iterations, whose factors are the inverse roots of a polynomial (Richardson 1911, Golub & Varga 1961). Smaller
//! roots would take more of the slow errors off, but each pass finds its own directions of the links: with 0.2 and 0.6 one cloth in
//! seven trembles.
//!
//! Positions before and after a pass satisfy the chains that are solved last, and so does what is extrapolated from them, to first
//! order. A pass alone is not quite self-adjoint, as only two of them solve the diagonals both ways. Nets feel that: a torus of quads
//! trembles at 0.6 m/s, if its last pass is extrapolated.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::{Kernel, Lane, Pack};

/// How many times as far the last pass goes, and the one before it.
const FACTORS: [f32; 2] = [1.0 / 0.7, 1.0 / 0.4];

/// How many times as far a pass goes; none for the first one, and before the last two.
pub(super) fn extrapolation_of(pass: u32, passes: u32) -> Option<f32> {
    let passes_left = passes - 1 - pass;
    FACTORS.get(passes_left as usize).copied().filter(|_| pass > 0)
}

/// The state before a pass that is extrapolated, and targets before bending that comes after stretch; empty before the first such
/// pass.
#[derive(Clone, Debug)]
pub(crate) struct BeforePass<P: Pack> {
    /// Coordinates of positions, m, in the order in which constraints hold them.
    coordinates: Vec<f32>,
    /// Targets of links, m.
    pub(super) targets: Vec<P>,
}

impl<P: Pack> BeforePass<P> {
    /// An empty state.
    pub fn none() -> Self {
        Self { coordinates: Vec::new(), targets: Vec::new() }
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Stores positions and targets before a pass.
    pub(super) fn begin_extrapolation(&mut self) {
        let BeforePass { coordinates, targets } = &mut self.before_pass;
        coordinates.clear();
        self.positions.visit_coordinates(|now| coordinates.extend_from_slice(now));
        targets.clone_from(&self.link_target);
    }

    /// Moves positions and targets `factor` times as far as the pass has moved them.
    pub(super) fn extrapolate(&mut self, factor: f32) {
        P::run(Extrapolate {
            factor,
            before: &self.before_pass,
            positions: &mut self.positions,
            targets: &mut self.link_target,
        });
    }
}

struct Extrapolate<'a, P: Pack, X> {
    factor: f32,
    before: &'a BeforePass<P>,
    positions: &'a mut X,
    targets: &'a mut [P],
}

impl<P: Pack, X: Positions<P>> Kernel<P> for Extrapolate<'_, P, X> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, _: L::Token) {
        let Self { factor, before, positions, targets } = self;
        let mut coordinates = &before.coordinates[..];
        positions.visit_coordinates(|now| {
            let (before, rest) = coordinates.split_at(now.len());
            coordinates = rest;
            extrapolate(now, before, factor);
        });
        for (now, before) in targets.iter_mut().zip(&before.targets) {
            extrapolate(now.lanes_mut(), before.lanes(), factor);
        }
    }
}

/// Moves numbers `factor` times as far from those before.
#[inline(always)]
fn extrapolate(now: &mut [f32], before: &[f32], factor: f32) {
    for (now, before) in now.iter_mut().zip(before) {
        *now = before + factor * (*now - before);
    }
}

#[cfg(test)]
mod tests {
    use super::extrapolation_of;

    #[test]
    fn the_last_two_passes_but_the_first_go_farther() {
        let factors = |passes| (0..passes).map(|pass| extrapolation_of(pass, passes)).collect();
        let of_passes: [Vec<Option<f32>>; 3] = [2, 3, 4].map(factors);
        let (farther, last) = (Some(2.5), Some(1.0 / 0.7));
        assert_eq!(of_passes[0], [None, last]);
        assert_eq!(of_passes[1], [None, farther, last]);
        assert_eq!(of_passes[2], [None, None, farther, last]);
    }

    /// Errors that a pass takes a part of off fall, whichever part.
    #[test]
    fn no_error_grows() {
        for passes in 2..9 {
            let part_left = |s: f32| -> f32 {
                let left = |pass| 1.0 - s * extrapolation_of(pass, passes).unwrap_or(1.0);
                (0..passes).map(left).product()
            };
            let parts = (0..=100).map(|percent| part_left(0.01 * percent as f32));
            assert!(parts.skip(1).all(|part| part < 1.0 && part > -0.1), "{passes} passes");
        }
    }
}
