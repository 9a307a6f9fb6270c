//! The address of the page in a browser, which names an example, as `?cape`.

use bevy::prelude::*;
use clap::ValueEnum;
use web_sys::{Location, window};

use crate::exhibit::Exhibit;
use crate::exit;

/// The example that the address names, or the first one.
pub fn exhibit() -> Exhibit {
    Exhibit::value_variants()[shown()]
}

/// Goes to the example for which a key asks.
pub fn follow(mut exits: MessageReader<AppExit>) {
    let exhibits = Exhibit::value_variants();
    let asked = exits.read().find_map(|exit| match exit {
        AppExit::Success => None,
        AppExit::Error(code) => exit::after(shown(), code.get(), exhibits.len()),
    });
    if let Some((location, asked)) = location().zip(asked) {
        // Only a page that is not shown any more has no address.
        let _ = location.set_search(&exhibits[asked].name());
    }
}

/// The number of the example that the address names, or else of the first one.
fn shown() -> usize {
    let query = location().and_then(|location| location.search().ok()).unwrap_or_default();
    let name = query.trim_start_matches('?');
    Exhibit::value_variants().iter().position(|exhibit| exhibit.name() == name).unwrap_or(0)
}

fn location() -> Option<Location> {
    window().map(|window| window.location())
}
