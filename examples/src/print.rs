//! Prints a flag's design onto its cloth.

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bunting_scenes::Design;

/// Pixels a metre.
const RESOLUTION: f32 = 128.0;

/// The picture of a design upon a flag of this size in m.
pub fn picture(design: &Design, size: Vec2) -> Image {
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

/// The colour at a point in m from the top of the pole.
fn colour(design: &Design, point: Vec2, size: Vec2) -> [u8; 3] {
    let stripe = |colours: &[[u8; 3]], part: f32| {
        colours[(part * colours.len() as f32) as usize % colours.len()]
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
