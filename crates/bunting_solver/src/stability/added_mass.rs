//! Added mass where few particles carry a large load.
//!
//! The directions of a chain's links are frozen while the chain is solved. The transverse vibration of a link
//! under the tension T, ω² = T/(m l), is therefore explicit, and unstable beyond h² T/(m l) ≈ ⅓. Chains of
//! different directions, solved one after the other, do not converge either if the load is heavier than the
//! particles that carry it. Mass is added in three cases: isolated pins carry a whole cloth on a few light
//! particles; so does the upper end of an upright pole; and pins that are too far apart strain the cloth
//! between them whatever it weighs. There the inertia is raised to the least that the substep can resolve,
//! from static bounds alone. Gravity acts on the true mass, so that rest states are exact.

use crate::constants::{GRAVITY, LEAST_LINK_COMPLIANCE};
use crate::fabric::{Fabric, FabricMaterial};
use crate::stability::pin_strain::PinStrain;
use crate::stability::pole::Pole;

/// Inertia that a particle needs, in units of (β h)² T/l. Smaller: a cloth that hangs by two corners
/// oscillates; 4.2 keeps it still, with some to spare, up to 65 × 65 particles with three substeps.
const INERTIA_PER_TENSION: f32 = 4.2;

/// Fraction of a cloth's weight that each end of its pole is assumed to carry. Smaller: with 0.3 a limp flag
/// of 33 × 33 particles oscillates with two substeps.
const LOAD_OF_END: f32 = 0.4;

/// Greatest mass added near the ends of a pole, as a fraction of the whole cloth's. Larger: a flag moves
/// sluggishly.
const MOST_ADDED: f32 = 0.45;

/// Inputs of one cloth's inverse masses, besides the substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AddedMass {
    /// Uprightness of the cloth's pole, see [`Pole::uprightness`].
    pub uprightness: f32,
    /// Inertia that a particle needs for each unit of strain by pins, m².
    pub inertia_per_strain: f32,
}

impl AddedMass {
    /// The inputs of a cloth for substeps of the effective length `step`, s.
    pub fn new(
        uprightness: f32,
        pin_strain: &PinStrain,
        fabric: &Fabric,
        material: &FabricMaterial,
        step: f32,
    ) -> Self {
        let inertia_per_strain = if pin_strain.of_particles.is_empty() {
            0.0
        } else {
            inertia_per_strain(fabric, material, step)
        };
        Self { uprightness, inertia_per_strain }
    }
}

/// Inverse mass of each particle of a fabric per unit of area density, for substeps of one length.
#[derive(Clone, Debug)]
pub(crate) struct InverseMasses {
    /// Inverse masses with a level pole, or without a pole, 1/m²; zero if pinned.
    pub level: Vec<f32>,
    /// Reduction of the inverse masses by an upright pole, 1/m².
    pub upright_reduction: Vec<f32>,
}

impl InverseMasses {
    /// Inverse masses without added mass: one over the areas.
    pub fn without_added(fabric: &Fabric) -> Self {
        let level = fabric.inverse_areas().to_vec();
        Self { upright_reduction: vec![0.0; level.len()], level }
    }

    /// Inverse masses with the added mass that a substep of the effective length `step`, s, needs.
    pub fn new(fabric: &Fabric, step: f32) -> Self {
        let mut masses = Self::without_added(fabric);
        let pins = fabric.pins();
        if !pins.is_empty() && pins.iter().all(|pin| pin.isolated) {
            let pins: Vec<u32> = pins.iter().map(|pin| pin.particle).collect();
            let load = fabric.mass_area() * GRAVITY / pins.len() as f32;
            let needed = needed(fabric, &pins, load, step);
            for (inverse_mass, needed) in masses.level.iter_mut().zip(needed) {
                *inverse_mass = inverse_mass.min(1.0 / needed);
            }
        } else if let Some(pole) = Pole::of(fabric) {
            masses.upright_reduction = upright_reduction(fabric, &pole, step);
        }
        masses
    }

    /// Inverse masses of one cloth, 1/m²; zero if pinned.
    pub fn of_cloth(&self, added_mass: AddedMass, pin_strain: &PinStrain) -> Vec<f32> {
        let pairs = self.level.iter().zip(&self.upright_reduction);
        let mut inverse_masses: Vec<f32> =
            pairs.map(|(level, reduction)| level - reduction * added_mass.uprightness).collect();
        for (inverse_mass, strain) in inverse_masses.iter_mut().zip(&pin_strain.of_particles) {
            *inverse_mass = inverse_mass.min(1.0 / (added_mass.inertia_per_strain * strain));
        }
        inverse_masses
    }
}

/// One over each inverse mass, m²; zero if the inverse mass is zero.
pub(crate) fn inertias(inverse_masses: &[f32]) -> Vec<f32> {
    let inertia = |&inverse_mass: &f32| if inverse_mass > 0.0 { 1.0 / inverse_mass } else { 0.0 };
    inverse_masses.iter().map(inertia).collect()
}

/// Reduction of a cloth's inverse masses by an upright pole, compared with one over the areas, 1/m².
fn upright_reduction(fabric: &Fabric, pole: &Pole, step: f32) -> Vec<f32> {
    let load = fabric.mass_area() * GRAVITY * LOAD_OF_END;
    let inverse_areas = fabric.inverse_areas();
    let areas = inverse_areas.iter().map(|inverse_area| 1.0 / inverse_area);
    // The mass of pins is infinite, so nothing is added to it.
    let added: Vec<f32> = needed(fabric, &pole.ends(fabric), load, step)
        .zip(areas)
        .map(|(needed, area)| (needed - area).max(0.0))
        .collect();
    let most = MOST_ADDED * fabric.mass_area();
    let part = (most / added.iter().sum::<f32>().max(most)).min(1.0);
    let reduction = |(&inverse_area, added): (&f32, f32)| {
        // The reduction 1/A − 1/(A + ΔA).
        let relative = inverse_area * added * part;
        inverse_area * relative / (1.0 + relative)
    };
    inverse_areas.iter().zip(added).map(reduction).collect()
}

/// Inertia that a particle needs for each unit of strain by pins, m².
///
/// In a strip as wide as its links are long, the tension over that length is the strain times the stiffness,
/// at every resolution.
fn inertia_per_strain(fabric: &Fabric, material: &FabricMaterial, step: f32) -> f32 {
    let stiffest = fabric.extremes().stiffest_stretch(material);
    let most = fabric.extremes().light_mass / LEAST_LINK_COMPLIANCE;
    INERTIA_PER_TENSION * (step * step * stiffest / material.area_density).min(most)
}

/// The inertia that each particle needs, m², where each of some particles supports a load, m³/s².
fn needed(fabric: &Fabric, supports: &[u32], load: f32, step: f32) -> impl Iterator<Item = f32> {
    let rest = fabric.rest_positions();
    let spacing = fabric.links().iter().map(|link| link.rest_length).fold(f32::MAX, f32::min);
    rest.iter().map(move |at| {
        let away = supports.iter().map(|&support| at.distance(rest[support as usize]));
        let nearest = away.fold(f32::MAX, f32::min);
        // A point load spreads with the distance from its support.
        let tension = load / (nearest / spacing).max(1.0);
        INERTIA_PER_TENSION * step * step * tension / spacing
    })
}

#[cfg(test)]
mod tests {
    use super::{InverseMasses, MOST_ADDED};
    use crate::fabric::{Fabric, FabricBuilder, Grid};

    /// Effective length of a substep, s.
    const STEP: f32 = 0.005;

    fn flag() -> Fabric {
        let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
        grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric")
    }

    #[test]
    fn an_upright_pole_adds_mass_at_its_ends() {
        let fabric = flag();
        let InverseMasses { level, upright_reduction } = InverseMasses::new(&fabric, STEP);
        assert_eq!(level, fabric.inverse_areas());
        // Pins and particles far from the ends stay as they are.
        let [end, other_end, far] = [0, 32 * 33, 16 * 33 + 32];
        assert_eq!([end, other_end, far].map(|particle| upright_reduction[particle]), [0.0; 3]);
        let beside = [1, 32 * 33 + 1];
        assert!(beside.iter().all(|&at| upright_reduction[at] > 0.9 * level[at]));
    }

    #[test]
    fn added_mass_is_limited() {
        let fabric = flag();
        for (step, is_most) in [(STEP, false), (4.0 * STEP, true)] {
            let InverseMasses { level, upright_reduction } = InverseMasses::new(&fabric, step);
            let free = level.iter().zip(upright_reduction).filter(|(level, _)| **level > 0.0);
            let added: f32 =
                free.map(|(level, reduction)| 1.0 / (level - reduction) - 1.0 / level).sum();
            let most = MOST_ADDED * fabric.area();
            assert!(added < 1.001 * most, "{added} m²");
            assert_eq!(added > 0.999 * most, is_most, "{added} m²");
        }
    }

    #[test]
    fn pins_that_stand_alone_add_mass_whatever_the_direction() {
        let grid = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0));
        let fabric = grid.pin([0, 32]).build().expect("a good fabric");
        let InverseMasses { level, upright_reduction } = InverseMasses::new(&fabric, STEP);
        assert!(level[1] < 0.1 * fabric.inverse_areas()[1]);
        assert!(upright_reduction.iter().all(|&reduction| reduction == 0.0));
    }
}
