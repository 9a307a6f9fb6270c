//! Levels of detail: the level of each cloth, and whether it sleeps.

pub mod batch_costs;
pub mod budget;
pub mod candidate;
pub mod cost_model;
pub mod cost_table;
pub mod effort;
pub mod error;
pub mod governor;
pub mod level_counts;
pub mod level_tables;
pub mod lod_cloth;
pub mod lod_set;
pub mod record;
pub mod report;
pub mod rest_timer;
pub mod select;
pub mod sleep;
pub mod view;
pub mod viewer;
