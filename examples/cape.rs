//! A figure that stands, walks, turns and runs in a cape.
//!
//! `cargo run --release --example cape -- --headless` simulates it as fast as possible and prints the costs.
//!
//! `cargo run --release --example cape --features render` opens a window. The figure's skeleton moves the cape's collar;
//! the rest of the cape hangs, swings and flies, no farther from where the skeleton would have it than the hem's play
//! allows, and not into the back. Arms and legs are capsules that push it.

use std::process::ExitCode;

use bunting_examples::scenes::cape::Cape;

fn main() -> ExitCode {
    bunting_examples::run(&Cape)
}
