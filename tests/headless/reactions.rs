//! Tests of the forces that cloths exert on their anchors.

use bevy_app::App;
use bevy_bunting::WakeCloth;
use bevy_bunting::bunting_solver::LaneCount;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{app, bits, run, spawn_flag, state};

/// Greatest error of a force at rest, of one.
const LIMIT: f32 = 0.01;

/// Updates after which a flag rests.
const REST: usize = 2000;

fn reactions(app: &App, cloth: Entity) -> &AnchorReactions {
    app.world().get(cloth).expect("reactions")
}

/// Weight of a cloth and its moment about a point, N and N·m.
fn weight(app: &App, cloth: Entity, about: Vec3) -> (Vec3, Vec3) {
    let state = state(app, cloth);
    let areas = state.fabric().expect("simulated").particle_areas();
    let frame = app.world().get::<GlobalTransform>(cloth).expect("a transform");
    let material = app.world().get::<ClothMaterial>(cloth).expect("a material").0;
    let mut sums = (Vec3::ZERO, Vec3::ZERO);
    for (&area, &at) in areas.iter().zip(state.positions()) {
        let weight = Vec3::NEG_Y * (9.81 * material.area_density * area);
        sums.0 += weight;
        sums.1 += (frame.transform_point(at) - about).cross(weight);
    }
    sums
}

/// A flag on a turned pole, with a damped material and reactions.
fn flag(app: &mut App, at: Vec3) -> Entity {
    let flag = spawn_flag(app, at);
    let turned =
        Transform::from_translation(at).with_rotation(bevy_math::Quat::from_rotation_y(0.7));
    let damped = FabricMaterial { damping: 2.0, ..FabricMaterial::FLAG_POLYESTER };
    app.world_mut().entity_mut(flag).insert((
        turned,
        ClothMaterial(damped),
        AnchorReactions::default(),
    ));
    flag
}

#[test]
fn a_flag_at_rest_weighs_and_turns_its_pole_asleep_or_awake_at_every_level() {
    let mut app = app();
    let at = Vec3::new(3.0, 2.0, 1.0);
    let flag = flag(&mut app, at);
    for level in [0, 1] {
        app.world_mut().entity_mut(flag).insert(LodSet::new([10.0]).pinned_to(level));
        app.world_mut().trigger(WakeCloth { entity: flag });
        run(&mut app, REST);
        assert_eq!(state(&app, flag).activity(), ClothActivity::AtRest);
        let (force, torque) = weight(&app, flag, at);
        let AnchorReactions { target, anchors } = reactions(&app, flag);
        assert!(anchors.is_empty());
        let error = target.force.distance(force) / force.length();
        assert!(error < LIMIT, "level {level}: {} for {force}", target.force);
        // The flag hangs near its pole: its moment is small beside weight times width.
        let error = target.torque.distance(torque) / force.length();
        assert!(error < LIMIT, "level {level}: {} for {torque}", target.torque);
    }
}

#[test]
fn reactions_are_of_each_anchor_and_about_its_place() {
    let mut app = app();
    let mut mast = |x: f32| app.world_mut().spawn(Transform::from_xyz(x, 0.0, 0.0)).id();
    let masts = [mast(0.0), mast(1.6)];
    let offset = Transform::from_xyz(-2.0, 0.0, 0.0);
    let right = Anchor::new(masts[1], ClothEdge::Right).with_offset(offset);
    let attachment = Attachment::new(masts[0], ClothEdge::Left).with_anchor(right);
    let damped = FabricMaterial { damping: 2.0, ..FabricMaterial::FLAG_POLYESTER };
    let banner = (ClothMesh::grid(33, 9, 2.0, 0.5), ClothMaterial(damped), attachment);
    let banner = app.world_mut().spawn((banner, AnchorReactions::default())).id();
    run(&mut app, REST);
    let (force, moment) = weight(&app, banner, Vec3::ZERO);
    let AnchorReactions { target, anchors } = reactions(&app, banner);
    let [other] = anchors[..] else { panic!("{anchors:?}") };
    // Each carries half of the weight, and the masts are drawn together.
    for of_one in [target.force, other.force] {
        assert!((of_one.y / force.y - 0.5).abs() < LIMIT, "{of_one} of {force}");
    }
    assert!(target.force.x > 0.1 * -force.y && (target.force + other.force).x.abs() < LIMIT);
    // The second anchor's origin is 2 m to the left of its mast.
    let about_origin = target.torque + other.torque + Vec3::new(-0.4, 0.0, 0.0).cross(other.force);
    assert!(about_origin.distance(moment) < LIMIT * moment.length(), "{about_origin}, {moment}");
}

#[test]
fn reactions_do_not_change_the_cloth_and_have_the_same_bits_in_every_batch() {
    let with = |others: usize, width: Option<LaneCount>, reports: bool| {
        let mut app = app();
        app.world_mut().resource_mut::<ClothSettings>().lanes = width;
        app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 2.0)).with_gusts(1.0, 0.5, 3));
        let first = flag(&mut app, Vec3::Y);
        for other in 0..others {
            spawn_flag(&mut app, Vec3::new(other as f32, 5.0, 0.0));
        }
        if !reports {
            app.world_mut().entity_mut(first).remove::<AnchorReactions>();
        }
        run(&mut app, 120);
        let reactions = app.world().get::<AnchorReactions>(first).cloned();
        (bits(&app, first), reactions)
    };
    let alone = with(0, None, true);
    assert!(alone.1.as_ref().is_some_and(|reactions| reactions.target.force.length() > 0.1));
    for width in [LaneCount::One, LaneCount::Eight, LaneCount::Sixteen] {
        assert_eq!(with(9, Some(width), true), alone, "{width:?}");
    }
    assert_eq!(with(0, None, false).0, alone.0);
}

#[test]
fn reactions_end_when_they_are_removed_and_begin_again() {
    let mut app = app();
    let flag = flag(&mut app, Vec3::ZERO);
    run(&mut app, 30);
    app.world_mut().entity_mut(flag).remove::<AnchorReactions>();
    run(&mut app, 2);
    app.world_mut().entity_mut(flag).insert(AnchorReactions::default());
    run(&mut app, 2);
    assert!(reactions(&app, flag).target.force.length() > 0.0);
}
