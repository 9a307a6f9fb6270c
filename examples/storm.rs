//! A field of flags in a storm: gusts that travel, blasts, and a truck whose wake drags flags along.
//!
//! `cargo run --release --example storm -- --headless` simulates the field as fast as possible and prints the
//! costs.
//!
//! `cargo run --release --example storm --features render` opens a window: drag to look around, scroll to come
//! closer. Gusts of thirty metres pass through the field from left to right; every four seconds a blast throws
//! the flags around it outward, later where they are farther away; on the road the flags bow to the truck.

use std::process::ExitCode;

use bunting_examples::scenes::storm::Storm;

fn main() -> ExitCode {
    bunting_examples::run(&Storm)
}
