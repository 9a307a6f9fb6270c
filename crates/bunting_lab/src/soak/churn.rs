//! Cloths that come and go, and whose levels, layers, materials and targets change meanwhile.

use std::collections::VecDeque;

use bevy_app::App;
use bevy_bunting::{
    Attachment, ClothCollider, ClothEdge, ClothLayers, ClothMaterial, ClothMesh, ClothPaused,
    LodSet, SelfCollision,
};
use bevy_ecs::entity::Entity;
use bevy_transform::components::Transform;
use bunting_solver::FabricMaterial;
use glam::{Vec2, Vec3};

use super::scenes;
use crate::{heap, meshes::Random};

/// Greatest numbers of cloths and of poles.
const CLOTHS: usize = 40;
const POLES: usize = 12;
/// Ticks after which nothing is kept of cloths that are gone: a little more than ten seconds.
const RELEASED: usize = 700;

/// Cloths, the oldest first, and what holds them.
pub struct Churn {
    random: Random,
    cloths: VecDeque<Entity>,
    poles: VecDeque<Entity>,
    /// Number of cloths so far.
    pub spawned: usize,
}

impl Churn {
    /// An app with gusts and a collider, and no cloth.
    pub fn new() -> (App, Self) {
        let mut app = scenes::app();
        scenes::gusts(&mut app, 4.0);
        let below = Transform::from_xyz(0.0, -1.2, 0.0);
        app.world_mut().spawn((ClothCollider::cuboid(Vec3::new(9.0, 0.2, 9.0)), below));
        let random = Random::of_seed(0);
        (app, Self { random, cloths: VecDeque::new(), poles: VecDeque::new(), spawned: 0 })
    }

    /// A cloth comes, the oldest one goes, or one is changed.
    pub fn act(&mut self, app: &mut App) {
        match self.random.below(10) {
            0..5 => self.spawn(app),
            5 => self.spawn_pole(app),
            _ => self.change(app),
        }
    }

    /// Despawns all cloths, and returns the bytes on the heap when nothing of them has to be kept any more.
    pub fn heap_without_cloth(&mut self, app: &mut App) -> usize {
        for entity in self.cloths.drain(..).chain(self.poles.drain(..)) {
            app.world_mut().despawn(entity);
        }
        (0..RELEASED).for_each(|_| app.update());
        heap::in_use()
    }

    fn spawn(&mut self, app: &mut App) {
        if self.cloths.len() == CLOTHS
            && let Some(oldest) = self.cloths.pop_front()
        {
            app.world_mut().despawn(oldest);
        }
        let (mesh, lods) = (self.mesh(), self.lods());
        let held = self.attachment();
        let place = Transform::from_translation(self.place());
        let mut cloth = app.world_mut().spawn((mesh, lods, place));
        if self.random.below(8) > 0 {
            cloth.insert(held);
        }
        if self.random.below(8) == 0 {
            cloth.insert(SelfCollision { thickness: 5e-3, levels: 1 });
        }
        self.cloths.push_back(cloth.id());
        self.spawned += 1;
    }

    /// Some sizes come again, others are new: their fabrics have to be released.
    fn mesh(&mut self) -> ClothMesh {
        let width = [1.0, 1.5, 1.0 + 1e-4 * self.spawned as f32][self.random.below(3)];
        match self.random.below(6) {
            0 => triangles(width),
            1 => ClothMesh::grid(17, 17, width, 1.0),
            2 => ClothMesh::grid(9, 17, width, 1.0),
            _ => ClothMesh::grid(9, 9, width, 1.0),
        }
    }

    fn lods(&mut self) -> LodSet {
        let levels = LodSet::new([20.0, 40.0]);
        match self.random.below(4) {
            0 => LodSet::automatic(3),
            pinned => levels.pinned_to(pinned - 1),
        }
    }

    fn place(&mut self) -> Vec3 {
        let [x, y, z] = [(); 3].map(|()| self.random.within(-4.0, 4.0) as f32);
        Vec3::new(x, 0.1 * y, z)
    }

    fn attachment(&mut self) -> Attachment {
        let edge = [ClothEdge::Left, ClothEdge::Top, ClothEdge::Right][self.random.below(3)];
        match self.poles.len() {
            0 => Attachment::in_place(edge),
            poles => Attachment::new(self.poles[self.random.below(poles)], edge),
        }
    }

    fn spawn_pole(&mut self, app: &mut App) {
        if self.poles.len() == POLES
            && let Some(oldest) = self.poles.pop_front()
        {
            app.world_mut().despawn(oldest);
        }
        let place = Transform::from_translation(self.place());
        self.poles.push_back(app.world_mut().spawn(place).id());
    }

    fn change(&mut self, app: &mut App) {
        if self.cloths.is_empty() {
            return;
        }
        let cloth = self.cloths[self.random.below(self.cloths.len())];
        let (lods, held) = (self.lods(), self.attachment());
        let layers = ClothLayers::new(1 << self.random.below(4), u32::MAX);
        let materials = [FabricMaterial::SILK, FabricMaterial::DENIM, FabricMaterial::COTTON];
        let material = ClothMaterial(materials[self.random.below(3)]);
        let kind = self.random.below(7);
        let mut cloth = app.world_mut().entity_mut(cloth);
        match kind {
            0 | 1 => cloth.insert(lods),
            2 => cloth.insert(layers),
            3 => cloth.insert(held),
            4 => cloth.insert(material),
            5 => cloth.insert(ClothPaused),
            _ => cloth.remove::<ClothPaused>(),
        };
    }
}

/// A sheet of triangles that is no rectangle, so that it becomes a net.
fn triangles(width: f32) -> ClothMesh {
    /// Columns and rows of cells.
    const SIZE: u32 = 8;
    let grid = (0..=SIZE).flat_map(|row| (0..=SIZE).map(move |column| [column, row]));
    let places: Vec<Vec2> = grid
        .map(|cell| cell.map(|it| it as f32 / SIZE as f32))
        .map(|[u, v]| Vec2::new(width * u * (1.0 - 0.3 * v), v))
        .collect();
    let cells = (0..SIZE * SIZE).map(|cell| cell / SIZE * (SIZE + 1) + cell % SIZE);
    let corners = cells.flat_map(|at| {
        let below = at + SIZE + 1;
        [at, below, at + 1, at + 1, below, below + 1]
    });
    let positions = places.iter().map(|at| Vec3::new(at.x, -at.y, 0.0)).collect();
    ClothMesh::triangles(positions, corners.collect(), places)
}
