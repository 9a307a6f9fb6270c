//! The scenes: each lets another part of the plugin run.

use std::{f32::consts::FRAC_PI_2, time::Duration};

use bevy_app::{App, FixedUpdate};
use bevy_bunting::{
    AttachedVertices, Attachment, ClothBudget, ClothCollider, ClothCollision, ClothEdge,
    ClothInertia, ClothMaterial, ClothMesh, ClothPressure, ClothResolution, ClothSettings, LodSet,
    LodViewer, SelfCollision, WindField, WindWake,
};
use bevy_ecs::entity::Entity;
use bevy_transform::components::Transform;
use bunting_solver::FabricMaterial;
use glam::{Quat, Vec3};

use crate::{
    game,
    meshes::{ball_with_poles, clothes::disk},
    product::TICK,
};

/// An app, and what moves in it before each update, by the number of the tick.
pub type SoakScene = (App, Box<dyn FnMut(&mut App, u32)>);

/// Makes a scene.
pub type Make = fn() -> SoakScene;

/// All of them, by their names.
pub const ALL: [(&str, Make); 6] = [
    ("flags, two on vehicles", flags),
    ("field with a flying camera", field),
    ("flags that are swung", swung),
    ("nets in gusts", nets),
    ("sheets on a table", sheets),
    ("cushions", cushions),
];

/// The scene of the example `flags`.
const FLAGS: &str = include_str!("../../../../assets/scenes/flags.ron");

/// An app with the plugin's own settings.
pub(super) fn app() -> App {
    let mut app = game::app_in_still_air([]);
    app.insert_resource(ClothSettings::default());
    app
}

/// Gusts about a mean wind, m/s.
pub(super) fn gusts(app: &mut App, speed: f32) {
    let mean = speed * Vec3::new(1.0, 0.0, 0.3).normalize();
    app.world_mut().spawn(WindField::steady(mean).with_gusts(0.5 * speed, 0.5, 1));
}

fn still(app: App) -> SoakScene {
    (app, Box::new(|_, _| {}))
}

fn flags() -> SoakScene {
    let scene = bunting_scenes::parse(FLAGS, "flags.ron".as_ref()).expect("a good scene");
    let mut app = app();
    app.add_systems(FixedUpdate, bunting_scenes::follow_tracks);
    bunting_scenes::spawn(&mut app.world_mut().commands(), &scene);
    still(app)
}

/// A hundred flags whose levels the governor chooses, with measured costs.
fn field() -> SoakScene {
    /// Flags in a row, and their distance, m.
    const SIDE: usize = 10;
    const APART: f32 = 4.0;
    /// Radius of the camera's path, m, and its angular speed, rad/s.
    const PATH: f32 = 15.0;
    const TURN: f32 = 0.4;
    let mut app = app();
    gusts(&mut app, 6.0);
    app.world_mut().resource_mut::<ClothBudget>().tick = Duration::from_millis(2);
    for flag in 0..SIDE * SIDE {
        let [row, column] = [flag / SIDE, flag % SIDE].map(|it| APART * it as f32 - 18.0);
        game::spawn_flag(&mut app, 33, Vec3::new(column, 0.0, row), LodSet::automatic(3));
    }
    let camera = app.world_mut().spawn((LodViewer::default(), Transform::default())).id();
    let fly = move |app: &mut App, tick: u32| {
        let (sin, cos) = libm::sincosf(TURN * TICK * tick as f32);
        let pose = Transform::from_xyz(PATH * cos, 1.0, PATH * sin);
        place(app, camera, pose.looking_to(Vec3::new(-sin - 0.4 * cos, 0.0, cos), Vec3::Y));
    };
    (app, Box::new(fly))
}

/// Flags on a pole that swings, one of which does not feel all of it, in the wake of the pole.
fn swung() -> SoakScene {
    let mut app = app();
    gusts(&mut app, 3.0);
    let pole = app.world_mut().spawn((Transform::default(), WindWake::new(5.0))).id();
    for inertia in [1.0, 0.4] {
        app.world_mut().spawn((
            ClothMesh::grid(25, 17, 1.5, 1.0),
            Attachment::new(pole, ClothEdge::Left),
            ClothInertia::new(inertia, inertia),
        ));
    }
    let swing = move |app: &mut App, tick: u32| {
        let time = TICK * tick as f32;
        let at = Vec3::new(2.0 * libm::sinf(1.7 * time), 0.3 * libm::sinf(4.1 * time), 0.0);
        let turn = Quat::from_rotation_y(1.5 * libm::sinf(0.9 * time));
        place(app, pole, Transform::from_translation(at).with_rotation(turn));
    };
    (app, Box::new(swing))
}

/// Disks of triangles that are simulated as nets.
fn nets() -> SoakScene {
    let mut app = app();
    gusts(&mut app, 5.0);
    let disk = disk(0.5, 400);
    let held = (0..).zip(&disk.is_held).filter(|(_, is_held)| **is_held).map(|(vertex, _)| vertex);
    let held: Vec<u32> = held.collect();
    for index in 0..4 {
        app.world_mut().spawn((
            ClothMesh::triangles(disk.positions.clone(), disk.indices.clone(), disk.uv.clone()),
            ClothResolution::Particles(400),
            Attachment::in_place(AttachedVertices::List(held.clone())),
            Transform::from_xyz(3.0 * index as f32, 0.0, 0.0),
        ));
    }
    still(app)
}

/// Two sheets, one upon the other, on a table and a ball that goes to and fro below them.
fn sheets() -> SoakScene {
    let mut app = app();
    let world = app.world_mut();
    let table = Transform::from_xyz(0.0, -0.55, 0.0);
    world.spawn((ClothCollider::cuboid(Vec3::new(0.3, 0.05, 0.3)), table));
    let ball = world.spawn((ClothCollider::ball(0.1), Transform::from_xyz(0.0, -0.45, 0.0))).id();
    for (size, height) in [(17, -0.2), (13, -0.1)] {
        let lies = Transform::from_xyz(-0.4, height, 0.4);
        world.spawn((
            ClothMesh::grid(size, size, 0.8, 0.8),
            ClothMaterial(FabricMaterial { damping: 1.0, ..FabricMaterial::COTTON }),
            lies.with_rotation(Quat::from_rotation_x(FRAC_PI_2)),
            SelfCollision { thickness: 5e-3, levels: 1 },
            ClothCollision { thickness: 5e-3, levels: 1 },
        ));
    }
    let roll = move |app: &mut App, tick: u32| {
        let along = 0.1 * libm::sinf(0.5 * TICK * tick as f32);
        place(app, ball, Transform::from_xyz(along, -0.45, 0.0));
    };
    (app, Box::new(roll))
}

/// Closed balls of cloth with air inside, on the ground.
fn cushions() -> SoakScene {
    let mut app = app();
    gusts(&mut app, 2.0);
    let ground = Transform::from_xyz(0.0, -0.4, 0.0);
    app.world_mut().spawn((ClothCollider::cuboid(Vec3::new(50.0, 0.1, 50.0)), ground));
    let ball = ball_with_poles(20, 10, 0.25);
    for index in 0..3 {
        let mesh =
            ClothMesh::triangles(ball.positions().to_vec(), ball.indices().to_vec(), Vec::new());
        // Held by a vertex on the ground: otherwise gusts roll it away.
        app.world_mut().spawn((
            mesh,
            ClothResolution::Particles(200),
            ClothPressure::sealed(40.0),
            Attachment::in_place(AttachedVertices::List(vec![0])),
            Transform::from_xyz(index as f32, 0.0, 0.0),
        ));
    }
    still(app)
}

fn place(app: &mut App, entity: Entity, at: Transform) {
    *app.world_mut().get_mut::<Transform>(entity).expect("it stays") = at;
}
