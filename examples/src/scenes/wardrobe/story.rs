//! What the figure does and wears, and when.

use std::f32::consts::PI;

use bevy::prelude::*;

use crate::figure::walker::{RUN, WALK};
use crate::figure::way::Way;
use crate::scenes::wardrobe::garment::Garment;

/// It walks, runs, stops, turns, sits down and rises.
pub const WAY: Way = Way {
    speed: &[[0.3, 0.7, WALK], [3.2, 0.9, RUN - WALK], [5.6, 0.8, -RUN]],
    turns: &[[6.5, 0.8, PI]],
    sits: &[[7.4, 0.9, 1.0], [8.9, 0.9, -1.0]],
};

/// Simulated time, s.
pub const SECONDS: f64 = 10.4;

/// What happens to a piece of clothing.
#[derive(Clone, Copy, Debug)]
enum Change {
    PutOn,
    TakeOff,
    Drop,
}

use Change::{Drop, PutOn, TakeOff};
use Garment::{Cape, Jacket, Scarf, Shirt, Skirt};

/// Changes of the clothes with their times, s.
const CHANGES: [(f32, Change, Garment); 8] = [
    (0.0, PutOn, Skirt),
    (0.0, PutOn, Shirt),
    (0.0, PutOn, Cape),
    (2.2, Drop, Cape),
    (2.4, PutOn, Jacket),
    (2.8, PutOn, Scarf),
    (9.9, TakeOff, Scarf),
    (10.1, TakeOff, Jacket),
];

/// The joints of the figure, in their order.
#[derive(Resource)]
pub struct Joints(pub Vec<Entity>);

/// Changes the clothes when it is time.
pub fn dress(
    clothes: Query<(Entity, &Garment)>,
    joints: Res<Joints>,
    time: Res<Time>,
    mut done: Local<usize>,
    mut commands: Commands,
) {
    while let Some(&(at, change, garment)) = CHANGES.get(*done)
        && at <= time.elapsed_secs()
    {
        *done += 1;
        let worn = clothes.iter().find(|(_, worn)| **worn == garment);
        match (change, worn) {
            (PutOn, _) => garment.put_on(&mut commands, &joints.0),
            (TakeOff, Some((cloth, _))) => commands.entity(cloth).despawn(),
            (Drop, Some((cloth, _))) => Garment::drop(&mut commands, cloth),
            _ => {}
        }
    }
}
