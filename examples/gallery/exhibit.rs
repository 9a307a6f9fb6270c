//! The examples of the gallery.

use clap::ValueEnum;

/// An example.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Exhibit {
    Flags,
    Crowd,
    Storm,
    Parasol,
    Drape,
    Curtain,
    Towel,
    Swatches,
    Cape,
    Wardrobe,
    CustomConstraint,
    #[cfg(feature = "avian")]
    Convoy,
    #[cfg(feature = "avian")]
    Rollback,
}

impl Exhibit {
    /// Its name on command lines and in addresses.
    pub fn name(self) -> String {
        self.to_possible_value().expect("no example is skipped").get_name().to_owned()
    }

    /// Simulated time at which the picture shows the example, s.
    pub fn time(self) -> f64 {
        match self {
            Self::Flags => 8.5,
            Self::Crowd => 5.0,
            Self::Storm => 3.8,
            Self::Parasol => 3.0,
            Self::Drape => 4.4,
            Self::Curtain => 5.0,
            Self::Towel => 4.0,
            Self::Swatches => 2.5,
            Self::Cape => 8.0,
            Self::Wardrobe => 4.6,
            Self::CustomConstraint => 2.0,
            #[cfg(feature = "avian")]
            Self::Convoy => 6.0,
            #[cfg(feature = "avian")]
            Self::Rollback => 1.6,
        }
    }
}
