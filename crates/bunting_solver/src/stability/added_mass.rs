//! Added mass where many particles hang from few.
//!
//! The directions of a yarn's links are frozen while it is solved, so the transverse vibration of a
//! taut link, ω² = T/(m l), is explicit, and unstable beyond h² T/(m l) ≈ ⅓. Yarns and bias, solved one
//! after the other, do not agree either where what they hold is heavier than what they move. A point
//! support carries a whole cloth on a few light particles, and so does the upper end of an upright
//! pole, and pins that are too far apart strain the cloth between them whatever it weighs. There the
//! inertia is raised to what the substep can follow, from static bounds alone; gravity acts on the true
//! mass, so that rest states are exact.

use crate::constants::{GRAVITY, LEAST_LINK_COMPLIANCE};
use crate::fabric::{Fabric, FabricMaterial};
use crate::stability::pin_strain::Overstretch;
use crate::stability::pole::Pole;

/// Inertia that a particle needs, in units of (β h)² T/l: 4.2 was found to calm a cloth hung by two
/// corners, with some to spare, up to 65 × 65 at three substeps.
const INERTIA_PER_TENSION: f32 = 4.2;

/// Part of a cloth's weight that is reckoned with at each end of its pole: with 0.3 a limp flag of
/// 33 × 33 still trembles at two substeps.
const LOAD_OF_END: f32 = 0.4;

/// Most that may be added near the ends of a pole, as a part of the whole cloth's mass: what is more
/// takes the life out of a flag.
const MOST_ADDED: f32 = 0.45;

/// One over each particle's inertia, in units of the density.
#[derive(Clone, Debug)]
pub(crate) struct Weights {
    /// Of a cloth that does not hang along its pole, 1/m²; zero where it is pinned.
    pub across: Vec<f32>,
    /// How much less they are of one that does, 1/m².
    pub eased: Vec<f32>,
}

/// What the weights of one cloth depend on besides the substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hung {
    /// How far its pole stands upright, see [`Pole::uprightness`].
    pub upright: f32,
    /// Inertia that its particles need where pins that are too far apart strain it by one, m².
    pub inertia_per_strain: f32,
}

impl Hung {
    /// Of a cloth in substeps of the effective length `step`, s.
    pub fn new(
        upright: f32,
        overstretch: &Overstretch,
        fabric: &Fabric,
        material: &FabricMaterial,
        step: f32,
    ) -> Self {
        let inertia_per_strain = if overstretch.strains.is_empty() {
            0.0
        } else {
            inertia_per_strain(fabric, material, step)
        };
        Self { upright, inertia_per_strain }
    }
}

impl Weights {
    /// Those of the bare cloth.
    pub fn bare(fabric: &Fabric) -> Self {
        let across = fabric.inverse_areas().to_vec();
        Self { eased: vec![0.0; across.len()], across }
    }

    /// Those that a substep of the effective length `step`, s, needs.
    pub fn new(fabric: &Fabric, step: f32) -> Self {
        let mut weights = Self::bare(fabric);
        let pins = fabric.pins();
        if !pins.is_empty() && pins.iter().all(|pin| pin.isolated) {
            let pins: Vec<u32> = pins.iter().map(|pin| pin.particle).collect();
            let load = fabric.area() * GRAVITY / pins.len() as f32;
            for (weight, needed) in weights.across.iter_mut().zip(needed(fabric, &pins, load, step))
            {
                *weight = weight.min(1.0 / needed);
            }
        } else if let Some(pole) = Pole::of(fabric) {
            let load = fabric.area() * GRAVITY * LOAD_OF_END;
            let areas = weights.across.iter().map(|weight| 1.0 / weight);
            // Pins have no end of inertia, and need none.
            let added: Vec<f32> = needed(fabric, &pole.ends(fabric), load, step)
                .zip(areas)
                .map(|(needed, area)| (needed - area).max(0.0))
                .collect();
            let most = MOST_ADDED * fabric.area();
            let part = (most / added.iter().sum::<f32>().max(most)).min(1.0);
            for ((eased, &weight), added) in
                weights.eased.iter_mut().zip(&weights.across).zip(added)
            {
                // 1/A − 1/(A + ΔA)
                let relative = weight * added * part;
                *eased = weight * relative / (1.0 + relative);
            }
        }
        weights
    }

    /// Those of one cloth, 1/m²; zero where it is pinned.
    pub fn of_lane(&self, hung: Hung, overstretch: &Overstretch) -> Vec<f32> {
        let pairs = self.across.iter().zip(&self.eased);
        let mut weights: Vec<f32> =
            pairs.map(|(across, eased)| across - eased * hung.upright).collect();
        for (weight, strain) in weights.iter_mut().zip(&overstretch.strains) {
            *weight = weight.min(1.0 / (hung.inertia_per_strain * strain));
        }
        weights
    }
}

/// One over each weight, and zero for zero.
pub(crate) fn inertias(weights: &[f32]) -> Vec<f32> {
    weights.iter().map(|&weight| if weight > 0.0 { 1.0 / weight } else { 0.0 }).collect()
}

/// The inertia that a particle needs about which the cloth is strained by one, m².
///
/// Of a strip as wide as its links are long the tension over that length is the strain times the
/// stiffness, at every resolution.
fn inertia_per_strain(fabric: &Fabric, material: &FabricMaterial, step: f32) -> f32 {
    let stiffest = material.warp_stiffness.max(material.weft_stiffness);
    let most = fabric.particle_areas()[0] / LEAST_LINK_COMPLIANCE;
    INERTIA_PER_TENSION * (step * step * stiffest / material.area_density).min(most)
}

/// The inertia that each particle needs, m², given where a load, m³/s², is carried.
fn needed(fabric: &Fabric, supports: &[u32], load: f32, step: f32) -> impl Iterator<Item = f32> {
    let rest = fabric.rest_positions();
    let spacing = fabric.links().iter().map(|link| link.rest_length).fold(f32::MAX, f32::min);
    rest.iter().map(move |at| {
        let away = supports.iter().map(|&support| at.distance(rest[support as usize]));
        let nearest = away.fold(f32::MAX, f32::min);
        // A point load spreads as it goes away from its pin.
        let tension = load / (nearest / spacing).max(1.0);
        INERTIA_PER_TENSION * step * step * tension / spacing
    })
}

#[cfg(test)]
mod tests {
    use super::{MOST_ADDED, Weights};
    use crate::fabric::{Fabric, FabricBuilder, Grid};

    /// Effective length of a substep, s.
    const STEP: f32 = 0.005;

    fn flag() -> Fabric {
        let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
        grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric")
    }

    #[test]
    fn a_pole_has_heavy_ends_where_it_stands_upright_alone() {
        let fabric = flag();
        let Weights { across, eased } = Weights::new(&fabric, STEP);
        assert_eq!(across, fabric.inverse_areas());
        // Pins and what is far away stay as they are.
        assert_eq!([eased[0], eased[32 * 33], eased[16 * 33 + 32]], [0.0; 3]);
        let beside = [1, 32 * 33 + 1];
        assert!(beside.iter().all(|&particle| eased[particle] > 0.9 * across[particle]));
    }

    #[test]
    fn no_more_is_added_than_may_be() {
        let fabric = flag();
        for (step, is_most) in [(STEP, false), (4.0 * STEP, true)] {
            let Weights { across, eased } = Weights::new(&fabric, step);
            let free = across.iter().zip(eased).filter(|(across, _)| **across > 0.0);
            let added: f32 =
                free.map(|(across, eased)| 1.0 / (across - eased) - 1.0 / across).sum();
            let most = MOST_ADDED * fabric.area();
            assert!(added < 1.001 * most, "{added} m²");
            assert_eq!(added > 0.999 * most, is_most, "{added} m²");
        }
    }

    #[test]
    fn points_are_heavy_however_the_cloth_hangs() {
        let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
        let fabric = grid.pin([0, 32]).build().expect("a good fabric");
        let Weights { across, eased } = Weights::new(&fabric, STEP);
        assert!(across[1] < 0.1 * fabric.inverse_areas()[1]);
        assert!(eased.iter().all(|&eased| eased == 0.0));
    }
}
