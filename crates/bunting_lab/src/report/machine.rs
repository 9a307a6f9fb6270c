//! The machine on which the figures were measured.

use std::{fmt, fs, thread, time::SystemTime};

use bunting_solver::instruction_set;

/// The machine and the day.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Name of the processor.
    pub processor: String,
    /// Threads that it offers.
    pub threads: usize,
    /// Instruction set of the wide kernels.
    pub instruction_set: &'static str,
    /// Date of the measurement, UTC.
    pub date: String,
    /// Mean number of threads that were running or ready in the minute before the measurement; none if the
    /// system does not provide it.
    pub load: Option<f64>,
}

/// Load of an idle machine.
const IDLE: f64 = 0.5;

impl Machine {
    /// Describes this machine at this time.
    #[must_use]
    pub fn here() -> Self {
        let described = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        Self {
            processor: model(&described).unwrap_or(std::env::consts::ARCH).into(),
            threads: thread::available_parallelism().map_or(1, usize::from),
            instruction_set: instruction_set(),
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            load: fs::read_to_string("/proc/loadavg").ok().as_deref().and_then(load),
        }
    }

    /// The load, if other programs disturbed the measurement.
    #[must_use]
    pub fn foreign_load(&self) -> Option<f64> {
        self.load.filter(|load| *load > IDLE)
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { processor, threads, instruction_set, date, .. } = self;
        write!(f, "{processor}, {threads} threads, {instruction_set}, {date}")
    }
}

/// Mean load of the last minute, the first of the three that Linux gives.
fn load(described: &str) -> Option<f64> {
    described.split_whitespace().next()?.parse().ok()
}

/// First model name that Linux gives.
fn model(described: &str) -> Option<&str> {
    let line = described.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_busy_machine_is_told_from_an_idle_one() {
        assert_eq!(load("14.23 11.26 9.86 3/512 71\n"), Some(14.23));
        assert_eq!(load(""), None);
        let with = |load| Machine { load, ..Machine::here() }.foreign_load();
        assert_eq!([with(Some(14.2)), with(Some(0.1)), with(None)], [Some(14.2), None, None]);
    }

    #[test]
    fn the_model_is_read() {
        let described = "processor\t: 0\nmodel name\t: Some Processor @ 2 GHz\nflags\t: x";
        assert_eq!(model(described), Some("Some Processor @ 2 GHz"));
        assert_eq!(model(""), None);
    }
}
