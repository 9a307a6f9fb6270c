//! A curtain whose rings slide on a rail, drawn aside and back by a hand.
//!
//! `cargo run --release --example curtain -- --headless` simulates it as fast as possible and prints the costs.
//!
//! `cargo run --release --example curtain --features render` opens a window: drag to look around, scroll to
//! come closer. The hand grabs the free edge (`ClothGrab`), draws the curtain open, lets go, and draws it shut again; the
//! rings slide on the rail with friction (`AnchorHold::Rail`). The keys are those of the example `flags`.

use std::process::ExitCode;

use bunting_examples::scenes::curtain::Curtain;

fn main() -> ExitCode {
    bunting_examples::run(&Curtain)
}
