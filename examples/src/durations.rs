//! How long something took, again and again.

use std::time::Duration;

/// Durations of the same thing in many ticks.
#[derive(Clone, Debug, Default)]
pub struct Durations {
    milliseconds: Vec<f64>,
}

impl Durations {
    /// Adds one.
    pub fn push(&mut self, duration: Duration) {
        self.milliseconds.push(duration.as_secs_f64() * 1e3);
    }

    /// The last so many.
    pub fn last(&self, count: usize) -> Self {
        let start = self.milliseconds.len().saturating_sub(count);
        Self { milliseconds: self.milliseconds[start..].to_vec() }
    }

    /// The duration that a part of all do not exceed, ms.
    pub fn quantile(&self, part: f64) -> f64 {
        let mut sorted = self.milliseconds.clone();
        sorted.sort_by(f64::total_cmp);
        let rank = (part * sorted.len() as f64) as usize;
        sorted.get(rank).or(sorted.last()).copied().unwrap_or(f64::NAN)
    }

    /// The part of all that do not exceed a limit in ms.
    pub fn part_within(&self, limit: f64) -> f64 {
        let within = self.milliseconds.iter().filter(|&&duration| duration <= limit).count();
        within as f64 / self.milliseconds.len().max(1) as f64
    }
}
