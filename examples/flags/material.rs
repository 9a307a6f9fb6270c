//! Shows cloth as meshes.

use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

use crate::print;

/// Shows all cloth with its design.
pub fn plugin(app: &mut App) {
    app.add_systems(Update, (drape, dress).chain());
}

fn dress(
    mut commands: Commands,
    cloths: Query<(Entity, &ClothMesh, &Design), Without<Mesh3d>>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    for (cloth, shape, design) in &cloths {
        let &ClothMesh::Grid { width, height, .. } = shape else { continue };
        let material = materials.add(StandardMaterial {
            base_color_texture: Some(images.add(print::picture(design, Vec2::new(width, height)))),
            double_sided: true,
            cull_mode: None,
            perceptual_roughness: 0.8,
            reflectance: 0.25,
            // Light shines through thin cloth.
            diffuse_transmission: 0.25,
            ..default()
        });
        let mesh = Mesh3d(meshes.add(Plane3d::default()));
        let surface = ClothSurface::default();
        commands.entity(cloth).insert((mesh, MeshMaterial3d(material), surface, NoFrustumCulling));
    }
}

fn drape(cloths: Query<(&ClothState, &ClothSurface, &Mesh3d)>, mut meshes: ResMut<Assets<Mesh>>) {
    for (state, surface, mesh) in &cloths {
        let (Some(fabric), Some(mut mesh)) = (state.fabric(), meshes.get_mut(mesh)) else {
            continue;
        };
        *mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::all())
            .with_inserted_indices(Indices::U32(fabric.triangles().as_flattened().to_vec()))
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, fabric.uvs().to_vec())
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, surface.normals.clone())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, surface.positions.clone());
    }
}
