//! Pins.

/// A pinned particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pin {
    /// The particle.
    pub particle: u32,
    /// Whether no edge joins it to another pinned particle.
    pub isolated: bool,
}
