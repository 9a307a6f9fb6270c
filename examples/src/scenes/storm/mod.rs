//! A field of flags in a storm: gusts that travel, blasts, and a truck whose wake drags flags along.

#[cfg(feature = "render")]
mod draw;
mod field;
mod weather;

use crate::limits::Limit;
use crate::strain::greatest_mean;
use crate::{OrbitExample, View};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::TickWind;

use crate::scenes::storm::weather::WIND;

/// Greatest mean strain of a flag: that of flags in blasts. Wrong forces stretch them further.
const STRAIN_LIMIT: f32 = 0.03;

/// Greatest part of the gusts that is the same all over the field, of their root mean square. A wind without places has 1.
const UNISON_LIMIT: f32 = 0.5;

/// A field of flags in a storm.
#[derive(Clone, Copy, Debug)]
pub struct Storm;

impl OrbitExample for Storm {
    const NAME: &'static str = "Storm";
    const SECONDS: f64 = 16.0;
    const VIEW: View = View { eye: Vec3::new(14.0, 5.5, 24.0), centre: Vec3::new(5.0, 1.0, 4.0) };

    #[cfg(feature = "render")]
    const STAGE: crate::render::stage::Stage = draw::STAGE;

    fn build(app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, (weather::drive, weather::detonate));
        let mut commands = app.world_mut().commands();
        field::spawn(&mut commands);
        weather::spawn(&mut commands);
    }

    /// Strain of the flags, and the part of the gusts that all flags feel at once.
    fn measure(world: &mut World) -> Vec<Limit> {
        let strain = greatest_mean(world);
        vec![
            Limit { name: "mean strain of a flag", value: strain, limit: STRAIN_LIMIT },
            Limit { name: "gusts in unison, of one", value: unison(world), limit: UNISON_LIMIT },
        ]
    }

    #[cfg(feature = "render")]
    fn draw(app: &mut App) {
        app.add_plugins(draw::plugin);
    }
}

/// Length of the mean over the field of the air's deviation from the mean wind, in units of its root mean square.
fn unison(world: &World) -> f32 {
    let wind = world.resource::<TickWind>();
    // Before the first tick there is no wind.
    if *wind == TickWind::default() {
        return 0.0;
    }
    let (mut sum, mut squares, mut count) = (Vec3::ZERO, 0.0, 0.0);
    for place in field::places() {
        let gust = wind.at(place) - WIND.velocity;
        sum += gust;
        squares += gust.length_squared();
        count += 1.0;
    }
    (sum / count).length() / (squares / count).sqrt()
}
