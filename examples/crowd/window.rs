//! Shows the plaza in a window.

use std::process::ExitCode;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_examples::{ASSETS, any_display};

use crate::flight::Pilot;
use crate::plaza::{self, Crowd};
use crate::{colours, controls, stage};

/// Shows it until the window is closed.
pub fn run(crowd: &Crowd) -> ExitCode {
    if !any_display() {
        eprintln!("no display can be opened: use --headless");
        return ExitCode::FAILURE;
    }
    let mut app = App::new();
    let window = Window { title: "Crowd".to_owned(), ..default() };
    app.add_plugins((
        DefaultPlugins
            .set(WindowPlugin { primary_window: Some(window), ..default() })
            .set(AssetPlugin { file_path: ASSETS.to_owned(), ..default() }),
        ClothPlugins::default(),
        (stage::plugin, colours::plugin, controls::plugin),
    ))
    .add_systems(PostStartup, |mut commands: Commands, pilot: Single<Entity, With<Pilot>>| {
        commands.entity(*pilot).insert(stage::STAGE.camera());
    });
    plaza::build(&mut app, crowd);
    if app.run().is_success() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
