//! Goes back, and simulates again.

use std::hash::{DefaultHasher, Hash, Hasher};

use avian3d::prelude::{AngularVelocity, LinearVelocity, Position, Rotation};
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::rollback::input::Inputs;
use crate::scenes::rollback::past::{Tick, restore};

/// The last tick that was simulated with its own input and those of all ticks before it, and a hash of the state after it.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Confirmed {
    pub tick: u32,
    pub hash: u64,
}

/// Receives the input of an earlier tick, goes back to it, and simulates again up to the present tick.
pub fn rewind(world: &mut World) -> Result {
    let now = world.resource::<Tick>().0;
    let received = world.resource_mut::<Inputs>().receive(now);
    let Some(first) = received.filter(|&first| first < now) else { return Ok(()) };
    let clock = *world.resource::<Time>();
    restore(world, first)?;
    for tick in first..now {
        let mut time = Time::<()>::default();
        time.advance_to(clock.elapsed() - (now - tick + 1) * clock.delta());
        time.advance_by(clock.delta());
        world.insert_resource(time);
        world.run_schedule(FixedUpdate);
        world.run_schedule(FixedPostUpdate);
        world.run_schedule(FixedLast);
        if tick == first {
            let hash = hash(world);
            world.insert_resource(Confirmed { tick, hash });
        }
    }
    world.insert_resource(clock);
    Ok(())
}

/// A hash of the bits of all cloth and all bodies.
pub fn hash(world: &mut World) -> u64 {
    let mut hasher = DefaultHasher::new();
    let mut add =
        |values: &[f32]| values.iter().for_each(|value| value.to_bits().hash(&mut hasher));
    let mut cloths = world.query::<(Entity, &ClothState)>();
    for (_, cloth) in cloths.iter(world).sort::<Entity>() {
        cloth.positions().iter().for_each(|position| add(&position.to_array()));
    }
    let mut bodies =
        world.query::<(Entity, &Position, &Rotation, &LinearVelocity, &AngularVelocity)>();
    for (_, position, rotation, linear, angular) in bodies.iter(world).sort::<Entity>() {
        add(&position.to_array());
        add(&rotation.to_array());
        add(&linear.to_array());
        add(&angular.to_array());
    }
    hasher.finish()
}
