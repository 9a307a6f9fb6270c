//! A plaza of flags and banners, seen from a flying camera.

#[cfg(feature = "render")]
mod draw;
mod flight;
mod plaza;
mod record;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::scenes::crowd::record::CrowdRecord;
use crate::{Example, Record};

/// A crowd of flags.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// Number of flags and banners.
    pub cloths: usize,
    /// Budget of all cloth.
    pub budget: ClothBudget,
    /// Whether cloth is coloured by level of detail.
    #[cfg(feature = "render")]
    pub levels: bool,
}

impl Example for Crowd {
    const NAME: &'static str = "Crowd";
    const SECONDS: f64 = flight::ROUND;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, flight::fly);
        app.insert_resource(self.budget.clone());
        plaza::spawn(&mut app.world_mut().commands(), self.cloths);
    }

    fn record(&self, ticks_per_second: usize) -> impl Record {
        CrowdRecord::new(ticks_per_second, self.budget.tick)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> crate::render::stage::Stage {
        draw::STAGE
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin(self.levels));
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        app.add_plugins(draw::control);
    }
}
