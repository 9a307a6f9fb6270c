//! A cart with a flag that a player drives from afar: its inputs arrive eight ticks late. In each tick the game goes back
//! to the tick whose input has just arrived, and simulates again from there.
//!
//! The ticks of a game are those of Bevy's fixed loop. `past.rs` keeps what a tick reads of those before it, of cloth by the
//! plugin's snapshots and of rigid bodies in `bodies.rs`, and `rewind.rs` goes back.

mod bodies;
#[cfg(feature = "render")]
mod draw;
mod input;
mod past;
mod record;
mod rewind;
mod yard;

use crate::scenes::rollback::input::{Inputs, drive};
use crate::scenes::rollback::past::{Costs, Past, Tick, save};
use crate::scenes::rollback::record::RollbackRecord;
use crate::scenes::rollback::rewind::{Confirmed, rewind};
use crate::{Example, Record, View, headless};
use avian3d::prelude::PhysicsPlugins;
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting_avian::ClothAvianPlugin;

/// The view of the only viewer.
const VIEW: View = View { eye: Vec3::new(4.6, 2.6, -0.4), centre: Vec3::new(-0.2, 0.8, -5.2) };

/// A game that goes back as often as an input arrives.
#[derive(Clone, Copy, Debug)]
pub struct Rollback {
    /// Ticks after which the input of a tick arrives. With 0 the game never goes back.
    pub delay: u32,
}

impl Default for Rollback {
    fn default() -> Self {
        Self { delay: 8 }
    }
}

impl Example for Rollback {
    const NAME: &'static str = "Rollback";
    const SECONDS: f64 = 4.0;

    /// The game is simulated in ticks, in a window, too.
    fn build(&self, app: &mut App, _schedule: impl ScheduleLabel) {
        app.add_plugins((PhysicsPlugins::default(), ClothAvianPlugin::default()))
            .insert_resource(Inputs::late(self.delay))
            .insert_resource(Past::of(self.delay))
            .init_resource::<Tick>()
            .init_resource::<Costs>()
            .init_resource::<Confirmed>()
            .add_systems(FixedFirst, rewind)
            .add_systems(FixedUpdate, drive)
            .add_systems(FixedLast, save);
        let mut commands = app.world_mut().commands();
        commands.spawn((LodViewer::default(), VIEW.pose()));
        yard::spawn(&mut commands);
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        RollbackRecord::new(|app| headless::start(app, &Self { delay: 0 }))
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> crate::render::stage::Stage {
        crate::render::stage::Stage::SMALL
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        crate::render::control_orbit(app, VIEW);
    }
}
