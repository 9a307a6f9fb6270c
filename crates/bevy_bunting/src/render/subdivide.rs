//! Chooses how finely visible cloths are drawn, and makes the meshes for it.

use std::sync::Arc;

use bevy_asset::Assets;
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::InheritedVisibility;
use bevy_ecs::prelude::*;
use bevy_mesh::Mesh;
use bevy_transform::components::GlobalTransform;
use bunting_solver::SubdivisionBuffers;

use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;
use crate::lod::view::{Sighting, View};
use crate::lod::viewer::LodViewer;
use crate::render::level_meshes::{LevelMeshes, MeshOrigin, SubdividedMesh};
use crate::render::subdivided_mesh;
use crate::render::subdivision::ClothSubdivision;
use crate::render::subdivisions::Subdivisions;

type DrawnCloth = (
    &'static ClothSubdivision,
    &'static ClothSurface,
    &'static InheritedVisibility,
    &'static GlobalTransform,
    &'static Aabb,
    &'static mut LevelMeshes,
);

/// Chooses the number of halvings of the cloths on the screen, and makes meshes that are new. While a subdivision is
/// built, the cloth keeps the mesh that it has. Cloth in the picture of a camera that is switched off counts as well, so
/// that it is right in the first frame of a cut to this camera.
pub fn subdivide_cloths(
    mut cloths: Query<DrawnCloth>,
    viewers: Query<(&LodViewer, &GlobalTransform)>,
    mut subdivisions: ResMut<Subdivisions>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut buffers: Local<SubdivisionBuffers>,
) {
    let views: Vec<View> =
        viewers.iter().map(|(viewer, pose)| View::new(viewer, pose, 0.0)).collect();
    for (wanted, surface, visibility, pose, bounds, mut level_meshes) in &mut cloths {
        let (level, present) = (surface.level(), level_meshes.halvings);
        let levels = &level_meshes.levels;
        let centre = pose.transform_point(bounds.center.into());
        let sighting = Sighting::of(&views, centre, bounds.half_extents.length());
        let is_drawn = sighting.pixels_per_metre > 0.0
            && visibility.get()
            && level_meshes.origin != MeshOrigin::Refused
            && levels.rigid().vertices.is_empty()
            && surface.positions.len() == levels.fabric(level).particle_count();
        if !is_drawn {
            continue;
        }
        let length = sighting.pixels_per_metre * edge_length(levels, level);
        let halvings = wanted.halvings_for(length, present, levels.halvings_to_cells(level));
        if halvings > 0 && level_meshes.subdivided(level, halvings).is_none() {
            let Some(subdivision) = subdivisions.find(levels, level, halvings) else { continue };
            let Some(base) = level_meshes.meshes.get(level).and_then(|base| meshes.get(base))
            else {
                continue;
            };
            let mut mesh = subdivided_mesh::new(base, &subdivision);
            let points = levels.points(level, &surface.positions);
            subdivided_mesh::write(&mut mesh, &subdivision, &points.positions, &mut buffers);
            let mesh = meshes.add(mesh);
            let made = SubdividedMesh { level, halvings, subdivision, mesh };
            level_meshes.subdivided.push(Arc::new(made));
        }
        if halvings != present {
            level_meshes.halvings = halvings;
        }
    }
}

/// Typical length of an edge of the mesh that shows a level without rigid part, m: that of squares of two triangles.
pub fn edge_length(levels: &ClothLevels, level: usize) -> f32 {
    let triangles = levels.topology(level).indices.len() / 3;
    (2.0 * levels.fabric(level).area() / triangles.max(1) as f32).sqrt()
}
