//! Materials by name.

use bevy_bunting::prelude::*;

/// The materials of [`FabricMaterial`] by name.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_bunting_inspector::PRESETS;
///
/// let silk = PRESETS.iter().find(|(name, _)| *name == "silk");
/// assert_eq!(silk, Some(&("silk", ClothMaterial::SILK)));
/// ```
pub const PRESETS: [(&str, ClothMaterial); 5] = [
    ("flag polyester", ClothMaterial::FLAG_POLYESTER),
    ("nylon", ClothMaterial::NYLON),
    ("cotton", ClothMaterial::COTTON),
    ("silk", ClothMaterial::SILK),
    ("denim", ClothMaterial::DENIM),
];
