//! Parasols in the wind, of which only the moving parts are simulated.
//!
//! `cargo run --release --example parasol -- --headless` simulates the parasols as fast as possible and
//! prints the costs.
//!
//! `cargo run --release --example parasol --features render` opens a window: drag to look around, scroll to
//! come closer. The valance flutters and the panels between the ribs billow. The middle of the canopy has
//! weight 0: it is rigid and costs nothing. No seam is visible between the two parts. The keys are those of
//! the example `flags`.

use std::process::ExitCode;

use bunting_examples::scenes::parasol::Parasols;

fn main() -> ExitCode {
    bunting_examples::run(&Parasols)
}
