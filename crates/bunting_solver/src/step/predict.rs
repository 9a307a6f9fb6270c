//! Prediction: the thesis's `v += Δt w F`, `damp`, `p = x + Δt v`.
//!
//! Formulas of all orders have one form (see [`Formula`](crate::step::bdf::Formula)): the changes of the last
//! two substeps are extrapolated by γ₁ and γ₂, and the new derivative acts for β h. Gravity and air come
//! after damping, so that rest states are exact.

use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::sum::Sum;
use crate::simd::vec3::{Pack3, V3};
use crate::stability::pole::{Axis, PolePacks};
use crate::step::air::Response;
use crate::step::bdf::MotionSums;
use crate::step::carry::FrameRegisters;
use crate::step::parameters::Parameters;

/// Constant that, added to a velocity in m/s or a position in m and subtracted again, rounds values below
/// 10⁻⁵ to multiples of 2⁻⁴³, 1.1 × 10⁻¹³, and returns larger values unchanged except for rare units in the
/// last place. It is needed because damped motion decays exponentially, to values that are subnormal or have
/// subnormal products, each of which takes processors a hundred times as long. Near one and a half times a
/// power of two, the constant rounds both signs alike. Its last place is odd, so that it is half a unit in
/// the last place of no larger value: a tie to even would change every odd one. Smaller: products of three
/// values are subnormal. Larger: the rounding is visible in slow motion.
pub(crate) const ROUNDING: f32 = 1.430_511_6e-6;

/// Rounding constant for the change of velocity by air in a substep, m/s, which is squared: it rounds to
/// multiples of 2⁻⁵³.
const AIR_ROUNDING: f32 = ROUNDING / 1024.0;

/// Kernel that extrapolates and damps velocities, adds air and gravity, and moves particles to their
/// positions without constraints.
pub(crate) struct Predict<'a, P: Pack, C> {
    pub areas: &'a [C],
    pub inverse_areas: &'a [C],
    pub inverse_masses: &'a [P],
    pub partial_sums: &'a [u8],
    pub pole: Option<&'a PolePacks<P>>,
    pub parameters: &'a Parameters<P>,
    /// Negative rate of substeps, −1/h, 1/s.
    pub frame_rate: f32,
    pub position: &'a [Pack3<P>],
    /// Before: the sums of the air, m³/s. After: the predicted positions, m.
    pub next: &'a mut [Pack3<P>],
    pub displacement: &'a [Pack3<P>],
    /// Displacement in the substep before; overwritten by that of this substep, m.
    pub older_displacement: &'a mut [Pack3<P>],
    /// Velocities of this and of the last substep: changes by air are added to both, so that they are not
    /// extrapolated.
    pub velocity: &'a mut [Pack3<P>],
    pub older_velocity: &'a mut [Pack3<P>],
    /// Velocities two substeps earlier; overwritten by the predicted velocities, m/s.
    pub oldest_velocity: &'a mut [Pack3<P>],
    /// Whether `next` contains the sums of the air.
    pub feels_air: bool,
    pub sums: &'a mut MotionSums<P>,
}

impl<P: Pack, C: Constant<P>> Kernel<P> for Predict<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let substep = Substep::<L>::load(token, self.parameters, self.pole, self.frame_rate);
        let response = Response::<L>::load(token, self.parameters);
        let gravity: V3<L> = V3::load(token, &self.parameters.gravity_step);
        let (rounding, air_rounding) = (V3::splat(token, ROUNDING), V3::splat(token, AIR_ROUNDING));
        let mut sums = Sums::new(token);
        let positions = self.position.iter().zip(self.next);
        let displacements = self.displacement.iter().zip(self.older_displacement);
        let velocities = self.velocity.iter_mut().zip(self.older_velocity);
        let masses = self.inverse_masses.iter().zip(self.areas).zip(self.inverse_areas);
        for (
            (((position, next), (displacement, older_displacement)), ((velocity, older), oldest)),
            (((inverse_mass, area), inverse_area), &partial_sum),
        ) in positions
            .zip(displacements)
            .zip(velocities.zip(self.oldest_velocity))
            .zip(masses.zip(self.partial_sums))
        {
            if inverse_area.is_zero() {
                *next = *position;
                *oldest = *velocity;
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let v: V3<L> = V3::load(token, velocity);
            let v_before: V3<L> = V3::load(token, older);
            let changes = [v - v_before, v_before - V3::load(token, oldest)];
            sums.add(token, partial_sum, inverse_area, v, changes);
            let turn = substep.turn_at(x);
            let damped = substep.damped(x, v, changes, turn);

            let inverse_mass = L::load(token, inverse_mass);
            // Gravity acts on the true mass, without added inertia.
            let true_part = inverse_mass * area.load(token);
            let mut forced = damped.plus_scaled(gravity, true_part);
            if self.feels_air {
                let explicit = V3::load(token, next) * inverse_mass;
                let explicit = (explicit + air_rounding) - air_rounding;
                let change = response.implicit_change(explicit, true_part, v, damped);
                forced = forced + change;
                for (past, stored) in [(v, velocity), (v_before, older)] {
                    let shifted = (past + change).or_where_not(response.acts, past);
                    inverse_area.select3(token, shifted, past).store(stored);
                }
            }
            let forced = (forced + rounding) - rounding;
            inverse_area.select3(token, forced, v).store(oldest);

            let oldest: V3<L> = V3::load(token, older_displacement);
            let moved = substep.moved(forced, V3::load(token, displacement), oldest, turn);
            inverse_area.select3(token, moved, oldest).store(older_displacement);
            let predicted = ((x + moved) + rounding) - rounding;
            inverse_area.select3(token, predicted, x).store(next);
        }
        sums.store::<C>(token, self.sums);
    }
}

/// Constants of the substep, in registers.
struct Substep<L: Lane> {
    /// Effective length β h, s.
    step: L,
    /// Coefficients γ₁ and γ₂.
    extrapolation: [L; 2],
    /// Fraction of the velocity relative to the frame that damping removes.
    damping: L,
    frame: FrameRegisters<L>,
    any_frame_moves: bool,
    frame_rate: L,
    half: L,
    zero: V3<L>,
    axis: Option<Axis<L>>,
    /// Turn about the pole that is undone, rad, and its rate, rad/s.
    pole_turn: [L; 2],
}

impl<L: Lane> Substep<L> {
    #[inline(always)]
    fn load(
        token: L::Token,
        parameters: &Parameters<L::Pack>,
        pole: Option<&PolePacks<L::Pack>>,
        frame_rate: f32,
    ) -> Self {
        let [last, before] = &parameters.extrapolation;
        let [angle, rate] = &parameters.pole_turn;
        let frame = FrameRegisters::<L>::load(token, parameters);
        Self {
            step: L::load(token, &parameters.step),
            extrapolation: [L::load(token, last), L::load(token, before)],
            damping: L::splat(token, 1.0) - L::load(token, &parameters.damping_factor),
            any_frame_moves: frame.moves.any(),
            frame,
            frame_rate: L::splat(token, frame_rate),
            half: L::splat(token, 0.5),
            zero: V3::splat(token, 0.0),
            axis: Axis::load(token, pole),
            pole_turn: [L::load(token, angle), L::load(token, rate)],
        }
    }

    /// Displacement of a point by a turn of one radian about the pole, m.
    #[inline(always)]
    fn turn_at(&self, x: V3<L>) -> V3<L> {
        match &self.axis {
            Some(axis) => axis.turn_of(x),
            None => self.zero,
        }
    }

    /// The extrapolated velocity, damped relative to the frame, and without the spurious turn about the pole
    /// in the present velocity. The small turn in the last two changes remains.
    #[inline(always)]
    fn damped(
        &self,
        x: V3<L>,
        v: V3<L>,
        [change, change_before]: [V3<L>; 2],
        turn: V3<L>,
    ) -> V3<L> {
        let [last, before] = self.extrapolation;
        let [_, rate] = self.pole_turn;
        let extrapolated = v.plus_scaled(change, last).plus_scaled(change_before, before);
        let relative = if self.any_frame_moves {
            let of_frame = self.frame.tangent_at(x, self.half) * self.frame_rate;
            v - of_frame.or_where_not(self.frame.moves, self.zero)
        } else {
            v
        };
        extrapolated.minus_scaled(relative, self.damping).minus_scaled(turn, rate)
    }

    /// The displacement in this substep, m, given the new velocity and the displacements of the last two.
    #[inline(always)]
    fn moved(&self, forced: V3<L>, displacement: V3<L>, older: V3<L>, turn: V3<L>) -> V3<L> {
        let [last, before] = self.extrapolation;
        let [angle, _] = self.pole_turn;
        (forced * self.step)
            .plus_scaled(displacement, last)
            .plus_scaled(older, before)
            .minus_scaled(turn, angle)
    }
}

/// Sums over the particles of squared velocities and of their differences.
struct Sums<L> {
    velocity: Sum<L>,
    first_difference: Sum<L>,
    second_difference: Sum<L>,
}

impl<L: Lane> Sums<L> {
    #[inline(always)]
    fn new(token: L::Token) -> Self {
        Self {
            velocity: Sum::new(token),
            first_difference: Sum::new(token),
            second_difference: Sum::new(token),
        }
    }

    /// Adds the terms of the free particles of a pack.
    #[inline(always)]
    fn add<C: Constant<L::Pack>>(
        &mut self,
        token: L::Token,
        partial: u8,
        inverse_area: &C,
        v: V3<L>,
        [change, change_before]: [V3<L>; 2],
    ) {
        let zero = L::splat(token, 0.0);
        let second = change - change_before;
        self.velocity.add(partial, inverse_area.select(token, v.dot(v), zero));
        self.first_difference.add(partial, inverse_area.select(token, change.dot(change), zero));
        self.second_difference.add(partial, inverse_area.select(token, second.dot(second), zero));
    }

    #[inline(always)]
    fn store<C: Constant<L::Pack>>(self, token: L::Token, into: &mut MotionSums<L::Pack>) {
        self.velocity.total::<C>(token).store(&mut into.velocity);
        self.first_difference.total::<C>(token).store(&mut into.first_difference);
        self.second_difference.total::<C>(token).store(&mut into.second_difference);
    }
}
