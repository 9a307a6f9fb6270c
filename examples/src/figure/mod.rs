//! A figure of joints that stands, walks, runs and sits, for the examples of clothes.

pub mod cloak;
pub mod follow;
pub mod part;
pub mod pose;
pub mod skeleton;
pub mod walker;
pub mod way;
