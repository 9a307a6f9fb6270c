//! A table, and a sheet that falls onto it.

use std::f32::consts::FRAC_PI_2;

use crate::limits::greatest;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

/// Half extents of the table top, m; its edges are round.
pub const TOP: Vec3 = Vec3::new(0.5, 0.03, 0.38);

/// Position of the middle of the top, m.
pub const CENTRE: Vec3 = Vec3::new(0.95, 0.74, 0.25);

/// Radius of the table's edges, m.
pub const ROUNDING: f32 = 0.028;

/// Additional distance between particles and the table, m: the sheet is straight between particles and would
/// cut the edges without it.
const MARGIN: f32 = 0.008;

/// Half the thickness of a leg, m.
const LEG: f32 = 0.025;

/// Distance of a leg's axis from the edges of the top, m.
const INSET: f32 = 0.07;

/// Extents of the sheet, m.
const SHEET: Vec2 = Vec2::new(1.7, 1.45);

/// Particles along the edges of the sheet.
const PARTICLES: (u32, u32) = (57, 49);

/// Height above the middle of the top from which the sheet falls, m.
const DROP: f32 = 0.12;

/// Angle between the sheet and the table, rad.
const ASKEW: f32 = 0.12;

/// The table top.
#[derive(Component, Clone, Copy, Debug)]
pub struct TableTop;

/// The sheet.
#[derive(Component, Clone, Copy, Debug)]
pub struct Sheet;

/// Spawns the table, the ground and the sheet.
pub fn spawn(commands: &mut Commands) {
    // A smaller box with a margin is a box with round edges.
    let top = ClothCollider {
        margin: ROUNDING + MARGIN,
        features: true,
        ..ClothCollider::cuboid(TOP - ROUNDING)
    };
    commands.spawn((TableTop, top, Transform::from_translation(CENTRE)));
    for (half, place) in legs() {
        let leg = ClothCollider { margin: MARGIN, features: true, ..ClothCollider::cuboid(half) };
        commands.spawn((leg, Transform::from_translation(place)));
    }
    commands.spawn((ClothCollider::ground(), Transform::default()));
    let turn = Quat::from_rotation_y(ASKEW) * Quat::from_rotation_x(-FRAC_PI_2);
    let corner = turn * Vec3::new(-0.5 * SHEET.x, 0.5 * SHEET.y, 0.0);
    commands.spawn((
        Sheet,
        Name::new("Tablecloth"),
        ClothMesh::grid(PARTICLES.0, PARTICLES.1, SHEET.x, SHEET.y),
        ClothMaterial(FabricMaterial { area_density: 0.2, ..FabricMaterial::COTTON }),
        Transform::from_translation(CENTRE + DROP * Vec3::Y + corner).with_rotation(turn),
        Design::Chequers { colours: [[236, 232, 222], [186, 58, 52]], rows: 16 },
    ));
}

/// Half extents and centre of each leg, m.
pub fn legs() -> [(Vec3, Vec3); 4] {
    let height = CENTRE.y - TOP.y;
    let half = Vec3::new(LEG, 0.5 * height, LEG);
    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(x, z)| {
        let (x, z) = (x * (TOP.x - INSET), z * (TOP.z - INSET));
        (half, Vec3::new(CENTRE.x + x, 0.5 * height, CENTRE.z + z))
    })
}

/// Depth of the deepest particle of the sheet in the table top, m.
pub fn depth(world: &mut World) -> f32 {
    let mut tables = world.query_filtered::<(&ClothCollider, &Transform), With<TableTop>>();
    let mut sheets = world.query_filtered::<(&ClothState, &Transform), With<Sheet>>();
    let (Ok((table, place)), Ok((sheet, frame))) = (tables.single(world), sheets.single(world))
    else {
        return f32::NAN;
    };
    let into_table = place.compute_affine().inverse() * frame.compute_affine();
    let depths = sheet.positions().iter().map(|&position| {
        let point = into_table.transform_point3(position);
        ROUNDING - table.shape.distance_to_local_point(point, true)
    });
    greatest(depths)
}
