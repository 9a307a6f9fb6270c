//! Shows a scene in a window.

use std::process::ExitCode;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::orbit::{self, Orbit};
use bunting_examples::{ASSETS, keys, title, weather};
use bunting_scenes::{LooksAt, Scene, Track};

use crate::{material, stage};

/// Shows the scene until the window is closed.
pub fn run(scene: &Scene) -> ExitCode {
    let mut app = App::new();
    let window = Window { title: "Flags".to_owned(), ..default() };
    app.add_plugins((
        DefaultPlugins
            .set(WindowPlugin { primary_window: Some(window), ..default() })
            .set(AssetPlugin { file_path: ASSETS.to_owned(), ..default() }),
        ClothPlugins::default(),
        (stage::plugin, material::plugin, orbit::plugin),
        (weather::plugin, keys::plugin, title::plugin("Flags")),
    ))
    .add_systems(Startup, raise_camera)
    .add_systems(Update, bunting_scenes::follow_tracks);
    bunting_scenes::spawn(&mut app.world_mut().commands(), scene);
    if app.run().is_success() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Takes the viewer off its track and gives it a camera.
fn raise_camera(mut commands: Commands, viewer: Single<(Entity, &LooksAt), With<LodViewer>>) {
    let (viewer, looks_at) = *viewer;
    commands
        .entity(viewer)
        .remove::<Track>()
        .insert((stage::STAGE.camera(), Orbit::around(looks_at.0)));
}
