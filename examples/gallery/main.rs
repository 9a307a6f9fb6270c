//! All examples but `hello_flag`, which is the README's app. `convoy` and `rollback` are left out without the feature `avian`.
//!
//! `cargo run --release --example gallery --features render,avian` shows one after the other in a window: → and ← go to
//! the next and the previous one, and each has its own keys.
//!
//! `cargo run --release --example gallery --features render,avian -- --headless --pictures DIR` writes one picture of
//! each.
//!
//! Each example has its own process, since it is a whole app: it adds systems, and sets resources.

mod exhibit;
mod exit;
#[cfg(feature = "render")]
mod hall;

use std::env;
use std::io;
use std::process::{Command, ExitCode};

use bunting_examples::Options;
use clap::{Parser, ValueEnum};

use crate::exhibit::Exhibit;
use crate::exit::{NEXT, PREVIOUS};

/// All examples, one after the other.
#[derive(Debug, Parser)]
struct Gallery {
    /// Run this example alone.
    #[arg(long)]
    only: Option<Exhibit>,
    #[command(flatten)]
    options: Options,
}

fn main() -> ExitCode {
    let gallery = Gallery::parse();
    if let Some(exhibit) = gallery.only {
        return exhibit.run(&gallery.options);
    }
    if !cfg!(feature = "avian") {
        eprintln!("convoy is left out: it needs --features avian");
    }
    let shown = if gallery.options.headless() { run_all() } else { tour() };
    shown.unwrap_or_else(|error| {
        eprintln!("{error}");
        ExitCode::FAILURE
    })
}

/// Runs each example without a window. Fails if one of them does.
fn run_all() -> io::Result<ExitCode> {
    let mut code = ExitCode::SUCCESS;
    for exhibit in Exhibit::value_variants() {
        println!("{exhibit:?}");
        if run(*exhibit)? != Some(0) {
            code = ExitCode::FAILURE;
        }
    }
    Ok(code)
}

/// Shows examples in windows, until one is closed.
fn tour() -> io::Result<ExitCode> {
    let exhibits = Exhibit::value_variants();
    let mut shown = 0;
    loop {
        let step = match run(exhibits[shown])?.map(u8::try_from) {
            Some(Ok(NEXT)) => 1,
            Some(Ok(PREVIOUS)) => exhibits.len() - 1,
            Some(Ok(0)) => return Ok(ExitCode::SUCCESS),
            _ => return Ok(ExitCode::FAILURE),
        };
        shown = (shown + step) % exhibits.len();
    }
}

/// Runs an example in a process of its own with this process's options. Returns its exit code.
fn run(exhibit: Exhibit) -> io::Result<Option<i32>> {
    let mut command = Command::new(env::current_exe()?);
    let name = exhibit.to_possible_value().expect("no example is skipped");
    command.args(env::args_os().skip(1)).args(["--only", name.get_name()]);
    command.status().map(|status| status.code())
}
