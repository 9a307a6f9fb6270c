//! Tests of impulses, accelerations, and control over single particles.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothEffort, ClothSubstep, ClothSubstepSystems, ControlError};
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, TICK, app, bits, greatest, run, spawn_flag, state};

/// Error of a velocity that is measured by positions a metre from the origin, m/s.
const ROUNDING: f32 = 5e-4;

/// Material that loses no momentum.
const UNDAMPED: ClothMaterial =
    ClothMaterial(FabricMaterial { damping: 0.0, internal_damping: 0.0, ..FabricMaterial::COTTON });

/// An app without gravity and air, with a free sheet of 1 m² in a turned frame, that has been simulated for some ticks.
fn free_sheet() -> (App, Entity) {
    let mut app = app();
    let mut settings = app.world_mut().resource_mut::<ClothSettings>();
    settings.gravity = Vec3::ZERO;
    settings.air_density = 0.0;
    let pose = Transform::from_xyz(0.0, 1.0, 0.0).with_rotation(Quat::from_rotation_y(1.0));
    let sheet = app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), UNDAMPED, pose)).id();
    run(&mut app, 5);
    (app, sheet)
}

/// Momentum of a cloth in its last tick, along the world's axes, kg m/s.
fn momentum(app: &App, cloth: Entity) -> Vec3 {
    let state = state(app, cloth);
    let areas = state.fabric().expect("the cloth is simulated").particle_areas();
    let pairs = state.positions().iter().zip(state.previous_positions());
    let moved: Vec3 = pairs.zip(areas).map(|((now, before), area)| (now - before) * *area).sum();
    let turned = app.world().get::<GlobalTransform>(cloth).expect("placed").rotation();
    turned * moved * (UNDAMPED.0.area_density / TICK)
}

fn errors(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

#[test]
fn an_impulse_gives_its_momentum() {
    let (mut app, sheet) = free_sheet();
    let corner = state(&app, sheet).positions()[0];
    let given = Vec3::new(0.1, -0.2, 0.05);
    let at = app.world().get::<GlobalTransform>(sheet).unwrap().transform_point(corner);
    app.world_mut().trigger(ClothImpulse::momentum(at, 0.6, given));
    run(&mut app, 1);
    let slack = ROUNDING * UNDAMPED.0.area_density;
    for tick in 0..20 {
        let measured = momentum(&app, sheet);
        assert!(measured.distance(given) < slack, "{measured} in tick {tick}");
        run(&mut app, 1);
    }
}

#[test]
fn a_push_moves_the_particles_around_its_place() {
    let (mut app, sheet) = free_sheet();
    let place = state(&app, sheet).positions()[40];
    let at = app.world().get::<GlobalTransform>(sheet).unwrap().transform_point(place);
    let impulse = ClothImpulse::velocity(at, 0.3, Vec3::Y).with_falloff(0.0);
    app.world_mut().trigger(impulse);
    let before = state(&app, sheet).positions().to_vec();
    run(&mut app, 1);
    let after = state(&app, sheet).positions();
    for (particle, (now, then)) in after.iter().zip(&before).enumerate() {
        let expected = if then.distance(place) < 0.3 { TICK } else { 0.0 };
        let moved = (now - then).y;
        // Links pull within the tick.
        assert!((moved - expected).abs() < 0.7 * TICK, "{particle}: {moved} m");
    }
}

#[test]
fn a_cloth_that_is_pushed_as_a_whole_moves_evenly_from_the_first_tick_on() {
    let (mut app, sheet) = free_sheet();
    let change = Vec3::new(1.0, 2.0, -3.0);
    app.world_mut().trigger(ClothImpulse::velocity(Vec3::ZERO, f32::INFINITY, change));
    let turned = app.world().get::<GlobalTransform>(sheet).unwrap().rotation();
    for tick in 0..20 {
        run(&mut app, 1);
        let state = state(&app, sheet);
        let pairs = state.positions().iter().zip(state.previous_positions());
        let error = pairs.map(|(now, before)| (turned * (now - before) / TICK).distance(change));
        let error = greatest(error);
        assert!(error < 4.0 * ROUNDING, "{error} m/s in tick {tick}");
    }
}

#[test]
fn an_impulse_on_one_cloth_changes_no_other() {
    let flags = |impulse: Option<ClothImpulse>| {
        let mut app = app();
        let flags = [Vec3::ZERO, Vec3::X].map(|at| spawn_flag(&mut app, at));
        run(&mut app, 10);
        if let Some(impulse) = impulse {
            app.world_mut().trigger(impulse.on(flags[0]));
        }
        run(&mut app, 10);
        flags.map(|flag| bits(&app, flag))
    };
    let alone = flags(None);
    let pushed = flags(Some(ClothImpulse::velocity(Vec3::ZERO, 9.0, Vec3::Z)));
    assert_ne!(pushed[0], alone[0]);
    assert_eq!(pushed[1], alone[1]);
    let elsewhere = flags(Some(ClothImpulse::velocity(Vec3::Z * 20.0, 9.0, Vec3::Z)));
    assert_eq!(elsewhere, alone);
}

#[test]
fn impulses_from_within_a_substep_wait_for_the_next_tick() {
    let (mut app, sheet) = free_sheet();
    let push = |mut commands: Commands, mut done: Local<bool>| {
        if !core::mem::replace(&mut done, true) {
            commands.trigger(ClothImpulse::velocity(Vec3::ZERO, f32::INFINITY, Vec3::X));
        }
    };
    app.add_systems(ClothSubstep, push.in_set(ClothSubstepSystems::UserForces));
    run(&mut app, 1);
    assert!(momentum(&app, sheet).length() < 1e-4);
    run(&mut app, 1);
    let mass = UNDAMPED.0.area_density;
    assert!(momentum(&app, sheet).distance(Vec3::X * mass) < ROUNDING * mass);
}

#[test]
fn bad_impulses_are_reported_and_have_no_effect() {
    let good = ClothImpulse::velocity(Vec3::ZERO, 9.0, Vec3::Z);
    for bad in [
        ClothImpulse { at: Vec3::splat(f32::NAN), ..good },
        ClothImpulse { radius: f32::NAN, ..good },
        ClothImpulse { radius: -1.0, ..good },
        ClothImpulse::velocity(Vec3::ZERO, 9.0, Vec3::splat(f32::INFINITY)),
        ClothImpulse::momentum(Vec3::ZERO, 9.0, Vec3::splat(f32::MAX)),
    ] {
        let mut app = app();
        let flags = [Vec3::ZERO; 2].map(|at| spawn_flag(&mut app, at));
        run(&mut app, 5);
        app.world_mut().trigger(bad.on(flags[0]));
        run(&mut app, 5);
        assert_eq!(bits(&app, flags[0]), bits(&app, flags[1]), "{bad:?}");
        assert_eq!(errors(&app), [ClothError::Impulse { entity: flags[0] }], "{bad:?}");
    }
}

#[test]
fn an_acceleration_of_its_own_adds_to_gravity() {
    let hanging = |gravity: f32, own: Option<f32>| {
        let mut app = app();
        app.world_mut().resource_mut::<ClothSettings>().gravity = Vec3::Y * gravity;
        let turned = Transform::from_rotation(Quat::from_rotation_z(0.5));
        let held = Attachment::in_place(ClothEdge::Left);
        let flag = app.world_mut().spawn((ClothMesh::grid(9, 9, 1.0, 1.0), held, turned)).id();
        if let Some(own) = own {
            app.world_mut().entity_mut(flag).insert(ClothAcceleration(Vec3::Y * own));
        }
        run(&mut app, 30);
        bits(&app, flag)
    };
    assert_eq!(hanging(-9.0, Some(6.0)), hanging(-3.0, None));
    assert_eq!(hanging(-9.0, Some(0.0)), hanging(-9.0, None));
    assert_eq!(hanging(-9.0, Some(9.0)), hanging(0.0, None));
}

#[test]
fn a_strong_acceleration_takes_more_substeps() {
    let mut app = app();
    let flags = [0.0, 300.0].map(|acceleration| {
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        app.world_mut().entity_mut(flag).insert(ClothAcceleration(Vec3::NEG_Y * acceleration));
        flag
    });
    run(&mut app, 10);
    let efforts = flags.map(|flag| app.world().get::<ClothEffort>(flag).expect("an effort"));
    assert_eq!(efforts.map(|effort| effort.loads().frame), [0.0, 300.0]);
    let [calm, loaded] = efforts.map(|effort| effort.settings().substeps);
    assert!(loaded > calm, "{loaded} and {calm} substeps");
}

#[test]
fn a_bad_acceleration_is_reported_and_counts_as_zero() {
    let mut app = app();
    let flags = [Vec3::ZERO; 2].map(|at| spawn_flag(&mut app, at));
    app.world_mut().entity_mut(flags[0]).insert(ClothAcceleration(Vec3::splat(f32::NAN)));
    run(&mut app, 20);
    assert_eq!(bits(&app, flags[0]), bits(&app, flags[1]));
    assert_eq!(errors(&app), [ClothError::Acceleration { entity: flags[0] }]);
}

/// Calls `edit` with control over a cloth.
fn control<R: Send + 'static>(
    app: &mut App,
    cloth: Entity,
    edit: impl FnOnce(&mut bevy_bunting::ControlledCloth) -> Result<R, ControlError>
    + Send
    + Sync
    + 'static,
) -> Result<R, ControlError> {
    let mut edit = Some(edit);
    let system = move |mut control: ClothControl| {
        control.edit(cloth, edit.take().expect("the system runs once"))
    };
    app.world_mut().run_system_once(system).expect("the system runs")
}

#[test]
fn velocities_of_particles_can_be_set_without_a_jolt() {
    let (mut app, sheet) = free_sheet();
    control(&mut app, sheet, |cloth| {
        let velocity = cloth.direction_to_local(Vec3::X);
        (0..cloth.count()).try_for_each(|particle| cloth.set_velocity(particle, velocity))
    })
    .expect("finite velocities");
    let mass = UNDAMPED.0.area_density;
    for tick in 0..20 {
        run(&mut app, 1);
        let measured = momentum(&app, sheet) / mass;
        assert!(measured.distance(Vec3::X) < ROUNDING, "{measured} m/s in tick {tick}");
    }
}

#[test]
fn moved_particles_keep_their_velocity() {
    let (mut app, sheet) = free_sheet();
    app.world_mut().trigger(ClothImpulse::velocity(Vec3::ZERO, f32::INFINITY, Vec3::X));
    run(&mut app, 10);
    let before = state(&app, sheet).positions().to_vec();
    control(&mut app, sheet, |cloth| {
        (0..cloth.count()).try_for_each(|particle| cloth.move_by(particle, Vec3::Z * 0.5))
    })
    .expect("finite positions");
    run(&mut app, 1);
    let turned = app.world().get::<GlobalTransform>(sheet).unwrap().rotation();
    let expected = turned.inverse() * Vec3::X * TICK + Vec3::Z * 0.5;
    let pairs = state(&app, sheet).positions().iter().zip(&before);
    let error = greatest(pairs.map(|(now, then)| (now - then).distance(expected)));
    assert!(error < ROUNDING * TICK, "{error} m");
    run(&mut app, 1);
    let measured = momentum(&app, sheet) / UNDAMPED.0.area_density;
    assert!(measured.distance(Vec3::X) < ROUNDING, "{measured} m/s");
}

#[test]
fn pinned_particles_are_not_moved() {
    let mut app = app();
    let flags = [Vec3::ZERO; 2].map(|at| spawn_flag(&mut app, at));
    run(&mut app, 5);
    control(&mut app, flags[0], |cloth| {
        cloth.set_position(0, Vec3::splat(9.0))?;
        cloth.set_velocity(0, Vec3::splat(9.0))
    })
    .expect("values that are ignored");
    run(&mut app, 10);
    assert_eq!(bits(&app, flags[0]), bits(&app, flags[1]));
}

#[test]
fn bad_control_is_refused_and_changes_nothing() {
    let mut app = app();
    let flags = [Vec3::ZERO; 2].map(|at| spawn_flag(&mut app, at));
    run(&mut app, 5);
    let entity = flags[0];
    let count = state(&app, entity).positions().len();
    let results = [
        control(&mut app, entity, move |cloth| {
            cloth.set_velocity(9, Vec3::ONE)?;
            cloth.set_position(count, Vec3::ZERO)
        }),
        control(&mut app, entity, |cloth| {
            cloth.set_velocity(9, Vec3::ONE)?;
            cloth.set_position(9, Vec3::splat(f32::NAN))
        }),
        control(&mut app, entity, |cloth| cloth.add_velocity(9, Vec3::splat(f32::INFINITY))),
    ];
    let expected = [
        ControlError::NoParticle { entity, particle: count, count },
        ControlError::NotFinite { entity, particle: 9 },
        ControlError::NotFinite { entity, particle: 9 },
    ];
    assert_eq!(results, expected.map(Err));
    let nothing = app.world_mut().spawn_empty().id();
    let result = control(&mut app, nothing, |cloth| Ok(cloth.count()));
    assert_eq!(result, Err(ControlError::NotSimulated { entity: nothing }));
    assert!(expected[0].to_string().contains(&entity.to_string()));
    run(&mut app, 5);
    assert_eq!(bits(&app, flags[0]), bits(&app, flags[1]));
}

#[test]
fn control_is_refused_within_a_substep() {
    #[derive(Resource, Default)]
    struct Results(Vec<Result<usize, ControlError>>);
    let mut app = app();
    let entity = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 5);
    app.init_resource::<Results>().add_systems(
        ClothSubstep,
        (move |mut control: ClothControl, mut results: ResMut<Results>| {
            results.0.push(control.edit(entity, |cloth| Ok(cloth.count())));
        })
        .in_set(ClothSubstepSystems::UserForces),
    );
    run(&mut app, 1);
    let results = &app.world().resource::<Results>().0;
    assert!(!results.is_empty());
    assert!(results.iter().all(|it| *it == Err(ControlError::InSubstep { entity })), "{results:?}");
}
