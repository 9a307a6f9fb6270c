//! Tests that vertices of weight 0 are rigid and have no particles, and that weights between 0 and 1 blend.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::Time;
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, bits, run, spawn_flag, state};

/// Vertices along an edge of the square that most tests use.
const EDGE: usize = 17;

/// Rigid columns of the square.
const RIGID: usize = 6;

/// Columns over which the weight grows from 0 to 1.
const BLENDED: usize = 4;

/// Greatest distance of a vertex from its place on the target, m: rounding at 10 m from the origin.
const TOLERANCE: f32 = 1e-5;

/// Greatest difference of a position that is computed in two ways, m.
const ROUNDING: f32 = 1e-6;

/// A square metre, rigid on the left, with weights that grow from 0 to 1 to the right.
fn square() -> ClothMesh {
    weighted(|vertex| weight(vertex % EDGE))
}

/// Weight of a column.
fn weight(column: usize) -> f32 {
    ((column + 1) as f32 - RIGID as f32).clamp(0.0, BLENDED as f32) / BLENDED as f32
}

fn weighted(weight: impl Fn(usize) -> f32) -> ClothMesh {
    let edge = EDGE as u32;
    ClothMesh::grid(edge, edge, 1.0, 1.0).with_weights((0..EDGE * EDGE).map(weight).collect())
}

/// The square without blending: each weight is 0 or 1.
fn unblended() -> ClothMesh {
    weighted(|vertex| weight(vertex % EDGE).ceil())
}

fn rest(vertex: usize) -> Vec3 {
    let step = ((EDGE - 1) as f32).recip();
    Vec3::new((vertex % EDGE) as f32 * step, -((vertex / EDGE) as f32 * step), 0.0)
}

fn errors(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

#[derive(Component)]
struct Vehicle;

/// Moves vehicles along a circle of 10 m at 20 m/s and spins them twice a second about a tilted axis.
fn drive(mut vehicles: Query<&mut Transform, With<Vehicle>>, time: Res<Time>) {
    for mut transform in &mut vehicles {
        let (angle, turn) = (2.0 * time.elapsed_secs(), 12.566 * time.elapsed_secs());
        transform.translation = 10.0 * Vec3::new(angle.cos(), 0.0, angle.sin());
        transform.rotation = Quat::from_axis_angle(Vec3::new(0.2, 1.0, -0.1).normalize(), turn);
    }
}

#[test]
fn a_rigid_vertex_is_in_its_place_on_a_fast_spinning_target() {
    let offset = Transform::from_xyz(-0.3, 1.4, 0.2);
    let mut app = app();
    app.add_systems(Update, drive);
    let vehicle = app.world_mut().spawn((Vehicle, Transform::default())).id();
    let attachment = Attachment::new(vehicle, AttachedVertices::Rigid).with_offset(offset);
    let cloth = app.world_mut().spawn((square(), attachment)).id();
    run(&mut app, 3);
    let mut moved = 0.0_f32;
    for _ in 0..120 {
        app.update();
        let global = |entity: Entity| *app.world().get::<GlobalTransform>(entity).expect("placed");
        let state = state(&app, cloth);
        for vertex in 0..EDGE * EDGE {
            let shown = state.vertex_position(vertex as u32).unwrap_or(rest(vertex));
            if weight(vertex % EDGE) == 0.0 {
                assert!(shown.distance(rest(vertex)) < ROUNDING, "{shown}");
                let place = global(vehicle).transform_point(offset.transform_point(rest(vertex)));
                let drawn = global(cloth).transform_point(shown);
                assert!(drawn.distance(place) < TOLERANCE, "{}", drawn.distance(place));
            } else {
                moved = moved.max(shown.distance(rest(vertex)));
            }
        }
    }
    assert!(moved > 0.2, "{moved} m: the simulated vertices move");
    assert_finite(&app, cloth);
}

#[test]
fn rigid_vertices_have_no_particles() {
    let mut app = app();
    let cells = ClothResolution::CellSize(((EDGE - 1) as f32).recip());
    let cloth = app.world_mut().spawn((square(), cells)).id();
    run(&mut app, 3);
    let state = state(&app, cloth);
    // One rigid column remains, since it pins the simulated part.
    let fabric = state.fabric().expect("a fabric");
    let border = rest(RIGID - 1).x;
    let mut pinned = 0;
    for (particle, at) in fabric.rest_positions().iter().enumerate() {
        assert!(at.x > border - ROUNDING, "{at}");
        assert_eq!(fabric.is_pinned(particle), at.x < border + ROUNDING, "{at}");
        pinned += usize::from(fabric.is_pinned(particle));
    }
    assert!((EDGE - 1..=EDGE + 1).contains(&pinned), "{pinned}");
    assert_eq!((state.particle_of_vertex(0), state.vertex_position(0)), (None, None));
    assert!(state.particle_of_vertex(EDGE as u32 - 1).is_some());
}

#[test]
fn the_surface_blends_from_rigid_to_simulated() {
    // An app of its own each: in one the second would be built some ticks later.
    let mut cloths = [square(), unblended()].map(|mesh| {
        let mut app = app();
        app.world_mut().spawn(WindField::steady(Vec3::new(1.0, 0.0, 5.0)));
        let cloth = app.world_mut().spawn(mesh).id();
        (app, cloth)
    });
    let mut furthest = [0.0_f32; EDGE];
    for _ in 0..100 {
        cloths.iter_mut().for_each(|(app, _)| app.update());
        let [blended, simulated] = cloths.each_ref().map(|(app, cloth)| state(app, *cloth));
        let Some(fabric) = blended.fabric() else { continue };
        for (particle, &rest) in fabric.rest_positions().iter().enumerate() {
            // Between two columns the weight grows evenly. Where it is rigid on one side, both are blended.
            let column = rest.x * (EDGE - 1) as f32;
            let (left, right) = (weight(column as usize), weight(column as usize + 1));
            let whole = if left == 0.0 { right.ceil() * column.fract() } else { 1.0 };
            let weight = left + (right - left) * column.fract();
            let weight = if whole == 0.0 { 0.0 } else { weight / whole };
            let (shown, at) = (blended.positions()[particle], simulated.positions()[particle]);
            // Columns are found to within some roundings.
            let off = shown.distance(rest.lerp(at, weight));
            assert!(off < 10.0 * ROUNDING, "{off} m at {rest}, {at}, weight {weight}");
            if whole < 1.0 {
                continue;
            }
            let (normal, simulated) = (blended.normals()[particle], simulated.normals()[particle]);
            let between = Vec3::Z.lerp(simulated, weight).normalize();
            assert!(normal.distance(between) < 10.0 * ROUNDING, "{normal} {between}");
        }
        for vertex in 0..EDGE * EDGE {
            let Some(shown) = blended.vertex_position(vertex as u32) else { continue };
            let column = &mut furthest[vertex % EDGE];
            *column = column.max(shown.distance(rest(vertex)));
        }
    }
    // Each column moves more in the wind than the one before.
    assert!(furthest[..RIGID].iter().all(|&moved| moved < ROUNDING), "{furthest:?}");
    assert!(furthest[RIGID - 1..].windows(2).all(|pair| pair[0] < pair[1]), "{furthest:?}");
    assert!(furthest[EDGE - 1] > 0.3, "{furthest:?}");
}

#[test]
fn every_level_keeps_the_border_to_the_rigid_part_and_blends() {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(1.0, 0.0, 5.0)));
    let levels = LodSet::new([5.0]).pinned_to(1);
    let cloth = app.world_mut().spawn((square(), levels)).id();
    run(&mut app, 60);
    let state = state(&app, cloth);
    assert_eq!(state.level(), 1);
    let particles = state.positions().len();
    assert!(particles < 400, "{particles}");
    for vertex in 0..EDGE * EDGE {
        let moved = state.vertex_position(vertex as u32).map(|at| at.distance(rest(vertex)));
        match vertex % EDGE {
            column if column + 1 == RIGID => {
                assert!(moved.is_some_and(|moved| moved < ROUNDING), "{moved:?}");
            }
            column if weight(column) == 0.0 => assert_eq!(moved, None),
            column if column == RIGID => assert!(moved.is_some_and(|moved| moved < 0.05)),
            column if column == EDGE - 1 => assert!(moved.is_some_and(|moved| moved > 0.1)),
            _ => {}
        }
    }
    assert!(errors(&app).is_empty());
}

#[test]
fn bad_weights_are_reported_and_other_cloths_are_simulated() {
    let alone = {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        run(&mut app, 20);
        bits(&app, flag)
    };
    let with = |weights: Vec<f32>| ClothMesh::grid(3, 3, 1.0, 1.0).with_weights(weights);
    let set = |weight: f32| with([vec![1.0; 5], vec![weight], vec![0.0; 3]].concat());
    let is_out =
        |source: WeightsError| matches!(source, WeightsError::OutOfRange { vertex: 5, .. });
    type Check = fn(WeightsError) -> bool;
    let few: Check = |source| source == WeightsError::Count { weights: 8, vertices: 9 };
    let many: Check = |source| source == WeightsError::Count { weights: 10, vertices: 9 };
    let bad: [(ClothMesh, Check); 6] = [
        (with(vec![1.0; 8]), few),
        (with(vec![1.0; 10]), many),
        (set(f32::NAN), is_out),
        (set(-0.01), is_out),
        (set(1.01), is_out),
        (with(vec![0.0; 9]), |source| source == WeightsError::AllRigid),
    ];
    for (mesh, check) in bad {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        let cloth = app.world_mut().spawn(mesh).id();
        run(&mut app, 20);
        assert_eq!(bits(&app, flag), alone);
        assert!(state(&app, cloth).positions().is_empty());
        let errors = errors(&app);
        let [error @ ClothError::Weights { entity, source }] = errors[..] else {
            panic!("{errors:?}")
        };
        assert!(entity == cloth && check(source), "{source:?}");
        assert!(error.to_string().contains(&cloth.to_string()), "{error}");
        app.world_mut().entity_mut(cloth).insert(square());
        run(&mut app, 3);
        assert_finite(&app, cloth);
    }
}

#[test]
fn an_attachment_of_rigid_vertices_needs_some() {
    let mut app = app();
    let rigid = Attachment::in_place(AttachedVertices::Rigid);
    let nothing = app.world_mut().spawn((weighted(|_| 1.0), rigid.clone())).id();
    let held = app.world_mut().spawn((square(), rigid)).id();
    run(&mut app, 3);
    let errors = errors(&app);
    assert!(
        matches!(errors[..], [ClothError::NoVertices { entity }] if entity == nothing),
        "{errors:?}"
    );
    assert_finite(&app, held);
}
