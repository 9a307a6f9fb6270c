//! Gauze, linen and wool hang on a rail against the sun.
//!
//! `cargo run --release --example swatches -- --headless` simulates them as fast as possible and prints the costs.
//!
//! `cargo run --release --example swatches --features render` opens a window: drag to look around, scroll to come closer.
//! Each cloth has a `Weave` with its own threads; from behind it glows, and shadows of what stands behind it show
//! through. The keys are those of the example `flags`.

use std::process::ExitCode;

use bunting_examples::scenes::swatches::Swatches;

fn main() -> ExitCode {
    bunting_examples::run(&Swatches)
}
