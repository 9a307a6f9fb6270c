//! Simulation in advance: a cloth is first shown as it hangs, not in its rest shape.

use std::sync::Arc;

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::helper::TransformHelper;
use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, FrameMotion, LaneCount, Loads,
    StepSettings,
};

use crate::background::Background;
use crate::batch::assign::assign_lanes;
use crate::cloth::instance::{ClothInstance, StateStorage};
use crate::cloth::state::ClothState;
use crate::environment::surroundings::{Exposure, Surroundings};
use crate::fabric::library::FabricLibrary;
use crate::lod::select::select_levels;
use crate::motion::attachment::Attachment;
use crate::motion::frame::frame_of;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// Longest time that is simulated in advance, s: 0.2 s of computing for a flag of 33 × 33.
const LONGEST: f32 = 60.0;

/// Expected throughput of a background thread in a tick, in substeps of one particle: half of what one thread
/// does. Larger: ticks wait for other threads. Smaller: cloths appear late without need.
const STEPS_PER_TICK: u64 = 1 << 18;

/// Simulates a cloth for some seconds before it is first shown: in the wind at the place where it is spawned,
/// on a frame at rest, without colliders. The simulation runs on another thread where there are threads.
/// Until it is done the cloth has no [`ClothState`]; this component is then removed. The tick in which this
/// happens follows from the amount of work, not from the machine's speed.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A curtain that hangs in folds when it is first seen.
/// let curtain = (ClothMesh::grid(33, 33, 2.0, 2.0), ClothPreroll { seconds: 2.0 });
/// # assert_eq!(curtain.1.seconds, 2.0);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothPreroll {
    /// Simulated time, s; at most 60.
    pub seconds: f32,
}

impl ClothPreroll {
    /// Simulates the given number of seconds in advance.
    #[must_use]
    pub const fn seconds(seconds: f32) -> Self {
        Self { seconds }
    }
}

impl Default for ClothPreroll {
    /// Three seconds: by then a flag has unfolded.
    fn default() -> Self {
        Self::seconds(3.0)
    }
}

/// Simulates cloths in advance, see [`ClothPreroll`].
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
struct PrerollTask {
    level: usize,
    /// Tick in which the state is taken.
    due: u64,
    /// State at the end of the simulation; none once it is taken.
    state: Option<Background<ClothSnapshot>>,
}

/// Queue of simulations in advance, which run one after the other, and the tick in which each is expected to
/// end.
#[derive(Resource, Debug, Default)]
struct PrerollQueue {
    /// Number of ticks so far.
    tick: u64,
    /// Substeps of one particle until the end of the queue, counted from the first tick on as if the thread
    /// were never idle.
    end: u64,
}

impl PrerollQueue {
    /// Appends a simulation of `steps` substeps of one particle, which begins at least `begin_after` ticks
    /// from now. Returns the tick in which it is expected to end, later than the present one.
    fn add(&mut self, steps: u64, begin_after: u64) -> u64 {
        self.end = self.end.max((self.tick + begin_after) * STEPS_PER_TICK) + steps.max(1);
        self.end.div_ceil(STEPS_PER_TICK)
    }
}

/// Inputs of a simulation in advance.
struct Preroll {
    fabric: Arc<Fabric>,
    state: ClothSnapshot,
    material: FabricMaterial,
    drive: Drive,
    settings: StepSettings,
    /// Length of a tick, s.
    tick: f32,
    ticks: u32,
}

impl Preroll {
    /// Work of the simulation, in substeps of one particle.
    fn steps(&self) -> u64 {
        self.fabric.particle_count() as u64
            * u64::from(self.settings.substeps)
            * u64::from(self.ticks)
    }

    /// Runs the simulation. Returns the state at its end, or the one at its start if a position is not
    /// finite.
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

type New<'a> = (
    Entity,
    &'a ClothPreroll,
    &'a mut ClothInstance,
    &'a mut ClothState,
    Option<&'a Attachment>,
    Exposure,
);

fn begin_prerolls(
    mut cloths: Query<New, Without<PrerollTask>>,
    transforms: TransformHelper,
    settings: Res<ClothSettings>,
    surroundings: Surroundings,
    (library, mut queue): (Res<FabricLibrary>, ResMut<PrerollQueue>),
    mut commands: Commands,
) {
    queue.tick += 1;
    let tick = surroundings.tick();
    for (entity, preroll, mut instance, mut state, attachment, exposure) in &mut cloths {
        // A cloth that has been simulated is not simulated in advance.
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
        let seconds = if preroll.seconds.is_finite() { preroll.seconds } else { 0.0 };
        let wind = surroundings.wind_at(frame * instance.rest_middle);
        let growth = instance.growth;
        let drive = growth.drive(surroundings.drive(wind, frame, FrameMotion::NONE, &exposure));
        let material = instance.acting_material();
        let air = Loads::of_air(&fabric, &drive, &material, tick);
        let (class, _) = Loads {
            air: growth.end() * air,
            frame: exposure.acceleration().length(),
            ..Loads::default()
        }
        .class();
        let acceleration = class.acceleration(settings.gravity.length()) / growth.end();
        let preroll = Preroll {
            settings: settings.limits(instance.level).of_fabric(&fabric, tick, acceleration),
            fabric,
            state: *snapshot,
            material,
            drive,
            tick,
            ticks: (seconds.clamp(0.0, LONGEST) / tick) as u32,
        };
        // The simulation waits until fabrics that are being built are ready.
        let due = queue.add(preroll.steps(), library.ticks_to_cut());
        let state = Some(Background::begin(move || preroll.run()));
        commands.entity(entity).insert(PrerollTask { level: instance.level, due, state });
    }
}

fn end_prerolls(
    mut cloths: Query<(Entity, &mut PrerollTask, &mut ClothInstance, &mut ClothState)>,
    queue: Res<PrerollQueue>,
    mut commands: Commands,
) {
    let due = cloths.iter_mut().filter(|(_, rolling, ..)| rolling.due <= queue.tick);
    for (entity, mut rolling, mut instance, mut state) in due {
        let Some(snapshot) = rolling.state.take().map(Background::take) else { continue };
        commands.entity(entity).remove::<(PrerollTask, ClothPreroll)>();
        // A cloth whose fabric was rebuilt in the meantime starts at rest.
        let Some(levels) = instance.levels.clone() else { continue };
        let fits = levels.fabric(rolling.level).particle_count() == snapshot.positions.len();
        if !fits || !matches!(instance.storage, StateStorage::None) {
            continue;
        }
        instance.level = rolling.level;
        state.restart(rolling.level, &levels, &snapshot.positions);
        instance.storage = snapshot.into();
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
