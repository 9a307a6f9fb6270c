//! Cloth that is first seen as it hangs, not as it was cut.

use std::sync::Arc;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_tasks::{AsyncComputeTaskPool, Task, futures::check_ready};
use bevy_time::Time;
use bevy_transform::helper::TransformHelper;
use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, FrameMotion, LaneCount, StepSettings,
};

use crate::batch::assign::assign_lanes;
use crate::cloth::instance::{ClothInstance, StateStorage};
use crate::cloth::state::ClothState;
use crate::environment::wind::TickWind;
use crate::lod::select::select_levels;
use crate::motion::attachment::Attachment;
use crate::motion::frame::frame_of;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// Longest time that is simulated in advance, s: 0.2 s of computing for a flag of 33 × 33.
const LONGEST: f32 = 60.0;

/// Simulates a cloth for so many seconds before it is first seen: in the wind that blows where it is spawned, on a
/// frame at rest, without colliders. That is done beside the main thread where there are threads; the cloth has no
/// [`ClothState`] until it is done, and then loses this component.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothPreroll {
    /// Simulated time, s; at most 60.
    pub seconds: f32,
}

impl ClothPreroll {
    /// So many seconds.
    #[must_use]
    pub const fn seconds(seconds: f32) -> Self {
        Self { seconds }
    }
}

impl Default for ClothPreroll {
    /// Three seconds: a flag has then unfolded.
    fn default() -> Self {
        Self::seconds(3.0)
    }
}

/// Simulates cloths before they are seen.
#[derive(Debug, Default)]
pub struct PrerollPlugin;

impl Plugin for PrerollPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothPreroll>().add_systems(
            ClothTick,
            (begin_prerolls, end_prerolls)
                .chain()
                .in_set(ClothSystems::SelectLod)
                .after(select_levels)
                .before(assign_lanes),
        );
    }
}

/// A cloth that is simulated in advance, at a level.
#[derive(Component, Debug)]
struct Rolling {
    level: usize,
    task: RollingTask,
}

#[derive(Debug)]
enum RollingTask {
    Running(Task<ClothSnapshot>),
    Done(ClothSnapshot),
}

/// What is simulated in advance.
struct Preroll {
    fabric: Arc<Fabric>,
    state: ClothSnapshot,
    material: FabricMaterial,
    drive: Drive,
    settings: StepSettings,
    /// s.
    tick: f32,
    ticks: u32,
}

impl Preroll {
    /// The state at the end; that at the start where it does not stay finite.
    fn run(self) -> ClothSnapshot {
        let mut batch = ClothBatch::new(self.fabric, LaneCount::One);
        let Ok(lane) = batch.insert(&self.state, self.material) else { return self.state };
        batch.drive(lane, self.drive);
        for _ in 0..self.ticks {
            batch.step(self.tick, self.settings);
        }
        let state = batch.snapshot(lane);
        if state.is_finite() { state } else { self.state }
    }
}

type New<'a> =
    (Entity, &'a ClothPreroll, &'a mut ClothInstance, &'a mut ClothState, Option<&'a Attachment>);

fn begin_prerolls(
    mut cloths: Query<New, Without<Rolling>>,
    transforms: TransformHelper,
    settings: Res<ClothSettings>,
    wind: Res<TickWind>,
    time: Res<Time>,
    mut commands: Commands,
) {
    let tick = time.delta_secs();
    for (entity, preroll, mut instance, mut state, attachment) in &mut cloths {
        // What has been simulated already is too late.
        if !instance.unmoved {
            if instance.lane().is_some() {
                commands.entity(entity).remove::<ClothPreroll>();
            }
            continue;
        }
        let Some(fabric) = instance.fabric().cloned() else { continue };
        let StateStorage::Snapshot(snapshot) = core::mem::take(&mut instance.storage) else {
            continue;
        };
        instance.unmoved = false;
        *state = ClothState::default();
        let frame = frame_of(entity, attachment, &transforms).unwrap_or_default();
        let inverse = frame.rotation.inverse();
        let seconds = if preroll.seconds.is_finite() { preroll.seconds } else { 0.0 };
        let limits = settings.limits(instance.level);
        let preroll = Preroll {
            settings: limits.of_fabric(&fabric, tick, settings.gravity.length()),
            fabric,
            state: snapshot,
            material: instance.material,
            drive: Drive {
                motion: FrameMotion::NONE,
                gravity: inverse * settings.gravity,
                wind: inverse * wind.at(frame * instance.rest_middle()),
                air_density: settings.air_density,
            },
            tick,
            ticks: (seconds.clamp(0.0, LONGEST) / tick) as u32,
        };
        let task = match AsyncComputeTaskPool::try_get() {
            Some(pool) => RollingTask::Running(pool.spawn(async move { preroll.run() })),
            None => RollingTask::Done(preroll.run()),
        };
        commands.entity(entity).insert(Rolling { level: instance.level, task });
    }
}

fn end_prerolls(
    mut cloths: Query<(Entity, &mut Rolling, &mut ClothInstance, &mut ClothState)>,
    mut commands: Commands,
) {
    for (entity, mut rolling, mut instance, mut state) in &mut cloths {
        let snapshot = match &mut rolling.task {
            RollingTask::Running(task) => check_ready(task),
            RollingTask::Done(snapshot) => Some(core::mem::take(snapshot)),
        };
        let Some(snapshot) = snapshot else { continue };
        commands.entity(entity).remove::<(Rolling, ClothPreroll)>();
        // A cloth that was cut anew in the meantime begins as any other.
        let Some(levels) = instance.levels.clone() else { continue };
        let fits = levels.fabric(rolling.level).particle_count() == snapshot.positions.len();
        if !fits || !matches!(instance.storage, StateStorage::None) {
            continue;
        }
        instance.level = rolling.level;
        state.restart(rolling.level, &levels, &snapshot.positions);
        instance.storage = StateStorage::Snapshot(snapshot);
    }
}
