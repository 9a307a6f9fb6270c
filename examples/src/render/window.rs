//! Shows an example in a window.

use std::process::ExitCode;

use bevy::asset::AssetMetaCheck;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

#[cfg(feature = "inspector")]
use crate::render::inspector;
use crate::render::{keys, title, viewer};
use crate::{ASSETS, Example};

/// The element of a browser's page in which an example is drawn, as a selector; its parent has its size.
const CANVAS: &str = "#cloth";

/// Shows an example until its app ends, and returns the app's exit code. Fails if no display can be opened.
pub fn run<E: Example>(example: &E) -> ExitCode {
    if !any_display() {
        eprintln!("no display can be opened: use --headless");
        return ExitCode::FAILURE;
    }
    let mut app = App::new();
    let window = Window {
        title: E::NAME.to_owned(),
        canvas: Some(CANVAS.to_owned()),
        fit_canvas_to_parent: true,
        ..default()
    };
    // No asset has a `.meta` file: each question for one would be an error in a browser's console.
    let meta_check = AssetMetaCheck::Never;
    let stage = example.stage();
    let camera = stage.camera();
    app.add_plugins((
        DefaultPlugins
            .set(WindowPlugin { primary_window: Some(window), ..default() })
            .set(AssetPlugin { file_path: ASSETS.to_owned(), meta_check, ..default() }),
        ClothPlugins::default(),
        (stage, keys::pause, title::plugin(E::NAME)),
    ));
    #[cfg(feature = "inspector")]
    app.add_plugins(inspector::plugin);
    example.build(&mut app, Update);
    let viewer = viewer(&mut app);
    app.world_mut().entity_mut(viewer).insert(camera);
    example.draw(&mut app);
    example.control(&mut app);
    match app.run() {
        AppExit::Success => ExitCode::SUCCESS,
        AppExit::Error(code) => ExitCode::from(code.get()),
    }
}

/// Whether a window can be opened: winit would panic otherwise.
fn any_display() -> bool {
    #[cfg(target_os = "linux")]
    return x11rb::connect(None).is_ok();
    #[cfg(not(target_os = "linux"))]
    true
}
