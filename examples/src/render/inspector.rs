//! The panel of `bevy_bunting_inspector` in every example.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting_inspector::{ClothInspectorPlugin, SelectedCloth};

/// Shows the panel with the first cloth.
pub fn plugin(app: &mut App) {
    app.add_plugins((ClothDragPlugin, ClothInspectorPlugin)).add_systems(PostStartup, select_first);
}

fn select_first(cloths: Query<Entity, With<ClothMesh>>, mut selected: ResMut<SelectedCloth>) {
    selected.0 = cloths.iter().min();
}
