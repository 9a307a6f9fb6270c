//! The hard cases: what breaks cloth in games, and how badly.
//!
//! Every case runs the product by default settings and reduces to one figure, its worst, that must not
//! exceed a limit.

mod case;
mod crumple;
mod levels;
mod motion;
mod rig;
mod sleep;
mod soundness;
mod sweeps;
mod touch;
mod weather;

pub use case::{HardCase, Status};

/// Runs one family of cases; shorter and smaller where `quick`.
pub type Family = fn(quick: bool) -> Vec<HardCase>;

/// Every family with its name.
pub const ALL: [(&str, Family); 8] = [
    ("sweeps of size, passes and rate", sweeps::cases),
    ("motion of pins and frames", motion::cases),
    ("wind and weight", weather::cases),
    ("crumpled and degenerate", crumple::cases),
    ("levels, lanes and input", levels::cases),
    ("colliders", touch::cases),
    ("sleep", sleep::cases),
    ("soundness", soundness::cases),
];
