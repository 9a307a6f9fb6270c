//! Shows a small scene: in a window, or headless with a table of what it cost and pictures.

use std::process::ExitCode;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use clap::Parser;

use crate::orbit::{self, Orbit};
use crate::pictures::Album;
use crate::stage::Stage;
use crate::{ASSETS, any_display, headless, keys, title, weather};

/// A scene, and how to look at it.
#[derive(Clone, Copy, Debug)]
pub struct Show {
    /// Name of the example.
    pub name: &'static str,
    /// Fills a world with cloth and what moves it.
    pub build: fn(&mut App),
    /// Adds what is only looked at.
    pub dress: fn(&mut App),
    /// Where the viewer is, m.
    pub eye: Vec3,
    /// What it looks at, m.
    pub looks_at: Vec3,
    /// What must hold after each tick.
    pub check: fn(&mut World) -> Vec<Check>,
}

/// A number that must not be too large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Check {
    /// What it is, with its unit.
    pub what: &'static str,
    /// Its value.
    pub value: f32,
    /// The greatest value that is right.
    pub limit: f32,
}

/// The command line of every such example.
#[derive(Debug, Parser)]
struct Arguments {
    /// Simulate as fast as it goes, without a window, and print what was measured.
    #[arg(long)]
    headless: bool,
    /// Simulated time in seconds.
    #[arg(long, default_value_t = 12.0, requires = "headless")]
    seconds: f64,
    #[command(flatten)]
    album: Album,
}

impl Show {
    /// Does what the command line says.
    #[must_use]
    pub fn main(&self) -> ExitCode {
        let arguments = Arguments::parse();
        if arguments.headless {
            headless::run(self, arguments.seconds, &arguments.album)
        } else if any_display() {
            self.open()
        } else {
            eprintln!("no display can be opened: use --headless");
            ExitCode::FAILURE
        }
    }

    /// Shows it in a window until that is closed.
    fn open(&self) -> ExitCode {
        let mut app = App::new();
        let window = Window { title: self.name.to_owned(), ..default() };
        app.add_plugins((
            DefaultPlugins
                .set(WindowPlugin { primary_window: Some(window), ..default() })
                .set(AssetPlugin { file_path: ASSETS.to_owned(), ..default() }),
            ClothPlugins::default(),
            (Stage::SMALL, orbit::plugin),
            (weather::plugin, keys::plugin, title::plugin(self.name)),
        ));
        (self.build)(&mut app);
        (self.dress)(&mut app);
        app.world_mut().spawn((Stage::SMALL.camera(), Orbit::from(self.eye, self.looks_at)));
        if app.run().is_success() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}
