//! The hard cases: situations in games that break cloth, and how badly they do.
//!
//! Every case runs the product with default settings and yields one value, the worst, that must not exceed a
//! limit.

mod case;
mod continuity;
mod crumple;
mod flags;
mod garments;
mod levels;
mod lone;
mod motion;
mod rig;
mod sleep;
mod soundness;
mod stiff;
mod storms;
mod sweeps;
mod touch;
mod weather;

pub use case::{HardCase, Status};

/// Runs one family of cases; shorter and smaller where `quick`.
pub type Family = fn(quick: bool) -> Vec<HardCase>;

/// Every family with its name.
pub const ALL: [(&str, Family); 15] = [
    ("sweeps of size, passes and rate", sweeps::cases),
    ("motion of pins and frames", motion::cases),
    ("wind and weight", weather::cases),
    ("storms and fast vehicles", storms::cases),
    ("crumpled and degenerate", crumple::cases),
    ("levels, lanes and input", levels::cases),
    ("colliders", touch::cases),
    ("sleep", sleep::cases),
    ("soundness", soundness::cases),
    ("garments", garments::cases),
    ("continuity of meshes", continuity::cases),
    ("stiff cloth at rest", stiff::at_rest),
    ("taut cloth", stiff::taut),
    ("flights of flags", flags::flights),
    ("levels of flags", flags::levels),
];
