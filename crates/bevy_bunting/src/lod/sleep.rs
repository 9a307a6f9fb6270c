//! Sleep at rest: cloths at rest fall asleep, and wake when anything that acts on them changes.

use bevy_app::{App, Plugin};
use bevy_ecs::change_detection::Tick;
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_ecs::system::SystemChangeTick;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::Time;

use crate::batch::publish::reset_diverged;
use crate::cloth::activity::ClothActivity;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::display::lift::lift_surfaces;
use crate::environment::cloth_collision::ClothCollision;
use crate::environment::collider::ClothCollider;
use crate::environment::forces::acceleration::ClothAcceleration;
use crate::environment::layers::{ClothFeatures, ClothLayers};
use crate::environment::pressure::ClothPressure;
use crate::environment::scaled_shape::ScaledShape;
use crate::environment::self_collision::SelfCollision;
use crate::environment::wind::influence::WindInfluence;
use crate::environment::wind::per_particle::WindPerParticle;
use crate::environment::wind::tick_wind::TickWind;
use crate::lod::record::LodRecord;
use crate::lod::rest_timer::RestTimer;
use crate::lod::select::select_levels;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::pose::PoseHistory;
use crate::motion::shift::ShiftOrigin;
use crate::schedule::{ClothSystems, ClothTick};
use crate::seams::seam::ClothSeams;
use crate::settings::ClothSettings;
use crate::skeleton::joints::JointPoses;

/// Root mean square distance of a cloth's particles from where they were, as a part of the cloth's size, up to which the cloth rests:
/// too small to be seen. Larger: cloth visibly stops. Smaller: heaps of cloth, whose folds tremble, do not fall asleep.
const REST_PART: f32 = 1e-3;

/// Greatest size of which that part is taken, m: larger cloths rest within the same distance as one of this size.
const LARGEST_SIZE: f32 = 1.0;

/// Time for which a cloth must rest before it falls asleep, s: longer than a pendulum is within that distance at its turning
/// points. Shorter: swinging cloth falls asleep there.
const REST_TIME: f32 = 1.0;

/// Distance from a cloth beyond which a moving collider does not wake it, m. Smaller: fast colliders enter
/// sleeping cloth.
const CLEARANCE: f32 = 0.5;

/// Wakes a cloth that sleeps at rest. Trigger this event when something unknown to the plugin begins to act
/// on the cloth, such as a force or a constraint of the user. A cloth that sleeps because no viewer sees it
/// is not woken.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_bunting::WakeCloth;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let entity = world.spawn(ClothMesh::grid(17, 17, 1.0, 1.0)).id();
/// world.trigger(WakeCloth { entity });
/// ```
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct WakeCloth {
    /// The cloth.
    pub entity: Entity,
}

/// Sends cloths at rest to sleep, and wakes them.
#[derive(Debug, Default)]
pub struct SleepPlugin;

impl Plugin for SleepPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Changes>()
            .add_observer(wake)
            .add_observer(shift_changes)
            .add_observer(wake_bared::<WindInfluence>)
            .add_observer(wake_bared::<WindPerParticle>)
            .add_observer(wake_bared::<ClothAcceleration>)
            .add_observer(wake_bared::<ClothPressure>)
            .add_observer(wake_bared::<SelfCollision>)
            .add_observer(wake_bared::<ClothSeams>)
            .add_observer(note_removed::<ClothCollider>)
            .add_observer(note_removed::<ClothCollision>);
        app.add_systems(
            ClothTick,
            (
                (note_changes, wake_exposed, wake_cloths)
                    .chain()
                    .in_set(ClothSystems::SelectLod)
                    .before(select_levels),
                send_to_sleep
                    .in_set(ClothSystems::Publish)
                    .after(reset_diverged)
                    .after(lift_surfaces),
            ),
        );
    }
}

/// Changes since the last tick in anything that acts on cloths.
#[derive(Resource, Debug, Default)]
pub(crate) struct Changes {
    /// Whether the wind, the settings (such as gravity) or the set of colliders changed, which affects all
    /// cloths.
    everywhere: bool,
    /// Number of ticks since the last change that affects all cloths.
    unchanged_ticks: u32,
    /// Balls around moving colliders and changing local winds: centres and radii, m.
    disturbed: Vec<(Vec3, f32)>,
    /// Number of cloths asleep at rest; some may have been woken since.
    asleep: usize,
    wind: TickWind,
    /// The settings in the last tick; none before the first.
    settings: Option<ClothSettings>,
    /// Whether something was removed since the last tick that acted on cloth, or was to be noted in a tick before which the
    /// world was saved.
    is_pending: bool,
    /// When changes were last noted, as a tick of change.
    noted: Tick,
}

/// What of the changes outlives the world.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SavedChanges {
    unchanged_ticks: u32,
    wind: TickWind,
    is_pending: bool,
    has_settings: bool,
}

impl Changes {
    /// What outlives the world, whose settings are these, given whether any collider or layer has [changed](Self::is_since)
    /// since the last tick.
    pub fn saved(&self, settings: &ClothSettings, has_changed: bool) -> SavedChanges {
        SavedChanges {
            unchanged_ticks: self.unchanged_ticks,
            wind: self.wind.clone(),
            is_pending: self.is_pending || has_changed,
            has_settings: self.settings.as_ref() == Some(settings),
        }
    }

    /// Takes over what was saved of a world with the same settings.
    pub fn restore(&mut self, saved: &SavedChanges, settings: &ClothSettings) {
        self.unchanged_ticks = saved.unchanged_ticks;
        self.wind.clone_from(&saved.wind);
        self.is_pending = saved.is_pending;
        self.settings = saved.has_settings.then(|| settings.clone());
    }

    /// Some cloths may have been put to sleep: they are counted in the next tick.
    pub fn count_again(&mut self) {
        self.asleep += 1;
    }

    /// Whether a change has not been noted yet, given the present tick of change.
    pub fn is_since(&self, changed: Tick, now: Tick) -> bool {
        changed.is_newer_than(self.noted, now)
    }

    /// Whether a change affects a cloth with a radius (m): of its frame, or of a collider or a wind
    /// near it.
    fn act_on(
        &self,
        state: &ClothState,
        frame: Isometry3d,
        timer: &mut RestTimer,
        radius: f32,
    ) -> bool {
        let middle = state.positions().get(state.positions().len() / 2);
        let middle = frame * (state.scale() * middle.copied().unwrap_or_default());
        let radius = state.scale() * radius;
        let is_near =
            |&(centre, other): &(Vec3, f32)| middle.distance(centre) < radius + other + CLEARANCE;
        timer.has_moved_to(frame) || self.disturbed.iter().any(is_near)
    }
}

/// Moves the last known winds along with the world.
fn shift_changes(shift: On<ShiftOrigin>, mut changes: ResMut<Changes>) {
    changes.wind.shift(shift.acting());
}

fn wake(request: On<WakeCloth>, mut cloths: Query<(&mut ClothInstance, &mut RestTimer)>) {
    if let Ok((mut instance, mut timer)) = cloths.get_mut(request.entity) {
        timer.restart();
        instance.wake();
    }
}

/// Wakes a cloth that loses a component on which the effect of its surroundings depends.
fn wake_bared<C: Component>(
    removed: On<Remove, C>,
    mut cloths: Query<(&mut ClothInstance, &mut RestTimer)>,
) {
    if let Ok((mut instance, mut timer)) = cloths.get_mut(removed.entity) {
        timer.restart();
        instance.wake();
    }
}

/// Filter of cloths on which their surroundings act otherwise than before.
type HasNewExposure = Or<(
    Changed<WindInfluence>,
    Changed<WindPerParticle>,
    Changed<ClothAcceleration>,
    Changed<ClothPressure>,
    Changed<ClothSeams>,
)>;

/// The components of a cloth on which the effect of its surroundings depends.
type Exposed = (
    Option<Ref<'static, WindInfluence>>,
    Option<Ref<'static, WindPerParticle>>,
    Option<Ref<'static, ClothAcceleration>>,
    Option<Ref<'static, ClothPressure>>,
    Option<Ref<'static, ClothSeams>>,
);

fn wake_exposed(
    mut cloths: Query<(&mut ClothInstance, &mut RestTimer, &PoseHistory, Exposed), HasNewExposure>,
) {
    for (mut instance, mut timer, history, (influence, per_particle, acceleration, air, seams)) in
        &mut cloths
    {
        let has_new = influence.is_some_and(|it| history.has_new(&it))
            || per_particle.is_some_and(|it| history.has_new(&it))
            || acceleration.is_some_and(|it| history.has_new(&it))
            || air.is_some_and(|it| history.has_new(&it))
            || seams.is_some_and(|it| history.has_new(&it));
        if has_new {
            timer.restart();
            instance.wake();
        }
    }
}

/// Notes that something is removed that acts on cloth.
fn note_removed<C: Component>(_: On<Remove, C>, mut changes: ResMut<Changes>) {
    changes.is_pending = true;
}

/// Filter of cloths and colliders that touch others than before.
type HasNewLayers = Or<(
    Changed<ClothLayers>,
    Changed<ClothFeatures>,
    Changed<SelfCollision>,
    Changed<ClothCollision>,
)>;

/// The components of a cloth or a collider by which it touches others.
type Layers = (
    Option<&'static PoseHistory>,
    Option<Ref<'static, ClothLayers>>,
    Option<Ref<'static, ClothFeatures>>,
    Option<Ref<'static, SelfCollision>>,
    Option<Ref<'static, ClothCollision>>,
);

/// Whether a cloth or a collider touches others than before.
fn has_new_layers(
    (history, layers, features, own, others): <Layers as QueryData>::Item<'_, '_>,
) -> bool {
    let Some(history) = history else { return true };
    layers.is_some_and(|it| history.has_new(&it))
        || features.is_some_and(|it| history.has_new(&it))
        || own.is_some_and(|it| history.has_new(&it))
        || others.is_some_and(|it| history.has_new(&it))
}

fn note_changes(
    colliders: Query<(Ref<ClothCollider>, &ScaledShape, &PoseHistory)>,
    layers: Query<Layers, HasNewLayers>,
    settings: Res<ClothSettings>,
    wind: Res<TickWind>,
    mut changes: ResMut<Changes>,
    ticks: SystemChangeTick,
) {
    let changes = &mut *changes;
    changes.noted = ticks.this_run();
    changes.everywhere = core::mem::take(&mut changes.is_pending);
    changes.everywhere |= wind.changed_everywhere(&changes.wind);
    changes.everywhere |= layers.iter().any(has_new_layers);
    if changes.settings.as_ref() != Some(&*settings) {
        changes.settings = Some(settings.clone());
        changes.everywhere = true;
    }
    changes.disturbed.clear();
    changes.disturbed.extend(wind.changed_balls(&changes.wind));
    changes.wind.clone_from(&wind);
    for (collider, shape, history) in &colliders {
        changes.everywhere |= history.has_new(&collider);
        if !history.rests() {
            let ball = shape.of(&collider.shape).compute_local_bounding_sphere();
            let centre = history.end() * ball.center;
            changes.disturbed.push((centre, ball.radius + collider.margin));
        }
    }
    changes.unchanged_ticks =
        if changes.everywhere { 0 } else { changes.unchanged_ticks.saturating_add(1) };
}

type RestingCloth = (
    &'static mut ClothInstance,
    &'static ClothState,
    &'static PoseHistory,
    Option<&'static AnchorPoses>,
    Option<&'static JointPoses>,
    &'static mut RestTimer,
    &'static LodRecord,
);

pub(crate) fn wake_cloths(mut cloths: Query<RestingCloth>, mut changes: ResMut<Changes>) {
    if changes.asleep == 0 {
        return;
    }
    changes.asleep = 0;
    for (mut instance, state, frame, anchors, joints, mut timer, record) in &mut cloths {
        if instance.activity != ClothActivity::AtRest {
            continue;
        }
        if changes.everywhere
            || changes.act_on(state, frame.end(), &mut timer, record.radius)
            || anchors.is_some_and(AnchorPoses::may_move)
            || joints.is_some_and(JointPoses::may_move)
        {
            instance.wake();
        } else {
            changes.asleep += 1;
        }
    }
}

pub(crate) fn send_to_sleep(
    mut cloths: Query<RestingCloth>,
    mut changes: ResMut<Changes>,
    time: Res<Time>,
) {
    // Gusts change in every tick, so no cloth comes to rest in them.
    if changes.everywhere {
        return;
    }
    let tick = time.delta_secs();
    // Cloths that may touch one another fall asleep together: one without a lane would let the others through.
    let mut rested: EntityHashMap<bool> = EntityHashMap::default();
    for (mut instance, state, frame, anchors, joints, mut timer, record) in &mut cloths {
        if instance.lane().is_none() {
            continue;
        }
        let pose = frame.end();
        let is_disturbed = changes.act_on(state, pose, &mut timer, record.radius)
            || anchors.is_some_and(AnchorPoses::may_move)
            || joints.is_some_and(JointPoses::may_move)
            || instance.taking_up.is_some();
        timer.pose = Some(pose);
        if is_disturbed {
            timer.restart();
        } else {
            let largest = LARGEST_SIZE / state.scale();
            let way = REST_PART * (2.0 * record.radius).min(largest);
            timer.count(state.positions(), state.previous_positions(), way);
        }
        let rests = timer.ticks.min(changes.unchanged_ticks) as f32 * tick > REST_TIME;
        match timer.group {
            Some(group) => *rested.entry(group).or_insert(true) &= rests,
            None if rests => {
                timer.restart();
                instance.activity = ClothActivity::AtRest;
                changes.asleep += 1;
            }
            None => {}
        }
    }
    if rested.values().any(|&rests| rests) {
        for (mut instance, .., mut timer, _) in &mut cloths {
            let rests = |group: Entity| instance.lane().is_some() && rested[&group];
            if timer.group.is_some_and(rests) {
                timer.restart();
                instance.activity = ClothActivity::AtRest;
                changes.asleep += 1;
            }
        }
    }
}
