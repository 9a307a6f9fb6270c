//! A flag in the wind above shapes of many parts that it does not come near: a program that compares the times of its
//! ticks with those of a flag without shapes.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example distant_shapes
//! ```

use bevy_app::App;
use bevy_bunting::parry3d::math::Pose;
use bevy_bunting::parry3d::shape::{HeightField, SharedShape, TriMesh};
use bevy_bunting::parry3d::utils::Array2;
use bevy_bunting::{Attachment, ClothCollider, ClothEdge, ClothMesh, ClothTimings, WindField};
use bevy_transform::components::Transform;
use bunting_lab::game;
use bunting_solver::StepSettings;
use glam::{Quat, Vec3};

/// Updates before anything is measured.
const WARM_UP: usize = 30;

const TICKS: usize = 300;

/// Height of the flag, m.
const HEIGHT: f32 = 5.0;

/// A bowl of 200 m with its lowest point at the origin.
fn bowl(cells: usize) -> HeightField {
    let at = |index: usize| 200.0 * (index as f32 / cells as f32 - 0.5);
    let mut heights = Array2::zeros(cells + 1, cells + 1);
    for row in 0..=cells {
        for column in 0..=cells {
            heights[(row, column)] = (at(row).powi(2) + at(column).powi(2)) / 400.0;
        }
    }
    HeightField::new(heights, Vec3::new(200.0, 1.0, 200.0))
}

fn mesh() -> SharedShape {
    let (points, triangles) = bowl(64).to_trimesh();
    SharedShape::new(TriMesh::new(points, triangles).expect("a bowl is a mesh"))
}

/// A hundred boxes in a ring around the flag.
fn ring() -> SharedShape {
    let boxes = (0..100).map(|index| {
        let turn = Quat::from_rotation_y(index as f32 / 100.0 * core::f32::consts::TAU);
        let place = Pose::from_parts(turn * Vec3::new(20.0, HEIGHT, 0.0), turn);
        (place, SharedShape::cuboid(0.5, 5.0, 0.5))
    });
    SharedShape::compound(boxes.collect())
}

fn app(shape: Option<SharedShape>) -> App {
    let mut app = game::app_in_still_air([StepSettings::default()]);
    let world = app.world_mut();
    world.spawn(WindField::steady(Vec3::new(5.0, 0.0, 1.0)));
    world.spawn((
        ClothMesh::grid(17, 17, 1.5, 1.0),
        Attachment::in_place(ClothEdge::Left),
        Transform::from_xyz(0.0, HEIGHT, 0.0),
    ));
    if let Some(shape) = shape {
        world.spawn((ClothCollider::new(shape), Transform::default()));
    }
    app
}

fn main() {
    let field = |cells| SharedShape::new(bowl(cells));
    let shapes = [
        ("no shape", None),
        ("heightfield of 16²", Some(field(16))),
        ("heightfield of 64²", Some(field(64))),
        ("heightfield of 256²", Some(field(256))),
        ("mesh of 64²", Some(mesh())),
        ("ring of boxes", Some(ring())),
    ];
    let names = shapes.each_ref().map(|(name, _)| *name);
    let mut apps = shapes.map(|(_, shape)| app(shape));
    for app in &mut apps {
        (0..WARM_UP).for_each(|_| app.update());
    }
    let times = game::time_in_turn(&mut apps, TICKS, |app| {
        app.world().resource::<ClothTimings>().total().as_secs_f64() * 1e6
    });
    for (name, times) in names.iter().zip(&times) {
        println!("{name}: least {:.1} µs, median {:.1} µs", times.min(), times.median());
    }
}
