//! Wall-clock times of repeated work.

use std::{hint::black_box, time::Instant};

/// Durations of the same work, repeated, in microseconds.
#[derive(Clone, Debug, Default)]
pub struct Timing {
    samples: Vec<f64>,
}

impl Timing {
    /// Runs `work` once and keeps its duration.
    pub fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = black_box(work());
        self.samples.push(start.elapsed().as_secs_f64() * 1e6);
        result
    }

    /// Runs `work` `warm_up` times untimed, then `repeats` times timed.
    pub fn repeat(warm_up: usize, repeats: usize, mut work: impl FnMut()) -> Self {
        for _ in 0..warm_up {
            black_box(&mut work)();
        }
        let mut timing = Self::default();
        for _ in 0..repeats {
            timing.time(&mut work);
        }
        timing
    }

    /// Keeps a duration measured elsewhere, µs.
    pub fn push(&mut self, duration: f64) {
        self.samples.push(duration);
    }

    /// Mean of all durations, of which longer ones count as `most`, µs.
    #[must_use]
    pub fn clipped_mean(&self, most: f64) -> f64 {
        let clipped: Vec<f64> = self.samples.iter().map(|time| time.min(most)).collect();
        crate::stats::mean(&clipped)
    }

    /// Sum of all durations, µs.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.samples.iter().sum()
    }

    /// Largest mean of `window` consecutive durations, µs; of all durations if there are fewer.
    #[must_use]
    pub fn worst_mean(&self, window: usize) -> f64 {
        let window = window.min(self.samples.len()).max(1);
        self.samples.windows(window).map(crate::stats::mean).fold(f64::NAN, f64::max)
    }

    /// Largest percentile `p` of `window` consecutive durations, µs; of all durations if there are fewer.
    #[must_use]
    pub fn worst_percentile(&self, window: usize, p: f64) -> f64 {
        let window = window.min(self.samples.len()).max(1);
        let parts = self.samples.windows(window);
        let percentiles = parts.map(|part| Self { samples: part.to_vec() }.percentile(p));
        percentiles.fold(f64::NAN, f64::max)
    }

    /// Shortest duration, µs; NaN before the first sample.
    #[must_use]
    pub fn min(&self) -> f64 {
        self.samples.iter().copied().fold(f64::NAN, f64::min)
    }

    /// Middle duration, µs; NaN before the first sample.
    #[must_use]
    pub fn median(&self) -> f64 {
        self.percentile(0.5)
    }

    /// Duration that a fraction `p` of the samples does not exceed, µs; NaN before the first sample.
    #[must_use]
    pub fn percentile(&self, p: f64) -> f64 {
        if self.samples.is_empty() {
            return f64::NAN;
        }
        let mut ascending = self.samples.clone();
        ascending.sort_by(f64::total_cmp);
        crate::stats::percentile(&ascending, p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warm_up_is_not_timed() {
        let mut calls = 0;
        let timing = Timing::repeat(2, 3, || calls += 1);
        assert_eq!((calls, timing.samples.len()), (5, 3));
        assert!(timing.min() <= timing.median());
    }
}
