//! The hand that draws the curtain.

use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::curtain::rail::{END, HEIGHT, RAIL, WIDTH};

/// Times at which the hand grabs, begins to draw and lets go, s: to open, and to shut.
const OPEN: [f32; 3] = [1.5, 2.0, 4.5];
const SHUT: [f32; 3] = [6.5, 7.0, 10.0];

/// Way of the hand along the rail, m.
const WAY: f32 = 1.4;

/// Height of the hand below the rail, m.
const BELOW: f32 = 0.35 * HEIGHT;

/// Radius within which the hand grabs, m.
const REACH: f32 = 0.12;

/// A hand, and the curtain that it draws.
#[derive(Component, Debug)]
pub struct Hand {
    curtain: Entity,
}

/// Spawns the hand.
pub fn spawn(commands: &mut Commands, curtain: Entity) {
    let at = END + Vec3::new(RAIL, -BELOW, 0.3);
    commands.spawn((Hand { curtain }, Transform::from_translation(at)));
}

/// Moves the hand, which grabs and lets go.
pub fn work(
    mut hands: Query<(Entity, &Hand, &mut Transform, Has<ClothGrab>)>,
    cloths: Query<(&ClothState, &GlobalTransform)>,
    time: Res<Time>,
    mut commands: Commands,
) {
    let now = time.elapsed_secs();
    for (entity, hand, mut transform, grabs) in &mut hands {
        let Ok((state, frame)) = cloths.get(hand.curtain) else { continue };
        let holds = [OPEN, SHUT].iter().any(|[from, _, to]| (*from..*to).contains(&now));
        if holds && !grabs {
            // It reaches for the free edge, where that is now.
            let Some(edge) = edge(state, frame) else { continue };
            transform.translation = edge;
            let grab = ClothGrab::within(hand.curtain, REACH).with_strength(150.0, 20.0);
            commands.entity(entity).insert(grab);
        } else if !holds && grabs {
            commands.entity(entity).remove::<ClothGrab>();
        } else if holds {
            let step = along(now) - along(now - time.delta_secs());
            transform.translation.x += step;
        }
    }
}

/// Place of the hand along the rail at a time (s), m.
fn along(now: f32) -> f32 {
    let part = |[_, from, to]: [f32; 3]| {
        let part = ((now - from) / (to - from)).clamp(0.0, 1.0);
        part * part * (3.0 - 2.0 * part)
    };
    WAY * (part(SHUT) - part(OPEN))
}

/// The point of the free edge at the height of the hand, in the world, m.
fn edge(state: &ClothState, frame: &GlobalTransform) -> Option<Vec3> {
    let fabric = state.fabric()?;
    let wanted = Vec3::new(WIDTH, -BELOW, 0.0);
    let rest = fabric.rest_positions().iter().zip(state.positions());
    let nearest = rest.min_by(|(one, _), (other, _)| {
        one.distance_squared(wanted).total_cmp(&other.distance_squared(wanted))
    });
    nearest.map(|(_, at)| frame.transform_point(*at))
}
