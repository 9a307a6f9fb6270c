//! Tests of cloths that are simulated while their components become invalid: they go on with the last valid ones.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, assert_finite, bits, run, spawn_flag, state};

fn errors(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

/// Inserts a component that is invalid into one of two equal cloths, which goes on like the other, bit for bit. Then inserts a
/// valid one, which is taken: the cloths differ.
fn goes_on<T: Component + Clone>(bad: T, good: T, is_it: impl Fn(&ClothError) -> bool) {
    let mut app = app();
    let (cloth, other) = (spawn_flag(&mut app, Vec3::ZERO), spawn_flag(&mut app, Vec3::ZERO));
    run(&mut app, 20);
    app.world_mut().entity_mut(cloth).insert(bad.clone());
    run(&mut app, 20);
    assert_eq!(bits(&app, cloth), bits(&app, other));
    let errors_now = errors(&app);
    assert!(errors_now.len() == 1 && is_it(&errors_now[0]), "{errors_now:?}");
    assert!(errors_now[0].to_string().contains(&cloth.to_string()), "it names the cloth");
    assert_eq!(state(&app, cloth).activity(), ClothActivity::Ticking);
    // Whoever writes it again in every tick is told once.
    for _ in 0..5 {
        app.world_mut().entity_mut(cloth).insert(bad.clone());
        run(&mut app, 1);
    }
    assert_eq!(errors(&app).len(), 1);
    app.world_mut().entity_mut(cloth).insert(good);
    run(&mut app, 20);
    assert_eq!(errors(&app).len(), 1);
    assert_ne!(bits(&app, cloth), bits(&app, other), "the valid one is taken");
    assert_finite(&app, cloth);
    // And what is invalid again is told again.
    app.world_mut().entity_mut(cloth).insert(bad);
    run(&mut app, 5);
    assert_eq!(errors(&app).len(), 2);
    assert_finite(&app, cloth);
}

#[test]
fn levels() {
    let coarse = || LodSet::new([5.0, 10.0]).pinned_to(1);
    goes_on(LodSet::new([5.0, 4.0]), coarse(), |it| matches!(it, ClothError::Levels { .. }));
    let far = LodSet::new([5.0]).pinned_to(7);
    goes_on(far, coarse(), |it| matches!(it, ClothError::PinnedLevel { level: 7, .. }));
}

#[test]
fn attached_vertices() {
    let list = |vertices: &[u32]| Attachment::in_place(AttachedVertices::List(vertices.to_vec()));
    goes_on(list(&[0, 9, 99_999]), list(&[0, 9]), |it| matches!(it, ClothError::Mesh { .. }));
    goes_on(list(&[]), list(&[0, 9]), |it| matches!(it, ClothError::NoVertices { .. }));
}

#[test]
fn meshes_and_weights() {
    let good = ClothMesh::grid(9, 9, 1.0, 1.0);
    let endless = ClothMesh::grid(5, 5, f32::INFINITY, 1.0);
    goes_on(endless, good.clone(), |it| matches!(it, ClothError::Mesh { .. }));
    let weighted = FLAG.with_weights(vec![2.0; 3]);
    goes_on(weighted, good, |it| matches!(it, ClothError::Weights { .. }));
}

#[test]
fn scales() {
    let scaled = |scale: f32| {
        let offset = Transform::from_scale(Vec3::splat(scale));
        Attachment::in_place(ClothEdge::Left).with_offset(offset)
    };
    let mut app = app();
    let pole = app.world_mut().spawn(Transform::default()).id();
    let on_pole = |scale: f32| Attachment { target: pole, ..scaled(scale) };
    let cloth = app.world_mut().spawn((FLAG, on_pole(1.0))).id();
    run(&mut app, 10);
    app.world_mut().entity_mut(cloth).insert(on_pole(0.0));
    run(&mut app, 10);
    assert_eq!(errors(&app), [ClothError::Scale { entity: cloth }]);
    assert_finite(&app, cloth);
    app.world_mut().entity_mut(cloth).insert(on_pole(2.0));
    run(&mut app, 10);
    let rest = state(&app, cloth).fabric().expect("it is simulated").rest_positions();
    assert!(rest.iter().any(|at| at.x > 2.0), "it has the new scale");
}

#[test]
fn a_cloth_that_is_given_to_a_target_that_is_not_there_yet_waits_where_it_hangs() {
    let mut app = app();
    let pole = app.world_mut().spawn(Transform::from_xyz(1.0, 2.0, 0.0)).id();
    let cloth = app.world_mut().spawn((FLAG, Attachment::new(pole, ClothEdge::Left))).id();
    run(&mut app, 30);
    let other = app.world_mut().spawn_empty().id();
    app.world_mut().entity_mut(cloth).insert(Attachment::new(other, ClothEdge::Left));
    run(&mut app, 30);
    let missing = ClothError::MissingTarget { entity: cloth, target: other };
    assert_eq!(errors(&app), [missing]);
    assert_eq!(state(&app, cloth).activity(), ClothActivity::Ticking);
    assert_finite(&app, cloth);
    let place = |app: &App| app.world().get::<Transform>(cloth).expect("a cloth").translation;
    assert_eq!(place(&app), Vec3::new(1.0, 2.0, 0.0));
    app.world_mut().entity_mut(other).insert(Transform::from_xyz(3.0, 2.0, 0.0));
    run(&mut app, 10);
    assert_eq!(place(&app), Vec3::new(3.0, 2.0, 0.0));
    assert_eq!(errors(&app).len(), 1);
    assert_finite(&app, cloth);
}

#[test]
fn an_attachment_that_is_removed_while_it_is_invalid_lets_the_cloth_fall() {
    let mut app = app();
    let cloth = spawn_flag(&mut app, Vec3::ZERO);
    run(&mut app, 10);
    let none = Attachment::in_place(AttachedVertices::List(Vec::new()));
    app.world_mut().entity_mut(cloth).insert(none);
    run(&mut app, 10);
    assert_eq!(errors(&app).len(), 1);
    app.world_mut().entity_mut(cloth).remove::<Attachment>();
    run(&mut app, 60);
    assert!(state(&app, cloth).positions()[0].y < -1.0, "it falls");
}

/// A sheet whose vertices all follow one joint.
fn spawn_skinned(app: &mut App) -> (Entity, Entity, ClothSkin) {
    let joint = app.world_mut().spawn(Transform::default()).id();
    let vertices = (0..9 * 9).map(|_| ([0; 4], [1.0, 0.0, 0.0, 0.0]));
    let skin = ClothSkin::new([(joint, Mat4::IDENTITY)]).with_vertices(vertices);
    let sheet = ClothMesh::grid(9, 9, 1.0, 1.0);
    let limits = SkinLimits { max_distance: 0.1.into(), ..SkinLimits::default() };
    let lods = LodSet::new([5.0]).pinned_to(0);
    let held = Attachment::in_place(ClothEdge::Top);
    (app.world_mut().spawn((sheet, held, skin.clone(), limits, lods)).id(), joint, skin)
}

#[test]
fn skins_and_their_limits() {
    let mut app = app();
    let (cloth, joint, skin) = spawn_skinned(&mut app);
    // Gusts keep it awake.
    app.world_mut().spawn(WindField::steady(Vec3::Z).with_gusts(0.5, 0.5, 3));
    run(&mut app, 10);
    let is_near = |app: &App, x: f32| {
        let at = |at: &Vec3| (at.x - x).abs() < 1.5 && at.is_finite();
        state(app, cloth).positions().iter().all(at)
    };
    let move_to = |app: &mut App, x: f32| {
        app.world_mut().get_mut::<Transform>(joint).expect("a joint").translation.x = x;
        run(app, 60);
    };
    let mut bad = skin.clone();
    bad.joint_indices[40] = [7; 4];
    app.world_mut().entity_mut(cloth).insert(bad);
    move_to(&mut app, 3.0);
    assert!(is_near(&app, 3.0), "it follows the joint");
    // A change of level does not read the invalid skin.
    app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(1);
    move_to(&mut app, 6.0);
    assert_eq!(state(&app, cloth).level(), 1);
    assert!(is_near(&app, 6.0), "{:?}", state(&app, cloth).positions());
    let joint_of = |it: &ClothError| match *it {
        ClothError::Skin { entity, source: SkinError::Joint { vertex, .. } } => (entity, vertex),
        _ => panic!("{it}"),
    };
    assert_eq!(errors(&app).iter().map(joint_of).collect::<Vec<_>>(), [(cloth, 40)]);
    app.world_mut().entity_mut(cloth).insert(skin);
    let far = SkinLimits { max_distance: (-1.0).into(), ..SkinLimits::default() };
    app.world_mut().entity_mut(cloth).insert(far);
    move_to(&mut app, 9.0);
    assert!(is_near(&app, 9.0), "it follows the joint within the last valid limits");
    assert_eq!(errors(&app).len(), 2);
}
