//! A figure that walks, runs and sits in clothes that it puts on and takes off.

mod body;
mod cut;
#[cfg(feature = "render")]
mod draw;
mod garment;
mod layers;
mod measure;
mod patterns;
mod record;
mod room;
mod scarf;
mod story;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{CostTable, LodCosts};

use crate::figure::follow::follow;
use crate::figure::walker::Walker;
use crate::figure::way::go;
use crate::figure::{pose, skeleton};
#[cfg(feature = "render")]
use crate::render::stage;
use crate::scenes::wardrobe::record::WardrobeRecord;
use crate::scenes::wardrobe::story::{Joints, dress};
use crate::{Example, Record};

/// Position of the viewer seen from the figure's feet, m.
const EYE: Vec3 = Vec3::new(2.9, 1.3, -0.9);

/// The point at which the viewer looks, seen from the figure's feet, m.
const CENTRE: Vec3 = Vec3::new(0.0, 0.9, 0.0);

/// Arms are held off the clothes, rad.
const SPREAD: f32 = 0.18;

/// Thighs are lifted so much higher in a run than a jogger's that they come to 80°, rad.
const LIFT: f32 = 0.37;

/// Greatest number of substeps in a tick. Legs that run would have 32, of which nothing is seen; with six they come through
/// the skirt.
const MOST_SUBSTEPS: u32 = 8;

/// A figure that changes its clothes.
#[derive(Clone, Copy, Debug)]
pub struct Wardrobe;

impl Example for Wardrobe {
    const NAME: &'static str = "Wardrobe";
    const SECONDS: f64 = story::SECONDS;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        let steps = vec![StepLimits { substeps: 1..=MOST_SUBSTEPS, ..StepLimits::default() }];
        app.insert_resource(ClothSettings { steps, ..ClothSettings::default() });
        // With measured costs, the ticks in which new clothes begin depend on the machine's load.
        let costs = LodCosts::Fixed(CostTable::default());
        app.insert_resource(ClothBudget { costs, ..ClothBudget::default() });
        app.insert_resource(story::WAY);
        app.add_systems(schedule, (go, pose::bend, dress, follow(EYE)).chain());
        let view = Transform::from_translation(EYE).looking_at(CENTRE, Vec3::Y);
        app.world_mut().spawn((LodViewer::default(), view));
        let mut commands = app.world_mut().commands();
        let walker = Walker { spread: SPREAD, lift: LIFT, ..default() };
        let joints = skeleton::spawn(&mut commands, walker);
        body::spawn(&mut commands, &joints);
        room::spawn(&mut commands);
        commands.insert_resource(Joints(joints));
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        WardrobeRecord::new()
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> stage::Stage {
        stage::Stage { field_of_view: 0.66, ..stage::Stage::SMALL }
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        app.add_plugins(crate::render::keys::gizmos);
    }
}
