//! A convoy of avian's rigid bodies at 25 m/s over rough ground: each vehicle has a flag, the first one a tarpaulin
//! over its load.
//!
//! `cargo run --release --example convoy --features avian -- --headless` simulates it as fast as possible and prints
//! the costs.
//!
//! `cargo run --release --example convoy --features avian,render` opens a window. The vehicles stand on springs,
//! which rays find the ground for; the ground and the boxes are avian's colliders alone, which the tarpaulin lies on
//! without set-up, and the vehicles feel the pull of their cloths (`FeelsCloth`).

use std::process::ExitCode;

use bunting_examples::scenes::convoy::Convoy;

fn main() -> ExitCode {
    bunting_examples::run(&Convoy)
}
