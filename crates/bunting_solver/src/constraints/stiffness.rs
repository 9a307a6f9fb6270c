//! Compliances of one cloth's constraints in a substep, and the thresholds of stiff bending and of twist.

use crate::constants::{GRAVITY, GREATEST_COMPLIANCE, LEAST_LINK_COMPLIANCE};
use crate::fabric::{Fabric, FabricMaterial};
use crate::step::Scheme;

/// Γ = σ g L³/B above which a cloth does not resist twist. At this Γ a sheet of length L that is clamped
/// level at one edge reaches out by a twentieth of L, and twist is small beside weight. Larger: twist is
/// solved for cloth in which it cannot be seen. A flag of a metre has 100,000.
const LIMP: f32 = 1000.0;

/// Square of the phase angle of the fastest bending wave in a substep, 16 h² B/(σ l⁴), above which bending is
/// solved at positions that contain the displacement by stretch. Larger: stiff strips droop too far. A 33 ×
/// 33 flag has 0.02.
const STIFF_BENDING: f32 = 1.0;

/// Whether a cloth is stiff enough for its resistance to twist to be visible.
pub(crate) fn resists_twist(fabric: &Fabric, material: &FabricMaterial) -> bool {
    let Some(grid) = fabric.grid() else { return false };
    let length = grid.width.max(grid.height);
    let stiffest = material.bend_stiffness * fabric.extremes().liveliest;
    material.area_density * GRAVITY * length.powi(3) < LIMP * stiffest
}

/// Stiffnesses of one cloth in a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stiffness<'a> {
    pub material: &'a FabricMaterial,
    /// Effective length β h of the substep, s.
    pub step: f32,
    pub scheme: Scheme,
}

impl Stiffness<'_> {
    /// XPBD compliance σ/(k h²) in units of the density, 1/m² for k in N/m.
    fn compliance(&self, stiffness: f32) -> f32 {
        let density = self.material.area_density;
        (density / (stiffness * self.step * self.step)).min(GREATEST_COMPLIANCE)
    }

    /// Compliance of each class of links, 1/m².
    pub fn of_links(&self, fabric: &Fabric) -> Vec<f32> {
        let least = LEAST_LINK_COMPLIANCE / fabric.extremes().light_mass;
        let classes = fabric.link_classes().iter();
        let stiffnesses = classes.map(|class| match self.scheme {
            Scheme::Yarns => class.uncoupled_stiffness(self.material),
            Scheme::GaussSeidel => class.stiffness(self.material),
        });
        stiffnesses.map(|stiffness| self.compliance(stiffness).max(least)).collect()
    }

    /// Compliance of each class of hinges, 1/m⁴.
    pub fn of_hinges(&self, fabric: &Fabric) -> Vec<f32> {
        let classes = fabric.hinge_classes().iter();
        classes.map(|class| self.compliance(class.stiffness(self.material))).collect()
    }

    /// Compliance σ/(B h²) of bending and twist for a line of unit weight, 1/m⁴.
    pub fn of_bending(&self) -> f32 {
        self.compliance(self.material.bend_stiffness)
    }

    /// Whether bending must be solved at positions that contain the displacement by stretch.
    pub fn bends_stiffly(&self, fabric: &Fabric) -> bool {
        let spacing = fabric.bend_profiles().iter().map(|profile| profile.inverse_spacing);
        let finest = spacing.fold(0.0, f32::max);
        let FabricMaterial { bend_stiffness, area_density, .. } = *self.material;
        let bend_stiffness = bend_stiffness * fabric.extremes().liveliest;
        let phase_squared =
            16.0 * self.step * self.step * bend_stiffness / area_density * finest.powi(4);
        phase_squared > STIFF_BENDING
    }
}
