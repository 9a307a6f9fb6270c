//! Extrapolation of the last pass over a cut grid: positions and tensions go twice as far as the pass has moved them.
//!
//! A pass takes a part s of each error off, with s real and from zero to one where passes are self-adjoint (`both_ways.rs`). Two
//! passes leave (1 − s)². From x₁ and x₂, the positions after each, x₂ + (x₂ − x₁) leaves (1 − s)(1 − 2 s), which is between −1/8 and 1:
//! slow errors, as of load that a border hands on by shear, lose 3 s in place of 2 s, and no error grows. This is a step of Chebyshev's
//! semi-iteration (Golub & Varga 1961) that needs no bounds of s. If the pass goes 2.3 times as far, a sheet with a hole trembles at
//! 9 mm/s after a jerk.
//!
//! Both positions satisfy the chains that are solved last, and so does what is extrapolated from them, to first order. A pass alone is
//! not quite self-adjoint, as only two of them solve the diagonals both ways. Nets feel that: a torus of quads trembles at
//! 0.6 m/s, if its last pass is extrapolated.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// The state before the last pass of a substep; empty where that is not extrapolated.
#[derive(Clone, Debug)]
pub(crate) struct BeforeLastPass<P: Pack> {
    /// Positions, m.
    positions: Vec<Pack3<P>>,
    /// Targets of links, m.
    targets: Vec<P>,
}

impl<P: Pack> BeforeLastPass<P> {
    /// An empty state.
    pub fn none() -> Self {
        Self { positions: Vec::new(), targets: Vec::new() }
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Stores positions and targets before the last pass.
    pub(super) fn begin_last_pass(&mut self) {
        let BeforeLastPass { positions, targets } = &mut self.before_last_pass;
        positions.clone_from(self.positions.packs_mut());
        targets.clone_from(&self.link_target);
    }

    /// Moves positions and targets once more as far as the last pass has moved them.
    pub(super) fn extrapolate_last_pass(&mut self) {
        P::run(Extrapolate {
            before: &self.before_last_pass,
            positions: self.positions.packs_mut(),
            targets: &mut self.link_target,
        });
    }
}

struct Extrapolate<'a, P: Pack> {
    before: &'a BeforeLastPass<P>,
    positions: &'a mut [Pack3<P>],
    targets: &'a mut [P],
}

impl<P: Pack> Kernel<P> for Extrapolate<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { before, positions, targets } = self;
        for (to, before) in positions.iter_mut().zip(&before.positions) {
            let now: V3<L> = V3::load(token, to);
            (now + (now - V3::load(token, before))).store(to);
        }
        for (to, before) in targets.iter_mut().zip(&before.targets) {
            let now = L::load(token, to);
            (now + (now - L::load(token, before))).store(to);
        }
    }
}
