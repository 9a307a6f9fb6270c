//! Air: pressure and skin friction on each triangle (thesis, eq. 5.1 and 5.2 in one).
//!
//! With the air's velocity u relative to a triangle of area A and normal n, the pressure force is
//! ½ρ C_n A |u·n| (u·n) n and the friction ½ρ C_t A |u| (u − (u·n) n). A third of a triangle's impulse
//! goes to each corner.
//!
//! In a substep of h seconds that would change a particle's velocity by J = a u, with
//! a = ½ρ C_n |u·n| h/σ: explicitly, which turns the motion round where a > 1 (the thesis then sets it to
//! zero). Implicitly it is a/(1 + a) of the relative velocity that all else would bring about by itself.
//! For that we take all else to do what it did in the substep before, c: j = a (u − c)/(1 + a). Drag alone
//! (c = 0) is then exact, and so are the force on what is held fast (c = −J) and the terminal speed.
//! |J| = a² σ/(½ρ C_n h) says what a is. Backward Euler knows no c, and has a/(1 + a min(a, 1)): right to
//! second order for what is held in weak air, implicit where the air is strong.
//!
//! With c limited to u, j is never more than 2u, and so never adds energy in still air.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::constants::LEAST_AREA_SQUARED;
use crate::fabric::{Fabric, Patch};
use crate::geometry::corners::{Giver, sum_corners};
use crate::geometry::normals::face;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Gathers what the air does to each particle in this substep.
    pub fn gather_air(&mut self) {
        if C::SIDE > 1
            && let Some(weave) = &mut self.weave
        {
            let (position, velocity) = (&self.position, &self.velocity);
            weave.gather_air(&self.parameters, position, velocity, &mut self.scratch);
            return;
        }
        P::run(Air {
            fabric: &self.fabric,
            parameters: &self.parameters,
            position: &self.position,
            velocity: &self.velocity,
            below: &mut self.below,
            impulse: &mut self.scratch,
        });
    }
}

struct Air<'a, P: Pack> {
    fabric: &'a Fabric,
    parameters: &'a Parameters<P>,
    position: &'a [Pack3<P>],
    velocity: &'a [Pack3<P>],
    below: &'a mut [Pack3<P>],
    impulse: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Air<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { fabric, parameters, position, velocity, below, impulse } = self;
        let stream = Stream::<L>::load(token, parameters);
        sum_corners(token, fabric, &Blown { stream, position, velocity }, below, impulse);
    }
}

struct Blown<'a, L: Lane> {
    stream: Stream<L>,
    position: &'a [Pack3<L::Pack>],
    velocity: &'a [Pack3<L::Pack>],
}

impl<L: Lane> Giver<L> for Blown<'_, L> {
    #[inline(always)]
    fn give(&self, token: L::Token, patch: &Patch) -> [V3<L>; 2] {
        let [first, second] = patch.corner_areas;
        self.stream.blow(
            patch.load(token, self.position),
            patch.load(token, self.velocity),
            [L::splat(token, first), L::splat(token, second)],
        )
    }

    #[inline(always)]
    fn finish(&self, _: L::Token, sum: V3<L>) -> V3<L> {
        sum
    }
}

/// The air as a triangle meets it.
pub(crate) struct Stream<L: Lane> {
    wind: V3<L>,
    pressure: L,
    friction: L,
    rubs: L::Mask,
    any_rubs: bool,
    third: L,
    least: L,
}

impl<L: Lane> Stream<L> {
    #[inline(always)]
    pub fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Self {
        let friction = L::load(token, &parameters.friction);
        let rubs = L::splat(token, 0.0).lt(friction);
        Self {
            wind: V3::load(token, &parameters.wind),
            pressure: L::load(token, &parameters.pressure),
            friction,
            rubs,
            any_rubs: rubs.any(),
            third: L::splat(token, 1.0 / 3.0),
            least: L::splat(token, LEAST_AREA_SQUARED),
        }
    }

    /// What falls to each corner of the two triangles of a patch: their changes of velocity times their
    /// shares. Given the positions and velocities of the four corners.
    #[inline(always)]
    pub fn blow(&self, at: [V3<L>; 4], velocities: [V3<L>; 4], shares: [L; 2]) -> [V3<L>; 2] {
        let [first, second] = face(at);
        let [a, b, c, d] = velocities;
        let shared = a + c;
        [self.change(first, shared + b) * shares[0], self.change(second, shared + d) * shares[1]]
    }

    /// Change of velocity of a triangle in this substep, explicitly, given a normal of any length and the
    /// sum of its corners' velocities.
    #[inline(always)]
    fn change(&self, normal: V3<L>, velocities: V3<L>) -> V3<L> {
        let u = self.wind.minus_scaled(velocities, self.third);
        let squared = normal.dot(normal).max(self.least);
        let across = u.dot(normal);
        let braking = self.pressure * across.abs();
        // a (u·n) n with n not normalised and a = braking/length.
        let length = squared.sqrt();
        let part = braking / (squared * length);
        let pressed = normal * (across * part);
        if !self.any_rubs {
            return pressed;
        }
        let along = u.minus_scaled(normal, across / squared);
        let rub = self.friction * u.dot(u).sqrt();
        let rubbed = pressed.plus_scaled(along, rub);
        rubbed.or_where_not(self.rubs, pressed)
    }
}

/// How particles give way to the air.
pub(crate) struct Response<L: Lane> {
    /// ½ρ (C_n + C_t) h/σ, s/m.
    braking: L,
    /// Lanes that feel any air.
    pub blows: L::Mask,
    keep: L,
    foresight: L,
    /// Lanes that have a past.
    remembers: L::Mask,
    nothing: L,
    one: L,
    least: L,
}

impl<L: Lane> Response<L> {
    #[inline(always)]
    pub fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Self {
        let nothing = L::splat(token, 0.0);
        let pressure = L::load(token, &parameters.pressure);
        let braking = pressure + L::load(token, &parameters.friction);
        Self {
            braking,
            blows: nothing.lt(braking),
            keep: L::load(token, &parameters.keep),
            foresight: L::load(token, &parameters.foresight),
            remembers: nothing.lt(L::load(token, &parameters.extrapolation[0])),
            nothing,
            one: L::splat(token, 1.0),
            least: L::splat(token, f32::MIN_POSITIVE),
        }
    }

    /// The change of a particle's velocity in this substep, given what it would be explicitly, the
    /// particle's area over its inertia, and its velocity at the start of the substep, as it was and
    /// extrapolated.
    #[inline(always)]
    pub fn to(&self, blown: V3<L>, lightness: L, last: V3<L>, extrapolated: V3<L>) -> V3<L> {
        let squared = blown.dot(blown).max(self.least);
        let a = (self.braking * lightness * squared.sqrt()).sqrt();
        // −c, against which the air holds.
        let held = (last * self.keep - extrapolated) * self.foresight;
        let part = squared.plus_product(a, held.dot(blown)).max(self.nothing);
        let most = squared + squared;
        let part = part.or_where_not(part.lt(most), most);
        let limited = a.or_where_not(a.lt(self.one), self.one);
        let limited = self.one.or_where_not(self.remembers, limited);
        blown * (part / (squared * self.one.plus_product(a, limited)))
    }
}
