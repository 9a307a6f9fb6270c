//! External forces, damping and prediction: the thesis's `v += Δt w F`, `damp`, `p = x + Δt v`.
//!
//! All orders are one formula (see [`Formula`](crate::step::bdf::Formula)): what has changed in the last
//! two substeps is extrapolated by γ₁ and γ₂, and the new derivative counts for β h. What is older than
//! that is overwritten by what is new, and the arrays change names.

use core::mem::swap;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::reduce::Sum;
use crate::simd::vec3::{Pack3, V3};
use crate::stability::pole::{Axis, Pole};
use crate::step::Scheme;
use crate::step::air::Response;
use crate::step::bdf::Unrest;
use crate::step::parameters::Parameters;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Begins a substep: carries the state into the moved frame, applies gravity and the air, damps,
    /// and predicts positions.
    pub fn integrate(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        self.begin_substep();
        if self.parameters.carries {
            P::run(CarryState {
                inverse_areas: &self.packs.inverse_areas,
                parameters: &self.parameters,
                inverse_step: 1.0 / self.clock.step,
                position: &mut self.position,
                velocity: &mut self.velocity,
                history: [
                    &mut self.displacement,
                    &mut self.older_displacement,
                    &mut self.older_velocity,
                    &mut self.oldest_velocity,
                    &mut self.memory,
                ],
            });
        }
        let feels_air = self.parameters.feels_air();
        if feels_air {
            self.gather_air();
        }
        let nothing = P::splat(0.0);
        let mut unrest = Unrest { motion: nothing, change: nothing, shake: nothing };
        P::run(Predict {
            areas: &self.packs.areas,
            inverse_areas: &self.packs.inverse_areas,
            weights: &self.lane_weights,
            parts: &self.parts,
            pole: self.pole,
            parameters: &self.parameters,
            frame_rate: -1.0 / self.clock.step,
            position: &self.position,
            next: &mut self.scratch,
            displacement: &self.displacement,
            older_displacement: &mut self.older_displacement,
            velocity: &mut self.velocity,
            older_velocity: &mut self.older_velocity,
            oldest_velocity: &mut self.oldest_velocity,
            feels_air,
            unrest: &mut unrest,
        });
        swap(&mut self.position, &mut self.scratch);
        swap(&mut self.velocity, &mut self.oldest_velocity);
        swap(&mut self.older_velocity, &mut self.oldest_velocity);
        swap(&mut self.displacement, &mut self.older_displacement);
        self.judge(&unrest);
        self.clock.done += 1;
    }

    /// Lets lanes whose motion is rough begin anew, and finds which hardly move.
    fn judge(&mut self, unrest: &Unrest<P>) {
        let particles = self.fabric.particle_count();
        let yarns = self.clock.settings.scheme == Scheme::Yarns;
        for cloth in 0..self.slots.len() {
            let Some(slot) = &mut self.slots[cloth] else { continue };
            let of_lane = |sum: &P| sum.lanes()[C::lanes(cloth).start];
            let unrest = Unrest {
                motion: of_lane(&unrest.motion),
                change: of_lane(&unrest.change),
                shake: of_lane(&unrest.shake),
            };
            let creeps = yarns && slot.past.creeps(unrest, particles);
            slot.past.judge(unrest, particles);
            if self.parameters.creeps(C::lanes(cloth)) && !creeps {
                self.forget_tremor(cloth);
            }
            self.parameters.set_creeps(C::lanes(cloth), creeps);
        }
    }
}

/// The frame's motion in registers.
struct Motion<L: Lane> {
    turn: [V3<L>; 3],
    shift: V3<L>,
    moves: L::Mask,
}

impl<L: Lane> Motion<L> {
    #[inline(always)]
    fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Self {
        let [x, y, z] = &parameters.turn;
        Self {
            turn: [V3::load(token, x), V3::load(token, y), V3::load(token, z)],
            shift: V3::load(token, &parameters.shift),
            moves: L::splat(token, 0.0).lt(L::load(token, &parameters.moves)),
        }
    }

    /// Change of the coordinates of a direction that stays in the world.
    #[inline(always)]
    fn turned(&self, direction: V3<L>) -> V3<L> {
        let [x, y, z] = &self.turn;
        V3 { x: x.dot(direction), y: y.dot(direction), z: z.dot(direction) }
    }

    /// Change of the coordinates of a point that stays in the world.
    #[inline(always)]
    fn moved(&self, point: V3<L>) -> V3<L> {
        self.turned(point) + self.shift
    }

    /// What the frame sweeps past a point in the substep, along the tangent: the chord of a turn
    /// points outwards, and damping towards it would throw the cloth that way.
    #[inline(always)]
    fn swept(&self, point: V3<L>, half: L) -> V3<L> {
        let [x, y, z] = &self.turn;
        let transposed = (*x * point.x).plus_scaled(*y, point.y).plus_scaled(*z, point.z);
        self.shift.plus_scaled(self.turned(point) - transposed, half)
    }

    /// Rewrites a direction that stays in the world.
    #[inline(always)]
    fn turn(&self, token: L::Token, direction: &mut Pack3<L::Pack>) {
        let d: V3<L> = V3::load(token, direction);
        self.apply(d, self.turned(d)).store(direction);
    }

    /// The changed vector in lanes whose frame moves; a lane at rest keeps its bits, whatever its
    /// neighbours do.
    #[inline(always)]
    fn apply(&self, vector: V3<L>, change: V3<L>) -> V3<L> {
        (vector + change).or_where_not(self.moves, vector)
    }
}

/// Rewrites the state in the coordinates of the moved frame. Free particles stay where they are in
/// the world; pinned ones go with the frame, and so have a velocity.
struct CarryState<'a, P: Pack, C> {
    inverse_areas: &'a [C],
    parameters: &'a Parameters<P>,
    inverse_step: f32,
    position: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    /// What else has a direction.
    history: [&'a mut [Pack3<P>]; 5],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for CarryState<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let motion = Motion::<L>::load(token, self.parameters);
        let inverse_step = L::splat(token, self.inverse_step);
        let particles = self.position.iter_mut().zip(self.velocity);
        for ((position, velocity), &inverse_area) in particles.zip(self.inverse_areas) {
            let x: V3<L> = V3::load(token, position);
            let carried = motion.apply(x, motion.moved(x));
            let of_pin = (x - carried) * inverse_step;
            if inverse_area.is_zero() {
                of_pin.store(velocity);
                continue;
            }
            inverse_area.choose3(token, carried, x).store(position);
            motion.turn(token, velocity);
            let turned: V3<L> = V3::load(token, velocity);
            inverse_area.choose3(token, turned, of_pin).store(velocity);
        }
        for directions in self.history {
            for direction in directions {
                motion.turn(token, direction);
            }
        }
    }
}

/// Extrapolates velocities and damps them, adds what air and gravity do, and moves the particles to where
/// they would go unconstrained. Gravity and air come after damping, so that rest states are exact.
struct Predict<'a, P: Pack, C> {
    areas: &'a [C],
    inverse_areas: &'a [C],
    weights: &'a [P],
    /// Into which part of the sums each pack goes.
    parts: &'a [u8],
    pole: Option<Pole>,
    parameters: &'a Parameters<P>,
    /// −1/h, 1/s.
    frame_rate: f32,
    position: &'a [Pack3<P>],
    /// Where the particles would go; before, what the air does.
    next: &'a mut [Pack3<P>],
    displacement: &'a [Pack3<P>],
    /// Overwritten by the displacement of this substep.
    older_displacement: &'a mut [Pack3<P>],
    /// These two are carried along with what the air does now, for its changes are not to be extrapolated.
    velocity: &'a mut [Pack3<P>],
    older_velocity: &'a mut [Pack3<P>],
    /// Overwritten by the velocity of this substep.
    oldest_velocity: &'a mut [Pack3<P>],
    /// Whether there are impulses of the air where the next positions will be.
    feels_air: bool,
    unrest: &'a mut Unrest<P>,
}

impl<P: Pack, C: Constant<P>> Kernel<P> for Predict<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let step = L::load(token, &self.parameters.step);
        let [last, before] = &self.parameters.extrapolation;
        let [last, before] = [L::load(token, last), L::load(token, before)];
        let lost = L::splat(token, 1.0) - L::load(token, &self.parameters.keep);
        let gravity: V3<L> = V3::load(token, &self.parameters.gravity_step);
        let response = Response::<L>::load(token, self.parameters);
        let motion = Motion::<L>::load(token, self.parameters);
        let any_moves = motion.moves.any();
        let frame_rate = L::splat(token, self.frame_rate);
        let half = L::splat(token, 0.5);
        let nothing = L::splat(token, 0.0);
        let still = V3::splat(token, 0.0);
        let axis = Axis::<L>::of(token, self.pole);
        let [angle, rate] = &self.parameters.turned;
        let [angle, rate] = [L::load(token, angle), L::load(token, rate)];
        let mut unrest = [Sum::new(token), Sum::new(token), Sum::new(token)];
        let [motions, changes, shakes] = &mut unrest;
        let places = self.position.iter().zip(self.next);
        let displacements = self.displacement.iter().zip(self.older_displacement);
        let velocities = self.velocity.iter_mut().zip(self.older_velocity);
        let constants = self.weights.iter().zip(self.areas).zip(self.inverse_areas).zip(self.parts);
        for (
            (((position, next), (displacement, older_displacement)), ((velocity, older), oldest)),
            (((weight, area), constant), &part),
        ) in places.zip(displacements).zip(velocities.zip(self.oldest_velocity)).zip(constants)
        {
            if constant.is_zero() {
                *next = *position;
                *oldest = *velocity;
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let v: V3<L> = V3::load(token, velocity);
            let v_before: V3<L> = V3::load(token, older);
            let change = v - v_before;
            let change_before = v_before - V3::load(token, oldest);
            let shake = change - change_before;
            motions.add(part, constant.choose(token, v.dot(v), nothing));
            changes.add(part, constant.choose(token, change.dot(change), nothing));
            shakes.add(part, constant.choose(token, shake.dot(shake), nothing));
            let extrapolated = v.plus_scaled(change, last).plus_scaled(change_before, before);
            // Damping acts on the motion relative to the frame, whose point at x has this velocity.
            let relative = if any_moves {
                v - (motion.swept(x, half) * frame_rate).or_where_not(motion.moves, still)
            } else {
                v
            };
            let damped = extrapolated.minus_scaled(relative, lost);
            // What the corrections have turned is taken out; its changes are small.
            let round = match &axis {
                Some(axis) => axis.round(x),
                None => still,
            };
            let damped = damped.minus_scaled(round, rate);

            let weight = L::load(token, weight);
            // Gravity acts on the true mass, whatever inertia is added to it.
            let lightness = weight * area.load(token);
            let mut forced = damped.plus_scaled(gravity, lightness);
            if self.feels_air {
                let blown = V3::load(token, next) * weight;
                let blown = response.to(blown, lightness, v, damped);
                forced = forced + blown;
                for (past, place) in [(v, velocity), (v_before, older)] {
                    let carried = (past + blown).or_where_not(response.blows, past);
                    constant.choose3(token, carried, past).store(place);
                }
            }
            constant.choose3(token, forced, v).store(oldest);

            let oldest: V3<L> = V3::load(token, older_displacement);
            let moved = (forced * step)
                .plus_scaled(V3::load(token, displacement), last)
                .plus_scaled(oldest, before)
                .minus_scaled(round, angle);
            constant.choose3(token, moved, oldest).store(older_displacement);
            constant.choose3(token, x + moved, x).store(next);
        }
        let [motions, changes, shakes] = unrest;
        motions.total::<C>(token).store(&mut self.unrest.motion);
        changes.total::<C>(token).store(&mut self.unrest.change);
        shakes.total::<C>(token).store(&mut self.unrest.shake);
    }
}
