//! The interface of a method: one substep of a sheet.

use super::sheet::Sheet;

/// One substep of a method.
pub trait Stepper {
    /// Advances the sheet by `h` seconds.
    fn substep(&mut self, sheet: &mut Sheet, h: f32);
}
