//! Roots of functions of one variable.

/// Bisections after which an interval of doubles cannot shrink any more.
const BISECTIONS: usize = 200;

/// The point of [`low`, `high`] where `is_past` turns from false to true.
pub fn bisect(mut low: f64, mut high: f64, is_past: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..BISECTIONS {
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
