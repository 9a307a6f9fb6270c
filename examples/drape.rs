//! A curtain on a rail and a sheet on a table.
//!
//! `cargo run --release --example drape -- --headless` simulates both as fast as possible and prints the
//! costs.
//!
//! `cargo run --release --example drape --features render` opens a window: drag to look around,
//! scroll to come closer. The sheet falls into folds at the corners of the table and is kept there by
//! friction; the curtain hangs by its rings in pleats and is parted by gusts at its slit. The keys
//! are those of the example `flags`.

use std::process::ExitCode;

use bunting_examples::scenes::drape::Drape;

fn main() -> ExitCode {
    bunting_examples::run(&Drape)
}
