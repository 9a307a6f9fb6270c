//! How fast a cloth still is that hangs without wind at the damping of a flag.

use std::sync::Arc;

use bunting_solver::{Drive, Fabric, FabricMaterial};
use serde::Serialize;

use super::{alone::Cloth, held};
use crate::flight::almost_at_rest;

/// Times after which the speed is taken, s: of a swing that decays by damping alone a fifth is left after the first, at .3/s, and
/// a four-hundredth after the second.
const HUNG: [f32; 2] = [10.0, 40.0];

/// RMS speeds of what hangs of a cloth that was let go almost at rest, m/s.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Rest {
    /// After 10 s and after 40 s.
    pub speeds: [f64; 2],
}

impl Rest {
    /// Of a cloth in still air.
    pub fn of(fabric: &Arc<Fabric>, material: FabricMaterial) -> Self {
        let mut cloth = Cloth::new(fabric, &almost_at_rest(fabric), material);
        let [first, second] = HUNG;
        let speeds = [first, second - first].map(|seconds| {
            cloth.advance(seconds, Drive::default());
            held::speed(&cloth.batch)
        });
        Self { speeds }
    }
}
