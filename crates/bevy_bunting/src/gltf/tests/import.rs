//! The project's own files.

use bevy_math::{Mat4, Quat};
use bevy_mesh::Mesh;

use super::*;

/// Departure of a pinned vertex from its place, m: rounding.
const ROUNDING: f32 = 1e-5;

/// By how much the cape's curve departs from the chord between two particles, h²/8R, m: cells of 3.5 cm on a radius of 0.22 m. A
/// vertex between particles is that far above their chord, in a direction that turns with the cloth.
const CURVE: f32 = 7e-4;

#[test]
fn the_flag_flies_as_its_file_says() {
    let mut app = app(&assets());
    let flag = spawn(&mut app, "cloths/flag.gltf", "FlagCloth.Red");
    let halyard = find(&mut app, "Halyard").expect("a node");
    run(&mut app, 60);
    assert_eq!(messages(&app), [""; 0]);
    let world = app.world();
    let material = world.get::<ClothMaterial>(flag).expect("a cloth").0;
    assert_eq!(material, FabricMaterial { area_density: 0.25, ..FabricMaterial::FLAG_POLYESTER });
    assert_eq!(world.resource::<ClothSettings>().air_density, 1.1);
    let held = world.get::<Attachment>(flag).expect("it is held");
    assert_eq!(held.target, halyard);
    assert_eq!(held.teleport_speed, Attachment::in_place(ClothEdge::Left).teleport_speed);
    let wind = find(&mut app, "Wind").expect("a node");
    assert_eq!(app.world().get::<WindField>(wind).expect("a wind").velocity.x, 5.0);
    // The left column is pinned to the halyard, and the rest flies.
    let rest = rest(&app, flag);
    let state = app.world().get::<ClothState>(flag).expect("it is simulated");
    assert_eq!(rest.len(), 17 * 11);
    for (vertex, rest) in rest.iter().enumerate() {
        let at = state.vertex_position(vertex as u32).expect("a vertex");
        let moved = at.distance(*rest);
        assert_eq!(moved < ROUNDING, vertex.is_multiple_of(17), "vertex {vertex}: {moved} m");
    }
    let place = |app: &App| app.world().get::<Transform>(flag).expect("placed").translation;
    assert!(place(&app).abs_diff_eq(Vec3::new(0.0, 3.0, 0.0), ROUNDING));
    // It goes where the halyard goes.
    let pole = find(&mut app, "Pole").expect("a node");
    app.world_mut().get_mut::<Transform>(pole).expect("a node").translation.x = 0.1;
    run(&mut app, 10);
    assert!(place(&app).abs_diff_eq(Vec3::new(0.1, 3.0, 0.0), ROUNDING));
    assert_eq!(messages(&app), [""; 0]);
}

#[test]
fn the_cape_hangs_on_its_skeleton_with_the_artists_pins_and_play() {
    let mut app = app(&assets());
    let cape = spawn(&mut app, "cloths/cape.gltf", "CapeCloth.Wool");
    run(&mut app, 90);
    assert_eq!(messages(&app), [""; 0]);
    let chest = find(&mut app, "Chest").expect("a node");
    let world = app.world();
    let collider = world.get::<ClothCollider>(chest).expect("a collider");
    assert!(collider.shape.as_capsule().is_some_and(|it| it.radius == 0.15));
    let skin = world.get::<crate::ClothSkin>(cape).expect("a skin");
    assert_eq!(skin.joints[1], chest);
    assert_eq!(world.get::<ClothMaterial>(cape).expect("a cloth").0.area_density, 0.3);
    let mesh = world.get::<ClothMesh>(cape).expect("a cloth");
    let play = &world.get::<SkinLimits>(cape).expect("limits").max_distance;
    let ByVertex::Each(play) = play else { panic!("{play:?}") };
    let state = world.get::<ClothState>(cape).expect("it is simulated");
    let rest = rest(&app, cape);
    let mut farthest: f32 = 0.0;
    for vertex in 0..13 * 17 {
        let is_pinned = vertex < 13;
        let v = (vertex / 13) as f32 / 16.0;
        assert_eq!(mesh.weights()[vertex] == 0.0, is_pinned, "vertex {vertex}");
        assert!((play[vertex] - (0.01 + 0.49 * v)).abs() < ROUNDING, "{}", play[vertex]);
        let at = state.vertex_position(vertex as u32).expect("a vertex");
        let moved = at.distance(rest[vertex]);
        farthest = farthest.max(moved);
        let most = CURVE + if is_pinned { 0.0 } else { play[vertex] };
        assert!(moved < most, "vertex {vertex}: {moved} m of {most} m");
    }
    assert!(farthest > 0.01, "the hem falls, not only by {farthest} m");
    let shown = app.world().get::<Mesh3d>(cape).expect("it is shown");
    let meshes = app.world().resource::<bevy_asset::Assets<Mesh>>();
    assert!(meshes.get(&shown.0).is_some());
}

/// Places of a cape's upper edge by its joints' present poses.
fn collar(app: &App, cape: Entity) -> Vec<Vec3> {
    let world = app.world();
    let skin = world.get::<crate::ClothSkin>(cape).expect("a skin");
    let matrices: Vec<Mat4> = skin
        .joints
        .iter()
        .zip(&skin.inverse_bind_poses)
        .map(|(&joint, bound)| {
            let pose = world.get::<GlobalTransform>(joint).expect("a node");
            pose.to_matrix() * *bound
        })
        .collect();
    let Some(ClothMesh::Grid { columns, width, .. }) = world.get::<ClothMesh>(cape) else {
        panic!("a grid")
    };
    let place = |column: u32| {
        let rest = Vec3::X * (width * column as f32 / (columns - 1) as f32);
        let vertex = column as usize;
        let both = skin.joint_indices[vertex].iter().zip(skin.joint_weights[vertex]);
        both.map(|(&joint, weight)| matrices[joint as usize].transform_point3(rest) * weight).sum()
    };
    (0..*columns).map(place).collect()
}

#[test]
fn the_figure_wears_the_cape_of_its_file() {
    /// Distance of the collar from its pose, m: rounding of the file and of the poses.
    const OFF: f32 = 1e-5;
    let mut app = app(&assets());
    let cape = spawn(&mut app, "cloths/caped_figure.gltf", "Cape");
    run(&mut app, 90);
    assert_eq!(messages(&app), [""; 0]);
    let mut colliders = app.world_mut().query::<(&ClothCollider, &GlobalTransform)>();
    assert_eq!(colliders.iter(app.world()).count(), 11);
    let worn = |app: &App| -> Vec<Vec3> {
        let frame = app.world().get::<GlobalTransform>(cape).expect("a frame");
        let state = app.world().get::<ClothState>(cape).expect("it is simulated");
        state.positions().iter().map(|&at| frame.transform_point(at)).collect()
    };
    let off = |app: &App| {
        let pairs = collar(app, cape).into_iter().zip(worn(app));
        pairs.map(|(place, at)| place.distance(at)).fold(0.0, f32::max)
    };
    assert!(off(&app) < OFF, "{} m", off(&app));
    // The hem hangs behind the calves.
    let hem = worn(&app)[24 * 25 + 12];
    assert!(hem.z > 0.05 && (0.2..0.7).contains(&hem.y), "{hem}");
    // It bows, and the limits of the cape's hem turn with the chest: backwards and up.
    let chest = find(&mut app, "Chest").expect("a node");
    let bow = Quat::from_rotation_x(-0.4);
    app.world_mut().get_mut::<Transform>(chest).expect("a node").rotation = bow;
    run(&mut app, 120);
    assert!(off(&app) < OFF, "{} m", off(&app));
    let bowed = worn(&app)[24 * 25 + 12];
    assert!(bowed.z > hem.z + 0.1 && bowed.y > hem.y, "{hem} {bowed}");
    assert_eq!(messages(&app), [""; 0]);
}
