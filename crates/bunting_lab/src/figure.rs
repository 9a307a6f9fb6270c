//! A physical figure that is the same on every machine, and by how much it may change unnoticed.

/// Part of a figure by which it may change.
const PART: f64 = 0.02;

/// A named number.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name with the unit; no two figures have the same.
    pub name: String,
    /// The number; infinite or NaN where there is none.
    pub value: f64,
    /// Change that does not matter, in the figure's unit, for figures near zero.
    pub floor: f64,
}

impl Figure {
    /// A figure.
    #[must_use]
    pub fn new(name: impl Into<String>, value: f64, floor: f64) -> Self {
        Self { name: name.into(), value, floor }
    }

    /// A figure of a case with a limit: what is small beside the limit does not matter.
    #[must_use]
    pub fn of_case(name: impl Into<String>, value: f64, limit: f64) -> Self {
        Self::new(name, value, PART * limit.abs())
    }

    /// The figure, named after what it is a figure of.
    #[must_use]
    pub fn of(self, what: &str) -> Self {
        Self { name: format!("{what}: {}", self.name), ..self }
    }

    /// Whether it differs from a number by more than a fiftieth and by more than does not matter.
    #[must_use]
    pub fn has_changed_from(&self, before: f64) -> bool {
        match (self.value.is_finite(), before.is_finite()) {
            (true, true) => (self.value - before).abs() > (PART * before.abs()).max(self.floor),
            (now, then) => now != then,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_of_more_than_a_fiftieth_and_the_floor_are_seen() {
        let changed = |value, before| Figure::new("a", value, 1e-3).has_changed_from(before);
        assert!(!changed(1.019, 1.0) && changed(1.021, 1.0) && changed(-1.0, 1.0));
        assert!(!changed(0.0009, 0.0) && changed(0.0011, 0.0));
        assert!(changed(f64::NAN, 1.0) && changed(1.0, f64::INFINITY));
        assert!(!changed(f64::NAN, f64::INFINITY), "neither is a number");
    }
}
