//! Classes of effort: cloths of one class and fabric take the same number of substeps.

/// Greatest acceleration of the class of least effort, m/s²: a calm flag turns its links by less. Smaller: flags in a
/// light wind take more substeps without need. Larger: heavy flags in 25 m/s have a 99.9 % strain of 5 %.
const LEAST: f32 = 10.0;

/// Ratio of the accelerations of two classes: substeps grow by its root. Smaller: more batches. Larger: more substeps
/// than needed.
const RATIO: f32 = 2.0;

/// Number of classes of effort.
const CLASSES: u8 = 9;

/// The reason for which a cloth takes the substeps that it takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum EffortCause {
    /// Its weight or the length of the tick.
    #[default]
    Weight,
    /// The speed of the air.
    Air,
    /// The acceleration or the turn of its frame, or an acceleration that acts on it like one.
    Frame,
    /// Its own motion.
    Motion,
    /// Tension by pins that are farther apart than the cloth between them is long.
    Tension,
    /// Colliders that it is pressed against, or that come near.
    Contacts,
}

/// A class of effort: cloths of one class and fabric take the same number of substeps. Classes are few, so that
/// batches are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EffortClass(u8);

impl EffortClass {
    /// Number of classes.
    pub const COUNT: usize = CLASSES as usize;

    /// The least class whose cloths bear an acceleration, m/s², and at most `highest`.
    pub(super) fn of(acceleration: f32, highest: u8) -> Self {
        let mut class = 0;
        let mut most = LEAST;
        while acceleration > most && class < highest {
            most *= RATIO;
            class += 1;
        }
        Self(class)
    }

    /// The class of the greatest effort.
    pub(super) const HIGHEST: u8 = CLASSES - 1;

    /// Number of the class, zero for the least effort.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// Acceleration for which the substeps of the class are chosen under a gravity, m/s²: the argument of
    /// [`StepLimits::of_fabric`](crate::StepLimits::of_fabric).
    #[must_use]
    pub fn acceleration(self, gravity: f32) -> f32 {
        match self.0 {
            0 => gravity,
            class => gravity.max(LEAST * RATIO.powi(class.into())),
        }
    }
}
