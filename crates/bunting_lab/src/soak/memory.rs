//! Memory of the process, as the system counts it.

use std::fs;

/// Bytes of a unit of `/proc/self/status`.
const KIB: usize = 1024;

/// Bytes of the process that are in memory; none where the system is not Linux.
pub(super) fn resident() -> Option<usize> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<usize>().ok()? * KIB)
}

#[cfg(test)]
mod tests {
    #[test]
    #[cfg(target_os = "linux")]
    fn a_program_has_some_megabytes() {
        let bytes = super::resident().expect("Linux tells it");
        assert!((1 << 20..1 << 34).contains(&bytes), "{bytes}");
    }
}
