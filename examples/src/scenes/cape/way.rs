//! The figure's way.

use std::f32::consts::{FRAC_PI_2, PI};

use crate::figure::walker::{RUN, WALK};
use crate::figure::way::Way;

/// It stands, walks, turns, runs, and stops.
pub const WAY: Way = Way {
    speed: &[[1.5, 0.7, WALK], [6.5, 1.0, RUN - WALK], [11.0, 0.9, -RUN]],
    turns: &[[3.8, 1.2, FRAC_PI_2], [8.6, 0.9, -FRAC_PI_2], [12.4, 0.7, PI * 0.6]],
    sits: &[],
};
