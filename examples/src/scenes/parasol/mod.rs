//! Parasols in the wind, of which only the moving parts are simulated.

mod canopy;
#[cfg(feature = "render")]
mod draw;
mod stand;

use std::f32::consts::TAU;

use crate::limits::{Limit, greatest};
use crate::scenes::parasol::stand::{HEIGHT, Parasol};
use crate::{OrbitExample, View};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

/// Feet of the parasols, m, and the colour of every second panel.
const PARASOLS: [(Vec3, [u8; 3]); 3] = [
    (Vec3::new(0.0, 0.0, 0.0), [196, 52, 44]),
    (Vec3::new(-3.9, 0.0, -2.6), [36, 86, 140]),
    (Vec3::new(3.6, 0.0, -3.4), [222, 160, 40]),
];

/// Colour of the other panels.
const CREAM: [u8; 3] = [238, 232, 214];

/// Cotton canvas: heavier and stiffer than clothes.
const CANVAS: FabricMaterial =
    FabricMaterial { area_density: 0.32, bend_stiffness: 6e-5, ..FabricMaterial::COTTON };

/// Amplitude of a parasol's sway, rad.
const SWAY: f32 = 0.02;

/// Frequency of a parasol's sway, 1/s.
const SWAY_FREQUENCY: f32 = 0.7;

/// Parasols in the wind.
#[derive(Clone, Copy, Debug)]
pub struct Parasols;

impl OrbitExample for Parasols {
    const NAME: &'static str = "Parasol";
    const SECONDS: f64 = 12.0;
    const VIEW: View = View { eye: Vec3::new(1.0, 2.45, 3.9), centre: Vec3::new(-0.15, 1.75, 0.0) };

    fn build(app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, sway);
        let mut commands = app.world_mut().commands();
        commands.spawn(WindField::steady(Vec3::new(2.4, 0.0, -0.6)).with_gusts(1.8, 0.6, 4));
        for (foot, colour) in PARASOLS {
            let parasol = commands.spawn((Parasol, Transform::from_translation(foot))).id();
            commands.spawn(cloth(parasol, colour));
        }
    }

    /// Distances of vertices from their rest positions: 0 if rigid, and bounded if simulated.
    fn measure(world: &mut World) -> Vec<Limit> {
        let [mut rigid, mut simulated] = [0.0_f32; 2];
        for (state, mesh) in world.query::<(&ClothState, &ClothMesh)>().iter(world) {
            let ClothMesh::Triangles { positions, weights, .. } = mesh else { continue };
            for (vertex, (rest, weight)) in (0..).zip(positions.iter().zip(weights)) {
                let Some(at) = state.vertex_position(vertex) else { continue };
                let distance = rest.distance(at);
                let worst = if *weight == 0.0 { &mut rigid } else { &mut simulated };
                *worst = greatest([*worst, distance]);
            }
        }
        vec![
            // Those on the border to what is simulated lie between particles: to within rounding.
            Limit { name: "distance of rigid vertices from rest, m", value: rigid, limit: 1e-5 },
            // A valance that is turned inside out is at twice its length from rest.
            Limit {
                name: "distance of simulated vertices from rest, m",
                value: simulated,
                limit: 2.0 * canopy::VALANCE,
            },
        ]
    }

    #[cfg(feature = "render")]
    fn draw(app: &mut App) {
        app.add_plugins(draw::plugin);
    }
}

fn cloth(parasol: Entity, colour: [u8; 3]) -> impl Bundle {
    let panels = (0..canopy::RIBS).map(|panel| if panel % 2 == 0 { colour } else { CREAM });
    (
        canopy::mesh(),
        // Three or four cells from the rim to the hem.
        ClothResolution::CellSize(0.06),
        ClothMaterial(CANVAS),
        LodSet::new([14.0]),
        // The vertices on the ribs have weight 0.
        Attachment::new(parasol, AttachedVertices::Rigid)
            .with_offset(Transform::from_xyz(0.0, HEIGHT, 0.0)),
        Design::Pales(panels.collect()),
    )
}

/// Sways the parasols: rigid vertices move with them.
fn sway(mut parasols: Query<&mut Transform, With<Parasol>>, time: Res<Time>) {
    for mut parasol in &mut parasols {
        let phase = TAU * SWAY_FREQUENCY * time.elapsed_secs() + parasol.translation.x;
        parasol.rotation = Quat::from_euler(
            EulerRot::XYZ,
            0.5 * SWAY * (0.6 * phase).sin(),
            0.0,
            -SWAY * (1.0 + phase.sin()),
        );
    }
}
