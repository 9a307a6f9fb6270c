//! Laid yarns of cloths side by side: the same yarn of each cloth in the lanes.

use super::{
    FARTHER, SolveLaidYarns, TightenLinks, YarnLink, YarnParticles, compliance, sum_couplings,
};
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Particles, Positions};
use crate::constraints::corrections::CorrectedParticles;
use crate::fabric::{BAND, LaidYarn, Node};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Solves the yarns of all lanes' cloths.
    pub(in crate::constraints) fn solve_yarns_side_by_side(&mut self, passes: u32) {
        let yarns = self.fabric.laid_yarns();
        P::run(BeginLinks {
            yarns: &yarns.list,
            inverse_masses: &self.masses.inverse,
            compliance: &self.layout.modulus_compliance,
            links: &mut self.yarn_links,
        });
        if passes > 1 {
            self.stretch_shift.clone_from(&self.correction);
            self.run_yarns(1);
            let (before, correction) = (&self.stretch_shift, &mut self.correction);
            P::run(GoFarther { before, correction });
            P::run(TightenLinks(&mut self.yarn_links));
        }
        self.run_yarns(passes.max(2) - 1);
    }

    fn run_yarns(&mut self, passes: u32) {
        let yarns = self.fabric.laid_yarns();
        P::run(SolveLaidYarns {
            yarns: &yarns.list,
            colours: yarns.colours.ranges(),
            passes,
            links: &mut self.yarn_links,
            rows: &mut self.band_rows,
            particles: CorrectedParticles {
                inverse_masses: &self.masses.inverse,
                predicted: self.positions.packs(),
                correction: &mut self.correction,
            },
        });
    }
}

/// Moves particles farther by a part of what a pass has moved them.
struct GoFarther<'a, P: Pack> {
    /// Sums of corrections before the pass, m.
    before: &'a [Pack3<P>],
    correction: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for GoFarther<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let farther = L::splat(token, FARTHER);
        for (correction, before) in self.correction.iter_mut().zip(self.before) {
            let now: V3<L> = V3::load(token, correction);
            now.plus_scaled(now - V3::load(token, before), farther).store(correction);
        }
    }
}

/// Computes what holds of the links in a substep.
struct BeginLinks<'a, P: Pack> {
    yarns: &'a [LaidYarn],
    inverse_masses: &'a [P],
    /// Compliance of a square of each family, σ/(Y h²), 1/m².
    compliance: &'a [P; 3],
    links: &'a mut [YarnLink<P>],
}

impl<P: Pack> Kernel<P> for BeginLinks<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let mut links = self.links.iter_mut();
        for yarn in self.yarns {
            let mut couplings = yarn.couplings.as_slice();
            for (laid, link) in yarn.links.iter().zip(&mut links) {
                let sums: [L; BAND + 1] =
                    sum_couplings(token, laid, &mut couplings, self.inverse_masses);
                for (sum, stored) in sums.into_iter().zip(&mut link.couplings) {
                    sum.store(stored);
                }
                let compliance: L = compliance(token, laid, self.compliance);
                compliance.store(&mut link.compliance);
                link.rest_length = P::splat(laid.rest_length);
                link.target = link.rest_length;
            }
        }
    }
}

impl<P: Pack> Kernel<P> for SolveLaidYarns<'_, P, LaidYarn, CorrectedParticles<'_, P>> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.solve_all::<L>(token);
    }
}

impl<L: Lane> YarnParticles<L> for CorrectedParticles<'_, L::Pack> {
    type Node = Node;

    #[inline(always)]
    fn node(&self, token: L::Token, node: &Node) -> V3<L> {
        let [a, b] = node.particles;
        let a: V3<L> = self.position(token, a);
        let b: V3<L> = self.position(token, b);
        (a * L::splat(token, node.parts[0])).plus_scaled(b, L::splat(token, node.parts[1]))
    }

    #[inline(always)]
    fn pull_node(&mut self, token: L::Token, node: &Node, pull: V3<L>) {
        for (&particle, &part) in node.particles.iter().zip(&node.parts) {
            let inverse_mass: L = self.inverse_mass(token, particle);
            let factor = inverse_mass * L::splat(token, part);
            self.correct(token, particle, pull, (pull, factor));
        }
    }
}
