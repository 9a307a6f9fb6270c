//! Air: pressure and skin friction on each triangle (thesis, eq. 5.1 and 5.2 in one).
//!
//! With u the air's velocity relative to a triangle of area A and normal n, the pressure force is ½ρ C_n A
//! |u·n| (u·n) n and the friction ½ρ C_t A |u| (u − (u·n) n). Each corner receives a third of the impulse, or each
//! corner of a grid's cell a quarter, as of the mass.
//!
//! Explicitly, a substep of h seconds changes a particle's velocity by J = a u, a = ½ρ C_n |u·n| h/σ, which
//! reverses the relative motion if a > 1 (the thesis then sets it to zero). Implicitly the change is the
//! fraction a/(1 + a) of the relative velocity to which all other forces alone would lead. These forces are
//! assumed to change the velocity by c, as in the substep before: j = a (u − c)/(1 + a). Drag alone (c = 0)
//! is then exact, and so are the force on particles that are held fast (c = −J) and the terminal speed. The a
//! of a particle follows from its J, |J| = a² σ/(½ρ C_n h). Backward Euler has no c, and uses a/(1 + a min(a,
//! 1)): exact to second order for held particles in weak air, implicit in strong air.
//!
//! Normals are those in the middle of the substep, extrapolated with the velocities: a change of velocity by normals of the
//! start lags behind the motion by half a substep, which fed the flutter of flags with energy, and strained them.
//!
//! With c limited to u, j is at most 2u, and so never adds energy in still air.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::constants::LEAST_AREA_SQUARED;
use crate::geometry::corners::{Contribution, CornerSums, Corners};
use crate::geometry::face::face;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Computes for each particle the sum over its triangles of corner area times the change of their
    /// velocity by air in this substep, m³/s, and writes it into `scratch`.
    pub fn gather_air(&mut self) {
        match self.local_wind.take() {
            None => self.sum_air(None),
            Some(mut local) => {
                self.gather_local_air(&mut local);
                self.local_wind = Some(local);
            }
        }
    }

    /// The same, with the given velocities (m/s) in place of the particles' own, if there are any.
    pub(super) fn sum_air(&mut self, velocity: Option<&[Pack3<P>]>) {
        let velocity = velocity.unwrap_or(&self.velocity);
        let (triangles, velocity) = self.layout.moving_triangles(&self.fabric, velocity);
        P::run(Air {
            triangles,
            parameters: &self.parameters,
            position: self.positions.field(),
            velocity,
            sums: &mut self.scratch,
            half_step: 0.5 * self.clock.step,
        });
    }
}

struct Air<'a, P: Pack, S: CornerSums<P>> {
    triangles: S,
    parameters: &'a Parameters<P>,
    /// Positions, m.
    position: &'a S::Field,
    /// Velocities, m/s.
    velocity: &'a S::Field,
    sums: &'a mut [Pack3<P>],
    /// Half of the substep, s.
    half_step: f32,
}

impl<P: Pack, S: CornerSums<P>> Kernel<P> for Air<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { triangles, parameters, position, velocity, sums, .. } = self;
        let airflow = Airflow::<L>::load(token, parameters);
        let half_step = L::splat(token, self.half_step);
        triangles.sum(token, &AirImpulse { airflow, half_step, position, velocity }, sums);
    }
}

struct AirImpulse<'a, L: Lane, F: ?Sized> {
    airflow: Airflow<L>,
    half_step: L,
    position: &'a F,
    velocity: &'a F,
}

impl<L: Lane, F: ?Sized> Contribution<L, F> for AirImpulse<'_, L, F> {
    #[inline(always)]
    fn of<C: Corners<L, Field = F>>(&self, token: L::Token, corners: &C) -> [V3<L>; 2] {
        let velocities = corners.load(token, self.velocity);
        let mut middle = corners.load(token, self.position);
        for (position, velocity) in middle.iter_mut().zip(velocities) {
            *position = position.plus_scaled(velocity, self.half_step);
        }
        let [first, second] = face(middle);
        let [a, b, c, d] = velocities;
        let [first_area, second_area] = corners.areas(token);
        let shared = a + c;
        [
            self.airflow.change(first, shared + b) * first_area,
            self.airflow.change(second, shared + d) * second_area,
        ]
    }

    #[inline(always)]
    fn finish(&self, _: L::Token, sum: V3<L>) -> V3<L> {
        sum
    }
}

/// Wind and the coefficients of the air, in registers.
struct Airflow<L: Lane> {
    /// Velocity of the wind, m/s.
    wind: V3<L>,
    /// ½ρ C_n h/σ and ½ρ C_t h/σ, s/m.
    pressure: L,
    friction: L,
    /// Lanes with skin friction.
    rubs: L::Mask,
    any_rubs: bool,
    third: L,
    least: L,
}

impl<L: Lane> Airflow<L> {
    #[inline(always)]
    fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Self {
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

    /// Explicit change of a triangle's velocity in this substep, m/s, given its normal, of any length, and the
    /// sum of its corners' velocities, m/s.
    #[inline(always)]
    fn change(&self, normal: V3<L>, velocities: V3<L>) -> V3<L> {
        let u = self.wind.minus_scaled(velocities, self.third);
        let squared = normal.dot(normal).max(self.least);
        let across = u.dot(normal);
        let braking = self.pressure * across.abs();
        // The pressure a (u·n) n, with n not normalised and a = braking/length.
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

/// The implicit response of particles to the air.
pub(crate) struct Response<L: Lane> {
    /// ½ρ (C_n + C_t) h/σ, s/m.
    braking: L,
    /// Lanes that the air acts on.
    pub acts: L::Mask,
    damping_factor: L,
    inverse_extrapolation: L,
    /// Lanes with a formula of second order.
    second_order: L::Mask,
    zero: L,
    one: L,
    least: L,
}

impl<L: Lane> Response<L> {
    #[inline(always)]
    pub fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Self {
        let zero = L::splat(token, 0.0);
        let pressure = L::load(token, &parameters.pressure);
        let braking = pressure + L::load(token, &parameters.friction);
        Self {
            braking,
            acts: zero.lt(braking),
            damping_factor: L::load(token, &parameters.damping_factor),
            inverse_extrapolation: L::load(token, &parameters.inverse_extrapolation),
            second_order: zero.lt(L::load(token, &parameters.extrapolation[0])),
            zero,
            one: L::splat(token, 1.0),
            least: L::splat(token, f32::MIN_POSITIVE),
        }
    }

    /// Change j of a particle's velocity in this substep, m/s, given the explicit change J, the part of its
    /// inertia that is its true mass, its velocity at the start of the substep, and that velocity
    /// extrapolated, all in m/s.
    #[inline(always)]
    pub fn implicit_change(
        &self,
        explicit: V3<L>,
        true_part: L,
        velocity: V3<L>,
        extrapolated: V3<L>,
    ) -> V3<L> {
        let squared = explicit.dot(explicit).max(self.least);
        let a = (self.braking * true_part * squared.sqrt()).sqrt();
        // −c.
        let held = (velocity * self.damping_factor - extrapolated) * self.inverse_extrapolation;
        // The quotient of J·(J − a c), limited to between zero and 2 J², and J² (1 + a) is the ratio of j to
        // J.
        let projected = squared.plus_product(a, held.dot(explicit)).max(self.zero);
        let most = squared + squared;
        let projected = projected.or_where_not(projected.lt(most), most);
        let limited = a.or_where_not(a.lt(self.one), self.one);
        let limited = self.one.or_where_not(self.second_order, limited);
        explicit * (projected / (squared * self.one.plus_product(a, limited)))
    }
}
