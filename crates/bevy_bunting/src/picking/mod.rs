//! Cloth that a pointer drags in a window.

mod backend;
pub mod drag;
pub mod plugin;

#[cfg(test)]
mod tests;
