//! The effort of a cloth over time.

use super::effort_class::{EffortCause, EffortClass};
use super::loads::Loads;

/// Time for which a cloth must need less before it gets less, s. Shorter: cloths that flutter change batches all the
/// time. Longer: a jerk is paid for longer.
const HELD: f32 = 0.5;

/// The class of a cloth over time: it rises at once, and falls to what the last half second has needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Effort {
    class: EffortClass,
    cause: EffortCause,
    /// Time for which a lower class has been enough, s.
    held: f32,
    /// The highest class, and its reason, that was needed in this time.
    highest: (EffortClass, EffortCause),
}

impl Effort {
    /// The class chosen last.
    #[must_use]
    pub const fn class(&self) -> EffortClass {
        self.class
    }

    /// The reason for the class.
    #[must_use]
    pub const fn cause(&self) -> EffortCause {
        self.cause
    }

    /// Chooses the class for a tick of `tick` seconds under these loads, and returns it.
    pub fn update(&mut self, loads: &Loads, tick: f32) -> EffortClass {
        let needed = loads.class();
        if needed.0 >= self.class {
            *self = Self { class: needed.0, cause: needed.1, ..Self::default() };
            return self.class;
        }
        if needed.0 >= self.highest.0 {
            self.highest = needed;
        }
        self.held += tick;
        if self.held > HELD {
            let (class, cause) = self.highest;
            *self = Self { class, cause, ..Self::default() };
        }
        self.class
    }
}

#[cfg(test)]
mod tests {
    use super::{Effort, Loads};

    #[test]
    fn effort_rises_at_once_and_falls_after_a_while() {
        let loads = |frame: f32| Loads { frame, ..Loads::default() };
        let mut effort = Effort::default();
        let mut after = |load: f32| effort.update(&loads(load), 1.0 / 64.0).index();
        assert_eq!(after(1200.0), 6);
        for tick in 0..32 {
            let load = if tick == 10 { 100.0 } else { 0.0 };
            assert_eq!(after(load), 6, "{tick}");
        }
        assert_eq!(after(0.0), 2);
        assert!((0..32).all(|_| after(f32::NAN) == 2));
        assert_eq!(after(0.0), 0);
        assert_eq!(effort, Effort::default());
    }
}
