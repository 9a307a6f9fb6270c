//! The lines along which a grid bends, side by side in the lanes.

use super::{Facing, OfLanes, Sheets};
use crate::batch::places::Constant;
use crate::fabric::{BendLine, Fabric};
use crate::simd::lane::Pack;
use crate::step::parameters::BendFactors;

/// Rows, then columns, and their profiles: each pack of lines has its own.
pub(super) fn lines<P: Pack>(
    fabric: &Fabric,
    sheets: &Sheets,
) -> (Vec<(Facing, Vec<BendLine>)>, Vec<OfLanes>) {
    let mut profiles = Vec::new();
    let is_row = |line: &&BendLine| line.particles[1] == line.particles[0] + 1;
    let lines = [Facing::Turned, Facing::Straight].map(|facing| {
        let alike: Vec<&BendLine> = fabric
            .bend_lines()
            .iter()
            .filter(|line| is_row(line) == (facing == Facing::Turned))
            .collect();
        let side_by_side = alike.chunks(P::WIDTH).enumerate().map(|(block, lines)| {
            profiles.push((0..P::WIDTH).map(|lane| Some(lines.get(lane)?.profile)).collect());
            let places = 0..lines[0].particles.len();
            BendLine {
                particles: places
                    .map(|place| sheets.at(facing, place, (block * P::WIDTH) as isize))
                    .collect(),
                profile: profiles.len() as u32 - 1,
            }
        });
        (facing, side_by_side.collect())
    });
    (lines.into(), profiles)
}

/// Room for the factors of lines with these profiles, and what moments move their particles by.
pub(super) fn factors<P: Pack>(fabric: &Fabric, profiles: &OfLanes) -> BendFactors<P, P> {
    let of_lanes: Vec<Option<BendFactors<P>>> = profiles
        .iter()
        .map(|profile| Some(BendFactors::new(&fabric.bend_profiles()[(*profile)? as usize])))
        .collect();
    // Lines that lie side by side are of one length.
    let first = of_lanes.iter().flatten().next();
    let rows = first.map_or(Vec::new(), |of_lane| of_lane.rows.clone());
    let places = first.map_or(0, |of_lane| of_lane.weights.len());
    let weight = |lane: usize, place: usize| {
        of_lanes[lane].as_ref().map_or(0.0, |of_lane| of_lane.weights[place])
    };
    let weights = (0..places).map(|place| P::of(|lane| weight(lane, place))).collect();
    BendFactors { rows, weights }
}
