//! Tests of meshes that a cloth carries.

use bevy_math::primitives::Cuboid;

use super::*;

/// A flag with a small box half a centimetre in front of its free edge, and the box.
fn flag_with_a_box(app: &mut App, levels: LodSet) -> [Entity; 2] {
    let cloth = spawn(app, levels);
    let mesh = Mesh::from(Cuboid::new(0.01, 0.01, 0.01));
    let mesh = mesh.translated_by(Vec3::new(1.3, -0.4, 0.01));
    let mesh = add(app, mesh);
    let carried = (mesh, crate::ClothDeformer { cloth }, ChildOf(cloth));
    [cloth, app.world_mut().spawn(carried).id()]
}

fn wait(app: &mut App, carried: Entity) {
    let rest = Vec3::new(1.3, -0.4, 0.01);
    for _ in 0..1000 {
        run(app, 1);
        std::thread::yield_now();
        if centre(app, carried).distance(rest) > 0.02 {
            return;
        }
    }
    panic!("nothing moves it");
}

fn centre(app: &App, carried: Entity) -> Vec3 {
    let positions = positions(app, carried);
    positions.iter().map(|&at| Vec3::from(at)).sum::<Vec3>() / positions.len() as f32
}

#[test]
fn a_carried_mesh_follows_its_cloth_at_every_level() {
    let mut app = app(TICK);
    let levels = LodSet::new([10.0]);
    let [cloth, carried] = flag_with_a_box(&mut app, levels.clone().pinned_to(0));
    wait(&mut app, carried);
    let mut last = centre(&app, carried);
    let (mut widest, mut sizes) = (0.0_f32, Vec::new());
    for tick in 0..200 {
        if tick == 100 {
            app.world_mut().entity_mut(cloth).insert(levels.clone().pinned_to(1));
        }
        run(&mut app, 1);
        let now = centre(&app, carried);
        widest = widest.max(now.distance(last));
        last = now;
        // It stays beside the cloth, and keeps its shape.
        let surface = surface(&app, cloth);
        let nearest = surface.positions.iter().map(|at| at.distance(now)).fold(9.0, f32::min);
        assert!(nearest < 0.25, "{nearest} m from a particle in tick {tick}");
        let radius = |&at: &[f32; 3]| Vec3::from(at).distance(now);
        sizes.push(positions(&app, carried).iter().map(radius).fold(0.0, f32::max));
    }
    assert!(widest < 0.15, "{widest} m in a tick");
    let radius = 0.005 * 3.0_f32.sqrt();
    // The cells of the coarse flag are sheared and strained by less than a third in gusts, and the box with them.
    assert!(sizes.iter().all(|size| (size / radius - 1.0).abs() < 0.3), "{sizes:?}");
    assert!(failures(&app).is_empty());
    app.world_mut().entity_mut(cloth).insert(ClothPaused);
    run(&mut app, 3);
    modified(&mut app);
    run(&mut app, 3);
    assert_eq!(modified(&mut app), 0, "at rest nothing is written");
}

#[test]
fn a_mesh_is_bound_as_it_was_given_when_the_cloth_is_made_anew() {
    let mut app = app(TICK);
    let [cloth, carried] = flag_with_a_box(&mut app, LodSet::default());
    wait(&mut app, carried);
    run(&mut app, 60);
    let given: Vec<Vec3> = surface(&app, cloth).positions.clone();
    let flown = centre(&app, carried);
    assert!(flown.z > 0.1, "the flag flies: {flown}");
    // Another attachment is another fabric, whose surface is flat again.
    app.world_mut().entity_mut(cloth).insert(Attachment::in_place(ClothEdge::Right));
    app.world_mut().entity_mut(cloth).insert(ClothPaused);
    let mut beside = f32::INFINITY;
    for _ in 0..300 {
        run(&mut app, 1);
        std::thread::sleep(Duration::from_millis(1));
        let now = centre(&app, carried);
        let surface = surface(&app, cloth);
        let nearest = surface.positions.iter().map(|at| at.distance(now)).fold(9.0, f32::min);
        beside = nearest;
    }
    assert_ne!(surface(&app, cloth).positions, given);
    assert!(beside < 0.15, "{beside} m from the nearest particle");
}

#[test]
fn what_lies_over_the_rigid_part_stays_and_the_rest_is_carried() {
    let mut app = app(TICK);
    let weight = |vertex: usize| if vertex % 9 < 3 { 0.0 } else { 1.0 };
    let shape = FLAG.with_weights((0..45).map(weight).collect());
    let cloth = app.world_mut().spawn((shape, Attachment::in_place(AttachedVertices::Rigid))).id();
    // A row of points over the whole width.
    let row: Vec<[f32; 3]> = (0..31).map(|at| [0.05 * at as f32, -0.4, 0.01]).collect();
    let mesh = Mesh::new(bevy_mesh::PrimitiveTopology::PointList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, row.clone());
    let mesh = add(&mut app, mesh);
    let carried = app.world_mut().spawn((mesh, crate::ClothDeformer { cloth })).id();
    for _ in 0..200 {
        run(&mut app, 1);
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(failures(&app), []);
    let moved: Vec<f32> = positions(&app, carried)
        .iter()
        .zip(&row)
        .map(|(now, rest)| Vec3::from(*now).distance(Vec3::from(*rest)))
        .collect();
    // Three columns of vertices are rigid: the first 0.375 m.
    assert!(moved[..7].iter().all(|&moved| moved == 0.0), "{moved:?}");
    assert!(moved[30] > 0.2, "{moved:?}");
    assert!(moved.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.08), "no gap: {moved:?}");
}

#[test]
fn what_cannot_be_read_is_reported_once() {
    let mut app = app(TICK);
    let cloth = spawn(&mut app, ());
    let mut mesh = Mesh::from(Cuboid::default());
    mesh.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let mesh = add(&mut app, mesh);
    let carried = app.world_mut().spawn((mesh, crate::ClothDeformer { cloth })).id();
    run(&mut app, 5);
    assert_eq!(failures(&app), [ClothError::MeshUnreadable { entity: carried }]);
}
