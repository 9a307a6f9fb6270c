//! Tests that cloth follows a skeleton: pins exactly, free particles within their limits.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothBatches, bunting_solver::LaneCount};
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Quat, Vec3};
use bevy_time::{Fixed, Time, Virtual};
use bevy_transform::TransformSystems;
use bevy_transform::prelude::*;
use bunting_tests::{
    Bits, Seen, TICK, app, assert_finite, bits, greatest, greatest_speed, run, spawn_flag, state,
};

/// Particles along an edge of the cape, which is a metre wide and high.
const COUNT: usize = 17;

/// Error of a place by rounding, m.
const TOLERANCE: f32 = 1e-5;

/// The shoulders of the cape's wearer, and where they are when the cape is bound.
const BOUND: [Vec3; 2] = [Vec3::ZERO, Vec3::X];

/// A joint, and its way in the frame of the hips: position, turn about x.
#[derive(Component)]
struct Joint(fn(f32) -> (Vec3, f32));

fn animate(mut joints: Query<(&Joint, &mut Transform)>, time: Res<Time>) {
    for (joint, mut transform) in &mut joints {
        let (at, turn) = (joint.0)(time.elapsed_secs());
        *transform = Transform::from_translation(at).with_rotation(Quat::from_rotation_x(turn));
    }
}

fn left(_: f32) -> (Vec3, f32) {
    (Vec3::ZERO, 0.0)
}

fn right(_: f32) -> (Vec3, f32) {
    (Vec3::X, 0.0)
}

fn shrugs(time: f32) -> (Vec3, f32) {
    (
        Vec3::new(1.0 - 0.1 * (4.0 * time).sin().abs(), 0.1 * (6.0 * time).sin(), 0.0),
        0.3 * time.sin(),
    )
}

/// A wearer with a cape.
struct Wearer {
    hips: Entity,
    joints: [Entity; 2],
    cape: Entity,
}

fn weight(vertex: usize) -> f32 {
    (vertex % COUNT) as f32 / (COUNT - 1) as f32
}

fn rest(vertex: usize) -> Vec3 {
    let step = 1.0 / (COUNT - 1) as f32;
    Vec3::new((vertex % COUNT) as f32 * step, (vertex / COUNT) as f32 * -step, 0.0)
}

/// The skin of a cape between two joints.
fn skin(joints: [Entity; 2]) -> ClothSkin {
    let poses = BOUND.map(|at| Mat4::from_translation(-at));
    let vertices = (0..COUNT * COUNT).map(|vertex| {
        let part = weight(vertex);
        ([0, 1, 0, 0], [1.0 - part, part, 0.0, 0.0])
    });
    ClothSkin::new(joints.into_iter().zip(poses)).with_vertices(vertices)
}

/// Spawns a wearer whose hips are at a place.
fn wearer(app: &mut App, at: Vec3, ways: [fn(f32) -> (Vec3, f32); 2]) -> Wearer {
    let world = app.world_mut();
    let hips = world.spawn(Transform::from_translation(at)).id();
    let joints = ways.map(|way| {
        let (at, turn) = way(0.0);
        let pose = Transform::from_translation(at).with_rotation(Quat::from_rotation_x(turn));
        world.spawn((Joint(way), pose, ChildOf(hips))).id()
    });
    let cape = world
        .spawn((
            ClothMesh::grid(COUNT as u32, COUNT as u32, 1.0, 1.0),
            Attachment::new(hips, ClothEdge::Top),
            LodSet { pinned: Some(0), ..LodSet::default() },
            skin(joints),
        ))
        .id();
    Wearer { hips, joints, cape }
}

/// Places of the vertices in the hips' frame by the joints' present transforms, m: linear blend skinning.
fn places(app: &App, wearer: &Wearer) -> Vec<Vec3> {
    let [a, b] = wearer.joints.map(|joint| *app.world().get::<Transform>(joint).expect("a joint"));
    let place = |vertex: usize| {
        let (part, rest) = (weight(vertex), rest(vertex));
        a.transform_point(rest - BOUND[0]) * (1.0 - part)
            + b.transform_point(rest - BOUND[1]) * part
    };
    (0..COUNT * COUNT).map(place).collect()
}

/// Greatest distance of the first `count` vertices from their places, m.
fn apart(positions: &[Vec3], places: &[Vec3], count: usize) -> f32 {
    assert_eq!(positions.len(), places.len());
    let pairs = positions.iter().zip(places).take(count);
    greatest(pairs.map(|(position, place)| position.distance(*place)))
}

fn in_ticks() -> App {
    let mut app = app();
    app.add_systems(FixedUpdate, animate);
    app
}

#[test]
fn pins_are_on_their_joints_in_every_tick() {
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
    run(&mut app, 2);
    for _ in 0..120 {
        run(&mut app, 1);
        let places = places(&app, &wearer);
        let error = apart(state(&app, wearer.cape).positions(), &places, COUNT);
        assert!(error < TOLERANCE, "{error} m");
    }
    let free = apart(state(&app, wearer.cape).positions(), &places(&app, &wearer), COUNT * COUNT);
    assert!(free > 0.05, "the rest of the cape swings: {free} m");
    assert!(greatest_speed(&app, wearer.cape) < 10.0);
}

#[test]
fn shown_pins_are_on_the_shown_joints() {
    // Frames of another length than ticks, in which the joints are moved as late as animation moves them.
    for in_update in [false, true] {
        let mut app = bunting_tests::app_at(std::time::Duration::from_micros(11_000));
        if in_update {
            app.add_systems(Update, animate);
        } else {
            app.add_systems(
                PostUpdate,
                animate.in_set(bevy_app::AnimationSystems).before(TransformSystems::Propagate),
            );
        }
        let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
        app.world_mut().entity_mut(wearer.cape).insert(ClothSurface::default());
        run(&mut app, 10);
        let mut late = 0.0_f32;
        for _ in 0..200 {
            run(&mut app, 1);
            let places = places(&app, &wearer);
            let surface = app.world().get::<ClothSurface>(wearer.cape).expect("a surface");
            let error = apart(&surface.positions, &places, COUNT);
            assert!(error < TOLERANCE, "{error} m, in update: {in_update}");
            late = late.max(apart(state(&app, wearer.cape).positions(), &places, COUNT));
        }
        assert!(late > 1e-3, "the state of ticks is older: {late} m");
    }
}

#[test]
fn pins_are_carried_through_the_substeps() {
    // A cape whose joints move as one swings as one whose hips move.
    fn way(time: f32) -> Vec3 {
        Vec3::new(0.0, 0.0, 0.1 - 0.1 * (6.0 * time).cos())
    }
    fn sways_left(time: f32) -> (Vec3, f32) {
        (way(time), 0.0)
    }
    fn sways_right(time: f32) -> (Vec3, f32) {
        (Vec3::X + way(time), 0.0)
    }
    fn sway(mut hips: Query<&mut Transform, With<Hips>>, time: Res<Time>) {
        hips.iter_mut().for_each(|mut hips| hips.translation = way(time.elapsed_secs()));
    }
    #[derive(Component)]
    struct Hips;
    let mut app = in_ticks();
    app.add_systems(FixedUpdate, sway);
    // Few ticks and equal substeps: the cape folds, which makes much of little.
    app.world_mut().resource_mut::<ClothSettings>().steps = vec![StepSettings::yarns(4).into()];
    let by_joints = wearer(&mut app, Vec3::ZERO, [sways_left, sways_right]);
    let by_hips = wearer(&mut app, Vec3::ZERO, [left, right]);
    app.world_mut().entity_mut(by_hips.hips).insert(Hips);
    // Without a lower corner, the cape would be free to turn about its pins, and the spurious part of that turn is
    // removed where pins are at rest only.
    let held: Vec<u32> = (0..COUNT).chain([COUNT * (COUNT - 1)]).map(|it| it as u32).collect();
    // Damping is relative to the frame.
    let undamped = FabricMaterial { damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };
    for wearer in [&by_joints, &by_hips] {
        let held = Attachment::new(wearer.hips, AttachedVertices::List(held.clone()));
        app.world_mut().entity_mut(wearer.cape).insert((held, ClothMaterial(undamped)));
    }
    run(&mut app, 16);
    let offset = way(app.world().resource::<Time<Fixed>>().elapsed_secs());
    let shifted: Vec<Vec3> =
        state(&app, by_hips.cape).positions().iter().map(|at| *at + offset).collect();
    let error = apart(state(&app, by_joints.cape).positions(), &shifted, COUNT * COUNT);
    assert!(error < 1e-3, "{error} m");
}

#[test]
fn cloth_begins_on_the_pose() {
    fn lifted(_: f32) -> (Vec3, f32) {
        (Vec3::new(0.0, 3.0, 1.0), 1.2)
    }
    fn lifted_right(_: f32) -> (Vec3, f32) {
        (Vec3::new(1.0, 3.0, 1.0), 1.2)
    }
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [lifted, lifted_right]);
    run(&mut app, 2);
    let error = apart(state(&app, wearer.cape).positions(), &places(&app, &wearer), COUNT * COUNT);
    assert!(error < 0.02, "{error} m after a tick");
}

fn storm() -> WindField {
    WindField::steady(Vec3::new(3.0, 2.0, 12.0))
}

/// Asserts that the free vertices of a finest cape are within a distance of their places, and some near it.
fn assert_within(app: &App, wearer: &Wearer, limit: f32) {
    let farthest = apart(state(app, wearer.cape).positions(), &places(app, wearer), COUNT * COUNT);
    assert!((0.9 * limit..limit + TOLERANCE).contains(&farthest), "{farthest} m of {limit} m");
}

#[test]
fn no_particle_leaves_its_greatest_distance() {
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
    app.world_mut().spawn(storm());
    let cape = app.world_mut().entity_mut(wearer.cape).id();
    let limits = |max: f32| SkinLimits { max_distance: max.into(), ..SkinLimits::default() };
    app.world_mut().entity_mut(cape).insert(limits(0.2));
    run(&mut app, 40);
    for _ in 0..60 {
        run(&mut app, 1);
        assert_within(&app, &wearer, 0.2);
    }
    app.world_mut().entity_mut(cape).insert(limits(0.05));
    run(&mut app, 20);
    assert_within(&app, &wearer, 0.05);
    app.world_mut().entity_mut(cape).remove::<SkinLimits>();
    run(&mut app, 60);
    let free = apart(state(&app, cape).positions(), &places(&app, &wearer), COUNT * COUNT);
    assert!(free > 0.5, "the cape blows: {free} m");
}

#[test]
fn no_particle_enters_its_backstop() {
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
    // The wind blows the cape backwards, against its normals.
    app.world_mut().spawn(WindField::steady(Vec3::new(0.0, 0.0, -12.0)));
    let limits = SkinLimits {
        backstop_distance: 0.02.into(),
        backstop_radius: 0.5.into(),
        ..SkinLimits::default()
    };
    app.world_mut().entity_mut(wearer.cape).insert(limits);
    run(&mut app, 40);
    let mut deepest = f32::INFINITY;
    for _ in 0..60 {
        run(&mut app, 1);
        let [a, b] =
            wearer.joints.map(|joint| *app.world().get::<Transform>(joint).expect("a joint"));
        let positions = state(&app, wearer.cape).positions().iter().enumerate();
        for ((vertex, position), place) in positions.zip(places(&app, &wearer)).skip(COUNT) {
            let part = weight(vertex);
            let normal = (a.rotation * Vec3::Z) * (1.0 - part) + (b.rotation * Vec3::Z) * part;
            let centre = place - normal.normalize() * 0.52;
            deepest = deepest.min(position.distance(centre));
        }
    }
    assert!((0.5 - TOLERANCE..0.501).contains(&deepest), "{deepest} m");
}

#[test]
fn the_shown_surface_is_blended_with_the_pose() {
    let mut app = in_ticks();
    let [whole, half] = [1.0, 0.5].map(|simulated: f32| {
        let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
        let limits = SkinLimits { simulated: simulated.into(), ..SkinLimits::default() };
        app.world_mut().entity_mut(wearer.cape).insert(limits);
        wearer
    });
    for wearer in [&whole, &half] {
        app.world_mut().entity_mut(wearer.cape).insert(bevy_bunting::ClothSeed(1));
    }
    run(&mut app, 60);
    let simulated = state(&app, whole.cape).positions();
    let expected: Vec<Vec3> =
        places(&app, &whole).iter().zip(simulated).map(|(place, at)| place.midpoint(*at)).collect();
    let error = apart(state(&app, half.cape).positions(), &expected, COUNT * COUNT);
    assert!(error < TOLERANCE, "{error} m");
}

#[test]
fn a_snap_of_the_pose_carries_the_cloth_along() {
    fn jumps(time: f32) -> Vec3 {
        if time > 1.0 { Vec3::new(0.0, 0.8, 0.5) } else { Vec3::ZERO }
    }
    fn jumps_left(time: f32) -> (Vec3, f32) {
        (jumps(time), 0.0)
    }
    fn jumps_right(time: f32) -> (Vec3, f32) {
        (Vec3::X + jumps(time), 0.0)
    }
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [jumps_left, jumps_right]);
    run(&mut app, 62);
    let before = apart(state(&app, wearer.cape).positions(), &places(&app, &wearer), COUNT * COUNT);
    for _ in 0..30 {
        run(&mut app, 1);
        let at = state(&app, wearer.cape).positions();
        let now = apart(at, &places(&app, &wearer), COUNT * COUNT);
        assert!((now - before).abs() < 0.01, "{now} m, {before} m before");
        assert!(greatest_speed(&app, wearer.cape) < 1.0, "no jump is shown");
    }
}

#[test]
fn a_reset_puts_the_cloth_on_the_pose() {
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
    app.world_mut().spawn(storm());
    run(&mut app, 60);
    let far = apart(state(&app, wearer.cape).positions(), &places(&app, &wearer), COUNT * COUNT);
    app.world_mut().trigger(TeleportCloth { entity: wearer.cape, mode: TeleportMode::Reset });
    run(&mut app, 1);
    let near = apart(state(&app, wearer.cape).positions(), &places(&app, &wearer), COUNT * COUNT);
    // The storm has blown for a tick.
    assert!(far > 1.0 && near < 0.15, "{far} m, then {near} m");
}

#[test]
fn coarser_levels_have_the_places_of_their_vertices() {
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
    app.world_mut().spawn(storm());
    let lods = |level| LodSet { pinned: Some(level), ..LodSet::automatic(3) };
    let limits = SkinLimits { max_distance: 0.2.into(), ..SkinLimits::default() };
    app.world_mut().entity_mut(wearer.cape).insert((lods(0), limits));
    run(&mut app, 30);
    for level in [2, 1, 0, 2, 0] {
        app.world_mut().entity_mut(wearer.cape).insert(lods(level));
        for tick in 0..20 {
            run(&mut app, 1);
            let places = places(&app, &wearer);
            let state = state(&app, wearer.cape);
            if tick > 0 {
                let count = (COUNT - 1) / (1 << level) + 1;
                assert_eq!(state.positions().len(), count * count);
            }
            for (vertex, place) in places.iter().enumerate() {
                let Some(particle) = state.particle_of_vertex(vertex as u32) else { continue };
                let away = state.positions()[particle].distance(*place);
                let limit = if vertex < COUNT { 0.0 } else { 0.2 };
                assert!(away < limit + TOLERANCE, "{away} m at level {level}, vertex {vertex}");
            }
        }
    }
}

#[test]
fn cloth_sleeps_on_a_resting_skeleton_and_wakes_with_it() {
    fn nods_late(time: f32) -> (Vec3, f32) {
        (Vec3::new(1.0, if time > 20.0 { 0.05 * (time - 20.0) } else { 0.0 }, 0.0), 0.0)
    }
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [left, nods_late]);
    run(&mut app, (19.0 / TICK) as usize);
    assert_eq!(state(&app, wearer.cape).activity(), ClothActivity::AtRest);
    run(&mut app, (2.0 / TICK) as usize);
    assert_eq!(state(&app, wearer.cape).activity(), ClothActivity::Ticking);
    let error = apart(state(&app, wearer.cape).positions(), &places(&app, &wearer), COUNT);
    assert!(error < TOLERANCE, "{error} m");
}

/// Moves the joints of a wearer at once.
type Snap = fn(&mut App, &Wearer);

#[test]
fn cloth_asleep_is_carried_by_a_skeleton_that_snaps() {
    /// How far both joints snap, m.
    const SNAP: Vec3 = Vec3::new(0.0, 0.5, 0.0);
    /// Greatest distance by which the woken cloth has moved by itself, m.
    const BY_ITSELF: f32 = 2e-3;
    fn move_joints(app: &mut App, wearer: &Wearer) {
        for joint in wearer.joints {
            app.world_mut().get_mut::<Transform>(joint).expect("a joint").translation += SNAP;
        }
    }
    let snaps: [(&str, Snap); 2] = [
        ("while time passes", move_joints),
        ("in a pause", |app, wearer| {
            app.world_mut().resource_mut::<Time<Virtual>>().pause();
            run(app, 3);
            move_joints(app, wearer);
            run(app, 3);
            app.world_mut().resource_mut::<Time<Virtual>>().unpause();
        }),
    ];
    for (name, snap) in snaps {
        let mut app = app();
        let wearer = wearer(&mut app, Vec3::Y, [left, right]);
        run(&mut app, (19.0 / TICK) as usize);
        let asleep = state(&app, wearer.cape);
        assert_eq!(asleep.activity(), ClothActivity::AtRest, "{name}");
        let before = asleep.positions().to_vec();
        snap(&mut app, &wearer);
        run(&mut app, 4);
        let woken = state(&app, wearer.cape);
        assert_eq!(woken.activity(), ClothActivity::Ticking, "{name}");
        let error = apart(woken.positions(), &places(&app, &wearer), COUNT);
        assert!(error < TOLERANCE, "{error} m, {name}");
        let carried: Vec<Vec3> = before.iter().map(|at| *at + SNAP).collect();
        let moved = apart(woken.positions(), &carried, COUNT * COUNT);
        assert!(moved < BY_ITSELF, "{moved} m, {name}");
    }
}

/// Bits of a cape with limits, and of a flag beside it, after a second.
fn simulated(lanes: Option<LaneCount>, edit: impl Fn(&mut App, &Wearer)) -> [Bits; 2] {
    let mut app = in_ticks();
    app.world_mut().resource_mut::<ClothSettings>().lanes = lanes;
    let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
    app.world_mut().spawn(storm());
    let limits = SkinLimits {
        max_distance: ByVertex::AlongV { top: 0.0, bottom: 0.3 },
        backstop_radius: 0.5.into(),
        backstop_distance: 0.02.into(),
        ..SkinLimits::default()
    };
    app.world_mut().entity_mut(wearer.cape).insert(limits);
    let flag = spawn_flag(&mut app, Vec3::new(5.0, 0.0, 0.0));
    run(&mut app, 32);
    edit(&mut app, &wearer);
    run(&mut app, 32);
    assert!(app.world().resource::<ClothBatches>().batch_count() > 0);
    [bits(&app, wearer.cape), bits(&app, flag)]
}

#[test]
fn every_width_gives_the_same_bits() {
    let [cape, _] = simulated(Some(LaneCount::One), |_, _| {});
    for &lanes in LaneCount::available() {
        assert_eq!(simulated(Some(lanes), |_, _| {})[0], cape, "{lanes:?}");
    }
}

/// Makes a skin invalid.
type Spoil = fn(&mut ClothSkin);

#[test]
fn a_bad_skin_is_reported_and_no_other_cloth_is_touched() {
    let [cape, flag] = simulated(None, |_, _| {});
    let later = simulated(None, |app, _| run(app, 121));
    let spoil: [(Spoil, SkinError); 4] = [
        (
            |skin| {
                skin.joints.pop();
                skin.inverse_bind_poses.pop();
            },
            SkinError::Joint { vertex: 1, joint: 1, joints: 1 },
        ),
        (
            |skin| {
                skin.joint_weights.pop();
            },
            SkinError::Count { given: COUNT * COUNT - 1, vertices: COUNT * COUNT },
        ),
        (|skin| skin.joint_weights[3] = [0.0; 4], SkinError::Weights { vertex: 3 }),
        (|skin| skin.inverse_bind_poses[1].x_axis.x = f32::NAN, SkinError::BindPose { joint: 1 }),
    ];
    for (spoil, error) in spoil {
        let bits = simulated(None, |app, wearer| {
            let mut skin = skin(wearer.joints);
            spoil(&mut skin);
            app.world_mut().entity_mut(wearer.cape).insert(skin);
            run(app, 1);
            let seen = &app.world().resource::<Seen<ClothFailed>>().0;
            let [ClothFailed { entity, error: ClothError::Skin { source, .. } }] = seen[..] else {
                panic!("{seen:?}")
            };
            assert_eq!((entity, source), (wearer.cape, error));
            run(app, 120);
        });
        assert_eq!(bits, later, "the cape follows its last valid skin, and the flag is as it was");
    }
    let bare = simulated(None, |app, wearer| {
        app.world_mut().entity_mut(wearer.cape).remove::<ClothSkin>();
        run(app, 121);
        let edge = state(app, wearer.cape).positions()[COUNT - 1];
        assert!(edge.distance(Vec3::X) < TOLERANCE, "the pins return to rest: {edge}");
    });
    assert_ne!(bare[0], later[0]);
    let limits = simulated(None, |app, wearer| {
        let limits = SkinLimits { max_distance: (-1.0).into(), ..SkinLimits::default() };
        app.world_mut().entity_mut(wearer.cape).insert(limits);
    });
    assert_eq!(limits, [cape, flag], "the last valid limits hold");
}

#[test]
fn a_despawned_joint_stays_where_it_was() {
    let [cape, flag] = simulated(None, |_, _| {});
    let bits = simulated(None, |app, wearer| {
        let before = places(app, wearer)[COUNT - 1];
        let joint = wearer.joints[1];
        app.world_mut().entity_mut(joint).despawn();
        run(app, 1);
        let seen = &app.world().resource::<Seen<ClothFailed>>().0;
        let [ClothFailed { entity, error: ClothError::MissingJoint { joint: missing, .. } }] =
            seen[..]
        else {
            panic!("{seen:?}")
        };
        assert_eq!((entity, missing), (wearer.cape, joint));
        let pin = state(app, wearer.cape).positions()[COUNT - 1];
        assert!(pin.distance(before) < TOLERANCE, "{pin} for {before}");
    });
    assert_ne!(bits[0], cape);
    let same_ticks = simulated(None, |app, _| run(app, 1));
    assert_eq!(bits[1], same_ticks[1], "the flag is as it was");
    assert_ne!(bits[1], flag);
}

#[test]
fn cloth_without_a_skin_again_hangs_from_its_frame() {
    let mut app = in_ticks();
    let wearer = wearer(&mut app, Vec3::Y, [left, shrugs]);
    run(&mut app, 30);
    app.world_mut().entity_mut(wearer.cape).remove::<ClothSkin>();
    run(&mut app, 120);
    assert_finite(&app, wearer.cape);
    let edge = state(&app, wearer.cape).positions()[COUNT - 1];
    assert!(edge.distance(Vec3::X) < TOLERANCE, "{edge}");
    app.world_mut().entity_mut(wearer.cape).insert(skin(wearer.joints));
    run(&mut app, 120);
    let error = apart(state(&app, wearer.cape).positions(), &places(&app, &wearer), COUNT);
    assert!(error < TOLERANCE, "{error} m");
}
