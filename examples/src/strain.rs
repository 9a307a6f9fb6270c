//! Strain of cloth.

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_solver::LinkFamily;

use crate::limits::greatest;

/// The mean strain of warp and weft of the cloth in which it is greatest.
pub fn greatest_mean(world: &mut World) -> f32 {
    let mut cloths = world.query::<&ClothState>();
    greatest(cloths.iter(world).map(|cloth| {
        let mut strain = Strain::default();
        strain.add(cloth, LinkFamily::Warp);
        strain.add(cloth, LinkFamily::Weft);
        strain.mean() as f32
    }))
}

/// Magnitudes of the strain of many links, |l/l₀ − 1|.
#[derive(Clone, Copy, Debug, Default)]
pub struct Strain {
    sum: f64,
    count: u64,
    greatest: f32,
}

impl Strain {
    /// Adds all links of one family of a cloth: warp, weft or diagonal.
    pub fn add(&mut self, cloth: &ClothState, family: LinkFamily) {
        let Some(fabric) = cloth.fabric() else { return };
        for link in fabric.links().iter().filter(|link| link.family == family) {
            let [from, to] = link.particles.map(|particle| cloth.positions()[particle as usize]);
            let strain = (from.distance(to) / link.rest_length - 1.0).abs();
            self.sum += f64::from(strain);
            self.count += 1;
            self.greatest = self.greatest.max(strain);
        }
    }

    /// The mean.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// The greatest.
    pub fn greatest(&self) -> f32 {
        self.greatest
    }
}
