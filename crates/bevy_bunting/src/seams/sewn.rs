//! How far the seams of a cloth are.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bunting_solver::Seams;

use crate::fabric::known_level::KnownLevel;
use crate::seams::run::SeamRun;
use crate::seams::seam_stitches::SeamStitches;

/// The stitches of a cloth's seams at its level, and how far they are.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct SewnCloth {
    pub(super) known: Option<KnownStitches>,
    /// One for each seam.
    pub progress: Vec<SeamProgress>,
}

/// The stitches of seams at a level.
#[derive(Clone, Debug)]
pub(super) struct KnownStitches {
    pub of: KnownLevel,
    /// The sides of each seam, and whether the second one is reversed.
    pub sides: Vec<([SeamRun; 2], bool)>,
    /// The stitches of each seam; none of one that cannot be sewn.
    pub of_seams: Vec<SeamStitches>,
    pub seams: Arc<Seams>,
}

/// How far a seam is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SeamProgress {
    /// The part that was closed in the last tick.
    pub closed: f32,
    /// Time that is left until it is drawn together, s.
    pub closing: f32,
    /// Whether its closing all along has been reported.
    pub is_reported: bool,
}
