//! Reads components that an artist has written into a glTF file.

mod components;
pub mod error;
mod nodes;
pub mod plugin;

#[cfg(test)]
mod tests;
