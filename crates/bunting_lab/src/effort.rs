//! The amount of work in a measurement of time.

/// Limits of a measurement of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Ticks that each flag flies before time is taken.
    pub warm_up: usize,
    /// Fewest ticks that are timed.
    pub least_ticks: usize,
    /// Time after which timing stops, s.
    pub seconds: f64,
    /// Most flags at once.
    pub most_cloths: usize,
}

impl Effort {
    /// A few seconds for a whole command.
    pub const QUICK: Self = Self { warm_up: 10, least_ticks: 10, seconds: 0.02, most_cloths: 64 };
    /// About a minute for a whole command.
    pub const FULL: Self = Self { warm_up: 10, least_ticks: 8, seconds: 0.25, most_cloths: 1000 };

    /// The quick or the full effort.
    #[must_use]
    pub fn of(quick: bool) -> Self {
        if quick { Self::QUICK } else { Self::FULL }
    }

    /// Number of ticks to time, if one takes `tick` microseconds.
    #[must_use]
    pub fn ticks(&self, tick: f64) -> usize {
        self.least_ticks.max((self.seconds * 1e6 / tick) as usize)
    }
}
