//! Numbers as users write them, and those at which arithmetic breaks.

use bevy_math::{EulerRot, Quat, Vec2, Vec3};
use bevy_transform::prelude::*;
use proptest::prelude::*;
use proptest::sample::select;

/// Numbers at which arithmetic breaks.
const SPECIAL: [f32; 14] = [
    0.0,
    -0.0,
    1.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    f32::EPSILON,
    1e-42,
    1e-12,
    1e12,
    1e25,
];

/// Any number: four of five as users write them, and positive ones more often.
pub(super) fn number() -> BoxedStrategy<f32> {
    let usual = (-3_f32..3.0, 0..4)
        .prop_map(|(power, sign)| 10_f32.powf(power) * if sign == 0 { -1.0 } else { 1.0 });
    prop_oneof![
        16 => usual,
        3 => select(&SPECIAL[..]),
        1 => any::<u32>().prop_map(f32::from_bits),
    ]
    .boxed()
}

/// Any three numbers: mostly those of places near the origin.
pub(super) fn vector() -> BoxedStrategy<Vec3> {
    prop_oneof![
        4 => [-2_f32..2.0, -2.0..2.0, -2.0..2.0].prop_map(Vec3::from_array),
        1 => [number(), number(), number()].prop_map(Vec3::from_array),
    ]
    .boxed()
}

/// Any two numbers: mostly those of the texture.
pub(super) fn uv() -> BoxedStrategy<Vec2> {
    prop_oneof![
        4 => [0_f32..1.0, 0.0..1.0].prop_map(Vec2::from_array),
        1 => [number(), number()].prop_map(Vec2::from_array),
    ]
    .boxed()
}

/// Any pose: mostly a turn, a place and no scale.
pub(super) fn pose() -> BoxedStrategy<Transform> {
    let turn = prop_oneof![
        6 => [-3_f32..3.0, -3.0..3.0, -3.0..3.0]
            .prop_map(|[a, b, c]| Quat::from_euler(EulerRot::XYZ, a, b, c)),
        1 => [number(), number(), number(), number()].prop_map(Quat::from_array),
    ];
    let scale = prop_oneof![
        6 => Just(Vec3::ONE),
        1 => number().prop_map(Vec3::splat),
        1 => vector(),
    ];
    (vector(), turn, scale)
        .prop_map(|(translation, rotation, scale)| Transform { translation, rotation, scale })
        .boxed()
}

/// Distances of layers, m. Where they are as large as cloth, all of it touches all of it, which takes long.
pub(super) fn thickness() -> BoxedStrategy<f32> {
    let bad = [0.0, -0.0, -1e-3, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-42];
    prop_oneof![3 => 1e-4_f32..0.02, 1 => select(bad.to_vec())].boxed()
}
