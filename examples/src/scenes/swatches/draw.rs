//! Draws the cloths, their rail, and posts behind them.

use std::f32::consts::FRAC_PI_2;

use bevy::light::TransmittedShadowReceiver;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::render::stage::{self, Stage};
use crate::scenes::swatches::rail::{RAIL, SPACING};
use crate::scenes::swatches::swatch::{SIZE, Swatch};

/// A low sun behind the cloths.
pub const STAGE: Stage =
    Stage { sun: Vec3::new(-0.45, 0.55, -1.0), shadows: [3.0, 12.0], ..Stage::SMALL };

/// Radius of the rail, m.
const RADIUS: f32 = 0.008;

/// Distance of the posts behind the cloths, m, and their radius.
const BEHIND: f32 = 0.25;
const POST: f32 = 0.012;

/// Weaves the cloths, and draws what stands around them.
pub fn plugin(app: &mut App) {
    app.add_plugins(WeavePlugin).add_systems(PostStartup, (weave, draw_bars));
}

fn weave(
    mut commands: Commands,
    swatches: Query<(Entity, &Swatch)>,
    mut materials: ResMut<Assets<WovenMaterial>>,
) {
    for (entity, swatch) in &swatches {
        let base = StandardMaterial {
            base_color: Color::srgb_from_array(swatch.colour),
            diffuse_transmission: swatch.transmission,
            ..stage::cloth()
        };
        let weave =
            Weave { relief: swatch.relief, gaps: swatch.gaps, ..Weave::new(SIZE, swatch.threads) };
        let woven = MeshMaterial3d(materials.add(weave.on(base)));
        commands.entity(entity).insert((woven, TransmittedShadowReceiver));
    }
}

fn draw_bars(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let paint = materials.add(stage::paint());
    let along_x = Quat::from_rotation_z(FRAC_PI_2);
    let rail = Mesh3d(meshes.add(Cylinder::new(RADIUS, 3.0 * SPACING + 0.1)));
    let at = Transform::from_xyz(0.0, RAIL + RADIUS, 0.0).with_rotation(along_x);
    commands.spawn((rail, MeshMaterial3d(paint.clone()), at));
    let post = Mesh3d(meshes.add(Cylinder::new(POST, RAIL)));
    for x in [-2.0, -1.0, 0.0, 1.0] {
        let at = Transform::from_xyz(x * SPACING, 0.5 * RAIL, -BEHIND);
        commands.spawn((post.clone(), MeshMaterial3d(paint.clone()), at));
    }
}
