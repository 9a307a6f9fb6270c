//! Yarns: the distance constraints along one path solved together, exactly.
//!
//! The XPBD system of a yarn, (J M⁻¹ Jᵀ + α̃) Δλ = −C − α̃ λ, is tridiagonal: with the links'
//! directions nᵢ frozen its diagonal is wᵢ + wᵢ₊₁ + α̃ᵢ and its off-diagonal −wᵢ₊₁ nᵢ·nᵢ₊₁. One
//! elimination down the yarn and one substitution back up solve it for about the price of a
//! Gauss–Seidel sweep (Thomas's algorithm). What a sweep leaves behind, a hidden compliance of
//! h²/(k m) that grows with the mesh, is gone: a hanging cloth has its material's own strain.
//! Goldenthal 2007 constrains warp and weft, Deul 2018 solves rods so.

use core::ops::Range;

use crate::constants::LEAST_LENGTH;
use crate::fabric::{LinkFamily, Yarn};
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3, splat3};

/// What the elimination leaves for the substitution, for one link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Knot<P: Pack> {
    /// Unit vector along the link.
    direction: Pack3<P>,
    /// The next multiplier's share in this one.
    share: P,
    /// The change of the multiplier, but for that share, m·kg/m².
    change: P,
}

impl<P: Pack> Knot<P> {
    pub fn new() -> Self {
        let zero = P::splat(0.0);
        Self { direction: splat3(glam::Vec3::ZERO), share: zero, change: zero }
    }
}

impl<P: Pack> LaneBatch<P> {
    /// Solves warp, weft, bias, then warp and weft again for each pass.
    ///
    /// The bias must not come last: what it moves is large against the strain of warp and weft.
    pub fn solve_yarns(&mut self, passes: u32) {
        self.solve_stretch(Visit::First);
        self.solve_bias();
        for _ in 0..passes {
            self.solve_stretch(Visit::Again);
        }
    }

    fn solve_stretch(&mut self, visit: Visit) {
        for colour in 0..self.fabric.yarn_colours().ranges().len() {
            let range = self.fabric.yarn_colours().ranges()[colour].clone();
            if self.fabric.yarn_family(range.start) != LinkFamily::Bias {
                self.solve_colour(range, visit);
            }
        }
    }

    fn solve_bias(&mut self) {
        for colour in 0..self.fabric.yarn_colours().ranges().len() {
            let range = self.fabric.yarn_colours().ranges()[colour].clone();
            if self.fabric.yarn_family(range.start) == LinkFamily::Bias {
                self.solve_colour(range, Visit::Only);
            }
        }
    }

    fn solve_colour(&mut self, range: Range<usize>, visit: Visit) {
        let colour = Colour {
            yarns: &self.fabric.yarns()[range],
            weights: &self.weights,
            compliance: &self.parameters.link_compliance,
            knots: &mut self.knots,
            multiplier: &mut self.link_multiplier,
            position: &mut self.position,
        };
        match visit {
            Visit::First => P::run(First(colour)),
            Visit::Again => P::run(Again(colour)),
            Visit::Only => P::run(Only(colour)),
        }
    }
}

/// Whether multipliers come from an earlier visit in the substep, and whether a later one wants
/// them.
#[derive(Clone, Copy)]
enum Visit {
    First,
    Again,
    Only,
}

/// The yarns of one colour.
struct Colour<'a, P: Pack> {
    yarns: &'a [Yarn],
    weights: &'a [f32],
    compliance: &'a [P],
    knots: &'a mut [Knot<P>],
    multiplier: &'a mut [P],
    position: &'a mut [Pack3<P>],
}

struct First<'a, P: Pack>(Colour<'a, P>);
struct Again<'a, P: Pack>(Colour<'a, P>);
struct Only<'a, P: Pack>(Colour<'a, P>);

impl<P: Pack> Kernel<P> for First<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.0.solve_all::<L, false, true>(token);
    }
}

impl<P: Pack> Kernel<P> for Again<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.0.solve_all::<L, true, true>(token);
    }
}

impl<P: Pack> Kernel<P> for Only<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.0.solve_all::<L, false, false>(token);
    }
}

impl<P: Pack> Colour<'_, P> {
    #[inline(always)]
    fn solve_all<L: Lane<Pack = P>, const HAS: bool, const KEEP: bool>(mut self, token: L::Token) {
        // Two yarns of one length side by side: each waits on a chain of divisions, and neither on
        // the other's.
        let mut yarns = self.yarns;
        while let [first, rest @ ..] = yarns {
            if let [second, rest @ ..] = rest
                && first.links.len() == second.links.len()
            {
                self.solve::<L, 2, HAS, KEEP>(token, [first, second]);
                yarns = rest;
            } else {
                self.solve::<L, 1, HAS, KEEP>(token, [first]);
                yarns = rest;
            }
        }
    }

    #[inline(always)]
    fn solve<L: Lane<Pack = P>, const SIDE: usize, const HAS: bool, const KEEP: bool>(
        &mut self,
        token: L::Token,
        yarns: [&Yarn; SIDE],
    ) {
        let count = yarns[0].links.len();
        let weights = self.weights;
        let weight = |particle: u32| -> L { L::splat(token, weights[particle as usize]) };
        let zero = L::splat(token, 0.0);
        let one = L::splat(token, 1.0);
        let least = L::splat(token, LEAST_LENGTH);

        let mut last = [V3::<L>::splat(token, 0.0); SIDE];
        let mut end: [V3<L>; SIDE] = core::array::from_fn(|yarn| {
            V3::load(token, &self.position[yarns[yarn].particles[0] as usize])
        });
        let mut end_weight: [L; SIDE] =
            core::array::from_fn(|yarn| weight(yarns[yarn].particles[0]));
        let mut inverse = [zero; SIDE];
        let mut change = [zero; SIDE];
        for link in 0..count {
            for yarn in 0..SIDE {
                let path = yarns[yarn];
                let joined = path.links[link];
                let next_particle = path.particles[link + 1];
                let next: V3<L> = V3::load(token, &self.position[next_particle as usize]);
                let next_weight = weight(next_particle);
                let along = next - end[yarn];
                let length = along.dot(along).sqrt().max(least);
                let direction = along * (one / length);
                let compliance = L::load(token, &self.compliance[joined.class as usize]);
                let mut excess = length - L::splat(token, joined.rest_length);
                if HAS {
                    let held = L::load(token, &self.multiplier[joined.link as usize]);
                    excess = excess + compliance * held;
                }

                let coupling = -(end_weight[yarn] * last[yarn].dot(direction));
                let share = coupling * inverse[yarn];
                if link > 0 {
                    share.store(&mut self.knots[(link - 1) * SIDE + yarn].share);
                }
                let pivot = end_weight[yarn] + next_weight + compliance - coupling * share;
                inverse[yarn] = one / pivot;
                change[yarn] = -(excess + coupling * change[yarn]) * inverse[yarn];
                let knot = &mut self.knots[link * SIDE + yarn];
                direction.store(&mut knot.direction);
                change[yarn].store(&mut knot.change);
                last[yarn] = direction;
                end[yarn] = next;
                end_weight[yarn] = next_weight;
            }
        }

        // Back up the yarn: Δλᵢ = changeᵢ − shareᵢ Δλᵢ₊₁, and each particle takes the pull of its
        // two links at once.
        let mut found = [zero; SIDE];
        let mut pull = [V3::<L>::splat(token, 0.0); SIDE];
        for link in (0..count).rev() {
            for yarn in 0..SIDE {
                let knot = &self.knots[link * SIDE + yarn];
                let mut change = L::load(token, &knot.change);
                if link + 1 < count {
                    change = change - L::load(token, &knot.share) * found[yarn];
                }
                found[yarn] = change;
                if KEEP {
                    let multiplier = &mut self.multiplier[yarns[yarn].links[link].link as usize];
                    if HAS {
                        (L::load(token, multiplier) + change).store(multiplier);
                    } else {
                        change.store(multiplier);
                    }
                }
                let tension = V3::<L>::load(token, &knot.direction) * change;
                let particle = yarns[yarn].particles[link + 1];
                let moved = (tension - pull[yarn]) * weight(particle);
                let position = &mut self.position[particle as usize];
                (V3::load(token, position) + moved).store(position);
                pull[yarn] = tension;
            }
        }
        for yarn in 0..SIDE {
            let particle = yarns[yarn].particles[0];
            let moved = pull[yarn] * -weight(particle);
            let position = &mut self.position[particle as usize];
            (V3::load(token, position) + moved).store(position);
        }
    }
}
