//! Towels that fold on themselves: one over a rail, one on the floor.

#[cfg(feature = "render")]
mod draw;
mod rail;

use std::f32::consts::FRAC_PI_2;

use crate::limits::{Limit, greatest};
use crate::scenes::towel::rail::{RAIL, RAIL_SIZE};
use crate::strain::greatest_mean;
use crate::{OrbitExample, View};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

/// Extents of a towel, m.
const TOWEL: Vec2 = Vec2::new(0.5, 1.0);

/// Particles along the edges of a towel.
const PARTICLES: [u32; 2] = [21, 41];

/// Distance that layers keep, m.
const LAYERS: f32 = 5e-3;

/// Height from which the towels fall, m: onto the rail, and onto the floor.
const DROPS: [f32; 2] = [0.05, 0.05];

/// Angle by which the second towel leans, rad.
const LEAN: f32 = 0.08;

/// Least number of substeps in a second. Fewer: in each substep the weight presses the layers of a heap into one another, as
/// far as it falls in a substep, and moving them apart again strains the links. With 120 the towel on the floor is strained
/// by 2 % at rest.
const SUBSTEP_RATE: u32 = 720;

/// Limit of the mean strain of each towel: larger strain would be visible.
const STRAIN_LIMIT: f32 = 0.01;

/// Limit of the part of [`LAYERS`] that particles of different layers are too near.
const NEARNESS_LIMIT: f32 = 0.7;

/// Two towels.
#[derive(Clone, Copy, Debug)]
pub struct Towels;

impl OrbitExample for Towels {
    const NAME: &'static str = "Towel";
    const SECONDS: f64 = 6.0;
    const VIEW: View = View { eye: Vec3::new(0.4, 1.1, 1.8), centre: Vec3::new(-0.1, 0.5, 0.0) };

    fn build(app: &mut App, _schedule: impl ScheduleLabel) {
        let finest = StepLimits { rate: SUBSTEP_RATE, ..StepLimits::default() };
        app.insert_resource(ClothSettings { steps: vec![finest], ..ClothSettings::default() });
        let mut commands = app.world_mut().commands();
        commands.spawn((ClothCollider::ground(), Transform::default()));
        let along_rail = Quat::from_rotation_z(FRAC_PI_2);
        // The rail is thinner than the towel's mesh is wide.
        let rail =
            ClothCollider { features: true, ..ClothCollider::capsule(RAIL_SIZE[0], RAIL_SIZE[1]) };
        commands.spawn((rail, Transform::from_translation(RAIL).with_rotation(along_rail)));
        // One lies level above the rail, a little askew and off its middle; one stands on its edge.
        let turn = Quat::from_rotation_y(0.06) * Quat::from_rotation_x(-FRAC_PI_2);
        let corner = turn * Vec3::new(-0.5 * TOWEL.x, 0.46 * TOWEL.y, 0.0);
        let above = RAIL + DROPS[0] * Vec3::Y + corner;
        let level = Transform::from_translation(above).with_rotation(turn);
        let standing = Transform::from_xyz(0.1, TOWEL.y + DROPS[1], 0.0)
            .with_rotation(Quat::from_rotation_x(LEAN));
        for (place, stripe) in [(level, [52, 104, 160]), (standing, [200, 90, 50])] {
            commands.spawn((
                ClothMesh::grid(PARTICLES[0], PARTICLES[1], TOWEL.x, TOWEL.y),
                ClothMaterial(FabricMaterial { area_density: 0.35, ..FabricMaterial::COTTON }),
                SelfCollision { thickness: LAYERS, ..default() },
                LodSet { pinned: Some(0), ..default() },
                place,
                Design::Chequers { colours: [[238, 236, 230], stripe], rows: 12 },
            ));
        }
    }

    /// Strain of the towels, and how much too near particles of their layers are.
    fn measure(world: &mut World) -> Vec<Limit> {
        let mut nearness = 0.0_f32;
        for state in world.query::<&ClothState>().iter(world) {
            let Some(fabric) = state.fabric() else { continue };
            nearness =
                greatest([nearness, 1.0 - nearest(state.positions(), fabric.rest_positions())]);
        }
        vec![
            Limit {
                name: "mean strain of a towel",
                value: greatest_mean(world),
                limit: STRAIN_LIMIT,
            },
            Limit {
                name: "part of the layers' distance that is lacking",
                value: nearness,
                limit: NEARNESS_LIMIT,
            },
        ]
    }

    #[cfg(feature = "render")]
    fn draw(app: &mut App) {
        app.add_plugins(draw::plugin);
    }
}

/// Distance of the two particles of different layers that are nearest to each other, as a part of [`LAYERS`].
fn nearest(positions: &[Vec3], rest: &[Vec3]) -> f32 {
    /// Distance at rest from which on particles may be in different layers, m.
    const APART: f32 = 0.1;
    let mut least = 1.0_f32;
    for (index, (at, at_rest)) in positions.iter().zip(rest).enumerate() {
        for (other, other_at_rest) in positions[..index].iter().zip(rest) {
            let distance = at.distance(*other) / LAYERS;
            if distance < least && at_rest.distance(*other_at_rest) > APART {
                least = distance;
            }
        }
    }
    least
}
