//! Ways out of an example.

/// Exit codes with which a key asks for another example; others end the gallery.
pub const NEXT: u8 = 10;
pub const PREVIOUS: u8 = 11;

/// The number of the example, of `count`, that is asked for by an exit code of the example with the number `shown`.
pub fn after(shown: usize, code: u8, count: usize) -> Option<usize> {
    match code {
        NEXT => Some((shown + 1) % count),
        PREVIOUS => Some((shown + count - 1) % count),
        _ => None,
    }
}
