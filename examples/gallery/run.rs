//! Runs an example of the gallery.

use std::process::ExitCode;

use bevy_bunting::prelude::*;
use bunting_examples::scenes::cape::Cape;
#[cfg(feature = "avian")]
use bunting_examples::scenes::convoy::Convoy;
use bunting_examples::scenes::crowd::Crowd;
use bunting_examples::scenes::curtain::Curtain;
use bunting_examples::scenes::custom_constraint::CustomConstraint;
use bunting_examples::scenes::drape::Drape;
use bunting_examples::scenes::flags::Flags;
use bunting_examples::scenes::parasol::Parasols;
#[cfg(feature = "avian")]
use bunting_examples::scenes::rollback::Rollback;
use bunting_examples::scenes::storm::Storm;
use bunting_examples::scenes::swatches::Swatches;
use bunting_examples::scenes::towel::Towels;
use bunting_examples::scenes::wardrobe::Wardrobe;
use bunting_examples::{Example, Options};

use crate::exhibit::Exhibit;

/// Number of cloths of the crowd.
const CROWD: usize = 1000;

impl Exhibit {
    /// Runs it in a window, or headless until the time of its picture.
    pub fn run(self, options: &Options) -> ExitCode {
        let options = options.until(self.time());
        match self {
            Self::Flags => match Flags::load() {
                Ok(flags) => show(&flags, &options),
                Err(error) => {
                    eprintln!("{error}");
                    ExitCode::FAILURE
                }
            },
            Self::Crowd => show(&crowd(), &options),
            Self::Storm => show(&Storm, &options),
            Self::Parasol => show(&Parasols, &options),
            Self::Drape => show(&Drape, &options),
            Self::Curtain => show(&Curtain, &options),
            Self::Towel => show(&Towels, &options),
            Self::Swatches => show(&Swatches, &options),
            Self::Cape => show(&Cape, &options),
            Self::Wardrobe => show(&Wardrobe, &options),
            Self::CustomConstraint => show(&CustomConstraint, &options),
            #[cfg(feature = "avian")]
            Self::Convoy => show(&Convoy, &options),
            #[cfg(feature = "avian")]
            Self::Rollback => show(&Rollback::default(), &options),
        }
    }
}

fn crowd() -> Crowd {
    Crowd {
        cloths: CROWD,
        budget: ClothBudget::default(),
        #[cfg(feature = "render")]
        levels: false,
    }
}

#[cfg(feature = "render")]
fn show<E: Example>(example: &E, options: &Options) -> ExitCode {
    options.run(&crate::hall::Hall(example))
}

#[cfg(not(feature = "render"))]
fn show(example: &impl Example, options: &Options) -> ExitCode {
    options.run(example)
}
