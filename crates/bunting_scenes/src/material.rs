//! Materials by name.

use bunting_solver::FabricMaterial;
use serde::Deserialize;

/// The presets of [`FabricMaterial`], by the names that scene files use.
pub const PRESETS: [(&str, FabricMaterial); 5] = [
    ("flag polyester", FabricMaterial::FLAG_POLYESTER),
    ("nylon", FabricMaterial::NYLON),
    ("cotton", FabricMaterial::COTTON),
    ("silk", FabricMaterial::SILK),
    ("denim", FabricMaterial::DENIM),
];

/// The preset with this name.
#[must_use]
pub fn preset(name: &str) -> Option<FabricMaterial> {
    PRESETS.into_iter().find_map(|(known, material)| (known == name).then_some(material))
}

/// A material in a scene file: a preset, and the values that differ from it, in the units of
/// [`FabricMaterial`].
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the fields are those of FabricMaterial, documented there")]
pub struct MaterialRecipe {
    /// Name of the preset that gives the missing values.
    pub like: String,
    pub area_density: Option<f32>,
    pub warp_stiffness: Option<f32>,
    pub weft_stiffness: Option<f32>,
    pub shear_stiffness: Option<f32>,
    pub bend_stiffness: Option<f32>,
    pub damping: Option<f32>,
    pub internal_damping: Option<f32>,
    pub pressure_coefficient: Option<f32>,
    pub friction_coefficient: Option<f32>,
    pub thickness: Option<f32>,
    pub surface_friction: Option<f32>,
}

impl MaterialRecipe {
    /// The material, if the preset exists. The values are not checked.
    #[must_use]
    pub fn material(&self) -> Option<FabricMaterial> {
        let like = preset(&self.like)?;
        Some(FabricMaterial {
            area_density: self.area_density.unwrap_or(like.area_density),
            warp_stiffness: self.warp_stiffness.unwrap_or(like.warp_stiffness),
            weft_stiffness: self.weft_stiffness.unwrap_or(like.weft_stiffness),
            shear_stiffness: self.shear_stiffness.unwrap_or(like.shear_stiffness),
            bend_stiffness: self.bend_stiffness.unwrap_or(like.bend_stiffness),
            damping: self.damping.unwrap_or(like.damping),
            internal_damping: self.internal_damping.unwrap_or(like.internal_damping),
            pressure_coefficient: self.pressure_coefficient.unwrap_or(like.pressure_coefficient),
            friction_coefficient: self.friction_coefficient.unwrap_or(like.friction_coefficient),
            thickness: self.thickness.unwrap_or(like.thickness),
            surface_friction: self.surface_friction.unwrap_or(like.surface_friction),
        })
    }
}
