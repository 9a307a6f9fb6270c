//! Roots of functions of one variable.

/// Bisections after which an interval of doubles cannot shrink any more.
const BISECTIONS: u32 = 200;

/// The point of [`low`, `high`] where `is_past` turns from false to true, as exactly as doubles can represent
/// it.
pub fn bisect(low: f64, high: f64, is_past: impl Fn(f64) -> bool) -> f64 {
    bisect_times(BISECTIONS, low, high, is_past)
}

/// [`bisect`] with a given number of evaluations of `is_past`, each of which halves the interval.
pub fn bisect_times(
    halvings: u32,
    mut low: f64,
    mut high: f64,
    is_past: impl Fn(f64) -> bool,
) -> f64 {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if is_past(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}
