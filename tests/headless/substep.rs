//! Tests of forces and constraints of the user, between the solver's phases of a substep.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothParticles, ClothSubstep, ClothSubstepSystems, WakeCloth};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::{Fixed, Time};
use bevy_transform::prelude::*;
use bunting_tests::{TICK, app, bits, greatest, run, spawn_flag, state};

/// Rounding error after a tick of substeps of a position some metres from the origin, m.
const ROUNDING: f32 = 1e-5;

/// Material that loses no momentum to the frame of the cloth.
const UNDAMPED: ClothMaterial =
    ClothMaterial(FabricMaterial { damping: 0.0, ..FabricMaterial::COTTON });

/// An app without gravity and air: only the user's systems act on free cloths.
fn empty_space() -> App {
    let mut app = app();
    let mut settings = app.world_mut().resource_mut::<ClothSettings>();
    settings.gravity = Vec3::ZERO;
    settings.air_density = 0.0;
    app
}

/// Angular momenta about the world's y axis, kg m²/s: expected from the vortex, and measured.
#[derive(Resource, Default)]
struct AngularMomentum {
    given: f32,
    measured: f32,
}

/// A vortex about the world's y axis: an acceleration of 3 /s² times the distance from the axis, along
/// circles around the axis.
fn vortex(
    mut particles: ClothParticles,
    cloths: Query<Entity, With<ClothMesh>>,
    mut momentum: ResMut<AngularMomentum>,
    time: Res<Time>,
) {
    for entity in &cloths {
        let Some(mut cloth) = particles.get_mut(entity) else { continue };
        for particle in 0..cloth.count() {
            let at = cloth.to_world(cloth.position(particle));
            let acceleration = 3.0 * Vec3::Y.cross(at);
            let torque = at.cross(acceleration).y / cloth.inverse_mass(particle);
            momentum.given += torque * time.delta_secs() / SUBSTEPS as f32;
            let acceleration = cloth.direction_to_local(acceleration);
            cloth.add_acceleration(particle, acceleration);
        }
    }
}

fn measure(
    mut particles: ClothParticles,
    cloths: Query<Entity, With<ClothMesh>>,
    mut momentum: ResMut<AngularMomentum>,
) {
    momentum.measured = 0.0;
    for entity in &cloths {
        let Some(cloth) = particles.get_mut(entity) else { continue };
        momentum.measured += (0..cloth.count())
            .map(|particle| {
                let at = cloth.to_world(cloth.position(particle));
                let velocity = cloth.direction_to_world(cloth.velocity(particle));
                at.cross(velocity).y / cloth.inverse_mass(particle)
            })
            .sum::<f32>();
    }
}

const SUBSTEPS: u32 = 4;

#[test]
fn a_vortex_gives_angular_momentum() {
    let mut app = empty_space();
    app.init_resource::<AngularMomentum>().add_systems(
        ClothSubstep,
        (
            vortex.in_set(ClothSubstepSystems::UserForces),
            measure.in_set(ClothSubstepSystems::UserConstraints),
        ),
    );
    app.world_mut().resource_mut::<ClothSettings>().steps =
        vec![StepSettings { substeps: SUBSTEPS, ..StepSettings::default() }.into()];
    // The pose is turned, so that the frame's axes differ from the world's.
    let pose = Transform::from_xyz(-0.5, 0.5, 0.0).with_rotation(Quat::from_rotation_x(-0.7));
    app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), UNDAMPED, pose));
    run(&mut app, 30);
    let AngularMomentum { given, measured } = *app.world().resource::<AngularMomentum>();
    assert!(given > 0.01, "{given}");
    assert!((measured / given - 1.0).abs() < 0.02, "{measured} of {given} kg m²/s");
}

/// Radius of the cylinder, m.
const RADIUS: f32 = 0.4;

/// Speed of the cylinder along x, m/s.
const SPEED: f32 = 1.5;

/// Distance of a point from the vertical axis of the cylinder at a time (s), m.
fn from_axis(point: Vec3, seconds: f32) -> Vec3 {
    (point - SPEED * seconds * Vec3::X).reject_from_normalized(Vec3::Y)
}

/// Keeps particles inside the cylinder at its pose at the end of the tick.
fn hold_inside(
    mut particles: ClothParticles,
    cloths: Query<Entity, With<ClothMesh>>,
    time: Res<Time>,
) {
    let seconds = time.elapsed_secs();
    for entity in &cloths {
        let Some(mut cloth) = particles.get_mut(entity) else { continue };
        for particle in 0..cloth.count() {
            let at = cloth.to_world(cloth.position(particle));
            let off = from_axis(at, seconds);
            if off.length() > RADIUS {
                let inside = cloth.to_local(at - off + RADIUS * off.normalize());
                cloth.set_position(particle, inside);
            }
        }
    }
}

#[test]
fn a_constraint_holds_a_cloth_inside_a_moving_cylinder() {
    let mut app = empty_space();
    app.add_systems(ClothSubstep, hold_inside.in_set(ClothSubstepSystems::UserConstraints));
    // The sheet is vertical and contains the axis; its edges are 10 cm from the wall.
    let pose = Transform::from_xyz(-0.3, 0.3, 0.0);
    let mesh = ClothMesh::grid(13, 13, 0.6, 0.6);
    let cloth = app.world_mut().spawn((mesh, UNDAMPED, pose)).id();
    for _ in 0..128 {
        run(&mut app, 1);
        let seconds = app.world().resource::<Time<Fixed>>().elapsed_secs();
        let frame = *app.world().get::<GlobalTransform>(cloth).expect("a frame");
        let positions = state(&app, cloth).positions().iter();
        let off = positions.map(|at| from_axis(frame.transform_point(*at), seconds).length());
        if state(&app, cloth).positions().is_empty() {
            continue;
        }
        let off = greatest(off);
        assert!(off < RADIUS + ROUNDING, "{off} m from the axis after {seconds} s");
    }
    let moved = state(&app, cloth).positions()[84];
    assert!(moved.x > 128.0 * TICK * SPEED - 2.0 * RADIUS, "the cylinder takes it along: {moved}");
}

/// Positions in the world of one particle in successive substeps, m.
#[derive(Resource, Default)]
struct Path(Vec<Vec3>);

#[test]
fn a_free_particle_stays_in_the_world_while_its_frame_moves() {
    let mut app = empty_space();
    let note = |mut particles: ClothParticles,
                cloths: Query<Entity, With<ClothMesh>>,
                mut path: ResMut<Path>| {
        let Ok(entity) = cloths.single() else { return };
        let cloth = particles.get_mut(entity).expect("it takes part in all substeps");
        path.0.push(cloth.to_world(cloth.position(44)));
    };
    let turn = |mut cloths: Query<&mut Transform, With<ClothMesh>>, time: Res<Time>| {
        let seconds = time.elapsed_secs();
        for mut transform in &mut cloths {
            *transform = Transform::from_xyz(2.0 * seconds, 0.0, -seconds)
                .with_rotation(Quat::from_axis_angle(Vec3::ONE.normalize(), 3.0 * seconds));
        }
    };
    app.init_resource::<Path>()
        .add_systems(FixedUpdate, turn)
        .add_systems(ClothSubstep, note.in_set(ClothSubstepSystems::UserForces));
    app.world_mut().resource_mut::<ClothSettings>().steps =
        vec![StepSettings { substeps: SUBSTEPS, ..StepSettings::default() }.into()];
    app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), UNDAMPED));
    run(&mut app, 2);
    let first = core::mem::take(&mut app.world_mut().resource_mut::<Path>().0);
    let first = *first.last().expect("a substep");
    run(&mut app, 1);
    let path = &app.world().resource::<Path>().0;
    assert_eq!(path.len(), SUBSTEPS as usize);
    for at in path {
        assert!(at.distance(first) < ROUNDING, "{at} is not {first}");
    }
}

/// Number of substeps in which each cloth took part.
#[derive(Resource, Default)]
struct Joined(Vec<(Entity, u32)>);

#[test]
fn a_cloth_of_fewer_substeps_takes_part_in_some_and_falls_alike() {
    let mut app = empty_space();
    let fall = |mut particles: ClothParticles, mut joined: ResMut<Joined>| {
        for (entity, substeps) in &mut joined.0 {
            let Some(mut cloth) = particles.get_mut(*entity) else { continue };
            *substeps += 1;
            for particle in 0..cloth.count() {
                cloth.add_acceleration(particle, -2.0 * Vec3::Y);
            }
        }
    };
    app.init_resource::<Joined>()
        .add_systems(ClothSubstep, fall.in_set(ClothSubstepSystems::UserForces));
    app.world_mut().resource_mut::<ClothSettings>().steps = vec![
        StepSettings { substeps: 6, ..StepSettings::default() }.into(),
        StepSettings { substeps: 4, ..StepSettings::default() }.into(),
    ];
    let cloths = [0, 1].map(|level| {
        let levels = LodSet::new([10.0]).pinned_to(level);
        app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), UNDAMPED, levels)).id()
    });
    app.world_mut().resource_mut::<Joined>().0 = cloths.map(|cloth| (cloth, 0)).to_vec();
    const TICKS: usize = 32;
    run(&mut app, TICKS + 1);
    let joined = &app.world().resource::<Joined>().0;
    let expected = [6, 4].map(|substeps| substeps * TICKS as u32);
    assert_eq!([joined[0].1, joined[1].1], expected);
    let seconds = TICKS as f32 * TICK;
    for cloth in cloths {
        let height = state(&app, cloth).positions()[0].y;
        let fallen = -0.5 * 2.0 * seconds * seconds;
        // Depending on the scheme, the fall differs by up to half a substep's velocity.
        assert!((height - fallen).abs() < 2.0 * seconds * TICK / 4.0, "{height} {fallen}");
    }
}

#[test]
fn a_system_that_changes_nothing_changes_no_bit() {
    let positions = |looks_on: bool| {
        let mut app = app();
        app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 3.0)));
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        if looks_on {
            let look = move |mut particles: ClothParticles| {
                if let Some(cloth) = particles.get_mut(flag) {
                    assert!(cloth.effective_step() > 0.0);
                }
            };
            app.add_systems(ClothSubstep, look.in_set(ClothSubstepSystems::UserConstraints));
        }
        run(&mut app, 60);
        bits(&app, flag)
    };
    assert_eq!(positions(true), positions(false));
}

#[test]
fn a_cloth_that_is_written_stays_awake_and_one_that_sleeps_can_be_woken() {
    #[derive(Resource)]
    struct Writes(bool);
    let mut app = empty_space();
    let cloth = app.world_mut().spawn((ClothMesh::grid(5, 5, 1.0, 1.0), UNDAMPED)).id();
    let write = move |mut particles: ClothParticles, writes: Res<Writes>| {
        if let (true, Some(mut cloth)) = (writes.0, particles.get_mut(cloth)) {
            cloth.add_acceleration(0, Vec3::ZERO);
        }
    };
    app.insert_resource(Writes(true))
        .add_systems(ClothSubstep, write.in_set(ClothSubstepSystems::UserForces));
    run(&mut app, 100);
    assert_eq!(state(&app, cloth).activity(), ClothActivity::Ticking);
    app.world_mut().resource_mut::<Writes>().0 = false;
    run(&mut app, 100);
    assert_eq!(state(&app, cloth).activity(), ClothActivity::AtRest);
    app.world_mut().trigger(WakeCloth { entity: cloth });
    run(&mut app, 2);
    assert_eq!(state(&app, cloth).activity(), ClothActivity::Ticking);
}
