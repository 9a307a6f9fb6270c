//! Tests of saving and restoring cloth.

mod app_with_ids;
mod bad;
mod rollback;
mod same_bits;
mod scenes;
mod single;
