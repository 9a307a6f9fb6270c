//! What the panel remembers from frame to frame.

use bevy_ecs::prelude::*;

/// What the panel remembers from frame to frame.
///
/// ```
/// use bevy_bunting_inspector::PanelState;
///
/// // A panel that a key opens.
/// let hidden = PanelState { is_open: false, ..PanelState::default() };
/// # assert_ne!(hidden, PanelState::default());
/// ```
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct PanelState {
    /// Whether the panel is shown.
    pub is_open: bool,
    /// Path of the tuning file.
    pub file: String,
    /// What came of the last button; empty before.
    pub message: String,
}

impl Default for PanelState {
    fn default() -> Self {
        Self { is_open: true, file: "cloth.tuning.ron".to_owned(), message: String::new() }
    }
}
