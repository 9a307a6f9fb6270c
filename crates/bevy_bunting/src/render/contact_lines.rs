//! Lines along the normals of contacts.

use bevy_color::Srgba;
use bevy_color::palettes::css::{AQUA, ORANGE, YELLOW};
use bevy_math::Vec3;
use bevy_transform::components::GlobalTransform;
use bunting_solver::{ContactPoint, Touched};

use crate::batch::batches::ClothBatches;
use crate::batch::lane_handle::LaneHandle;

/// Length of a line, m.
const LENGTH: f32 = 0.02;

/// Both ends of the lines of a cloth's contacts, in the world, with their colours.
pub(crate) fn contact_lines(
    batches: &ClothBatches,
    lane: LaneHandle,
    frame: &GlobalTransform,
) -> Vec<(Vec3, Vec3, Srgba)> {
    let line = |ContactPoint { what, at, normal }: ContactPoint| {
        let colour = match what {
            Touched::Collider => AQUA,
            Touched::Itself => YELLOW,
            Touched::Cloth => ORANGE,
        };
        (at, at + normal * LENGTH, colour)
    };
    let alone = batches.contact_points(lane).into_iter().map(line);
    let alone = alone
        .map(|(from, to, colour)| (frame.transform_point(from), frame.transform_point(to), colour));
    alone.chain(batches.touching_points(lane).into_iter().map(line)).collect()
}
