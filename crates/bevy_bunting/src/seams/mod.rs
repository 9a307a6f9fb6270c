//! Seams: edges of a cloth that are sewn to edges of the same cloth, for good or until they are opened.

pub(crate) mod error;
pub(crate) mod events;
mod particles;
pub(crate) mod plugin;
pub(crate) mod run;
pub(crate) mod seam;
mod seam_stitches;
mod sew;
pub(crate) mod sewn;
mod stitches;
