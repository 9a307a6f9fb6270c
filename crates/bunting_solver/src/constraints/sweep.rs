//! Polish: one sweep over warp and weft after the yarns, link by link.
//!
//! Where a flag cracks like a whip, the frozen directions of a yarn overshoot at its free end; a
//! sweep takes off what single links are then too long by. The constraint and its targets are
//! those of the yarns.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::{Cloths, Constant, Places};
use crate::batch::single_cloth::Weave;
use crate::fabric::SweepLink;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Sweeps over warp and weft once, yarn by yarn.
    pub fn polish(&mut self) {
        if C::SIDE > 1
            && let Some(weave) = self.woven()
        {
            weave.polish();
            return;
        }
        P::run(Polish {
            links: &self.fabric.chains().sweep_links,
            compliance: &self.parameters.link_compliance,
            target: &mut self.link_target,
            places: Cloths::new(&self.lane_weights, &mut self.position),
        });
    }
}

impl<P: Pack> Weave<P> {
    fn polish(&mut self) {
        for colour in 0..self.strands.colours.len() {
            let links = self.strands.colours[colour].sweep_links.clone();
            if !links.is_empty() {
                self.sheets.turn(self.facings[colour]);
                P::run(Polish {
                    links: &self.strands.sweep_links[links],
                    compliance: &self.compliance,
                    target: &mut self.target,
                    places: self.sheets.threads(&self.present),
                });
            }
        }
    }
}

struct Polish<'a, P: Pack, S: Places<P>> {
    links: &'a [SweepLink],
    compliance: &'a [P],
    target: &'a mut [P],
    places: S,
}

impl<P: Pack, S: Places<P>> Kernel<P> for Polish<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let least = L::splat(token, f32::MIN_POSITIVE);
        for link in self.links {
            let target = &mut self.target[link.target as usize];
            let [a, b] = link.particles;
            let wa: L = self.places.weight(token, a);
            let wb: L = self.places.weight(token, b);
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = self.places.position(token, a);
            let to: V3<L> = self.places.position(token, b);
            let along = to - from;
            let squared = along.dot(along);
            let length = squared.sqrt();
            let held = L::load(token, target);
            let lack = (-squared).plus_product(held, length);
            // Multiplied, not divided by: the division need not wait for the root.
            let one = self.places.one::<L>(token, link.class);
            let inverse = one / least.plus_product(wa + wb + compliance, squared);
            let change = lack * inverse;
            held.minus_product(compliance * length, change).store(target);
            let pull = along * change;
            self.places.set_position(a, from.minus_scaled(pull, wa));
            self.places.set_position(b, to.plus_scaled(pull, wb));
        }
    }
}
