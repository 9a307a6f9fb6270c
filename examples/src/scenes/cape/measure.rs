//! Measurements of a cape on any figure, as it is shown: from its skin and from the capsules on the bones.

use bevy::prelude::*;
use bevy_bunting::ClothSurface;
use bevy_bunting::prelude::*;

use crate::limits::greatest;

/// A cloth as it is simulated and as it is shown.
type ShownCloth = (&'static ClothState, Option<&'static ClothSurface>, &'static GlobalTransform);

/// The shown positions of a cloth in the world, m, each with its particle.
fn shown<'a>(
    (state, surface, frame): (&'a ClothState, Option<&'a ClothSurface>, &'a GlobalTransform),
) -> impl Iterator<Item = (usize, Vec3)> + 'a {
    let positions = surface.map_or(state.positions(), |surface| &surface.positions);
    positions.iter().map(|&at| frame.transform_point(at)).enumerate()
}

/// Greatest depth of a free particle of any cloth in a capsule, m.
pub fn depth(world: &mut World) -> f32 {
    let capsules: Vec<([Vec3; 2], f32)> = world
        .query::<(&ClothCollider, &GlobalTransform)>()
        .iter(world)
        .filter_map(|(collider, pose)| {
            let capsule = collider.shape.as_capsule()?;
            let ends = [capsule.segment.a, capsule.segment.b];
            Some((ends.map(|end| pose.transform_point(end)), capsule.radius))
        })
        .collect();
    let mut cloths = world.query::<ShownCloth>();
    greatest(cloths.iter(world).flat_map(|cloth| {
        let fabric = cloth.0.fabric();
        let is_free = move |particle| fabric.is_some_and(|it| !it.is_pinned(particle));
        let free = shown(cloth).filter(move |&(particle, _)| is_free(particle));
        free.flat_map(|(_, at)| {
            capsules.iter().map(move |&([from, to], radius)| {
                let along = (at - from).dot(to - from) / from.distance_squared(to);
                (radius - at.distance(from.lerp(to, along.clamp(0.0, 1.0)))).max(0.0)
            })
        })
    }))
}

/// Greatest distance of a pinned particle from where the joints of its skin hold it, m. The cloth has all of its
/// particles, in the order of its vertices.
pub fn off(world: &mut World) -> f32 {
    let poses = world.query::<&GlobalTransform>();
    let mut capes = world.query::<(&ClothSkin, ShownCloth)>();
    greatest(capes.iter(world).flat_map(|(skin, cloth)| {
        let of_joint = |joint: usize| {
            let pose = poses.get_manual(world, skin.joints[joint]).ok();
            pose.map_or(Mat4::NAN, GlobalTransform::to_matrix) * skin.inverse_bind_poses[joint]
        };
        let matrices: Vec<Mat4> = (0..skin.joints.len()).map(of_joint).collect();
        let fabric = cloth.0.fabric();
        let pinned = shown(cloth).filter_map(move |(particle, at)| {
            let fabric = fabric.filter(|fabric| fabric.is_pinned(particle))?;
            Some((particle, at, fabric.rest_positions()[particle]))
        });
        pinned.map(move |(particle, at, rest)| {
            let joints = skin.joint_indices[particle].iter().zip(skin.joint_weights[particle]);
            let place: Vec3 = joints
                .map(|(&joint, weight)| weight * matrices[joint as usize].transform_point3(rest))
                .sum();
            at.distance(place)
        })
    }))
}
