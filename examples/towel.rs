//! Towels that fold on themselves: one over a rail, one on the floor.
//!
//! `cargo run --release --example towel -- --headless` simulates both as fast as possible and prints the costs.
//!
//! `cargo run --release --example towel --features render` opens a window: drag to look around, scroll to come closer. One
//! towel falls over a rail and is kept there by friction, its halves against each other; the other one falls on its edge,
//! and its layers come to lie on one another, as `SelfCollision` keeps them apart. The keys are those of the example
//! `flags`.

use std::process::ExitCode;

use bunting_examples::scenes::towel::Towels;

fn main() -> ExitCode {
    bunting_examples::run(&Towels)
}
