//! A figure that walks, runs and sits in clothes that it puts on and takes off.
//!
//! `cargo run --release --example wardrobe -- --headless` simulates it as fast as possible and prints the costs.
//!
//! `cargo run --release --example wardrobe --features render` opens a window. Each piece of clothing is a cloth of its own,
//! held by a bone: it is put on by spawning it, and taken off by despawning it, or dropped by letting go of it.

use std::process::ExitCode;

use bunting_examples::scenes::wardrobe::Wardrobe;

fn main() -> ExitCode {
    bunting_examples::run(&Wardrobe)
}
