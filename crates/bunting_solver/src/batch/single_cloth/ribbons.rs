//! The ribbons along which a grid twists, side by side in the lanes.
//!
//! Neighbouring ribbons share particles. So of those side by side every second is solved, and then the
//! others, while the lanes between have factors that find no moment.

use super::{Facing, OfLanes, Sheets};
use crate::batch::places::Constant;
use crate::fabric::{Fabric, Ribbon};
use crate::simd::lane::Pack;
use crate::step::parameters::{Parameters, TwistFactors};

/// Packs of ribbons.
#[derive(Clone, Debug)]
pub(crate) struct Ribbons<P: Pack> {
    /// Along what their pairs lie.
    pub facing: Facing,
    pub ribbons: Vec<Ribbon>,
    pub factors: Vec<TwistFactors<P, P>>,
    /// For each of the factors, the fabric's profile in each lane.
    profiles: Vec<OfLanes>,
}

impl<P: Pack> Ribbons<P> {
    pub fn of(fabric: &Fabric, sheets: &Sheets) -> Self {
        let mut of_fabric: Vec<&Ribbon> = fabric.ribbons().iter().collect();
        of_fabric.sort_by_key(|ribbon| ribbon.pairs[0][0]);
        let [first, beside] = of_fabric[0].pairs[0];
        let facing = if beside == first + 1 { Facing::Straight } else { Facing::Turned };
        let places = of_fabric[0].pairs.len();
        let (mut ribbons, mut profiles) = (Vec::new(), Vec::new());
        for parity in 0..2 {
            for (block, side) in of_fabric.chunks(P::WIDTH).enumerate() {
                let of_lane = |lane: usize| {
                    let ribbon = side.get(lane).filter(|_| lane % 2 == parity);
                    ribbon.map(|ribbon| ribbon.profile)
                };
                let of_lanes: OfLanes = (0..P::WIDTH).map(of_lane).collect();
                if of_lanes.iter().all(Option::is_none) {
                    continue;
                }
                let first = (block * P::WIDTH) as isize;
                let at = |place: usize| sheets.at(facing, place, first);
                let pairs = (0..places).map(|place| [at(place), at(place) + 1]).collect();
                ribbons.push(Ribbon { pairs, profile: profiles.len() as u32 });
                profiles.push(of_lanes);
            }
        }
        let factors = profiles.iter().map(|of_lanes| factors(fabric, of_lanes, places)).collect();
        Self { facing, ribbons, factors, profiles }
    }

    /// Takes over what is constant over many substeps.
    pub fn set_parameters(&mut self, parameters: &Parameters<P>) {
        for (factors, of_lanes) in self.factors.iter_mut().zip(&self.profiles) {
            for (cell, factor) in factors.cells.iter_mut().enumerate() {
                let of = |lane: usize| {
                    of_lanes[lane].map(|of| &parameters.twist_factors[of as usize].cells[cell])
                };
                factor.near = P::of(|lane| of(lane).map_or(0.0, |of| of.near.lanes()[0]));
                factor.inverse = P::of(|lane| of(lane).map_or(0.0, |of| of.inverse.lanes()[0]));
            }
        }
    }
}

/// Room for the factors of ribbons with these profiles, and what moments move their particles by.
fn factors<P: Pack>(fabric: &Fabric, of_lanes: &OfLanes, places: usize) -> TwistFactors<P, P> {
    let weight = |lane: usize, place: usize, side: usize| {
        of_lanes[lane].map_or(0.0, |profile| {
            fabric.ribbon_profiles()[profile as usize].inverse_areas[place][side]
        })
    };
    let weights = |place: usize| [0, 1].map(|side| P::of(|lane| weight(lane, place, side)));
    TwistFactors {
        cells: TwistFactors::<P>::room(places),
        weights: (0..places).map(weights).collect(),
    }
}
