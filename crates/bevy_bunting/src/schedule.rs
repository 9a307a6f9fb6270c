//! The schedules and sets of a tick.

use bevy_app::{App, FixedPostUpdate, Plugin, PreStartup};
use bevy_ecs::intern::Interned;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor};
use bevy_time::{Fixed, Real, Time, Virtual};

/// The schedule of one tick of all cloths. It runs once in each fixed step, in `FixedPostUpdate` or the
/// schedule given to [`ClothPlugins::new`](crate::ClothPlugins::new).
///
/// Systems in this schedule run on one thread, and ambiguous orders are errors: order your systems against
/// the [`ClothSystems`], or against other systems within their set.
#[derive(ScheduleLabel, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ClothTick;

/// The schedule of one substep. It runs in [`ClothSystems::Step`], as often as the finest level needs;
/// coarser levels take part in some of the runs.
///
/// Without a user's system in it the schedule is not run: its phases are called directly, batch by batch and
/// with the same result, so that each batch stays in the processor's cache.
#[derive(ScheduleLabel, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ClothSubstep;

/// The sets of a [`ClothTick`], in this order.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_math::Vec3;
///
/// /// Calms the wind before it acts on cloth.
/// fn calm(mut winds: Query<&mut WindField>) {
///     winds.iter_mut().for_each(|mut wind| wind.velocity = Vec3::ZERO);
/// }
///
/// let mut app = App::new();
/// app.add_plugins((bevy_time::TimePlugin, bevy_transform::TransformPlugin, ClothPlugins::default()))
///     .add_systems(ClothTick, calm.before(ClothSystems::Prepare));
/// app.update();
/// ```
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClothSystems {
    /// Looks up or builds the fabrics of new and changed cloths, frees the lanes of removed ones, and sums up
    /// the wind.
    Prepare,
    /// Chooses levels of detail, transfers states between levels, and gives every simulated cloth a lane.
    SelectLod,
    /// Sets the frame motion, gravity, wind and colliders that act on each cloth in this tick.
    Drive,
    /// Runs [`ClothSubstep`].
    Step,
    /// Computes normals, once a tick.
    Normals,
    /// Writes [`ClothState`](crate::ClothState) and the transforms of attached cloths.
    Publish,
}

impl ClothSystems {
    /// All sets in the order in which they run.
    pub const ORDER: [Self; 6] =
        [Self::Prepare, Self::SelectLod, Self::Drive, Self::Step, Self::Normals, Self::Publish];
}

/// The sets of a [`ClothSubstep`], in this order. [`ClothParticles`](crate::ClothParticles) has an example of a user's force.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClothSubstepSystems {
    /// Transforms states into the moved frame, applies external forces and damping, and predicts positions.
    Integrate,
    /// Applies forces of the user, see [`ClothParticles`](crate::ClothParticles).
    UserForces,
    /// Corrects the predicted positions by constraints and contacts.
    SolveConstraints,
    /// Applies constraints of the user, which correct positions last, see
    /// [`ClothParticles`](crate::ClothParticles).
    UserConstraints,
    /// Computes velocities from the corrected positions.
    UpdateVelocities,
}

impl ClothSubstepSystems {
    /// All sets in the order in which they run.
    pub const ORDER: [Self; 5] = [
        Self::Integrate,
        Self::UserForces,
        Self::SolveConstraints,
        Self::UserConstraints,
        Self::UpdateVelocities,
    ];
}

/// Adds the schedules with their sets, and runs [`ClothTick`].
#[derive(Debug)]
pub struct SchedulePlugin {
    host: Interned<dyn ScheduleLabel>,
}

impl SchedulePlugin {
    /// A plugin that runs [`ClothTick`] in the given schedule.
    #[must_use]
    pub fn new(host: impl ScheduleLabel) -> Self {
        Self { host: host.intern() }
    }
}

impl Default for SchedulePlugin {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl Plugin for SchedulePlugin {
    fn build(&self, app: &mut App) {
        let [prepare, select, drive, step, normals, publish] = ClothSystems::ORDER;
        app.init_schedule(ClothTick)
            .init_schedule(ClothSubstep)
            .edit_schedule(ClothTick, |schedule| {
                own(schedule)
                    .configure_sets((prepare, select, drive, step, normals, publish).chain());
            })
            .edit_schedule(ClothSubstep, |schedule| {
                let [integrate, forces, solve, constraints, update] = ClothSubstepSystems::ORDER;
                own(schedule)
                    .configure_sets((integrate, forces, solve, constraints, update).chain());
            })
            .add_systems(PreStartup, tell_missing_clock)
            .add_systems(self.host, run_cloth_tick);
    }
}

/// Sets the executor and the ambiguity check of one of this plugin's schedules. The host's schedules keep
/// theirs.
fn own(schedule: &mut Schedule) -> &mut Schedule {
    schedule.set_executor(SingleThreadedExecutor::new()).set_build_settings(ScheduleBuildSettings {
        ambiguity_detection: LogLevel::Error,
        ..Default::default()
    })
}

/// Gives an app without a clock one that stands still, and says what is missing: systems that want a clock would stop the app
/// with a message that does not.
fn tell_missing_clock(world: &mut World) {
    if world.contains_resource::<Time<Virtual>>() && world.contains_resource::<Time>() {
        return;
    }
    log::error!(
        "cloth stands still: this app has no clock; add Bevy's TimePlugin, which DefaultPlugins and MinimalPlugins contain, beside ClothPlugins"
    );
    world.init_resource::<Time>();
    world.init_resource::<Time<Real>>();
    world.init_resource::<Time<Virtual>>();
    world.init_resource::<Time<Fixed>>();
}

/// Runs [`ClothTick`] unless no time has passed. This system is public so that other systems of its schedule
/// can be ordered against it.
pub fn run_cloth_tick(world: &mut World) {
    if !world.resource::<Time>().delta().is_zero() {
        world.run_schedule(ClothTick);
    }
}
