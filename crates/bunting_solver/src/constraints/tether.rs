//! Tethers: no particle strays further from its nearest pin, nor from its farthest, than the cloth between
//! them is long.
//!
//! One-sided and after the yarns (Kim, Chentanez and Müller 2012, "Long range attachments"). They
//! catch the free corner of a flag that cracks like a whip, where the yarns' frozen directions
//! overshoot, and those to the farthest pins a flag that is shaken until its lower corner lies beneath its
//! pole: at 10 Hz by half a metre that came to 1.92 m from the upper one (33 × 33, two substeps; 1.46 with 64
//! substeps, 1.49 so). They are longer than at rest by the strain that the loads may cause, and by a slack,
//! so that they do not hide what the material gives.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::{Constant, Places};
use crate::batch::single_cloth::{Facing, PackedTethers, Weave};
use crate::constants::LEAST_LENGTH;
use crate::fabric::Tether;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Projects every tether once.
    pub fn solve_tethers(&mut self) {
        let [stretch, far_stretch] =
            [self.parameters.tether_stretch, self.parameters.far_tether_stretch];
        if C::SIDE > 1
            && let Some(weave) = self.woven()
        {
            weave.solve_tethers(&stretch, &far_stretch);
            return;
        }
        for (tethers, stretch) in
            [(self.fabric.far_tethers(), &far_stretch), (self.fabric.tethers(), &stretch)]
        {
            P::run(Tethers { tethers, stretch, position: &mut self.position });
        }
    }
}

impl<P: Pack> Weave<P> {
    fn solve_tethers(&mut self, stretch: &P, far_stretch: &P) {
        self.sheets.turn(Facing::Straight);
        for (tethers, stretch) in [(&self.far_tethers, far_stretch), (&self.tethers, stretch)] {
            P::run(Packs { tethers, stretch, places: self.sheets.threads(&self.present) });
        }
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
            let place = &mut self.position[tether.particle as usize];
            let reach = stretch * L::splat(token, tether.length);
            if let Some(caught) = caught(token, V3::load(token, place), pin, reach) {
                caught.store(place);
            }
        }
    }
}

/// Packs of one cloth's particles.
struct Packs<'a, P: Pack, S: Places<P>> {
    tethers: &'a PackedTethers<P>,
    stretch: &'a P,
    places: S,
}

impl<P: Pack, S: Places<P>> Kernel<P> for Packs<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let stretch = L::load(token, self.stretch);
        let PackedTethers { at, pins, lengths, .. } = self.tethers;
        for ((pin, length), &at) in pins.iter().zip(lengths).zip(at) {
            let pin: V3<L> = V3::load(token, pin);
            let reach = stretch * L::load(token, length);
            if let Some(caught) = caught(token, self.places.position(token, at), pin, reach) {
                self.places.set_position(at, caught);
            }
        }
    }
}

/// Where particles are within reach of their pins, if any strays.
#[inline(always)]
fn caught<L: Lane>(token: L::Token, at: V3<L>, pin: V3<L>, reach: L) -> Option<V3<L>> {
    let away = at - pin;
    let squared = away.dot(away);
    let strays = (reach * reach).lt(squared);
    // Seldom true of any lane, so the root and the division are seldom paid for.
    if !strays.any() {
        return None;
    }
    let length = squared.sqrt().max(L::splat(token, LEAST_LENGTH));
    Some((pin + away * (reach / length)).or_where_not(strays, at))
}
