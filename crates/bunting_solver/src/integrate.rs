//! External forces, damping and prediction: the thesis's `v += Δt w F`, `damp`, `p = x + Δt v`.

use crate::fabric::Fabric;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Mask, Pack};
use crate::parameters::Parameters;
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Begins a substep: carries the state into the moved frame, applies the air and gravity, damps,
    /// and predicts positions.
    pub fn integrate(&mut self) {
        self.begin_substep();
        if self.parameters.carries {
            P::run(CarryState {
                fabric: &self.fabric,
                parameters: &self.parameters,
                inverse_step: 1.0 / self.clock.step,
                position: &mut self.position,
                velocity: &mut self.velocity,
            });
        }
        self.apply_air();
        P::run(Predict {
            fabric: &self.fabric,
            parameters: &self.parameters,
            step: self.clock.step,
            position: &mut self.position,
            predicted: &mut self.predicted,
            velocity: &mut self.velocity,
            air_impulse: &self.air_impulse,
        });
        self.clock.done += 1;
    }
}

/// Rewrites the state in the coordinates of the moved frame. Free particles stay where they are in
/// the world; pinned ones go with the frame, and so have a velocity.
struct CarryState<'a, P: Pack> {
    fabric: &'a Fabric,
    parameters: &'a Parameters<P>,
    inverse_step: f32,
    position: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

/// The frame's motion in registers.
struct Motion<L> {
    turn: [V3<L>; 3],
    shift: V3<L>,
}

impl<L: Lane> Motion<L> {
    #[inline(always)]
    fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Self {
        let [x, y, z] = &parameters.turn;
        Self {
            turn: [V3::load(token, x), V3::load(token, y), V3::load(token, z)],
            shift: V3::load(token, &parameters.shift),
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
}

impl<P: Pack> Kernel<P> for CarryState<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let motion = Motion::<L>::load(token, self.parameters);
        let moves = L::splat(token, 0.0).lt(L::load(token, &self.parameters.moves));
        let inverse_step = L::splat(token, self.inverse_step);
        let particles = self.position.iter_mut().zip(self.velocity);
        for ((position, velocity), &inverse_area) in particles.zip(self.fabric.inverse_areas()) {
            let x: V3<L> = V3::load(token, position);
            // A lane at rest keeps its bits, whatever its neighbours do.
            let change = motion.moved(x);
            let carried = (x + change).or_where_not(moves, x);
            if inverse_area == 0.0 {
                ((x - carried) * inverse_step).store(velocity);
            } else {
                carried.store(position);
                let v: V3<L> = V3::load(token, velocity);
                (v + motion.turned(v)).or_where_not(moves, v).store(velocity);
            }
        }
    }
}

struct Predict<'a, P: Pack> {
    fabric: &'a Fabric,
    parameters: &'a Parameters<P>,
    step: f32,
    position: &'a mut [Pack3<P>],
    predicted: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    air_impulse: &'a [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Predict<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let step = L::splat(token, self.step);
        let gravity: V3<L> = V3::load(token, &self.parameters.gravity_step);
        let keep = L::load(token, &self.parameters.keep);
        let motion = Motion::<L>::load(token, self.parameters);
        let moves = L::splat(token, 0.0).lt(L::load(token, &self.parameters.moves));
        let any_moves = moves.any();
        let minus_rate = L::splat(token, -1.0 / self.step);
        let zero = V3::splat(token, 0.0);
        let particles = self.position.iter_mut().zip(self.predicted).zip(self.velocity);
        for (((position, predicted), velocity), (impulse, &inverse_area)) in
            particles.zip(self.air_impulse.iter().zip(self.fabric.inverse_areas()))
        {
            if inverse_area == 0.0 {
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let air: V3<L> = V3::load(token, impulse);
            let mut v: V3<L> = V3::load(token, velocity);
            v = v + gravity + air * L::splat(token, inverse_area);
            // Damping acts on the motion relative to the frame, whose point at x has this velocity.
            if any_moves {
                let frame = (motion.moved(x) * minus_rate).or_where_not(moves, zero);
                v = (frame + (v - frame) * keep).or_where_not(moves, v * keep);
            } else {
                v = v * keep;
            }
            v.store(velocity);
            let x = x + v * step;
            x.store(predicted);
            x.store(position);
        }
    }
}
