//! Which pictures are written.

use std::path::PathBuf;

use clap::Args;

/// Selection of the pictures, and their folder.
#[derive(Clone, Debug, Args)]
pub struct PictureOptions {
    /// Write pictures as PNG into this directory.
    #[arg(long, value_name = "DIR", requires = "headless")]
    pub(super) pictures: Option<PathBuf>,
    /// Simulated times of the pictures, in seconds.
    #[arg(
        long,
        value_name = "SECONDS",
        value_delimiter = ',',
        default_value = "9,10,11",
        requires = "pictures"
    )]
    pub(super) at: Vec<f64>,
    /// Width in pixels; the height is 9/16 of it.
    #[arg(long, default_value_t = 1280, value_parser = clap::value_parser!(u32).range(16..=8192), requires = "pictures")]
    pub(super) width: u32,
}

impl PictureOptions {
    /// These options for one picture at a time (s).
    #[must_use]
    pub fn at(&self, time: f64) -> Self {
        Self { at: vec![time], ..self.clone() }
    }
}
