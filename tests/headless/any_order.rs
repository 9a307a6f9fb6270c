//! Random actions of a user in random order: nothing panics, every position stays finite, and no cloth is
//! torn apart.

use std::time::Duration;

use bevy_app::App;
use bevy_bunting::bunting_solver::{FabricMaterial, LaneCount};
use bevy_bunting::prelude::*;
use bevy_bunting::{CostTable, LodCosts};
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::*;
use bevy_math::{EulerRot, Quat, Vec3};
use bevy_time::TimeUpdateStrategy;
use bevy_transform::prelude::*;
use bunting_tests::{app, greatest, state, stretches};

/// Number of runs, each with its own seed, and number of actions in each run.
const RUNS: u32 = 16;
const ACTIONS: usize = 300;

/// Greatest numbers of cloths and of poles.
const MOST: usize = 6;

/// Greatest ratio of a link's length to its rest length. The actions are violent: poles move at up to 20 m/s
/// from one frame to the next.
const STRETCH: f32 = 2.5;

/// Pseudo-random numbers (Numerical Recipes' linear congruential generator).
struct Random(u32);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as usize % count
    }

    /// A number from −1 to 1.
    fn signed(&mut self) -> f32 {
        self.below(2001) as f32 / 1000.0 - 1.0
    }

    fn vector(&mut self, length: f32) -> Vec3 {
        length * Vec3::new(self.signed(), self.signed(), self.signed())
    }

    fn pose(&mut self, reach: f32) -> Transform {
        let [a, b, c] = [(); 3].map(|()| 3.0 * self.signed());
        let rotation = Quat::from_euler(EulerRot::XYZ, a, b, c);
        Transform::from_translation(self.vector(reach)).with_rotation(rotation)
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> Option<T> {
        (!all.is_empty()).then(|| all[self.below(all.len())])
    }
}

/// A world on which the actions are performed.
struct Playground {
    app: App,
    random: Random,
    cloths: Vec<Entity>,
    poles: Vec<Entity>,
    others: Vec<Entity>,
    /// Whether cloths may be torn apart: colliders may cross held vertices, and the surface of cloth with
    /// weights is a mean of simulated and rigid positions.
    is_rough: bool,
    /// The actions so far.
    log: Vec<String>,
}

impl Playground {
    fn new(seed: u32) -> Self {
        let mut app = app();
        app.world_mut().resource_mut::<ClothBudget>().costs = LodCosts::Fixed(CostTable::default());
        app.world_mut().spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, 8.0)));
        app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 2.0)).with_gusts(2.0, 0.5, 1));
        Self {
            app,
            random: Random(seed),
            cloths: Vec::new(),
            poles: Vec::new(),
            others: Vec::new(),
            is_rough: seed.is_multiple_of(2),
            log: Vec::new(),
        }
    }

    fn mesh(&mut self) -> ClothMesh {
        match self.random.below(if self.is_rough { 4 } else { 3 }) {
            0 => ClothMesh::grid(9, 9, 1.0, 1.0),
            1 => ClothMesh::grid(17, 9, 1.5, 1.0),
            2 => ClothMesh::grid(9, 17, 0.5, 1.0),
            _ => {
                let weights = (0..45).map(|vertex| (vertex % 9) as f32 / 8.0).collect();
                ClothMesh::grid(9, 5, 1.0, 0.6).with_weights(weights)
            }
        }
    }

    fn lods(&mut self) -> LodSet {
        match self.random.below(4) {
            0 => LodSet::default(),
            1 => LodSet::new([6.0, 12.0]),
            2 => LodSet::automatic(2).pinned_to(1),
            _ => LodSet::automatic(3),
        }
    }

    fn held(&mut self) -> AttachedVertices {
        match self.random.below(6) {
            0 => ClothEdge::Left.into(),
            1 => ClothEdge::Top.into(),
            2 => ClothEdge::Right.into(),
            3 => ClothCorner::TopLeft.into(),
            4 => AttachedVertices::Corners(vec![ClothCorner::TopLeft, ClothCorner::BottomRight]),
            _ => AttachedVertices::List(vec![0, 8]),
        }
    }

    fn attachment(&mut self) -> Attachment {
        let held = self.held();
        let attachment = match self.random.one_of(&self.poles.clone()) {
            Some(pole) => Attachment::new(pole, held),
            None => Attachment::in_place(held),
        };
        let offset = self.random.pose(1.0);
        attachment.with_offset(offset)
    }

    fn spawn(&mut self) {
        if self.cloths.len() >= MOST {
            return self.despawn();
        }
        let (mesh, lods) = (self.mesh(), self.lods());
        let place = self.random.pose(4.0);
        let cloth = self.app.world_mut().spawn((mesh, lods, place)).id();
        if self.random.below(4) > 0 {
            let attachment = self.attachment();
            self.app.world_mut().entity_mut(cloth).insert(attachment);
        }
        if self.random.below(2) == 0 {
            self.app.world_mut().entity_mut(cloth).insert(ClothSurface::default());
        }
        if self.random.below(4) == 0 {
            self.app.world_mut().entity_mut(cloth).insert(ClothPreroll::seconds(0.5));
        }
        self.cloths.push(cloth);
    }

    fn despawn(&mut self) {
        if self.cloths.is_empty() {
            return;
        }
        let index = self.random.below(self.cloths.len());
        let cloth = self.cloths.swap_remove(index);
        self.app.world_mut().despawn(cloth);
    }

    fn spawn_pole(&mut self) {
        if self.poles.len() >= MOST {
            let index = self.random.below(self.poles.len());
            let pole = self.poles.swap_remove(index);
            self.app.world_mut().despawn(pole);
            // A cloth that is a child of the pole is despawned with it.
            let world = self.app.world();
            self.cloths.retain(|&cloth| world.get_entity(cloth).is_ok());
            self.poles.retain(|&pole| world.get_entity(pole).is_ok());
            return;
        }
        let place = self.random.pose(4.0);
        self.poles.push(self.app.world_mut().spawn(place).id());
    }

    /// Changes a component of a cloth. Returns a name of the change.
    fn change(&mut self, cloth: Entity) -> &'static str {
        let action = self.random.below(14);
        let attachment = self.attachment();
        let (mesh, lods, held) = (self.mesh(), self.lods(), self.held());
        let pole = self.random.one_of(&self.poles.clone());
        let offset = self.random.pose(1.0);
        let mut entity = self.app.world_mut().entity_mut(cloth);
        match action {
            0 => {
                entity.insert(attachment);
            }
            1 => {
                entity.remove::<Attachment>();
            }
            2 => {
                if let Some(mut attachment) = entity.get_mut::<Attachment>() {
                    attachment.offset = offset;
                }
            }
            3 => {
                if let Some(mut attachment) = entity.get_mut::<Attachment>() {
                    attachment.vertices = held;
                }
            }
            4 => {
                entity.insert(mesh);
            }
            5 => {
                entity.insert(lods);
            }
            6 => {
                entity.insert(ClothPaused);
            }
            7 => {
                entity.remove::<ClothPaused>();
            }
            8 => {
                let material = FabricMaterial { damping: 0.5, ..FabricMaterial::SILK };
                entity.insert(ClothMaterial(material));
            }
            9 => {
                entity.insert(ClothPreroll::seconds(0.2));
            }
            10 => match pole {
                Some(pole) => {
                    entity.insert(ChildOf(pole));
                }
                None => {
                    entity.remove::<ChildOf>();
                }
            },
            11 => {
                let mode = TeleportMode::Reset;
                self.app.world_mut().trigger(TeleportCloth { entity: cloth, mode });
            }
            12 => {
                let mode = TeleportMode::Keep;
                self.app.world_mut().trigger(TeleportCloth { entity: cloth, mode });
            }
            _ if self.cloths.len() < MOST => {
                let clone = entity.clone_and_spawn();
                self.cloths.push(clone);
            }
            _ => {}
        }
        const NAMES: [&str; 14] = [
            "attach", "detach", "offset", "hold", "mesh", "levels", "pause", "resume", "material",
            "preroll", "child", "reset", "teleport", "clone",
        ];
        NAMES[action]
    }

    fn move_something(&mut self) {
        let all: Vec<Entity> = self.poles.iter().chain(&self.cloths).copied().collect();
        let Some(moved) = self.random.one_of(&all) else { return };
        // The pole walks, jumps by less than a teleport, or teleports.
        let reach = [0.01, 0.2, 10.0][self.random.below(3)];
        let by = self.random.vector(reach);
        let turn = self.random.pose(0.0).rotation;
        let turns = self.random.below(4) == 0;
        if let Some(mut place) = self.app.world_mut().get_mut::<Transform>(moved) {
            place.translation += by;
            if turns {
                place.rotation = turn;
            }
        }
    }

    /// Changes something that acts on all cloths.
    fn surround(&mut self) {
        match self.random.below(5) {
            0 if self.others.len() < MOST && self.is_rough => {
                let shape = match self.random.below(3) {
                    0 => ClothCollider { features: true, ..ClothCollider::ball(0.5) },
                    1 => ClothCollider::cuboid(Vec3::new(0.5, 0.2, 0.3)),
                    _ => ClothCollider { margin: 0.01, ..ClothCollider::capsule(0.4, 0.2) },
                };
                let place = self.random.pose(3.0);
                self.others.push(self.app.world_mut().spawn((shape, place)).id());
            }
            1 if self.others.len() < MOST => {
                let wind = WindField::steady(self.random.vector(3.0)).with_gusts(1.0, 0.5, 2);
                self.others.push(self.app.world_mut().spawn(wind).id());
            }
            2 => {
                let lanes = [None, Some(LaneCount::One), Some(LaneCount::Eight)];
                let lanes = lanes[self.random.below(3)];
                self.app.world_mut().resource_mut::<ClothSettings>().lanes = lanes;
            }
            3 => {
                let frame = [0, 3, 15, 16, 31, 60][self.random.below(6)];
                let frame = TimeUpdateStrategy::ManualDuration(Duration::from_millis(frame));
                self.app.insert_resource(frame);
            }
            _ if !self.others.is_empty() => {
                let index = self.random.below(self.others.len());
                let other = self.others.swap_remove(index);
                self.app.world_mut().despawn(other);
            }
            _ => {}
        }
    }

    fn act(&mut self) {
        let done = match self.random.below(12) {
            0 | 1 => {
                self.spawn();
                "spawn"
            }
            2 => {
                self.despawn();
                "despawn"
            }
            3 => {
                self.spawn_pole();
                "pole"
            }
            4..=6 => {
                self.move_something();
                "move"
            }
            7 => {
                self.surround();
                "surround"
            }
            _ => match self.random.one_of(&self.cloths.clone()) {
                Some(cloth) => self.change(cloth),
                None => "nothing",
            },
        };
        self.log.push(done.to_owned());
        for _ in 0..self.random.below(4) {
            self.app.update();
        }
    }

    fn check(&self, context: &str) {
        for &cloth in &self.cloths {
            let state = state(&self.app, cloth);
            if state.positions().is_empty() {
                continue;
            }
            let finite = state.positions().iter().chain(state.normals()).all(|at| at.is_finite());
            assert!(finite, "{context}: {cloth} is not finite");
            if self.is_rough {
                continue;
            }
            let stretch = greatest(stretches(&self.app, cloth));
            let last = &self.log[self.log.len().saturating_sub(12)..];
            assert!(stretch < STRETCH, "{context}: {cloth} is stretched to {stretch}: {last:?}");
        }
    }
}

#[test]
fn anything_may_be_done_in_any_order() {
    for seed in 0..RUNS {
        let mut playground = Playground::new(seed);
        for action in 0..ACTIONS {
            playground.act();
            playground.check(&format!("seed {seed}, action {action}"));
        }
    }
}
