//! A table, and a sheet that falls over it.

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Half the extents of the table top, m; its edges are round.
pub const TOP: Vec3 = Vec3::new(0.5, 0.03, 0.38);

/// Where the middle of the top is, m.
pub const PLACE: Vec3 = Vec3::new(0.95, 0.74, 0.25);

/// Radius of its edges, m.
pub const ROUNDING: f32 = 0.028;

/// Distance that the sheet keeps besides, m: between its particles it is straight.
const MARGIN: f32 = 0.008;

/// Half the thickness of a leg, m.
const LEG: f32 = 0.025;

/// How far the middle of a leg is from the edges, m.
const INSET: f32 = 0.07;

/// Extents of the sheet, m.
const SHEET: Vec2 = Vec2::new(1.7, 1.45);

/// Particles along its edges.
const PARTICLES: (u32, u32) = (57, 49);

/// From how high it falls, m.
const DROP: f32 = 0.12;

/// By how much it lies askew, rad.
const ASKEW: f32 = 0.12;

/// What the sheet falls upon.
#[derive(Component, Clone, Copy, Debug)]
pub struct Table;

/// The sheet.
#[derive(Component, Clone, Copy, Debug)]
pub struct Sheet;

/// Sets the table up and lets the sheet fall.
pub fn lay(commands: &mut Commands) {
    // All that is nearer to a smaller box than the rounding is a box with round edges.
    let top = ClothCollider { margin: ROUNDING + MARGIN, ..ClothCollider::cuboid(TOP - ROUNDING) };
    commands.spawn((Table, top, Transform::from_translation(PLACE)));
    for (half, place) in legs() {
        let leg = ClothCollider { margin: MARGIN, ..ClothCollider::cuboid(half) };
        commands.spawn((leg, Transform::from_translation(place)));
    }
    commands.spawn((ClothCollider::ground(), Transform::default()));
    let turn = Quat::from_rotation_y(ASKEW) * Quat::from_rotation_x(-FRAC_PI_2);
    let corner = turn * Vec3::new(-0.5 * SHEET.x, 0.5 * SHEET.y, 0.0);
    commands.spawn((
        Sheet,
        ClothMesh::grid(PARTICLES.0, PARTICLES.1, SHEET.x, SHEET.y),
        ClothMaterial(FabricMaterial { area_density: 0.2, ..FabricMaterial::COTTON }),
        Transform::from_translation(PLACE + DROP * Vec3::Y + corner).with_rotation(turn),
    ));
}

/// Half the extents of each leg, and where its middle is, m.
pub fn legs() -> [(Vec3, Vec3); 4] {
    let height = PLACE.y - TOP.y;
    let half = Vec3::new(LEG, 0.5 * height, LEG);
    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(x, z)| {
        let (x, z) = (x * (TOP.x - INSET), z * (TOP.z - INSET));
        (half, Vec3::new(PLACE.x + x, 0.5 * height, PLACE.z + z))
    })
}

/// How deep the deepest particle of the sheet is in the table top, m.
pub fn depth(world: &mut World) -> f32 {
    let mut tables = world.query_filtered::<(&ClothCollider, &Transform), With<Table>>();
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
    depths.fold(0.0, f32::max)
}
