//! Compliances and factorised systems of the constraints: of one cloth, and in lanes.

use core::ops::Range;

use crate::constraints::bend_factors::{self, BendFactors, BendRow};
use crate::constraints::stiffness::{Stiffness, resists_twist};
use crate::constraints::twist_factors::{self, TwistFactors, TwistRow};
use crate::fabric::Fabric;
use crate::simd::lane::Pack;

/// Compliances and factorised systems in lanes, as kernels read them.
#[derive(Clone, Debug)]
pub(crate) struct Factors<P: Pack, C> {
    /// Compliance of each class of links, σ/(k h²), 1/m².
    pub link_compliance: Vec<P>,
    /// Factors of each profile of bend lines.
    pub bending: Vec<BendFactors<P, C>>,
    /// Factors of each profile of ribbons.
    pub twist: Vec<TwistFactors<P, C>>,
    /// One in lanes whose cloth resists twist, zero in others.
    pub resists_twist: P,
}

impl<P: Pack, C> Factors<P, C> {
    /// Whether any lane resists twist.
    pub fn resist_twist(&self) -> bool {
        self.resists_twist.lanes().contains(&1.0)
    }

    /// Sets whether some lanes resist twist.
    pub fn set_resists_twist(&mut self, lanes: Range<usize>, of_cloth: &ClothFactors) {
        self.resists_twist.lanes_mut()[lanes].fill(if of_cloth.resists_twist { 1.0 } else { 0.0 });
    }
}

/// Compliances and factorised systems of one cloth, for each class and profile of its fabric.
pub(crate) struct ClothFactors {
    pub link_compliance: Vec<f32>,
    pub bending: Vec<Vec<BendRow<f32>>>,
    pub twist: Vec<Vec<TwistRow<f32>>>,
    /// Whether the cloth resists twist.
    pub resists_twist: bool,
}

impl ClothFactors {
    /// Computes compliances, and factorises the systems.
    pub fn new(fabric: &Fabric, stiffness: &Stiffness) -> Self {
        let compliance = stiffness.of_bending();
        let bend = |profile| bend_factors::factorise(profile, compliance);
        let twists = resists_twist(fabric, stiffness.material);
        let twist = |profile| {
            if twists {
                twist_factors::factorise(profile, compliance)
            } else {
                twist_factors::without_twist(profile)
            }
        };
        Self {
            link_compliance: stiffness.of_links(fabric),
            bending: fabric.bend_profiles().iter().map(bend).collect(),
            twist: fabric.ribbon_profiles().iter().map(twist).collect(),
            resists_twist: twists,
        }
    }
}
