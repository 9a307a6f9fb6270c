//! Cloths that are held at points on their triangles.

use bevy_app::App;
use bevy_bunting::bunting_solver::FabricError;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, run, state};

/// A level square metre of two triangles.
fn sheet() -> ClothMesh {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Z, Vec3::new(1.0, 0.0, 1.0)].to_vec();
    ClothMesh::triangles(positions, vec![0, 2, 1, 1, 2, 3], vec![])
}

/// In the middle of the first triangle, a third of a metre from two sides, and on the second one.
const FIRST: MeshPoint = MeshPoint::middle([0, 1, 2]);
const SECOND: MeshPoint = MeshPoint { vertices: [1, 2, 3], weights: [0.25, 0.25, 0.5] };

fn points(points: impl IntoIterator<Item = MeshPoint>) -> AttachedVertices {
    AttachedVertices::Points(points.into_iter().collect())
}

/// Where a point of a cloth is in its frame, m.
fn at(app: &App, cloth: Entity, point: &MeshPoint) -> Vec3 {
    let state = state(app, cloth);
    state.positions()[state.particle_of_point(point).expect("a particle")]
}

fn spawn(app: &mut App, at: Transform) -> Entity {
    app.world_mut().spawn(at).id()
}

fn damped() -> ClothMaterial {
    ClothMaterial(FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON })
}

#[test]
fn targets_carry_points_exactly_at_every_level() {
    for level in [0, 1, 2] {
        let mut app = app();
        let [left, right] = [(); 2].map(|()| spawn(&mut app, Transform::default()));
        let held = Attachment::new(left, points([FIRST]))
            .with_anchor(Anchor::new(right, points([SECOND])));
        let lods = LodSet::new([10.0, 20.0]).pinned_to(level);
        let cloth = (sheet(), held, lods, ClothResolution::CellSize(0.05), damped());
        let cloth = app.world_mut().spawn((cloth, AnchorReactions::default())).id();
        run(&mut app, 3);
        let rest = [FIRST, SECOND].map(|point| at(&app, cloth, &point));
        let [of_first, of_second] = rest;
        assert!(of_first.distance(Vec3::new(1.0, 0.0, 1.0) / 3.0) < 1e-6, "{of_first}");
        assert!(of_second.distance(Vec3::new(0.75, 0.0, 0.75)) < 1e-6, "{of_second}");
        for step in 1..40 {
            let by = 0.004 * step as f32;
            let turn = Quat::from_rotation_y(-0.01 * step as f32);
            *app.world_mut().get_mut::<Transform>(left).expect("a hand") =
                Transform::from_xyz(by, 0.0, 0.0).with_rotation(turn);
            let to = Transform::from_xyz(0.0, by, 0.0);
            *app.world_mut().get_mut::<Transform>(right).expect("a hand") = to;
            run(&mut app, 1);
        }
        run(&mut app, 700);
        assert_eq!(at(&app, cloth, &FIRST), of_first, "level {level}: in the frame");
        let frame = app.world().get::<GlobalTransform>(cloth).expect("a transform");
        let second = frame.transform_point(at(&app, cloth, &SECOND));
        let told = of_second + Vec3::Y * 0.156;
        assert!(second.distance(told) < 1e-6, "level {level}: {second}, not {told}");
        let state = state(&app, cloth);
        let fabric = state.fabric().expect("a fabric");
        let pins = (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle));
        assert_eq!(pins.count(), 2, "level {level}");
        let lowest = state.positions().iter().map(|at| at.y).fold(0.0, f32::min);
        assert!(lowest < -0.2, "level {level}: its corners hang {lowest} m low");
        // Both carry the cloth together, each a part of it.
        let reactions = app.world().get::<AnchorReactions>(cloth).expect("reactions");
        let weight = 9.81 * FabricMaterial::COTTON.area_density * fabric.area();
        let sum = reactions.target.force + reactions.anchors[0].force;
        let error = (sum + Vec3::Y * weight).length() / weight;
        assert!(error < 0.02, "level {level}: {sum} N of {weight} N");
        let forces = [reactions.target.force, reactions.anchors[0].force];
        assert!(forces.iter().all(|force| force.y < -0.1 * weight), "level {level}: {forces:?}");
        assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
    }
}

#[test]
fn a_point_beside_vertices_of_another_target_follows_its_own() {
    let mut app = app();
    let [left, right] = [(); 2].map(|()| spawn(&mut app, Transform::default()));
    // The vertices around the point are held by the anchor, and may move away from it.
    let vertices = Anchor::new(right, AttachedVertices::List(vec![0, 1]));
    let held = Attachment::new(left, points([FIRST])).with_anchor(vertices);
    let cloth = (sheet(), held, ClothResolution::CellSize(0.1));
    let cloth = app.world_mut().spawn(cloth).id();
    run(&mut app, 3);
    let rest = at(&app, cloth, &FIRST);
    for step in 1..30 {
        let to = Transform::from_xyz(0.0, 0.0, 0.005 * step as f32);
        *app.world_mut().get_mut::<Transform>(right).expect("a hand") = to;
        run(&mut app, 1);
        assert_eq!(at(&app, cloth, &FIRST), rest);
    }
    run(&mut app, 5);
    let corner = state(&app, cloth).vertex_position(0).expect("a vertex");
    assert!(corner.distance(Vec3::Z * 0.145) < 1e-5, "{corner}");
}

#[test]
fn a_point_on_a_lost_target_is_let_go_and_the_other_stays_held() {
    let mut app = app();
    let [left, right] = [(); 2].map(|()| spawn(&mut app, Transform::default()));
    let held =
        Attachment::new(left, points([FIRST])).with_anchor(Anchor::new(right, points([SECOND])));
    let held = Attachment { on_lost: TargetLost::Release, ..held };
    let cloth = (sheet(), held, ClothResolution::CellSize(0.07), damped());
    let cloth = app.world_mut().spawn(cloth).id();
    run(&mut app, 200);
    let before = state(&app, cloth).vertex_position(3).expect("a vertex");
    app.world_mut().despawn(right);
    run(&mut app, 2);
    let after = state(&app, cloth).vertex_position(3).expect("a vertex");
    assert!(after.distance(before) < 0.03, "{before} {after}: it keeps its shape");
    run(&mut app, 200);
    assert_finite(&app, cloth);
    let stays = at(&app, cloth, &FIRST);
    assert!(stays.distance(Vec3::new(1.0, 0.0, 1.0) / 3.0) < 1e-6, "{stays}");
    assert_eq!(state(&app, cloth).particle_of_point(&SECOND), None);
    let fallen = state(&app, cloth).vertex_position(3).expect("a vertex");
    assert!(fallen.y < before.y - 0.2, "{before} {fallen}");
}

#[test]
fn a_spring_holds_a_point() {
    let mut app = app();
    let post = spawn(&mut app, Transform::default());
    let none = AttachedVertices::List(Vec::new());
    let spring = Anchor::new(post, points([FIRST])).with_stiffness(50.0);
    let cloth = (sheet(), Attachment::new(post, none).with_anchor(spring), damped());
    let cloth = app.world_mut().spawn(cloth).id();
    run(&mut app, 700);
    let sinks = -at(&app, cloth, &FIRST).y;
    let expected = 9.81 * FabricMaterial::COTTON.area_density / 50.0;
    assert!((sinks / expected - 1.0).abs() < 0.05, "{sinks} m, not {expected} m");
}

#[test]
fn a_grid_is_held_beside_its_vertices_and_keeps_its_vertices() {
    let mut app = app();
    let grid = ClothMesh::grid(17, 17, 1.0, 1.0);
    let peg = grid.nearest_point(Vec3::new(0.53, -0.02, 0.0)).expect("triangles");
    let spawned = |held| (grid.clone(), Attachment::in_place(held), Transform::default());
    let beside = app.world_mut().spawn(spawned(points([peg]))).id();
    let at_vertices = points([MeshPoint::at_vertex(0), MeshPoint::at_vertex(16)]);
    let at_vertices = app.world_mut().spawn(spawned(at_vertices)).id();
    let corners = AttachedVertices::List(vec![0, 16]);
    let by_list = app.world_mut().spawn(spawned(corners)).id();
    run(&mut app, 60);
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
    let held = at(&app, beside, &peg);
    assert!(held.distance(Vec3::new(0.53, -0.02, 0.0)) < 1e-6, "{held}");
    let cloth = state(&app, beside);
    assert!((0..289).all(|vertex| cloth.vertex_position(vertex).is_some_and(Vec3::is_finite)));
    assert_eq!(cloth.vertex_position(289), None);
    let corner = cloth.vertex_position(0).expect("a corner");
    assert!(corner.distance(Vec3::ZERO) > 0.1, "it is free: {corner}");
    // At vertices alone it is the grid that it was.
    assert_eq!(state(&app, at_vertices).positions(), state(&app, by_list).positions());
    assert_eq!(state(&app, at_vertices).positions().len(), 289);
    // With another point it keeps its shape.
    let other = MeshPoint { weights: [0.2, 0.3, 0.5], ..peg };
    *app.world_mut().get_mut::<Attachment>(beside).expect("held") =
        Attachment::in_place(points([peg, other]));
    run(&mut app, 2);
    let kept = state(&app, beside).vertex_position(0).expect("a corner");
    assert!(kept.distance(corner) < 0.1, "{corner} {kept}");
}

#[test]
fn bad_points_are_reported_and_others_do_as_before() {
    let mut app = app();
    let at_rest = |held| (sheet(), Attachment::in_place(held), ClothResolution::CellSize(0.2));
    let bad = [
        MeshPoint::middle([0, 1, 9]),
        MeshPoint::middle([0, 1, 3]),
        MeshPoint { weights: [0.5, 0.5, f32::NAN], ..FIRST },
        MeshPoint { weights: [1.2, -0.2, 0.0], ..FIRST },
    ];
    let cloths = bad.map(|point| app.world_mut().spawn(at_rest(points([FIRST, point]))).id());
    let empty = app.world_mut().spawn(at_rest(points([]))).id();
    run(&mut app, 4);
    let errors: Vec<ClothError> =
        app.world().resource::<Seen<ClothFailed>>().0.iter().map(|it| it.error).collect();
    assert_eq!(errors.len(), 5, "{errors:?}");
    for cloth in cloths {
        let of_cloth = |error: &&ClothError| matches!(error, ClothError::Mesh { entity, .. } if *entity == cloth);
        let error = errors.iter().find(of_cloth).expect("an error").to_string();
        assert!(error.contains("point") && error.contains(&cloth.to_string()), "{error}");
    }
    let is = |test: &dyn Fn(&FabricError) -> bool| {
        errors
            .iter()
            .filter(|it| matches!(it, ClothError::Mesh { source, .. } if test(source)))
            .count()
    };
    assert_eq!(is(&|it| matches!(it, FabricError::PointOutOfRange { vertex: 9, .. })), 1);
    assert_eq!(is(&|it| matches!(it, FabricError::PointOffMesh { vertices: [0, 1, 3] })), 1);
    assert_eq!(is(&|it| matches!(it, FabricError::PointWeights { .. })), 2);
    assert!(errors.contains(&ClothError::NoVertices { entity: empty }));
    // A good one is simulated; a bad one after it changes nothing.
    let cloth = cloths[0];
    let hold = |app: &mut App, point: MeshPoint| {
        let held = Attachment::in_place(points([point]));
        app.world_mut().entity_mut(cloth).insert(held);
        run(app, 10);
    };
    hold(&mut app, FIRST);
    let rest = at(&app, cloth, &FIRST);
    hold(&mut app, bad[0]);
    assert_eq!(at(&app, cloth, &FIRST), rest);
    assert_finite(&app, cloth);
}
