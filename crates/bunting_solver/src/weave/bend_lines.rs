//! The lines along which a grid bends, eight in the lanes.

use super::{Facing, SIDE, Sheets, pack};
use crate::fabric::{BendLine, Fabric};
use crate::lanes::Pack8;
use crate::parameters::BendFactors;

/// The fabric's profile in each lane.
type Profiles = Vec<[Option<u32>; SIDE]>;

/// Rows, then columns, and their profiles: each pack of lines has its own.
pub(super) fn lines(fabric: &Fabric, sheets: &Sheets) -> (Vec<(Facing, Vec<BendLine>)>, Profiles) {
    let mut profiles = Profiles::new();
    let is_row = |line: &&BendLine| line.particles[1] == line.particles[0] + 1;
    let lines = [Facing::Turned, Facing::Straight].map(|facing| {
        let alike: Vec<&BendLine> = fabric
            .bend_lines()
            .iter()
            .filter(|line| is_row(line) == (facing == Facing::Turned))
            .collect();
        let side_by_side = alike.chunks(SIDE).enumerate().map(|(block, lines)| {
            profiles.push(core::array::from_fn(|lane| lines.get(lane).map(|line| line.profile)));
            let places = 0..lines[0].particles.len();
            BendLine {
                particles: places
                    .map(|place| sheets.at(facing, place, (block * SIDE) as isize))
                    .collect(),
                profile: profiles.len() as u32 - 1,
            }
        });
        (facing, side_by_side.collect())
    });
    (lines.into(), profiles)
}

/// Room for the factors of lines with these profiles, and what moments move their particles by.
pub(super) fn factors(
    fabric: &Fabric,
    profiles: &[Option<u32>; SIDE],
) -> BendFactors<Pack8, Pack8> {
    let of_lanes = profiles.map(|profile| {
        profile.map(|profile| BendFactors::<Pack8>::new(&fabric.bend_profiles()[profile as usize]))
    });
    let first = of_lanes[0].clone();
    let Some(BendFactors { rows, weights }) = first else {
        return BendFactors { rows: Vec::new(), weights: Vec::new() };
    };
    let lanes: [Option<&[f32]>; SIDE] =
        core::array::from_fn(|lane| of_lanes[lane].as_ref().map(|of_lane| &of_lane.weights[..]));
    let weights = (0..weights.len())
        .map(|place| pack(&lanes, |weights| weights.map_or(0.0, |weights| weights[place])))
        .collect();
    BendFactors { rows, weights }
}
