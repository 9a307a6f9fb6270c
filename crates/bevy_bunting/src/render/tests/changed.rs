//! Tests of cloths whose mesh assets change.

use bevy_mesh::Indices;

use super::*;

/// The flag's mesh, higher by a factor, with a red left column.
fn flag_of(app: &mut App, height: f32) -> Mesh {
    let mesh = flag_mesh(app);
    let scaled =
        values(&mesh, Mesh::ATTRIBUTE_POSITION).iter().map(|&[x, y, z]| [x, height * y, z]);
    let scaled: Vec<_> = scaled.collect();
    let red = |vertex: usize| if vertex.is_multiple_of(9) { 1.0 } else { 0.0 };
    let colors: Vec<_> = (0..45).map(|vertex| [red(vertex), 0.0, 0.0, 1.0]).collect();
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, scaled)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}

/// The mesh with a third triangle on the edge from 10 to 11, so that no cloth can be made of it.
fn with_a_fin(mesh: Mesh) -> Mesh {
    let Some(Indices::U32(indices)) = mesh.indices() else { panic!("indices") };
    let fin = [&indices[..], &[10, 11, 30]].concat();
    mesh.with_inserted_indices(Indices::U32(fin))
}

fn spawn_from(app: &mut App, mesh: &Mesh3d) -> Entity {
    app.world_mut().spawn((mesh.clone(), ClothFromMesh::painted(), ClothSubdivision::NONE)).id()
}

/// Difference of lengths that is none, m: the mesh is that of a flag in wind.
const SAME: f32 = 0.1;

/// Height of a cloth at rest, m.
fn height(app: &App, cloth: Entity) -> f32 {
    let shape = app.world().get::<ClothMesh>(cloth).expect("a cloth");
    let ClothMesh::Triangles { positions, .. } = shape else { panic!("triangles") };
    -positions.iter().map(|at| at.y).fold(0.0, f32::min)
}

fn replace(app: &mut App, given: &Mesh3d, mesh: Mesh) {
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    meshes.insert(given.id(), mesh).expect("a mesh");
}

fn ticks(app: &App, cloth: Entity) -> bool {
    app.world().get::<ClothState>(cloth).is_some_and(|it| it.activity() == ClothActivity::Ticking)
}

#[test]
fn a_changed_asset_makes_the_cloth_anew_and_the_plugins_own_writes_do_not() {
    let mut app = app(TICK);
    let mesh = flag_of(&mut app, 1.0);
    let given = add(&mut app, mesh);
    let cloth = spawn_from(&mut app, &given);
    run(&mut app, 60);
    let moved = positions(&app, cloth)[44];
    assert!((height(&app, cloth) - 1.0).abs() < SAME);
    // An access that changes nothing changes nothing.
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    meshes.get_mut(&given.0).expect("it is loaded").into_inner();
    run(&mut app, 3);
    assert!(Vec3::from(positions(&app, cloth)[44]).distance(Vec3::from(moved)) < 0.2, "it flew on");
    // Hot reloading replaces the asset.
    let taller = flag_of(&mut app, 2.0);
    replace(&mut app, &given, taller);
    run(&mut app, 60);
    assert!((height(&app, cloth) - 2.0).abs() < SAME);
    assert!(is_current(&app, cloth) && ticks(&app, cloth));
    // Weights are painted anew: all is free.
    let mut meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    let mut mesh = meshes.get_mut(&given.0).expect("it is loaded");
    mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, vec![[0.0, 0.0, 0.0, 1.0]; 45]);
    drop(mesh);
    run(&mut app, 60);
    let shape = app.world().get::<ClothMesh>(cloth).expect("a cloth");
    assert!(!shape.weights().contains(&0.0));
    assert_eq!(failures(&app), []);
}

#[test]
fn another_handle_makes_the_cloth_anew_with_as_many_vertices_too() {
    let mut app = app(TICK);
    let mesh = flag_of(&mut app, 1.0);
    let given = add(&mut app, mesh);
    let cloth = spawn_from(&mut app, &given);
    run(&mut app, 30);
    let mesh = flag_of(&mut app, 3.0);
    let at_rest = values(&mesh, Mesh::ATTRIBUTE_POSITION).clone();
    let other = add(&mut app, mesh);
    let by_user = other.clone();
    // A system of the user in `Update` gives it, between the ticks and what is drawn.
    let mut is_given = false;
    app.add_systems(Update, move |mut commands: Commands| {
        if !core::mem::replace(&mut is_given, true) {
            commands.entity(cloth).insert(by_user.clone());
        }
    });
    run(&mut app, 60);
    assert_eq!(failures(&app), []);
    assert!((height(&app, cloth) - 3.0).abs() < SAME);
    assert!(is_current(&app, cloth));
    let users = app.world().resource::<Assets<Mesh>>().get(&other.0).expect("the user's mesh");
    assert_eq!(values(users, Mesh::ATTRIBUTE_POSITION), &at_rest, "it is not written");
}

#[test]
fn a_bad_mesh_keeps_the_last_good_cloth() {
    let mut app = app(TICK);
    let mesh = flag_of(&mut app, 1.0);
    let given = add(&mut app, mesh.clone());
    let [changed, replaced] = [(); 2].map(|()| spawn_from(&mut app, &given));
    let other = add(&mut app, with_a_fin(mesh.clone()));
    run(&mut app, 30);
    app.world_mut().entity_mut(replaced).insert(other.clone());
    run(&mut app, 30);
    let edge = |app: &App, cloth: Entity| {
        let is_named = |error: &ClothError| match *error {
            ClothError::Mesh {
                entity,
                source: bunting_solver::FabricError::NonManifoldEdge { a, b },
            } => entity == cloth && [a.min(b), a.max(b)] == [10, 11],
            _ => false,
        };
        failures(app).iter().filter(|error| is_named(error)).count()
    };
    assert_eq!((failures(&app).len(), edge(&app, replaced)), (1, 1), "{:?}", failures(&app));
    replace(&mut app, &given, with_a_fin(mesh));
    run(&mut app, 30);
    assert_eq!((failures(&app).len(), edge(&app, changed)), (2, 1), "{:?}", failures(&app));
    for cloth in [changed, replaced] {
        assert!(ticks(&app, cloth) && is_current(&app, cloth));
        assert!((height(&app, cloth) - 1.0).abs() < SAME);
    }
    // What is mended is taken.
    let mended = flag_of(&mut app, 2.0);
    replace(&mut app, &given, mended.clone());
    replace(&mut app, &other, mended);
    run(&mut app, 30);
    for cloth in [changed, replaced] {
        assert!((height(&app, cloth) - 2.0).abs() < SAME);
        assert!(is_current(&app, cloth));
    }
    assert_eq!(failures(&app).len(), 2);
}

#[test]
fn what_a_cloth_waits_for_is_said() {
    let mut app = app(TICK);
    let mesh = flag_of(&mut app, 1.0);
    let loaded_later = app.world().resource::<Assets<Mesh>>().reserve_handle();
    let waits = spawn_from(&mut app, &Mesh3d(loaded_later.clone()));
    let bad = add(&mut app, with_a_fin(mesh.clone()));
    let bad = spawn_from(&mut app, &bad);
    run(&mut app, 5);
    let activity = |app: &App, cloth: Entity| {
        app.world().get::<ClothState>(cloth).expect("a state").activity()
    };
    assert_eq!(activity(&app, waits), ClothActivity::AwaitsAsset);
    assert_eq!(activity(&app, bad), ClothActivity::Failed);
    assert!(app.world().get::<ClothMesh>(bad).is_none());
    replace(&mut app, &Mesh3d(loaded_later), mesh);
    run(&mut app, 5);
    assert_eq!(activity(&app, waits), ClothActivity::Ticking);
}

#[test]
fn a_carried_mesh_that_changes_is_bound_anew() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    let mesh = flag_of(&mut app, 1.0);
    let given = add(&mut app, mesh.clone());
    let fringe = (given.clone(), crate::ClothDeformer { cloth }, ChildOf(cloth));
    let fringe = app.world_mut().spawn(fringe).id();
    let is_bound = |app: &App, x: f32| {
        let drawn = positions(app, fringe);
        (drawn[0][0] - x).abs() < SAME && drawn[44] != values(&mesh, Mesh::ATTRIBUTE_POSITION)[44]
    };
    let wait = |app: &mut App, x: f32| {
        for _ in 0..5000 {
            run(app, 1);
            std::thread::sleep(Duration::from_millis(1));
            if is_bound(app, x) {
                return;
            }
        }
        panic!("not bound: {:?}", failures(app));
    };
    run(&mut app, 10);
    wait(&mut app, 0.0);
    let beside: Vec<_> =
        values(&mesh, Mesh::ATTRIBUTE_POSITION).iter().map(|&[x, y, z]| [x - 0.5, y, z]).collect();
    let beside = mesh.clone().with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, beside);
    replace(&mut app, &given, beside);
    wait(&mut app, -0.3);
    assert_eq!(failures(&app), []);
    // The cloth goes, the fringe stays, and keeps no fabric.
    let state = app.world().get::<ClothState>(cloth).expect("a cloth");
    let fabric = std::sync::Arc::downgrade(state.fabric().expect("it is simulated"));
    app.world_mut().entity_mut(fringe).remove::<ChildOf>();
    app.world_mut().despawn(cloth);
    run(&mut app, 70);
    assert_eq!(fabric.strong_count(), 0);
}
