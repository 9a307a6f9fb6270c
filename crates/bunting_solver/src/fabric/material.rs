//! The material of a cloth, in SI units.

use super::error::FabricError;

/// A woven or knitted material, in SI units.
///
/// Masses and compliances at every level of detail follow from these values, so that a cloth behaves alike at
/// every resolution.
///
/// ```
/// use bunting_solver::FabricMaterial;
///
/// // Canvas: heavier and stiffer than clothes.
/// let canvas = FabricMaterial { area_density: 0.32, bend_stiffness: 6e-5, ..FabricMaterial::COTTON };
/// # assert!(canvas.area_density > FabricMaterial::COTTON.area_density);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FabricMaterial {
    /// Area density: mass per area, kg/m².
    pub area_density: f32,
    /// Stretch stiffness along the warp (the u axis), N/m. Infinite: inextensible (PBD).
    pub warp_stiffness: f32,
    /// Stretch stiffness along the weft (the v axis), N/m. Infinite: inextensible (PBD).
    pub weft_stiffness: f32,
    /// Shear stiffness G, N/m: the energy is ½ G γ² per square metre at a shear angle of γ rad.
    pub shear_stiffness: f32,
    /// Bending stiffness B, N·m: the energy is ½ B κ² per square metre at a curvature of κ 1/m.
    pub bend_stiffness: f32,
    /// Rate at which all motion relative to the cloth's frame decays, 1/s.
    pub damping: f32,
    /// Rate at which all motion except the cloth's rigid motion decays, 1/s (thesis, appendix A).
    pub internal_damping: f32,
    /// Air pressure coefficient C_n: a triangle facing the air feels ½ ρ C_n A u_n².
    pub pressure_coefficient: f32,
    /// Skin friction coefficient C_t: a triangle along the air feels ½ ρ C_t A u².
    pub friction_coefficient: f32,
    /// Distance that the cloth's middle surface keeps from colliders, m.
    pub thickness: f32,
    /// Coulomb friction coefficient against colliders.
    pub surface_friction: f32,
}

/// Least area density, kg/m²: that of graphene. Smaller: accelerations by air and links overflow.
const LEAST_DENSITY: f32 = 1e-6;

/// Least stretch stiffness, N/m. Smaller: compliances overflow.
const LEAST_STIFFNESS: f32 = 1e-6;

/// Presets, with values after Wang, O'Brien and Ramamoorthi 2011, "Data-driven elastic models for cloth": the
/// stretch stiffness is the slope at the smallest measured strain, and the paper's bending coefficient k
/// corresponds to B ≈ k/4.
impl FabricMaterial {
    /// Knitted flag polyester. Density: flag makers' 110–115 g/m². Stretch, shear and bending:
    /// Wang et al. 2011, polyester tablecloth (2002/2027/19 N/m, k = 41 µN·m). The rest: estimates.
    pub const FLAG_POLYESTER: Self = Self {
        area_density: 0.113,
        warp_stiffness: 2002.0,
        weft_stiffness: 2027.0,
        shear_stiffness: 19.0,
        bend_stiffness: 1.03e-5,
        damping: 0.3,
        internal_damping: 0.0,
        pressure_coefficient: 1.2,
        friction_coefficient: 0.02,
        thickness: 5e-4,
        surface_friction: 0.3,
    };

    /// Woven flag nylon. Density: flag makers' 200 denier, about 70 g/m². The rest: estimates.
    pub const NYLON: Self = Self {
        area_density: 0.07,
        warp_stiffness: 1500.0,
        weft_stiffness: 1500.0,
        shear_stiffness: 15.0,
        bend_stiffness: 6e-6,
        thickness: 2e-4,
        surface_friction: 0.2,
        ..Self::FLAG_POLYESTER
    };

    /// Plain woven cotton. Density: shirting poplin, about 120 g/m². The rest: estimates.
    pub const COTTON: Self = Self {
        area_density: 0.12,
        warp_stiffness: 1200.0,
        weft_stiffness: 800.0,
        shear_stiffness: 25.0,
        bend_stiffness: 1e-5,
        thickness: 4e-4,
        surface_friction: 0.4,
        ..Self::FLAG_POLYESTER
    };

    /// Habotai silk. Density: 14 momme at 4.34 g/m² each. The rest: estimates.
    pub const SILK: Self = Self {
        area_density: 0.061,
        warp_stiffness: 1000.0,
        weft_stiffness: 1000.0,
        shear_stiffness: 8.0,
        bend_stiffness: 3e-6,
        thickness: 1.5e-4,
        surface_friction: 0.2,
        ..Self::FLAG_POLYESTER
    };

    /// Cotton denim. Density, stretch, shear and bending: Wang et al. 2011 (k = 80 µN·m).
    /// The rest: estimates.
    pub const DENIM: Self = Self {
        area_density: 0.324,
        warp_stiffness: 205.0,
        weft_stiffness: 1014.0,
        shear_stiffness: 53.0,
        bend_stiffness: 2e-5,
        thickness: 9e-4,
        surface_friction: 0.5,
        ..Self::FLAG_POLYESTER
    };

    /// Checks that the values can be simulated.
    ///
    /// # Errors
    ///
    /// [`FabricError::Material`] names the first invalid value: a density below 10⁻⁶ kg/m² or not finite, a
    /// stretch stiffness below 10⁻⁶ N/m, any other value that is negative or not finite.
    pub fn validate(&self) -> Result<(), FabricError> {
        let density = |value: f32| value >= LEAST_DENSITY && value.is_finite();
        let stretch = |value: f32| value >= LEAST_STIFFNESS;
        let other = |value: f32| value >= 0.0 && value.is_finite();
        let checks = [
            ("area_density", self.area_density, density as fn(f32) -> bool),
            ("warp_stiffness", self.warp_stiffness, stretch),
            ("weft_stiffness", self.weft_stiffness, stretch),
            ("shear_stiffness", self.shear_stiffness, other),
            ("bend_stiffness", self.bend_stiffness, other),
            ("damping", self.damping, other),
            ("internal_damping", self.internal_damping, other),
            ("pressure_coefficient", self.pressure_coefficient, other),
            ("friction_coefficient", self.friction_coefficient, other),
            ("thickness", self.thickness, other),
            ("surface_friction", self.surface_friction, other),
        ];
        match checks.into_iter().find(|&(_, value, is_valid)| !is_valid(value)) {
            Some((name, value, _)) => Err(FabricError::Material { name, value }),
            None => Ok(()),
        }
    }

    /// The material along two directions at right angles, the first at an angle to the warp of which `cos2` is cos².
    ///
    /// Young's moduli and the shear modulus follow the rule for orthotropic sheets (Jones 1999, 2.6), without
    /// Poisson's ratio, which links at right angles have not. A strip that is cut along either direction is then as
    /// stiff as the cloth, but does not narrow when it is pulled.
    #[must_use]
    pub(crate) fn turned(&self, cos2: f32) -> Self {
        // Also keeps inextensible materials: ∞ × 0 is not a number.
        if cos2 == 1.0 {
            return *self;
        }
        let sin2 = 1.0 - cos2;
        let softness =
            [self.warp_stiffness, self.weft_stiffness, self.shear_stiffness].map(f32::recip);
        let [warp, weft, shear] = softness;
        let along =
            |cos2: f32, sin2: f32| cos2 * cos2 * warp + sin2 * sin2 * weft + cos2 * sin2 * shear;
        let sheared = 4.0 * cos2 * sin2 * (warp + weft) + (cos2 - sin2).powi(2) * shear;
        Self {
            warp_stiffness: along(cos2, sin2).recip(),
            weft_stiffness: along(sin2, cos2).recip(),
            shear_stiffness: sheared.recip(),
            ..*self
        }
    }

    /// The stiffnesses `[C₁₁, C₂₂, G]` in N/m with which a lattice of links has the material's measured
    /// stiffnesses, if its diagonals resist stretch as well as shear.
    ///
    /// Such diagonals couple warp and weft by C₁₂ = G. A strip that is pulled along the warp and free to
    /// narrow then measures C₁₁ − C₁₂²/C₂₂; setting this equal to the warp stiffness, and likewise for the
    /// weft, gives C₁₁ and C₂₂. If diagonals resist shear alone (`constraints/shear.rs`), the material's own
    /// stiffnesses hold.
    pub(crate) fn lattice_moduli(&self) -> [f32; 3] {
        let (warp, weft, shear) = (self.warp_stiffness, self.weft_stiffness, self.shear_stiffness);
        if !warp.is_finite() || !weft.is_finite() {
            return [warp, weft, shear];
        }
        let factor = 0.5 * (1.0 + (1.0 + 4.0 * shear * shear / (warp * weft)).sqrt());
        [warp * factor, weft * factor, shear]
    }
}

impl Default for FabricMaterial {
    fn default() -> Self {
        Self::FLAG_POLYESTER
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattice_moduli_measure_as_the_material() {
        for material in
            [FabricMaterial::FLAG_POLYESTER, FabricMaterial::DENIM, FabricMaterial::COTTON]
        {
            let [c11, c22, g] = material.lattice_moduli();
            let (warp, weft) = (c11 - g * g / c22, c22 - g * g / c11);
            assert!((warp / material.warp_stiffness - 1.0).abs() < 1e-5, "{warp}");
            assert!((weft / material.weft_stiffness - 1.0).abs() < 1e-5, "{weft}");
        }
    }

    #[test]
    fn bad_values_are_named() {
        let bad = FabricMaterial { area_density: -1.0, ..FabricMaterial::SILK };
        assert!(matches!(bad.validate(), Err(FabricError::Material { name: "area_density", .. })));
        let bad = FabricMaterial { area_density: 1e-30, ..FabricMaterial::SILK };
        assert!(matches!(bad.validate(), Err(FabricError::Material { name: "area_density", .. })));
        let bad = FabricMaterial { weft_stiffness: 1e-30, ..FabricMaterial::SILK };
        assert!(matches!(
            bad.validate(),
            Err(FabricError::Material { name: "weft_stiffness", .. })
        ));
        let bad = FabricMaterial { bend_stiffness: f32::NAN, ..FabricMaterial::SILK };
        assert!(matches!(
            bad.validate(),
            Err(FabricError::Material { name: "bend_stiffness", .. })
        ));
    }

    #[test]
    fn presets_are_valid() {
        for preset in [
            FabricMaterial::FLAG_POLYESTER,
            FabricMaterial::NYLON,
            FabricMaterial::COTTON,
            FabricMaterial::SILK,
            FabricMaterial::DENIM,
        ] {
            preset.validate().expect("a preset must be valid");
        }
    }
}
