//! How long a measurement of time may take.

/// How long measuring may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Ticks that each flag flies before time is taken.
    pub warm_up: usize,
    /// Fewest ticks that are timed.
    pub least_ticks: usize,
    /// Time in seconds to go on timing for.
    pub seconds: f64,
    /// Most flags at once.
    pub most_cloths: usize,
}

impl Effort {
    /// A few seconds in all.
    pub const QUICK: Self = Self { warm_up: 10, least_ticks: 10, seconds: 0.02, most_cloths: 64 };
    /// About a minute in all.
    pub const FULL: Self = Self { warm_up: 10, least_ticks: 8, seconds: 0.25, most_cloths: 1000 };

    /// The one asked for.
    #[must_use]
    pub fn of(quick: bool) -> Self {
        if quick { Self::QUICK } else { Self::FULL }
    }

    /// How many ticks to time, where one takes `tick` microseconds.
    #[must_use]
    pub fn ticks(&self, tick: f64) -> usize {
        self.least_ticks.max((self.seconds * 1e6 / tick) as usize)
    }
}
