//! The cape: a rectangle of cloth, gathered at a collar that lies about the shoulders.
//!
//! The collar is a row of joints on the chest. In their bind poses they lie along the upper edge of the flat cloth; in the
//! figure's pose they lie on half an ellipse behind the neck. So the cloth hangs about the back in the pose of its skeleton,
//! narrower at the collar than it is wide, and falls into folds.

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_scenes::Design;

use crate::figure::skeleton::Joint;

/// Width of the cloth, m.
const WIDTH: f32 = 0.86;

/// Length of the cloth, m.
const LENGTH: f32 = 1.12;

/// Number of joints of the collar.
const COLLAR: usize = 7;

/// Centre of the collar in the figure's frame at rest, m.
const NECK: Vec3 = Vec3::new(0.0, 1.475, 0.03);

/// Half the width of the collar, and its depth behind the neck, m.
const REACH: [f32; 2] = [0.19, 0.11];

/// Half the angle that the collar lies about the neck, rad.
const HALF_ANGLE: f32 = 0.75 * FRAC_PI_2;

/// Angle by which the cape stands off from the body in the pose of its skeleton, rad.
const FLARE: f32 = 0.12;

/// A woollen cloth: heavier and stiffer than cotton.
const WOOL: FabricMaterial =
    FabricMaterial { area_density: 0.22, bend_stiffness: 2e-4, ..FabricMaterial::COTTON };

/// Colour.
pub const CRIMSON: [u8; 3] = [148, 28, 36];

/// Spawns the cape with its collar on the chest, with `count` particles along each edge.
pub fn spawn(commands: &mut Commands, joints: &[Entity], count: u32) -> Entity {
    let chest = joints[Joint::Chest.index()];
    let collar: Vec<Entity> =
        (0..COLLAR).map(|joint| commands.spawn((pose(joint), ChildOf(chest))).id()).collect();
    let bound = (0..COLLAR).map(|joint| Mat4::from_translation(-bind_place(joint)));
    let cape = commands.spawn((
        ClothMesh::grid(count, count, WIDTH, LENGTH),
        ClothMaterial(WOOL),
        Attachment::new(chest, ClothEdge::Top),
        ClothSkin::new(collar.into_iter().zip(bound)).with_vertices(vertices(count)),
        SkinLimits {
            max_distance: ByVertex::AlongV { top: 0.02, bottom: 0.75 },
            backstop_distance: 0.04.into(),
            backstop_radius: 0.4.into(),
            ..default()
        },
        LodSet { pinned: Some(0), ..default() },
        Design::Bars(vec![CRIMSON]),
    ));
    cape.id()
}

/// Place of a collar's joint on the flat cloth, m.
fn bind_place(joint: usize) -> Vec3 {
    Vec3::new(WIDTH * joint as f32 / (COLLAR - 1) as f32, 0.0, 0.0)
}

/// Pose of a collar's joint on the chest: its z axis points away from the body.
fn pose(joint: usize) -> Transform {
    let [across, behind] = REACH;
    let angle = HALF_ANGLE * (2.0 * joint as f32 / (COLLAR - 1) as f32 - 1.0);
    let place = NECK + Vec3::new(across * angle.sin(), 0.0, behind * angle.cos());
    let outwards = Vec3::new(behind * angle.sin(), 0.0, across * angle.cos());
    let turn = Quat::from_rotation_y(outwards.x.atan2(outwards.z));
    Transform::from_translation(place - Joint::Chest.place())
        .with_rotation(turn * Quat::from_rotation_x(-FLARE))
}

/// Indices and weights of the collar's joints for each vertex: the two beside it.
fn vertices(count: u32) -> impl Iterator<Item = ([u16; 4], [f32; 4])> {
    (0..count * count).map(move |vertex| {
        let along = (vertex % count) as f32 / (count - 1) as f32 * (COLLAR - 1) as f32;
        let left = (along as usize).min(COLLAR - 2);
        let part = along - left as f32;
        ([left as u16, left as u16 + 1, 0, 0], [1.0 - part, part, 0.0, 0.0])
    })
}
