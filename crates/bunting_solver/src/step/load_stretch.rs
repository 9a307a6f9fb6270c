//! Bounds on the stretch of a cloth by loads and pins, from its size, its material and its loads.

use crate::fabric::FabricMaterial;
use crate::step::Drive;

/// Strain by wind above which the strain counts as an unsolved error and not as the material's. Larger:
/// diagonals no longer hold a flag that a storm has stretched too far. Smaller: cloth that the wind holds
/// taut stretches too little.
const GREATEST_WIND_STRAIN: f32 = 0.01;

/// Factor on the bounds by which tethers are longer than at rest, so that they do not hide the material's own
/// strain.
const TETHER_MARGIN: f32 = 2.0;

/// Lengths under load, in units of those at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LoadStretch {
    /// Lengths of tethers to the farthest pins, which run along diagonals, and to the nearest pins.
    pub tethers: [f32; 2],
    /// Greatest length of a grid's diagonals.
    pub diagonals: f32,
}

impl LoadStretch {
    /// Bounds for a cloth that hangs by a length of `reach` metres, whose pins strain it by `pin_strain`, and on which the air inside pushes
    /// with a pressure of `inside` Pa.
    pub fn new(
        material: &FabricMaterial,
        drive: &Drive,
        reach: f32,
        pin_strain: f32,
        inside: f32,
    ) -> Self {
        let tensions = greatest_tensions(material, drive, reach, inside);
        let strains = |softness: f32| tensions.map(|tension| tension * softness);
        let tether = |[by_weight, by_wind]: [f32; 2]| {
            1.0 + TETHER_MARGIN * (pin_strain + by_weight + by_wind)
        };
        let softness = 1.0 / material.warp_stiffness.min(material.weft_stiffness);
        let straight = strains(softness);
        let [by_weight, by_wind] = straight;
        Self {
            tethers: [tether(strains(diagonal_softness(material))), tether(straight)],
            diagonals: 1.0 + pin_strain + by_weight + by_wind.min(GREATEST_WIND_STRAIN),
        }
    }
}

/// Strain along a diagonal for each N/m of tension, m/N: of warp and weft, and of shear.
fn diagonal_softness(material: &FabricMaterial) -> f32 {
    let FabricMaterial { warp_stiffness, weft_stiffness, shear_stiffness, .. } = *material;
    0.25 * (1.0 / warp_stiffness + 1.0 / weft_stiffness + 1.0 / shear_stiffness)
}

/// Greatest tensions at the top of a cloth that hangs by a length of `reach` metres, by its weight and by the
/// wind and the air inside, N/m.
fn greatest_tensions(
    material: &FabricMaterial,
    drive: &Drive,
    reach: f32,
    inside: f32,
) -> [f32; 2] {
    let weight = material.area_density * drive.gravity.length();
    let coefficients = material.pressure_coefficient + material.friction_coefficient;
    let pressure = 0.5 * drive.air_density * coefficients * drive.wind.length_squared();
    [weight * reach, (pressure + inside) * reach]
}
