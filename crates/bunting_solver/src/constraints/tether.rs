//! Tethers: no particle strays further from its nearest pin than the cloth between them is long.
//!
//! One-sided and after the yarns (Kim, Chentanez and Müller 2012, "Long range attachments"). They
//! catch the free corner of a flag that cracks like a whip, where the yarns' frozen directions
//! overshoot. They are longer than at rest by the strain that the loads may cause, and by a slack, so
//! that they do not hide what the material gives.

use crate::constants::LEAST_LENGTH;
use crate::fabric::Tether;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Mask, Pack};
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Projects every tether once.
    pub fn solve_tethers(&mut self) {
        P::run(Tethers {
            tethers: self.fabric.tethers(),
            stretch: &self.parameters.tether_stretch,
            position: &mut self.position,
        });
    }
}

struct Tethers<'a, P: Pack> {
    tethers: &'a [Tether],
    stretch: &'a P,
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Tethers<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let stretch = L::load(token, self.stretch);
        for tether in self.tethers {
            let pin: V3<L> = V3::load(token, &self.position[tether.pin as usize]);
            let at: V3<L> = V3::load(token, &self.position[tether.particle as usize]);
            let away = at - pin;
            let squared = away.dot(away);
            let reach = stretch * L::splat(token, tether.length);
            let strays = (reach * reach).lt(squared);
            // Seldom true of any lane, so the root and the division are seldom paid for.
            if strays.any() {
                let length = squared.sqrt().max(L::splat(token, LEAST_LENGTH));
                let caught = pin + away * (reach / length);
                caught.or_where_not(strays, at).store(&mut self.position[tether.particle as usize]);
            }
        }
    }
}
