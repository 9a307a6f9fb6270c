//! Tests of entities that are despawned in the middle of a tick: the other cloths are the same, bit for bit.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Bits, app, assert_finite, bits, run, spawn_flag};

/// Ticks before the despawn, and in all.
const BEFORE: u32 = 30;
const TICKS: usize = 60;

const SETS: [ClothSystems; 5] = [
    ClothSystems::Prepare,
    ClothSystems::SelectLod,
    ClothSystems::Drive,
    ClothSystems::Step,
    ClothSystems::Publish,
];

/// Bits of a flag beside what `spawn` spawns, of which one entity is despawned before a set of a tick. The other entity that
/// `spawn` returns is a cloth that stays.
fn beside(set: ClothSystems, spawn: impl Fn(&mut App) -> (Option<Entity>, Option<Entity>)) -> Bits {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(3.0, 0.0, 1.0)).with_gusts(1.0, 0.5, 3));
    let flag = spawn_flag(&mut app, Vec3::Y);
    let (gone, stays) = spawn(&mut app);
    let despawn = move |mut commands: Commands, mut tick: Local<u32>| {
        *tick += 1;
        if let Some(gone) = gone.filter(|_| *tick == BEFORE) {
            commands.entity(gone).despawn();
        }
    };
    app.add_systems(ClothTick, despawn.before(set));
    run(&mut app, TICKS);
    assert!(gone.is_none_or(|gone| app.world().get_entity(gone).is_err()), "{set:?}");
    if let Some(stays) = stays {
        assert_finite(&app, stays);
    }
    bits(&app, flag)
}

fn alone() -> Bits {
    beside(ClothSystems::Step, |_| (None, None))
}

#[test]
fn a_cloth_may_be_despawned_within_a_tick() {
    let alone = alone();
    for set in SETS {
        // A cloth like the flag lies in one batch with it, and a grid of its own in another.
        let like = |app: &mut App| (Some(spawn_flag(app, Vec3::new(4.0, 1.0, 0.0))), None);
        assert_eq!(beside(set, like), alone, "{set:?}");
        let other = |app: &mut App| {
            let cloth = (ClothMesh::grid(9, 7, 1.0, 0.8), Attachment::in_place(ClothEdge::Top));
            (Some(app.world_mut().spawn(cloth).id()), None)
        };
        assert_eq!(beside(set, other), alone, "{set:?}");
    }
}

#[test]
fn a_joint_may_be_despawned_within_a_tick() {
    let alone = alone();
    for set in SETS {
        let caped = |app: &mut App| {
            let world = app.world_mut();
            let joint = world.spawn(Transform::from_xyz(3.0, 0.0, 0.0)).id();
            let vertices = (0..9 * 9).map(|_| ([0; 4], [1.0, 0.0, 0.0, 0.0]));
            let cape = world.spawn((
                ClothMesh::grid(9, 9, 1.0, 1.0),
                Attachment::in_place(ClothEdge::Top),
                ClothSkin::new([(joint, Mat4::IDENTITY)]).with_vertices(vertices),
                SkinLimits { max_distance: 0.3.into(), ..SkinLimits::default() },
                Transform::from_xyz(3.0, 0.0, 0.0),
            ));
            (Some(joint), Some(cape.id()))
        };
        assert_eq!(beside(set, caped), alone, "{set:?}");
    }
}

#[test]
fn a_collider_and_a_wind_may_be_despawned_within_a_tick() {
    let alone = alone();
    for set in SETS {
        let cloth = |app: &mut App| {
            let at = Transform::from_xyz(9.0, 1.0, 0.0);
            app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), at)).id()
        };
        let collider = |app: &mut App| {
            let ball = (ClothCollider::ball(0.5), Transform::from_xyz(9.5, 0.3, 0.0));
            (Some(app.world_mut().spawn(ball).id()), Some(cloth(app)))
        };
        assert_eq!(beside(set, collider), alone, "{set:?}");
        let wind = |app: &mut App| {
            let region = (WindField::steady(9.0 * Vec3::Z), WindRegion::ball(3.0, 1.0));
            let wind = app.world_mut().spawn((region, Transform::from_xyz(9.5, 0.5, 0.0))).id();
            (Some(wind), Some(cloth(app)))
        };
        assert_eq!(beside(set, wind), alone, "{set:?}");
    }
}
