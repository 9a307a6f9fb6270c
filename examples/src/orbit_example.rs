//! Examples of one place, around which the viewer's camera can be turned.

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::limits::{Limit, LimitRecord};
#[cfg(feature = "render")]
use crate::render::{control_orbit, stage::Stage};
use crate::{Example, Record, View};

/// An [`Example`] of one place, with values that must stay within limits. In a window the mouse turns the camera
/// around the view's centre.
pub trait OrbitExample {
    /// [`Example::NAME`].
    const NAME: &'static str;

    /// [`Example::SECONDS`].
    const SECONDS: f64;

    /// The view of the only viewer.
    const VIEW: View;

    /// Sky, ground and light.
    #[cfg(feature = "render")]
    const STAGE: Stage = Stage::SMALL;

    /// Spawns everything but the viewer, and adds the systems that move it to `schedule`.
    fn build(app: &mut App, schedule: impl ScheduleLabel);

    /// The values after a tick.
    fn measure(world: &mut World) -> Vec<Limit>;

    /// Adds the plugins that give meshes and materials to the entities of [`build`](Self::build).
    #[cfg(feature = "render")]
    fn draw(app: &mut App);
}

impl<E: OrbitExample> Example for E {
    const NAME: &'static str = E::NAME;
    const SECONDS: f64 = E::SECONDS;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.world_mut().spawn((LodViewer::default(), E::VIEW.pose()));
        E::build(app, schedule);
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        LimitRecord::new(E::measure)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> Stage {
        E::STAGE
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        E::draw(app);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        control_orbit(app, E::VIEW);
    }
}
