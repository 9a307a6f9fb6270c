//! Cloth that a pointer drags in a window, and whose pins it paints.

mod backend;
pub mod drag;
pub mod pins;
pub mod plugin;

#[cfg(test)]
mod tests;
