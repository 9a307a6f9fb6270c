//! The measuring bench of `bevy_bunting`: it compares the simulated cloth with closed forms and references.
//!
//! Nothing in [`scenes`], [`mod@reference`], [`baselines`] or [`oracles`] shares code with the product, so
//! that agreement is evidence. Lengths are in metres, times in seconds, masses in kilograms unless said
//! otherwise.

pub mod baselines;
pub mod budget;
pub mod cli;
pub mod commands;
pub mod comparison;
pub mod contacts;
pub mod contender;
pub mod effort;
pub mod figure;
pub mod fleet;
pub mod flight;
pub mod forces;
pub mod fuzz;
pub mod game;
pub mod golden;
pub mod heap;
pub mod levels;
pub mod meshes;
pub mod need;
pub mod observation;
pub mod oracles;
pub mod output;
pub mod parallel;
#[cfg(feature = "peers")]
pub mod peers;
pub mod product;
pub mod reference;
pub mod report;
pub mod scenes;
pub mod settings;
pub mod simulation;
pub mod soak;
pub mod specimen;
pub mod stability;
pub mod stats;
pub mod surface;
pub mod timing;
