//! The materials of the cases.

use bunting_solver::FabricMaterial;

/// Isotropic but for Poisson's ratio.
pub(super) const ISOTROPIC: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 5e3,
    damping: 4.0,
    ..FabricMaterial::FLAG_POLYESTER
};
/// The fabric of the standard scenes.
pub(super) const STANDARD: FabricMaterial = FabricMaterial { shear_stiffness: 200.0, ..ISOTROPIC };
