//! Flags of printed cloth.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::{print, stage};
use bunting_scenes::Design;

/// Gives each flag a material that shows its design; the plugin gives it a mesh.
pub fn plugin(app: &mut App) {
    app.add_systems(Update, dress);
}

fn dress(
    mut commands: Commands,
    flags: Query<(Entity, &ClothMesh, &Design), Added<Design>>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (flag, shape, design) in &flags {
        let &ClothMesh::Grid { width, height, .. } = shape else { continue };
        let material = materials.add(StandardMaterial {
            base_color_texture: Some(images.add(print::picture(design, Vec2::new(width, height)))),
            ..stage::bunting()
        });
        commands.entity(flag).insert(MeshMaterial3d(material));
    }
}
