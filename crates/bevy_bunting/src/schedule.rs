//! The schedules and sets of a tick.

use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::intern::Interned;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor};
use bevy_time::Time;

/// One tick of all cloths. Runs once a fixed step, in `FixedPostUpdate` or the schedule given to
/// [`ClothPlugins::new`](crate::ClothPlugins::new).
///
/// Its systems run on one thread and in an order that may not be ambiguous: order yours against
/// the [`ClothSystems`], or within the set that they are in.
#[derive(ScheduleLabel, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ClothTick;

/// One substep of the cloths that join in it. Runs in [`ClothSystems::Step`], as often as the
/// finest level needs.
///
/// As long as no user adds a system, the schedule is not run: the same phases run batch by batch, with the
/// same result, so that each batch stays in the processor's cache from one phase to the next.
#[derive(ScheduleLabel, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ClothSubstep;

/// The sets of a [`ClothTick`], in this order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClothSystems {
    /// New, changed and removed cloths: fabrics are cut, wind is added up.
    Prepare,
    /// Levels of detail are chosen, states are transferred between them, and every simulated cloth gets a
    /// lane.
    SelectLod,
    /// What acts on each cloth in this tick is set: the motion of its frame, gravity, wind, colliders.
    Drive,
    /// Runs [`ClothSubstep`].
    Step,
    /// Normals are recomputed, once.
    Normals,
    /// [`ClothState`](crate::ClothState) and the transforms of attached cloths are written.
    Publish,
}

impl ClothSystems {
    /// All sets in the order in which they run.
    pub const ORDER: [Self; 6] =
        [Self::Prepare, Self::SelectLod, Self::Drive, Self::Step, Self::Normals, Self::Publish];
}

/// The sets of a [`ClothSubstep`], in this order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClothSubstepSystems {
    /// States are transformed into the moved frame; external forces, damping, predicted positions.
    Integrate,
    /// For forces of the user, see [`ClothParticles`](crate::ClothParticles).
    UserForces,
    /// Constraints and contacts correct the predicted positions.
    SolveConstraints,
    /// For constraints of the user, which correct positions after all others, see
    /// [`ClothParticles`](crate::ClothParticles).
    UserConstraints,
    /// Velocities from the corrected positions.
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

/// Makes the schedules and their sets, and runs [`ClothTick`].
#[derive(Debug)]
pub struct SchedulePlugin {
    host: Interned<dyn ScheduleLabel>,
}

impl SchedulePlugin {
    /// Ticks in the given schedule.
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
            .add_systems(self.host, run_cloth_tick);
    }
}

/// Sets the executor and the checks of a schedule of this plugin; those of the host's schedules are left
/// alone.
fn own(schedule: &mut Schedule) -> &mut Schedule {
    schedule.set_executor(SingleThreadedExecutor::new()).set_build_settings(ScheduleBuildSettings {
        ambiguity_detection: LogLevel::Error,
        ..Default::default()
    })
}

/// Runs [`ClothTick`], unless no time has passed. Public, so that other systems of its schedule can
/// be ordered against it.
pub fn run_cloth_tick(world: &mut World) {
    if !world.resource::<Time>().delta().is_zero() {
        world.run_schedule(ClothTick);
    }
}
