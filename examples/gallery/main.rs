//! All examples but `hello_flag`, which is the README's app. `convoy` and `rollback` are left out without the feature `avian`.
//!
//! `cargo run --release --example gallery --features render,avian` shows one after the other in a window: → and ← go to
//! the next and the previous one, and each has its own keys.
//!
//! `cargo run --release --example gallery --features render,avian -- --headless --pictures DIR` writes one picture of
//! each.
//!
//! `.ci/web` makes a page of it for browsers.
//!
//! Each example has its own process, or is loaded as its own page, since it is a whole app: it adds systems, and sets
//! resources.

#[cfg(target_arch = "wasm32")]
mod address;
mod exhibit;
mod exit;
#[cfg(feature = "render")]
mod hall;
#[cfg(target_arch = "wasm32")]
mod page;
mod run;
#[cfg(not(target_arch = "wasm32"))]
mod tour;

use std::process::ExitCode;

use bunting_examples::Options;
use clap::Parser;

use crate::exhibit::Exhibit;

/// All examples, one after the other.
#[derive(Debug, Parser)]
struct Gallery {
    /// Run this example alone.
    #[arg(long)]
    only: Option<Exhibit>,
    #[command(flatten)]
    options: Options,
}

#[cfg(target_arch = "wasm32")]
fn main() -> ExitCode {
    page::show(&Gallery::parse_from(["gallery"]).options)
}

#[cfg(not(target_arch = "wasm32"))]
fn main() -> ExitCode {
    let gallery = Gallery::parse();
    if let Some(exhibit) = gallery.only {
        return exhibit.run(&gallery.options);
    }
    if !cfg!(feature = "avian") {
        eprintln!("convoy is left out: it needs --features avian");
    }
    let shown = if gallery.options.headless() { tour::run_all() } else { tour::show() };
    shown.unwrap_or_else(|error| {
        eprintln!("{error}");
        ExitCode::FAILURE
    })
}
