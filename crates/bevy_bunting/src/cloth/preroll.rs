//! Cloth that is first seen as it hangs, not as it was cut.

use std::sync::Arc;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_time::Time;
use bevy_transform::helper::TransformHelper;
use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, FrameMotion, LaneCount, StepSettings,
};

use crate::background::Background;
use crate::batch::assign::assign_lanes;
use crate::cloth::instance::{ClothInstance, StateStorage};
use crate::cloth::state::ClothState;
use crate::environment::wind::TickWind;
use crate::fabric::library::FabricLibrary;
use crate::lod::select::select_levels;
use crate::motion::attachment::Attachment;
use crate::motion::frame::frame_of;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// Longest time that is simulated in advance, s: 0.2 s of computing for a flag of 33 × 33.
const LONGEST: f32 = 60.0;

/// Steps of one particle through one substep that are expected to be done in a tick: half of what one thread does.
/// Larger: ticks wait for other threads. Smaller: cloths appear late without need.
const STEPS_PER_TICK: u64 = 1 << 18;

/// Simulates a cloth for so many seconds before it is first seen: in the wind that blows where it is spawned, on a
/// frame at rest, without colliders. That is done beside the main thread where there are threads; the cloth has no
/// [`ClothState`] until a tick that follows from the amount of work, and then loses this component.
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
        app.register_type::<ClothPreroll>().init_resource::<PrerollQueue>().add_systems(
            ClothTick,
            (begin_prerolls, end_prerolls)
                .chain()
                .in_set(ClothSystems::SelectLod)
                .after(select_levels)
                .before(assign_lanes),
        );
    }
}

/// A cloth that is simulated in advance.
#[derive(Component, Debug)]
struct Rolling {
    level: usize,
    /// The tick in which the state is taken.
    due: u64,
    /// The state at the end. None once it is taken.
    state: Option<Background<ClothSnapshot>>,
}

/// When states are due, which are computed one after the other.
#[derive(Resource, Debug, Default)]
struct PrerollQueue {
    /// Number of ticks so far.
    tick: u64,
    /// Number of steps before the end of the queue, counted as if they had been done since the first tick.
    end: u64,
}

impl PrerollQueue {
    /// Adds steps, which begin at least so many ticks from now. Returns the tick in which they are expected to be
    /// done, which is a later one.
    fn add(&mut self, steps: u64, begin_after: u64) -> u64 {
        self.end = self.end.max((self.tick + begin_after) * STEPS_PER_TICK) + steps.max(1);
        self.end.div_ceil(STEPS_PER_TICK)
    }
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
    /// Number of steps of one particle through one substep.
    fn steps(&self) -> u64 {
        self.fabric.particle_count() as u64
            * u64::from(self.settings.substeps)
            * u64::from(self.ticks)
    }

    /// The state at the end; that at the start where it does not stay finite.
    fn run(self) -> ClothSnapshot {
        let mut batch = ClothBatch::new(self.fabric, LaneCount::One);
        let Ok(lane) = batch.insert(&self.state, self.material) else { return self.state };
        if batch.drive(lane, self.drive).is_err() {
            return self.state;
        }
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
    (library, mut queue): (Res<FabricLibrary>, ResMut<PrerollQueue>),
    mut commands: Commands,
) {
    queue.tick += 1;
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
        // Fabrics that are being cut come first.
        let due = queue.add(preroll.steps(), library.ticks_to_cut());
        let state = Some(Background::begin(move || preroll.run()));
        commands.entity(entity).insert(Rolling { level: instance.level, due, state });
    }
}

fn end_prerolls(
    mut cloths: Query<(Entity, &mut Rolling, &mut ClothInstance, &mut ClothState)>,
    queue: Res<PrerollQueue>,
    mut commands: Commands,
) {
    let due = cloths.iter_mut().filter(|(_, rolling, ..)| rolling.due <= queue.tick);
    for (entity, mut rolling, mut instance, mut state) in due {
        let Some(snapshot) = rolling.state.take().map(Background::take) else { continue };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_due_after_all_work_before() {
        let mut queue = PrerollQueue { tick: 10, end: 0 };
        assert_eq!(queue.add(1, 0), 11);
        assert_eq!(queue.add(2 * STEPS_PER_TICK, 0), 13);
        assert_eq!(queue.add(1, 5), 16);
        queue.tick = 40;
        assert_eq!(queue.add(STEPS_PER_TICK, 0), 41);
    }
}
