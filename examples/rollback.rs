//! Rollback: a player drives a cart of avian's from afar, and its inputs arrive eight ticks late.
//!
//! `cargo run --release --example rollback --features avian -- --headless` simulates it as fast as possible, and prints
//! what saving and restoring takes, and a hash of the result beside that of a game in which no input was late: they are
//! equal, and the example fails if they are not.
//!
//! `cargo run --release --example rollback --features avian,render` opens a window: drag to look around, scroll to come
//! closer.
//!
//! In each tick the game goes back by eight, takes the input that has arrived, and simulates those eight ticks again. The
//! state of cloth is one `save_cloths` and one `restore_cloths`. Avian has no such call. What has to be saved of its
//! bodies for the same bits are the components `Position`, `Rotation`, `LinearVelocity`, `AngularVelocity`,
//! `ColliderAabb`, `EnlargedAabb` and `BodyIslandNode`, with the `Transform` and, of bodies with `FeelsCloth`, the
//! `FormerReaction`; and the resources `ContactGraph`, `ConstraintGraph`, `PhysicsIslands`, `ColliderTrees` and
//! `MovedProxies`. `src/scenes/rollback/bodies.rs` does it, and says what was left out.

use std::process::ExitCode;

use bunting_examples::scenes::rollback::Rollback;

fn main() -> ExitCode {
    bunting_examples::run(&Rollback::default())
}
