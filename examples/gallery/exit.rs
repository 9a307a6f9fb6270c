//! Ways out of an example.

/// Exit codes of a window in which a key asked for another example; others end the gallery.
pub const NEXT: u8 = 10;
pub const PREVIOUS: u8 = 11;
