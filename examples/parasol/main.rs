//! Parasols in the wind, of which only what moves is simulated.
//!
//! `cargo run --release --example parasol` shows them; drag to look around, scroll to come closer.
//! Look at the valance, which flutters, at the panels between the ribs, which billow, and at the
//! middle of the canopy, which is rigid: its weights are 0, and it costs nothing. Between the two
//! there is no seam to be seen. The keys are those of the example `flags`.
//!
//! `cargo run --release --example parasol -- --headless` simulates them as fast as it goes and prints
//! what it cost; with `--pictures DIR` it writes pictures.

mod canopy;
mod frame;

use std::f32::consts::TAU;
use std::process::ExitCode;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::show::{Check, Show};

/// Height of the top of the canopy, m.
const HEIGHT: f32 = 2.5;

/// Where the parasols stand, m, and the colour of every second panel.
const PARASOLS: [(Vec3, [u8; 3]); 3] = [
    (Vec3::new(0.0, 0.0, 0.0), [196, 52, 44]),
    (Vec3::new(-3.9, 0.0, -2.6), [36, 86, 140]),
    (Vec3::new(3.6, 0.0, -3.4), [222, 160, 40]),
];

/// Cotton canvas: heavier and stiffer than what clothes are made of.
const CANVAS: FabricMaterial =
    FabricMaterial { area_density: 0.32, bend_stiffness: 6e-5, ..FabricMaterial::COTTON };

/// How far a gust turns a parasol, rad.
const SWAY: f32 = 0.02;

/// How often it sways, 1/s.
const SWAYS: f32 = 0.7;

/// A parasol, with its foot on the ground; and the colour of every second panel.
#[derive(Component, Clone, Copy, Debug)]
struct Parasol {
    colour: [u8; 3],
}

/// The cloth of a parasol.
#[derive(Component, Clone, Copy, Debug)]
struct Canopy(Parasol);

fn main() -> ExitCode {
    let show = Show {
        name: env!("CARGO_BIN_NAME"),
        build,
        dress: |app| {
            app.add_plugins(frame::plugin);
        },
        eye: Vec3::new(1.0, 2.45, 3.9),
        looks_at: Vec3::new(-0.15, 1.75, 0.0),
        check,
    };
    show.main()
}

/// Wind, parasols and their cloth.
fn build(app: &mut App) {
    app.add_systems(FixedUpdate, sway);
    let mut commands = app.world_mut().commands();
    commands.spawn(WindField::steady(Vec3::new(2.4, 0.0, -0.6)).with_gusts(1.8, 0.6, 4));
    for (foot, colour) in PARASOLS {
        let parasol = Parasol { colour };
        let stand = commands.spawn((parasol, Transform::from_translation(foot))).id();
        commands.spawn((
            Canopy(parasol),
            canopy::mesh(),
            ClothMaterial(CANVAS),
            LodSet::new([14.0]),
            // What is sewn to the ribs has weight 0.
            Attachment::new(stand, AttachedVertices::Rigid)
                .with_offset(Transform::from_xyz(0.0, HEIGHT, 0.0)),
        ));
    }
}

/// Sways the parasols: what is rigid goes with them.
fn sway(mut parasols: Query<&mut Transform, With<Parasol>>, time: Res<Time>) {
    for mut stand in &mut parasols {
        let phase = TAU * SWAYS * time.elapsed_secs() + stand.translation.x;
        stand.rotation = Quat::from_euler(
            EulerRot::XYZ,
            0.5 * SWAY * (0.6 * phase).sin(),
            0.0,
            -SWAY * (1.0 + phase.sin()),
        );
    }
}

/// Cloth is where it belongs.
fn check(world: &mut World) -> Vec<Check> {
    let (mut off, mut fallen) = (0.0_f32, 0.0_f32);
    for (state, mesh) in world.query::<(&ClothState, &ClothMesh)>().iter(world) {
        let ClothMesh::Triangles { positions, weights, .. } = mesh else { continue };
        for (vertex, (rest, weight)) in (0..).zip(positions.iter().zip(weights)) {
            let Some(particle) = state.particle_of_vertex(vertex) else { continue };
            let distance = rest.distance(state.positions()[particle]);
            let worst = if *weight == 0.0 { &mut off } else { &mut fallen };
            *worst = worst.max(distance);
        }
    }
    vec![
        Check { what: "what is rigid, off its place, m", value: off, limit: 0.0 },
        // The valance can be turned inside out, and not more.
        Check { what: "cloth, off its place, m", value: fallen, limit: 2.0 * canopy::VALANCE },
    ]
}
