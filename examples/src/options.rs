//! The part of the command line that all examples share.

use clap::Args;

#[cfg(feature = "render")]
use crate::render::picture_options::PictureOptions;

/// The part of the command line that all examples share.
#[derive(Clone, Debug, Args)]
pub struct Options {
    /// Simulate as fast as possible, without a window, and print measurements.
    #[arg(long)]
    headless: bool,
    /// Simulated time in seconds.
    #[arg(long, value_parser = positive, requires = "headless")]
    pub(crate) seconds: Option<f64>,
    /// Number of threads that simulate cloth.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..), requires = "headless")]
    pub(crate) threads: u16,
    #[cfg(feature = "render")]
    #[command(flatten)]
    pub(crate) pictures: PictureOptions,
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|error| format!("{error}"))?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("must be positive".to_owned()) }
}

impl Options {
    /// Whether there is no window.
    #[must_use]
    pub fn headless(&self) -> bool {
        self.headless
    }

    /// These options, but headless runs end after a time (s), of which pictures are written.
    #[must_use]
    pub fn until(&self, time: f64) -> Self {
        Self {
            seconds: Some(time),
            #[cfg(feature = "render")]
            pictures: self.pictures.at(time),
            ..self.clone()
        }
    }
}
