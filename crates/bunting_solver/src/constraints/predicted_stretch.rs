//! Stiff bending solved where stretch will have acted.
//!
//! Bending is solved before stretch, on positions that gravity has already moved and that stretch
//! will move back. For limp cloth that does not matter; a stiff strip is bent by the detour: at
//! Γ = 50 the heavy cantilever droops 1.8 % too far with three substeps. So what stretch did in the
//! last substeps is remembered, as an acceleration, and anticipated while bending is solved.
//!
//! Only what warp and weft did. What a cloth does in its own plane it does slowly, against its bias, and
//! that pushes each row of a narrow strip to and fro: anticipated, it made the strip's rows part sideways
//! for ever. Where diagonals count as warp or weft, since cells are long, it cannot be told from these, and
//! nothing is anticipated.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::fabric::Fabric;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

/// Part of the remembered change that is anticipated. All of it would not forget a jitter.
const ANTICIPATED: f32 = 0.9;

/// Part of the memory that a substep renews.
const RENEWED: f32 = 0.5;

/// Stiffness number h² B/(σ l⁴) × 16, the square of the fastest bending wave's phase in a substep,
/// above which bending counts as stiff. A 33 × 33 flag has 0.02.
const STIFF: f32 = 1.0;

/// How much of its memory a lane anticipates, given its stiffness number.
pub(crate) fn anticipated(fabric: &Fabric, stiffness_number: f32) -> f32 {
    if fabric.has_shear_cells() && stiffness_number > STIFF { ANTICIPATED } else { 0.0 }
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Solves bending with the positions leaning by what stretch is expected to do.
    pub fn solve_bending_with_anticipation(&mut self) {
        if !self.anticipates() {
            self.solve_bending();
            self.solve_twist();
            return;
        }
        self.lean(1.0);
        self.solve_bending();
        self.solve_twist();
        self.unravel();
        self.lean(-1.0);
        self.bent.copy_from_slice(&self.position);
    }

    /// Remembers what stretch did in this substep, but for what it did between two calls of `overlook`.
    pub fn remember_stretch(&mut self) {
        if self.anticipates() {
            P::run(Remember {
                parameters: &self.parameters,
                position: &self.position,
                bent: &self.bent,
                memory: &mut self.memory,
            });
        }
    }

    /// Before (`sign` −1) and after (1) what is not to be remembered: moves the places from which stretch is
    /// counted along with it.
    pub fn overlook(&mut self, sign: f32) {
        if self.anticipates() {
            self.unravel();
            P::run(Overlook { sign, position: &self.position, bent: &mut self.bent });
        }
    }

    fn anticipates(&self) -> bool {
        self.parameters.anticipated.lanes().iter().any(|&part| part > 0.0)
    }

    fn lean(&mut self, sign: f32) {
        P::run(Lean {
            parameters: &self.parameters,
            sign,
            position: &mut self.position,
            memory: &self.memory,
        });
    }
}

struct Lean<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    sign: f32,
    position: &'a mut [Pack3<P>],
    memory: &'a [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Lean<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let step = L::load(token, &self.parameters.step);
        let part = L::load(token, &self.parameters.anticipated);
        let scale = step * step * part * L::splat(token, self.sign);
        let leans = L::splat(token, 0.0).lt(part);
        for (position, memory) in self.position.iter_mut().zip(self.memory) {
            let x: V3<L> = V3::load(token, position);
            (x + V3::load(token, memory) * scale).or_where_not(leans, x).store(position);
        }
    }
}

struct Overlook<'a, P: Pack> {
    sign: f32,
    position: &'a [Pack3<P>],
    bent: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Overlook<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let sign = L::splat(token, self.sign);
        for (bent, position) in self.bent.iter_mut().zip(self.position) {
            let from: V3<L> = V3::load(token, bent);
            from.plus_scaled(V3::load(token, position), sign).store(bent);
        }
    }
}

struct Remember<'a, P: Pack> {
    parameters: &'a Parameters<P>,
    position: &'a [Pack3<P>],
    bent: &'a [Pack3<P>],
    memory: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Remember<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let rate = L::load(token, &self.parameters.inverse_step);
        let renewed = L::splat(token, RENEWED);
        for ((position, bent), memory) in self.position.iter().zip(self.bent).zip(self.memory) {
            let moved: V3<L> = V3::load(token, position) - V3::load(token, bent);
            let old: V3<L> = V3::load(token, memory);
            (old + (moved * (rate * rate) - old) * renewed).store(memory);
        }
    }
}
