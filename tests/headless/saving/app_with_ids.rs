//! An app whose state besides cloth is known: entities that move by the numbers of ticks and frames, and are told by numbers.

use std::ops::{Deref, DerefMut};

use bevy_app::prelude::*;
use bevy_bunting::ClothSurface;
use bevy_bunting::prelude::*;
use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{Time, Virtual};
use bevy_transform::prelude::*;
use bunting_tests::{Bits, TICK, app, bits, state};

/// Numbers of ticks and frames so far.
#[derive(Resource, Clone, Copy, Debug, Default)]
struct Passed {
    ticks: u32,
    frames: u32,
}

/// Number of an entity, in the order of spawning.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Id(u32);

/// A path, by the time in s.
pub type Path = fn(f32) -> Transform;

/// Moves its entity in each tick.
#[derive(Component)]
pub struct InTicks(pub Path);

/// Moves its entity in each frame.
#[derive(Component)]
pub struct InFrames(pub Path);

fn move_in_ticks(mut passed: ResMut<Passed>, mut movers: Query<(&InTicks, &mut Transform)>) {
    passed.ticks += 1;
    for (mover, mut transform) in &mut movers {
        *transform = mover.0(passed.ticks as f32 * TICK);
    }
}

fn move_in_frames(
    mut passed: ResMut<Passed>,
    mut movers: Query<(&InFrames, &mut Transform)>,
    time: Res<Time<Virtual>>,
) {
    // In the first frame of an app no time passes.
    if time.delta().is_zero() {
        return;
    }
    passed.frames += 1;
    for (mover, mut transform) in &mut movers {
        *transform = mover.0(passed.frames as f32 * TICK);
    }
}

/// The app, and the number of the next entity.
pub struct AppWithIds {
    app: App,
    next: u32,
}

impl Deref for AppWithIds {
    type Target = App;

    fn deref(&self) -> &App {
        &self.app
    }
}

impl DerefMut for AppWithIds {
    fn deref_mut(&mut self) -> &mut App {
        &mut self.app
    }
}

/// State of an app besides cloth: what a game or a library of rollback saves.
#[derive(Clone, Debug)]
pub struct Others {
    passed: Passed,
    transforms: Vec<(Id, Transform)>,
}

/// What is read of a cloth after a tick: positions, those of its surface, what it does to its anchors, and whether it sleeps.
#[derive(Debug, PartialEq)]
struct Read {
    positions: Bits,
    surface: Vec<[u32; 3]>,
    reactions: Option<AnchorReactions>,
    activity: ClothActivity,
    level: usize,
}

impl Read {
    fn of(app: &App, cloth: Entity) -> Self {
        let surface = app.world().get::<ClothSurface>(cloth);
        let surface = surface.into_iter().flat_map(|surface| &surface.positions);
        Self {
            positions: bits(app, cloth),
            surface: surface.map(|at| at.to_array().map(f32::to_bits)).collect(),
            reactions: app.world().get::<AnchorReactions>(cloth).cloned(),
            activity: state(app, cloth).activity(),
            level: state(app, cloth).level(),
        }
    }
}

/// What is read of cloths and colliders after each tick.
#[derive(Debug, PartialEq)]
pub struct Trace(Vec<(Vec<Read>, Vec<Vec3>)>);

impl AppWithIds {
    /// An app whose entities differ from those of another by so many.
    pub fn new(offset: usize) -> Self {
        let mut app = app();
        app.init_resource::<Passed>()
            .add_systems(FixedUpdate, move_in_ticks)
            .add_systems(Update, move_in_frames);
        (0..offset).for_each(|_| _ = app.world_mut().spawn_empty());
        Self { app, next: 0 }
    }

    /// Spawns an entity with the next number.
    pub fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.next += 1;
        let id = Id(self.next);
        self.world_mut().spawn((id, bundle)).id()
    }

    fn ids(&self) -> Vec<(Id, Entity)> {
        let mut query = self.world().try_query::<(&Id, Entity)>().expect("there are numbers");
        let mut ids: Vec<_> = query.iter(self.world()).map(|(&id, entity)| (id, entity)).collect();
        ids.sort_unstable();
        ids
    }

    /// The entities of another app of the same scene, and those of this one.
    pub fn entities_for(&self, other: &Self) -> EntityHashMap<Entity> {
        let pairs = other.ids().into_iter().zip(self.ids());
        pairs
            .map(|((id, from), (of, to))| {
                assert_eq!(id, of);
                (from, to)
            })
            .collect()
    }

    /// The state besides cloth.
    pub fn others(&self) -> Others {
        let transforms = self.ids().into_iter().filter_map(|(id, entity)| {
            let entity = self.world().entity(entity);
            let transform = entity.get::<Transform>().filter(|_| !entity.contains::<ClothMesh>());
            Some((id, *transform?))
        });
        let passed = *self.world().resource::<Passed>();
        Others { passed, transforms: transforms.collect() }
    }

    /// Restores the state besides cloth.
    pub fn restore_others(&mut self, others: &Others) {
        *self.world_mut().resource_mut::<Passed>() = others.passed;
        let ids = self.ids();
        for (id, transform) in &others.transforms {
            let found = ids.binary_search_by_key(id, |it| it.0).expect("the same scene");
            *self.world_mut().get_mut::<Transform>(ids[found].1).expect("a transform") = *transform;
        }
    }

    /// Forces on colliders, N, in the order of their numbers.
    fn forces(&self) -> Vec<Vec3> {
        let reactions = self
            .ids()
            .into_iter()
            .filter_map(|(_, entity)| Some(self.world().get::<ClothReactions>(entity)?.force));
        reactions.collect()
    }

    /// Runs a number of updates of one tick each.
    pub fn trace(&mut self, cloths: &[Entity], updates: usize) -> Trace {
        let trace = (0..updates).map(|_| {
            self.update();
            (cloths.iter().map(|&cloth| Read::of(self, cloth)).collect(), self.forces())
        });
        Trace(trace.collect())
    }
}

impl Trace {
    /// The first update in which something differs, the number of the cloth if it is one, and what differs there.
    pub fn first_difference(&self, other: &Self) -> Option<String> {
        assert_eq!(self.0.len(), other.0.len());
        let updates = self.0.iter().zip(&other.0).enumerate();
        updates.into_iter().find_map(|(update, (one, other))| {
            let mut cloths = one.0.iter().zip(&other.0).enumerate();
            let cloth =
                cloths.find(|(_, (one, other))| one != other).map(|(cloth, (one, other))| {
                    let differs = [
                        ("positions", one.positions != other.positions),
                        ("surface", one.surface != other.surface),
                        ("reactions", one.reactions != other.reactions),
                        ("activity", one.activity != other.activity),
                        ("level", one.level != other.level),
                    ];
                    let names = differs.iter().filter(|it| it.1).map(|it| it.0).collect::<Vec<_>>();
                    format!("update {update}, cloth {cloth}: {names:?}")
                });
            let forces = || (one.1 != other.1).then(|| format!("update {update}: forces"));
            cloth.or_else(forces)
        })
    }

    /// Whether any cloth does this in any tick.
    pub fn has(&self, does: ClothActivity) -> bool {
        self.0.iter().flat_map(|tick| &tick.0).any(|read| read.activity == does)
    }

    /// The levels of all cloths in all ticks, without repetitions.
    pub fn levels(&self) -> Vec<usize> {
        let mut levels: Vec<usize> =
            self.0.iter().flat_map(|tick| &tick.0).map(|read| read.level).collect();
        levels.sort_unstable();
        levels.dedup();
        levels
    }

    /// Whether any collider is touched.
    pub fn touches(&self) -> bool {
        self.0.iter().flat_map(|tick| &tick.1).any(|force| force.length() > 0.0)
    }
}
