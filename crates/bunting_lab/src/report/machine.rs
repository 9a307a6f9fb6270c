//! What the figures were measured on.

use std::{fs, thread, time::SystemTime};

use bunting_solver::instruction_set;

/// The machine and the day.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Name of the processor.
    pub processor: String,
    /// Threads that it offers.
    pub threads: usize,
    /// Instruction set that wide kernels ran with.
    pub instruction_set: &'static str,
    /// When it was measured, UTC.
    pub date: String,
}

impl Machine {
    /// This machine, now.
    #[must_use]
    pub fn here() -> Self {
        let described = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        Self {
            processor: model(&described).unwrap_or(std::env::consts::ARCH).into(),
            threads: thread::available_parallelism().map_or(1, usize::from),
            instruction_set: instruction_set(),
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        }
    }
}

/// The first model name that Linux gives.
fn model(described: &str) -> Option<&str> {
    let line = described.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_read() {
        let described = "processor\t: 0\nmodel name\t: Some Processor @ 2 GHz\nflags\t: x";
        assert_eq!(model(described), Some("Some Processor @ 2 GHz"));
        assert_eq!(model(""), None);
    }
}
