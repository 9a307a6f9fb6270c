//! A curtain whose rings slide on a rail, drawn aside and back by a hand.

#[cfg(feature = "render")]
mod draw;
mod hand;
mod rail;

use crate::limits::{Limit, greatest};
use crate::strain::greatest_mean;
use crate::{OrbitExample, View};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Limit of the mean strain: larger strain would be visible.
const STRAIN_LIMIT: f32 = 0.01;

/// Limit of a ring's distance from the rail, m: a tenth of the ring.
const RING_LIMIT: f32 = 3e-3;

/// A curtain on a rail.
#[derive(Clone, Copy, Debug)]
pub struct Curtain;

impl OrbitExample for Curtain {
    const NAME: &'static str = "Curtain";
    const SECONDS: f64 = 12.0;
    const VIEW: View = View { eye: Vec3::new(0.5, 1.6, 3.7), centre: Vec3::new(-0.15, 1.1, 0.0) };

    fn build(app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, hand::work);
        let mut commands = app.world_mut().commands();
        let curtain = rail::spawn(&mut commands);
        hand::spawn(&mut commands, curtain);
    }

    /// Strain of the curtain, and distance of its rings from the rail.
    fn measure(world: &mut World) -> Vec<Limit> {
        let mut off = 0.0_f32;
        for state in world.query::<&ClothState>().iter(world) {
            if state.fabric().is_none() {
                continue;
            }
            for ring in rail::rings() {
                let at = state.positions()[ring as usize];
                off = greatest([off, at.yz().length()]);
            }
        }
        vec![
            Limit {
                name: "mean strain of the curtain",
                value: greatest_mean(world),
                limit: STRAIN_LIMIT,
            },
            Limit { name: "distance of the rings from the rail, m", value: off, limit: RING_LIMIT },
        ]
    }

    #[cfg(feature = "render")]
    fn draw(app: &mut App) {
        app.add_plugins(draw::plugin);
    }
}
