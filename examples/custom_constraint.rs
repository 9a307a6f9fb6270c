//! A user's own force and constraint: a streamer in a swinging glass tube with a vortex of air.
//!
//! `cargo run --release --example custom_constraint -- --headless` simulates the streamer as fast as possible
//! and prints its greatest distance from the axis of the tube.
//!
//! `cargo run --release --example custom_constraint --features render` opens a window: drag to look
//! around, scroll to come closer.
//!
//! The force and the constraint are in `src/scenes/custom_constraint`.

use std::process::ExitCode;

use bunting_examples::scenes::custom_constraint::CustomConstraint;

fn main() -> ExitCode {
    bunting_examples::run(&CustomConstraint)
}
