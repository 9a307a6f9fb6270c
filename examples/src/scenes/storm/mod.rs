//! A field of flags in a storm: gusts that travel, blasts, and a truck whose wake drags flags along.

#[cfg(feature = "render")]
mod draw;
mod field;
mod weather;

use crate::limits::{Limit, LimitRecord, greatest};
use crate::strain::Strain;
use crate::{Example, Record};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::TickWind;
use bevy_bunting::prelude::*;
use bunting_solver::LinkFamily;

use crate::scenes::storm::weather::WIND;

/// Position of the viewer, m.
const EYE: Vec3 = Vec3::new(14.0, 5.5, 24.0);

/// The point at which the viewer looks, m.
const CENTRE: Vec3 = Vec3::new(5.0, 1.0, 4.0);

/// Greatest mean strain of a flag: that of flags in blasts. Wrong forces stretch them further.
const STRAIN_LIMIT: f32 = 0.03;

/// Greatest part of the gusts that is the same all over the field, of their root mean square. A wind without places has 1.
const UNISON_LIMIT: f32 = 0.5;

/// A field of flags in a storm.
#[derive(Clone, Copy, Debug)]
pub struct Storm;

impl Example for Storm {
    const NAME: &'static str = "Storm";
    const SECONDS: f64 = 16.0;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, (weather::drive, weather::detonate));
        let mut commands = app.world_mut().commands();
        let view = Transform::from_translation(EYE).looking_at(CENTRE, Vec3::Y);
        commands.spawn((LodViewer::default(), view));
        field::spawn(&mut commands);
        weather::spawn(&mut commands);
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        LimitRecord::new(measure)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> crate::render::stage::Stage {
        draw::STAGE
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        crate::render::control_orbit(app, EYE, CENTRE);
    }
}

/// Strain of the flags, and the part of the gusts that all flags feel at once.
fn measure(world: &mut World) -> Vec<Limit> {
    let mut strain = 0.0;
    for state in world.query::<&ClothState>().iter(world) {
        let mut flag = Strain::default();
        flag.add(state, LinkFamily::Warp);
        flag.add(state, LinkFamily::Weft);
        strain = greatest([strain, flag.mean() as f32]);
    }
    vec![
        Limit { name: "mean strain of a flag", value: strain, limit: STRAIN_LIMIT },
        Limit { name: "gusts in unison, of one", value: unison(world), limit: UNISON_LIMIT },
    ]
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
