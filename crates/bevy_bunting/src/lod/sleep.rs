//! Cloth that has come to rest falls asleep.

use bevy_app::{App, Plugin};
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_time::Time;

use crate::batch::publish::publish_states;
use crate::cloth::activity::{ClothActivity, ClothRest, ClothWatch};
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::display::easing::ease_surfaces;
use crate::environment::collider::ClothCollider;
use crate::environment::wind::TickWind;
use crate::lod::choose_levels;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;

/// Root mean square speed of a cloth at rest, m/s: a millimetre in a second is seen by no one.
const REST_SPEED: f32 = 1e-3;

/// How long it must be as slow, s: longer than a pendulum stands at its turning points.
const REST_TIME: f32 = 0.5;

/// Distance between a cloth and a collider at which the one does not wake the other, m.
const CLEARANCE: f32 = 0.5;

/// Sends cloths at rest to sleep, and wakes them.
#[derive(Debug, Default)]
pub struct RestPlugin;

impl Plugin for RestPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Changes>().add_systems(
            ClothTick,
            (
                (note_changes, wake_cloths)
                    .chain()
                    .in_set(ClothSystems::SelectLod)
                    .before(choose_levels),
                rest_cloths
                    .in_set(ClothSystems::Publish)
                    .after(publish_states)
                    .after(ease_surfaces),
            ),
        );
    }
}

/// What has changed since the last tick that acts on cloths.
#[derive(Resource, Debug, Default)]
struct Changes {
    /// Wind, gravity, settings, or which colliders there are.
    everywhere: bool,
    /// Ticks since then.
    calm: u32,
    /// Balls around colliders that move, centres and radii, m.
    colliders: Vec<(Vec3, f32)>,
    /// Most cloths that may be at rest.
    resting: usize,
    wind: TickWind,
    collider_poses: EntityHashMap<Isometry3d>,
}

impl Changes {
    /// Whether anything near a cloth has changed, or its frame.
    fn reach(&self, state: &ClothState, frame: Isometry3d, rest: &ClothRest, radius: f32) -> bool {
        let middle = state.positions().get(state.positions().len() / 2);
        let middle = frame * middle.copied().unwrap_or_default();
        let near =
            |&(centre, other): &(Vec3, f32)| middle.distance(centre) < radius + other + CLEARANCE;
        rest.pose != Some(frame) || self.colliders.iter().any(near)
    }
}

fn note_changes(
    colliders: Query<(Entity, Ref<ClothCollider>, &PoseHistory)>,
    mut removed: RemovedComponents<ClothCollider>,
    settings: Res<ClothSettings>,
    wind: Res<TickWind>,
    mut changes: ResMut<Changes>,
) {
    let changes = &mut *changes;
    changes.everywhere = settings.is_changed() || wind.differs_from(&changes.wind);
    changes.wind.clone_from(&wind);
    for entity in removed.read() {
        changes.collider_poses.remove(&entity);
        changes.everywhere = true;
    }
    changes.colliders.clear();
    for (entity, collider, history) in &colliders {
        changes.everywhere |= collider.is_changed();
        let pose = history.end();
        if changes.collider_poses.insert(entity, pose) != Some(pose) {
            let ball = collider.shape.compute_local_bounding_sphere();
            changes.colliders.push((pose * ball.center, ball.radius + collider.margin));
        }
    }
    changes.calm = if changes.everywhere { 0 } else { changes.calm.saturating_add(1) };
}

type Watched = (
    &'static mut ClothInstance,
    &'static ClothState,
    &'static PoseHistory,
    &'static mut ClothRest,
    &'static ClothWatch,
);

fn wake_cloths(mut cloths: Query<Watched>, mut changes: ResMut<Changes>) {
    if changes.resting == 0 {
        return;
    }
    changes.resting = 0;
    for (mut instance, state, frame, rest, watch) in &mut cloths {
        if instance.activity != ClothActivity::AtRest {
            continue;
        }
        if changes.everywhere || changes.reach(state, frame.end(), &rest, watch.radius) {
            instance.wake();
        } else {
            changes.resting += 1;
        }
    }
}

fn rest_cloths(mut cloths: Query<Watched>, mut changes: ResMut<Changes>, time: Res<Time>) {
    // In gusts nothing comes to rest: not worth a look.
    if changes.everywhere {
        return;
    }
    let tick = time.delta_secs();
    for (mut instance, state, frame, mut rest, watch) in &mut cloths {
        if instance.slot().is_none() {
            continue;
        }
        let pose = frame.end();
        let disturbed = changes.reach(state, pose, &rest, watch.radius);
        rest.pose = Some(pose);
        rest.still = if disturbed || speed(state, tick) > REST_SPEED { 0 } else { rest.still + 1 };
        if rest.still.min(changes.calm) as f32 * tick > REST_TIME {
            rest.still = 0;
            instance.activity = ClothActivity::AtRest;
            changes.resting += 1;
        }
    }
}

/// Root mean square speed in the last tick, m/s.
fn speed(state: &ClothState, tick: f32) -> f32 {
    let pairs = state.positions().iter().zip(state.previous_positions());
    let squares: f32 = pairs.map(|(now, before)| now.distance_squared(*before)).sum();
    (squares / state.positions().len().max(1) as f32).sqrt() / tick
}
