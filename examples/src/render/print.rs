//! Prints a cloth's design onto it.

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

/// Resolution of a print, pixels/m.
const RESOLUTION: f32 = 128.0;

/// Size of a print on a cloth of triangles, m: large enough for sharp stripes.
const TRIANGLES_SIZE: Vec2 = Vec2::new(8.0, 0.1);

/// Threads in a metre of a printed cloth: a fine canvas.
const THREADS: f32 = 1000.0;

/// Gives each cloth with a [`Design`] this material, printed with the design, and grids a weave. The mesh comes from the
/// cloth's plugin.
pub fn plugin(material: StandardMaterial) -> impl Plugin {
    move |app: &mut App| {
        let material = material.clone();
        let print = move |mut commands: Commands,
                          cloths: Query<(Entity, &ClothMesh, &Design), Added<Design>>,
                          mut images: ResMut<Assets<Image>>,
                          mut woven: ResMut<Assets<WovenMaterial>>,
                          mut materials: ResMut<Assets<StandardMaterial>>| {
            for (cloth, mesh, design) in &cloths {
                let mut printed = |size| {
                    let base_color_texture = Some(images.add(image(design, size)));
                    StandardMaterial { base_color_texture, ..material.clone() }
                };
                let mut cloth = commands.entity(cloth);
                match *mesh {
                    ClothMesh::Grid { width, height, .. }
                    | ClothMesh::Sheet { width, depth: height, .. } => {
                        let size = Vec2::new(width, height);
                        let printed = Weave::new(size, THREADS).on(printed(size));
                        cloth.insert(MeshMaterial3d(woven.add(printed)));
                    }
                    ClothMesh::Triangles { .. } => {
                        let printed = printed(TRIANGLES_SIZE);
                        cloth.insert(MeshMaterial3d(materials.add(printed)));
                    }
                }
            }
        };
        app.add_plugins(WeavePlugin).add_systems(Update, print);
    }
}

/// The image of a design on a flag of this size in m.
pub fn image(design: &Design, size: Vec2) -> Image {
    let pixels = (size * RESOLUTION).as_uvec2();
    let colours = (0..pixels.y).flat_map(|row| {
        (0..pixels.x).flat_map(move |column| {
            let point = (UVec2::new(column, row).as_vec2() + 0.5) / RESOLUTION;
            let [red, green, blue] = colour(design, point, size);
            [red, green, blue, u8::MAX]
        })
    });
    Image::new(
        Extent3d { width: pixels.x, height: pixels.y, depth_or_array_layers: 1 },
        TextureDimension::D2,
        colours.collect(),
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::RENDER_WORLD,
    )
}

/// Colour at a point (m) measured from the top of the pole.
fn colour(design: &Design, point: Vec2, size: Vec2) -> [u8; 3] {
    let stripe = |colours: &[[u8; 3]], fraction: f32| {
        colours[(fraction * colours.len() as f32) as usize % colours.len()]
    };
    match design {
        Design::Pales(colours) => stripe(colours, point.x / size.x),
        Design::Bars(colours) => stripe(colours, point.y / size.y),
        Design::Cross { field, cross } => {
            let centre = Vec2::new(0.36 * size.x, 0.5 * size.y);
            let on_cross = (point - centre).abs().min_element() < 0.09 * size.y;
            if on_cross { *cross } else { *field }
        }
        Design::Disc { field, disc } => {
            let on_disc = point.distance(0.5 * size) < 0.3 * size.y;
            if on_disc { *disc } else { *field }
        }
        Design::Chequers { colours, rows } => {
            let square = (point / size.y * f32::from(*rows)).as_uvec2();
            colours[((square.x + square.y) % 2) as usize]
        }
    }
}
