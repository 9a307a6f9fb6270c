//! A curtain that hangs from a rail by rings.

use std::f32::consts::TAU;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

/// Number of pleats, each from one ring to the next.
const PLEATS: u32 = 12;

/// Number of vertices across a pleat.
const ACROSS: u32 = 6;

/// Rows of vertices.
const ROWS: u32 = 36;

/// Distance from ring to ring, m.
const SPACING: f32 = 0.14;

/// Amplitude of the pleats about the plane of the rail, m: the cloth is one and a half times as wide
/// as the curtain.
const DEPTH: f32 = 0.042;

/// Height of the curtain, m.
const HEIGHT: f32 = 2.1;

/// Fraction of the height, from the top, at which the slit begins; it ends at the hem.
const SLIT: f32 = 0.3;

/// Colour.
const LINEN: [u8; 3] = [92, 125, 140];

/// Position of the middle of the curtain's top, m.
pub const TOP: Vec3 = Vec3::new(-1.05, 2.2, -0.55);

/// Spawns the curtain.
pub fn spawn(commands: &mut Commands) {
    commands.spawn((
        mesh(),
        // Five cells or more in each pleat.
        ClothResolution::CellSize(0.045),
        ClothMaterial(FabricMaterial { area_density: 0.16, ..FabricMaterial::COTTON }),
        Attachment::in_place(AttachedVertices::List(rings().collect())),
        Transform::from_translation(TOP),
        Design::Bars(vec![LINEN]),
    ));
}

/// The top vertices that hang on rings: those at the front of the pleats.
fn rings() -> impl Iterator<Item = u32> {
    (0..=PLEATS).map(|pleat| pleat * ACROSS)
}

/// Positions at which the rings hold the cloth, in its frame, m.
#[cfg(feature = "render")]
pub fn ring_positions() -> impl Iterator<Item = Vec3> {
    rings().map(|vertex| position(vertex, 0))
}

/// A pleated grid with a slit.
fn mesh() -> ClothMesh {
    let columns = PLEATS * ACROSS + 1;
    let nodes = || (0..ROWS).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let positions = nodes().map(|(column, row)| position(column, row)).collect();
    let uv = nodes().map(|(column, row)| {
        Vec2::new(column as f32 / (columns - 1) as f32, row as f32 / (ROWS - 1) as f32)
    });
    let in_slit =
        |column: u32, row: u32| column == columns / 2 && row as f32 >= SLIT * (ROWS - 1) as f32;
    let cells = (1..ROWS).flat_map(|row| (1..columns).map(move |column| (column, row)));
    let indices =
        cells.filter(|&(column, row)| !in_slit(column, row)).flat_map(|(right, below)| {
            let at = |column: u32, row: u32| row * columns + column;
            let [a, b] = [at(right - 1, below - 1), at(right, below - 1)];
            let [c, d] = [at(right - 1, below), at(right, below)];
            if (right + below) % 2 == 0 { [a, c, d, a, d, b] } else { [a, c, b, b, c, d] }
        });
    ClothMesh::triangles(positions, indices.collect(), uv.collect())
}

fn position(column: u32, row: u32) -> Vec3 {
    let pleats = column as f32 / ACROSS as f32;
    Vec3::new(
        SPACING * (pleats - 0.5 * PLEATS as f32),
        -HEIGHT * row as f32 / (ROWS - 1) as f32,
        DEPTH * (TAU * pleats).cos(),
    )
}
