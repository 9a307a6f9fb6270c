//! What the player does, and when the game hears of it.

use avian3d::prelude::{Forces, WriteRigidBodyForces};
use bevy::prelude::*;

use crate::scenes::rollback::past::Tick;
use crate::scenes::rollback::yard::Cart;

/// The last tick whose input is known beforehand. By then all cloth has a state: what is still being made is not in a snapshot,
/// and would not go back.
const START: u32 = 10;

/// Greatest force that drives the cart, N, and greatest torque that turns it, N·m.
const THRUST: f32 = 1_600.0;
const TURN: f32 = 60.0;

/// What the player does in a tick, each between −1 and 1.
#[derive(Clone, Copy, Debug)]
struct Input {
    throttle: f32,
    steer: f32,
}

impl Input {
    /// The player drives into the crates and then back, and holds the stick still in no two ticks: each guess is wrong.
    fn of_player(tick: u32) -> Self {
        let tick = tick as f32;
        Self { throttle: (0.03 * tick).cos(), steer: (0.1 * tick).sin() }
    }
}

/// The inputs that have arrived.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Inputs {
    /// Ticks after which the input of a tick arrives.
    delay: u32,
    /// The last tick whose input has arrived.
    last: u32,
}

impl Inputs {
    /// The input of each tick after the first ones arrives `delay` ticks late.
    pub fn late(delay: u32) -> Self {
        Self { delay, last: START }
    }

    /// Receives what has arrived before a tick. Returns the tick whose input that is; none if nothing new has.
    pub fn receive(&mut self, now: u32) -> Option<u32> {
        let last = now.saturating_sub(self.delay);
        (last > self.last).then(|| {
            self.last = last;
            last
        })
    }

    /// The input of a tick. The player is supposed to go on with what arrived last.
    fn at(&self, tick: u32) -> Input {
        Input::of_player(tick.min(self.last))
    }
}

/// Drives the cart.
pub fn drive(
    inputs: Res<Inputs>,
    tick: Res<Tick>,
    mut carts: Query<(&Transform, Forces), With<Cart>>,
) {
    let Input { throttle, steer } = inputs.at(tick.0);
    for (pose, mut cart) in &mut carts {
        cart.apply_force(THRUST * throttle * pose.forward());
        cart.apply_torque(TURN * steer * Vec3::Y);
    }
}
