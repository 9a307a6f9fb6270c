//! Durations of many ticks.

use std::time::Duration;

/// Durations of the same work in many ticks.
#[derive(Clone, Debug, Default)]
pub struct Durations {
    milliseconds: Vec<f64>,
}

impl Durations {
    /// Adds the duration of a tick.
    pub fn push(&mut self, duration: Duration) {
        self.milliseconds.push(duration.as_secs_f64() * 1e3);
    }

    /// The last `count` durations.
    pub fn last(&self, count: usize) -> Self {
        let start = self.milliseconds.len().saturating_sub(count);
        Self { milliseconds: self.milliseconds[start..].to_vec() }
    }

    /// The duration that a fraction of all ticks does not exceed, ms.
    pub fn quantile(&self, fraction: f64) -> f64 {
        let mut sorted = self.milliseconds.clone();
        sorted.sort_by(f64::total_cmp);
        let rank = (fraction * sorted.len() as f64) as usize;
        sorted.get(rank).or(sorted.last()).copied().unwrap_or(f64::NAN)
    }

    /// Median and 95th percentile as text.
    pub fn summary(&self) -> String {
        format!("median {:.3} ms, 95 % {:.3} ms", self.quantile(0.5), self.quantile(0.95))
    }

    /// The fraction of ticks that do not exceed a limit in ms.
    pub fn fraction_within(&self, limit: f64) -> f64 {
        let within = self.milliseconds.iter().filter(|&&duration| duration <= limit).count();
        within as f64 / self.milliseconds.len().max(1) as f64
    }
}
