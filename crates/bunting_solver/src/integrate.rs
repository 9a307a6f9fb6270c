//! External forces, damping and prediction: the thesis's `v += Δt w F`, `damp`, `p = x + Δt v`.
//!
//! Both orders are one formula (see [`Formula`](crate::parameters::Formula)): what has changed in
//! the last substep is extrapolated by γ, and the new derivative counts for β h. Gauss–Seidel takes
//! γ = 0 and β = 1, backward Euler; yarns take BDF2's γ = 1/3 and β = 2/3.

use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Mask, Pack};
use crate::parameters::Parameters;
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Begins a substep: carries the state into the moved frame, applies gravity and the air, damps,
    /// and predicts positions.
    pub fn integrate(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        self.begin_substep();
        let inverse_areas = self.fabric.inverse_areas();
        if self.parameters.carries {
            P::run(CarryState {
                inverse_areas,
                parameters: &self.parameters,
                inverse_step: 1.0 / self.clock.step,
                position: &mut self.position,
                displacement: &mut self.displacement,
                velocity: &mut self.velocity,
                older_velocity: &mut self.older_velocity,
                memory: &mut self.memory,
            });
        }
        P::run(Extrapolate {
            inverse_areas,
            parameters: &self.parameters,
            frame_rate: -1.0 / self.clock.step,
            position: &self.position,
            velocity: &mut self.velocity,
            older_velocity: &mut self.older_velocity,
        });
        self.apply_air();
        P::run(Predict {
            areas: self.fabric.particle_areas(),
            weights: &self.weights,
            parameters: &self.parameters,
            position: &mut self.position,
            predicted: &mut self.predicted,
            displacement: &mut self.displacement,
            velocity: &mut self.velocity,
            air_impulse: &self.air_impulse,
        });
        self.clock.done += 1;
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

    /// The changed vector in lanes whose frame moves; a lane at rest keeps its bits, whatever its
    /// neighbours do.
    #[inline(always)]
    fn apply(&self, vector: V3<L>, change: V3<L>) -> V3<L> {
        (vector + change).or_where_not(self.moves, vector)
    }
}

/// Rewrites the state in the coordinates of the moved frame. Free particles stay where they are in
/// the world; pinned ones go with the frame, and so have a velocity.
struct CarryState<'a, P: Pack> {
    inverse_areas: &'a [f32],
    parameters: &'a Parameters<P>,
    inverse_step: f32,
    position: &'a mut [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    older_velocity: &'a mut [Pack3<P>],
    memory: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for CarryState<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let motion = Motion::<L>::load(token, self.parameters);
        let inverse_step = L::splat(token, self.inverse_step);
        let particles = self.position.iter_mut().zip(self.velocity);
        let history = self.displacement.iter_mut().zip(self.older_velocity).zip(self.memory);
        for (((position, velocity), ((displacement, older), memory)), &inverse_area) in
            particles.zip(history).zip(self.inverse_areas)
        {
            let x: V3<L> = V3::load(token, position);
            let carried = motion.apply(x, motion.moved(x));
            if inverse_area == 0.0 {
                ((x - carried) * inverse_step).store(velocity);
                continue;
            }
            carried.store(position);
            for direction in [displacement, velocity, older, memory] {
                let d: V3<L> = V3::load(token, direction);
                motion.apply(d, motion.turned(d)).store(direction);
            }
        }
    }
}

/// Extrapolates velocities and damps them. Gravity and air come after, undamped, so that rest states
/// are exact.
struct Extrapolate<'a, P: Pack> {
    inverse_areas: &'a [f32],
    parameters: &'a Parameters<P>,
    /// −1/h, 1/s.
    frame_rate: f32,
    position: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    older_velocity: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Extrapolate<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let extrapolation = L::load(token, &self.parameters.extrapolation);
        let keep = L::load(token, &self.parameters.keep);
        let motion = Motion::<L>::load(token, self.parameters);
        let any_moves = motion.moves.any();
        let frame_rate = L::splat(token, self.frame_rate);
        let zero = V3::splat(token, 0.0);
        let half = L::splat(token, 0.5);
        let speeds = self.velocity.iter_mut().zip(self.older_velocity);
        for (((velocity, older), position), &inverse_area) in
            speeds.zip(self.position).zip(self.inverse_areas)
        {
            if inverse_area == 0.0 {
                continue;
            }
            let v: V3<L> = V3::load(token, velocity);
            let before: V3<L> = V3::load(token, older);
            v.store(older);
            let v = v.plus_scaled(v - before, extrapolation);
            // Damping acts on the motion relative to the frame, whose point at x has this velocity.
            let damped = if any_moves {
                let x = V3::load(token, position);
                let frame = (motion.swept(x, half) * frame_rate).or_where_not(motion.moves, zero);
                frame.plus_scaled(v - frame, keep).or_where_not(motion.moves, v * keep)
            } else {
                v * keep
            };
            damped.store(velocity);
        }
    }
}

/// Adds what air and gravity do, and moves the particles to where they would go unconstrained.
struct Predict<'a, P: Pack> {
    areas: &'a [f32],
    weights: &'a [f32],
    parameters: &'a Parameters<P>,
    position: &'a mut [Pack3<P>],
    predicted: &'a mut [Pack3<P>],
    displacement: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    air_impulse: &'a [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Predict<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let step = L::load(token, &self.parameters.step);
        let extrapolation = L::load(token, &self.parameters.extrapolation);
        let gravity: V3<L> = V3::load(token, &self.parameters.gravity_step);
        let places = self.position.iter_mut().zip(self.predicted).zip(self.displacement);
        let speeds = self.velocity.iter_mut().zip(self.air_impulse);
        let inertia = self.weights.iter().zip(self.areas);
        for ((((position, predicted), displacement), (velocity, impulse)), (&weight, &area)) in
            places.zip(speeds).zip(inertia)
        {
            if weight == 0.0 {
                continue;
            }
            let air: V3<L> = V3::load(token, impulse);
            // Gravity acts on the true mass, whatever inertia is added to it.
            let v = V3::load(token, velocity)
                .plus_scaled(air, L::splat(token, weight))
                .plus_scaled(gravity, L::splat(token, weight * area));
            v.store(velocity);
            let change = (v * step).plus_scaled(V3::load(token, displacement), extrapolation);
            change.store(displacement);
            let x = V3::load(token, position) + change;
            x.store(predicted);
            x.store(position);
        }
    }
}
