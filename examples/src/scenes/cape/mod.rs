//! A figure that stands, walks, turns and runs in a cape.
//!
//! Where it is drawn, the figure is that of a glTF file, played by Bevy's animation. Without assets it is the same
//! figure, made here.

mod body;
#[cfg(feature = "render")]
mod file;
mod measure;
mod way;

use crate::figure::follow::follow;
use crate::figure::walker::Walker;
use crate::figure::way::go;
use crate::figure::{cloak, pose, skeleton};
use crate::limits::{Limit, LimitRecord};
#[cfg(feature = "render")]
use crate::render::{print, stage};
use crate::strain::greatest_mean;
use crate::{Example, Record};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Position of the viewer seen from the figure's feet, m.
const EYE: Vec3 = Vec3::new(2.6, 1.5, 2.9);

/// The point at which the viewer looks, seen from the figure's feet, m.
const CENTRE: Vec3 = Vec3::new(0.0, 0.9, 0.25);

/// Particles along each edge of the cape: 625 in all.
const COUNT: u32 = 25;

/// Limit of the mean strain of the cape: larger strain would be visible.
const STRAIN_LIMIT: f32 = 0.03;

/// Limit of a particle's depth in the body, m: where an arm squeezes the cape against the side.
const DEPTH_LIMIT: f32 = 0.015;

/// Limit of the distance of the collar from its pose, m: rounding.
const COLLAR_LIMIT: f32 = 1e-4;

/// A figure in a cape.
#[derive(Clone, Copy, Debug)]
pub struct Cape;

impl Example for Cape {
    const NAME: &'static str = "Cape";
    const SECONDS: f64 = 14.0;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.insert_resource(way::WAY);
        app.add_systems(schedule, (go, pose::bend, follow(EYE)).chain());
        let view = Transform::from_translation(EYE).looking_at(CENTRE, Vec3::Y);
        app.world_mut().spawn((LodViewer::default(), view));
        #[cfg(feature = "render")]
        if app.world().contains_resource::<AssetServer>() {
            app.add_plugins(file::plugin);
            return;
        }
        let mut commands = app.world_mut().commands();
        let joints = skeleton::spawn(&mut commands, Walker::default());
        body::spawn(&mut commands, &joints);
        cloak::spawn(&mut commands, &joints, COUNT);
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        LimitRecord::new(measure)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> stage::Stage {
        stage::Stage { field_of_view: 0.62, ..stage::Stage::SMALL }
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(print::plugin(stage::cloth()));
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        app.add_plugins(crate::render::keys::gizmos);
    }
}

/// Strain of the cape, distance of its collar from the pose, and depth in the body.
fn measure(world: &mut World) -> Vec<Limit> {
    let strain = greatest_mean(world);
    let off = measure::off(world);
    let depth = measure::depth(world);
    vec![
        Limit { name: "mean strain of the cape", value: strain, limit: STRAIN_LIMIT },
        Limit { name: "distance of the collar from the pose, m", value: off, limit: COLLAR_LIMIT },
        Limit { name: "depth of the cape in the body, m", value: depth, limit: DEPTH_LIMIT },
    ]
}
