//! Tests of substeps by need.

use std::time::Duration;

use bevy_app::prelude::*;
use bevy_bunting::bunting_solver::{EffortCause, LaneCount};
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothBatches, ClothEffort, CostTable, LodCosts, LodReport};
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::{Fixed, Time};
use bevy_transform::prelude::*;
use bunting_tests::{Bits, TICK, app, assert_finite, bits, run, state, stretches};

/// Ticks after which a cloth that has become calm has got fewer substeps.
const A_WHILE: usize = 40;

fn spawn(app: &mut App, material: FabricMaterial, at: Vec3) -> Entity {
    let held = Attachment::in_place(ClothEdge::Left);
    let place = Transform::from_translation(at);
    let cloth = (ClothMesh::grid(33, 33, 1.0, 1.0), ClothMaterial(material), held, place);
    app.world_mut().spawn(cloth).id()
}

/// Silk, and cloth that no wind moves fast.
fn light_and_heavy() -> [FabricMaterial; 2] {
    let light = FabricMaterial { area_density: 0.03, ..FabricMaterial::FLAG_POLYESTER };
    [light, FabricMaterial { area_density: 30.0, ..light }]
}

fn effort(app: &App, cloth: Entity) -> &ClothEffort {
    app.world().get(cloth).expect("a cloth has an effort")
}

fn substeps(app: &App, cloth: Entity) -> u32 {
    effort(app, cloth).settings().substeps
}

#[test]
fn storms_are_solved_finer_as_long_as_they_last() {
    let [light, _] = light_and_heavy();
    let mut app = app();
    let wind = app.world_mut().spawn(WindField::steady(Vec3::new(25.0, 0.0, 3.0))).id();
    let cloth = spawn(&mut app, light, Vec3::ZERO);
    run(&mut app, 4);
    assert_eq!(substeps(&app, cloth), 8);
    assert_eq!(effort(&app, cloth).cause(), EffortCause::Air);
    let class = effort(&app, cloth).class().index();
    assert_eq!(app.world().resource::<LodReport>().efforts[class], 1);
    for _ in 0..100 {
        run(&mut app, 1);
        assert!(stretches(&app, cloth).all(|stretch| stretch < 1.5));
    }
    app.world_mut().get_mut::<WindField>(wind).expect("a wind").velocity = Vec3::ZERO;
    run(&mut app, 5 * A_WHILE);
    assert_finite(&app, cloth);
    assert_eq!(substeps(&app, cloth), 2);
    assert_eq!(effort(&app, cloth).cause(), EffortCause::Weight);
}

#[test]
fn only_the_cloth_that_needs_more_pays() {
    let [light, heavy] = light_and_heavy();
    let fly = |both: bool| {
        let mut app = app();
        app.world_mut().spawn(WindField::steady(Vec3::new(25.0, 0.0, 3.0)));
        let calm = spawn(&mut app, heavy, Vec3::ZERO);
        let stormy = both.then(|| spawn(&mut app, light, Vec3::Y * 3.0));
        run(&mut app, 60);
        assert_eq!(substeps(&app, calm), 2);
        assert!(stormy.is_none_or(|cloth| substeps(&app, cloth) >= 8));
        bits(&app, calm)
    };
    assert_eq!(fly(true), fly(false));
}

/// Five heavy flags and three of silk in one order or the other after a second, the heavy ones first: each with its bits, the
/// substeps that it needs and those that it takes, and the number of batches.
fn heavy_and_silk(
    settings: impl Fn(&mut ClothSettings),
    turned: bool,
) -> (Vec<(Bits, u32, u32)>, usize) {
    let [light, heavy] = light_and_heavy();
    let mut app = app();
    settings(&mut app.world_mut().resource_mut::<ClothSettings>());
    app.world_mut().spawn(WindField::steady(Vec3::new(10.0, 0.0, 1.0)));
    let mut order: Vec<usize> = (0..8).collect();
    if turned {
        order.reverse();
    }
    let mut flag = |index: usize| {
        let material = if index < 5 { heavy } else { light };
        (index, spawn(&mut app, material, Vec3::Y * 3.0 * index as f32))
    };
    let mut flags: Vec<(usize, Entity)> = order.into_iter().map(&mut flag).collect();
    flags.sort_unstable();
    run(&mut app, 60);
    let of = |&(_, flag): &(usize, Entity)| {
        let needed = effort(&app, flag).needed().substeps;
        (bits(&app, flag), needed, substeps(&app, flag))
    };
    (flags.iter().map(of).collect(), app.world().resource::<ClothBatches>().batch_count())
}

#[test]
fn flags_that_need_different_substeps_share_a_batch() {
    let (shared, batches) = heavy_and_silk(|_| {}, false);
    let most = shared.iter().map(|it| it.1).max().expect("eight flags");
    assert!(shared[..5].iter().all(|it| it.1 == 2) && most > 2, "silk needs more");
    assert!(shared.iter().all(|it| it.2 == most));
    assert_eq!(batches, 1);
    // Neither the order in which they were spawned nor the width of the batches changes a bit.
    assert_eq!(heavy_and_silk(|_| {}, true), (shared.clone(), 1));
    let narrow = heavy_and_silk(|settings| settings.lanes = Some(LaneCount::One), false);
    assert_eq!(narrow, (shared, 8));
}

#[test]
fn cloths_that_share_no_batch_take_what_they_need() {
    let (apart, batches) = heavy_and_silk(|settings| settings.share_batches = false, false);
    assert!(apart.iter().all(|it| it.1 == it.2));
    assert!(batches > 1);
    let [_, heavy] = light_and_heavy();
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(10.0, 0.0, 1.0)));
    let alone = spawn(&mut app, heavy, Vec3::ZERO);
    run(&mut app, 60);
    assert_eq!(bits(&app, alone), apart[0].0);
}

#[test]
fn limits_of_the_user_hold() {
    let [light, _] = light_and_heavy();
    let mut app = app();
    app.world_mut().resource_mut::<ClothSettings>().steps = vec![StepSettings::default().into()];
    app.world_mut().spawn(WindField::steady(Vec3::X * 25.0));
    let cloth = spawn(&mut app, light, Vec3::ZERO);
    run(&mut app, 60);
    assert!(effort(&app, cloth).class().index() > 0);
    assert_eq!(substeps(&app, cloth), 2);
}

#[test]
fn levels_become_coarser_where_a_storm_needs_more_substeps() {
    let [light, _] = light_and_heavy();
    let mut app = app();
    let budget = Duration::from_micros(1000);
    *app.world_mut().resource_mut::<ClothBudget>() = ClothBudget {
        tick: budget,
        costs: LodCosts::Fixed(CostTable::default()),
        ..ClothBudget::default()
    };
    app.world_mut().spawn((LodViewer::default(), Transform::from_xyz(0.0, 0.0, 6.0)));
    let wind = app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 1.0))).id();
    let cloths: Vec<Entity> = (0..20)
        .map(|index| {
            let cloth = spawn(&mut app, light, Vec3::X * (0.2 * index as f32 - 2.0));
            app.world_mut().entity_mut(cloth).insert(LodSet::automatic(4));
            cloth
        })
        .collect();
    let particles = |app: &App| -> usize {
        cloths.iter().map(|&cloth| state(app, cloth).positions().len()).sum()
    };
    run(&mut app, 4 * A_WHILE);
    let calm = particles(&app);
    app.world_mut().get_mut::<WindField>(wind).expect("a wind").velocity = Vec3::X * 25.0;
    let is_over = |app: &mut App| {
        run(app, 1);
        app.world().resource::<LodReport>().expected > budget
    };
    let over = (0..2 * A_WHILE).filter(|_| is_over(&mut app)).count();
    assert!(over <= 4, "{over} ticks over the budget");
    let report = app.world().resource::<LodReport>();
    assert!(report.expected <= budget, "{:?}", report.expected);
    assert_eq!(report.raised(), cloths.len());
    assert!(particles(&app) < calm, "{} particles after {calm}", particles(&app));
}

#[test]
fn cloth_that_is_drawn_out_is_solved_finer() {
    let mut app = app();
    let mast = app.world_mut().spawn(Transform::IDENTITY).id();
    let right = Anchor::new(mast, ClothEdge::Right);
    let held = Attachment::in_place(ClothEdge::Left).with_anchor(right);
    let cloth = app.world_mut().spawn((ClothMesh::grid(33, 33, 1.0, 1.0), held)).id();
    run(&mut app, A_WHILE);
    assert_eq!((effort(&app, cloth).cause(), substeps(&app, cloth)), (EffortCause::Weight, 2));

    let mut draw_out = |by: f32, ticks: usize| {
        let at = Transform::from_translation(Vec3::X * by);
        *app.world_mut().get_mut::<Transform>(mast).expect("a mast") = at;
        run(&mut app, ticks);
        (effort(&app, cloth).cause(), substeps(&app, cloth))
    };
    let (cause, substeps) = draw_out(0.05, A_WHILE);
    assert!(cause == EffortCause::Tension && substeps > 8, "{cause:?}, {substeps}");
    assert_eq!(draw_out(0.0, 4 * A_WHILE), (EffortCause::Weight, 2));
}

#[test]
fn cloth_that_is_pulled_against_a_shape_is_solved_finer() {
    /// Radius of the ball, m, and its way into the sheet.
    const RADIUS: f32 = 0.1;
    const WAY: f32 = 0.15;
    const TICKS: usize = 60;
    let mut app = app();
    let sheet = ClothMesh::grid(33, 33, 1.0, 1.0);
    let sides = AttachedVertices::list_where(&sheet, |uv| uv.x == 0.0 || uv.x == 1.0);
    let held = Attachment::in_place(sides);
    let material = ClothMaterial(FabricMaterial { damping: 4.0, ..FabricMaterial::COTTON });
    let cloth = app.world_mut().spawn((sheet, material, held)).id();
    run(&mut app, A_WHILE);
    assert_eq!(effort(&app, cloth).cause(), EffortCause::Weight);
    assert_eq!(substeps(&app, cloth), 2);

    let middle = state(&app, cloth).positions()[16 * 33 + 16];
    let behind = |way: f32| Transform::from_translation(middle - (RADIUS - way) * Vec3::Z);
    let ball = app.world_mut().spawn((ClothCollider::ball(RADIUS), behind(-0.01))).id();
    for tick in 0..TICKS {
        let part = tick as f32 / TICKS as f32;
        *app.world_mut().get_mut::<Transform>(ball).expect("a ball") = behind(part * WAY);
        run(&mut app, 1);
    }
    run(&mut app, 2 * A_WHILE);
    assert_eq!(effort(&app, cloth).cause(), EffortCause::Contacts);
    assert!(substeps(&app, cloth) >= 4, "{}", substeps(&app, cloth));
    let longest = stretches(&app, cloth).fold(0.0, f32::max);
    assert!(longest < 1.5, "{longest}");

    app.world_mut().despawn(ball);
    run(&mut app, 5 * A_WHILE);
    assert_eq!(effort(&app, cloth).cause(), EffortCause::Weight);
    assert_eq!(substeps(&app, cloth), 2);
}

/// A capsule of 5 cm walks at 0.7 m/s through a sheet that hangs from its upper edge. It touches some twenty of 1,089
/// particles, and its upper end draws them along.
#[test]
fn small_shapes_that_draw_cloth_along_are_solved_finer() {
    const RADIUS: f32 = 0.05;
    const HALF: f32 = 0.8;
    const SPEED: f32 = 0.7;
    let mut app = app();
    let held = Attachment::in_place(ClothEdge::Top);
    let place = Transform::from_xyz(-0.6, 2.0, 0.0);
    let sheet = (ClothMesh::grid(33, 33, 1.2, 2.0), ClothMaterial::COTTON, held, place);
    let cloth = app.world_mut().spawn(sheet).id();
    let at = |z: f32| Transform::from_xyz(0.0, HALF + RADIUS, z);
    let shape = ClothCollider { features: true, ..ClothCollider::capsule(HALF, RADIUS) };
    let capsule = app.world_mut().spawn((shape, at(-0.1))).id();
    run(&mut app, A_WHILE);
    let hung = substeps(&app, cloth);
    let mut longest = 0.0_f32;
    for tick in 0..160 {
        let z = -0.1 + SPEED * TICK * tick as f32;
        *app.world_mut().get_mut::<Transform>(capsule).expect("a capsule") = at(z);
        run(&mut app, 1);
        longest = stretches(&app, cloth).fold(longest, f32::max);
        // The cloth does not pass through.
        let middle = Vec3::new(0.6, HALF + RADIUS - 2.0, z);
        let depth = |at: &Vec3| {
            let axis = middle.with_y(at.y.clamp(middle.y - HALF, middle.y + HALF));
            RADIUS - axis.distance(*at)
        };
        let deepest = state(&app, cloth).positions().iter().map(depth).fold(0.0, f32::max);
        assert!(deepest < 0.01, "{deepest} m at {z} m");
    }
    assert_eq!(effort(&app, cloth).cause(), EffortCause::Contacts);
    assert!(substeps(&app, cloth) > hung, "{} after {hung}", substeps(&app, cloth));
    // With the mean over all particles 3 to 4.
    assert!(longest < 1.3, "{longest}");
}

/// A sheet that lies on a ball takes no more substeps than it would without.
#[test]
fn cloth_that_rests_on_a_large_shape_is_not_solved_finer() {
    let mut app = app();
    let lies = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    let place = Transform::from_xyz(-0.5, 0.31, -0.5).with_rotation(lies);
    let cloth = (ClothMesh::grid(33, 33, 1.0, 1.0), ClothMaterial::COTTON, place);
    let cloth = app.world_mut().spawn(cloth).id();
    app.world_mut().spawn((ClothCollider::ball(0.3), Transform::default()));
    run(&mut app, 8 * A_WHILE);
    assert_eq!(substeps(&app, cloth), 2, "{:?}", effort(&app, cloth).loads());
    let longest = stretches(&app, cloth).fold(0.0, f32::max);
    assert!(longest < 1.1, "{longest}");
}

/// Velocity of the pole, m/s.
#[derive(Resource)]
struct Speed(f32);

#[test]
fn a_jerk_is_solved_finer_in_the_same_tick() {
    let mut app = app();
    app.insert_resource(Speed(0.0)).add_systems(
        FixedUpdate,
        |speed: Res<Speed>,
         time: Res<Time<Fixed>>,
         mut poles: Query<&mut Transform, Without<ClothMesh>>| {
            for mut pole in &mut poles {
                pole.translation.x += speed.0 * time.delta_secs();
            }
        },
    );
    let pole = app.world_mut().spawn(Transform::default()).id();
    let held = Attachment { teleport_speed: 1000.0, ..Attachment::new(pole, ClothEdge::Left) };
    let cloth = app.world_mut().spawn((ClothMesh::grid(33, 33, 1.0, 1.0), held)).id();
    run(&mut app, 10);
    assert_eq!(substeps(&app, cloth), 2);
    app.world_mut().resource_mut::<Speed>().0 = 20.0;
    let before = app.world().get::<Transform>(pole).expect("a pole").translation.x;
    run(&mut app, 1);
    let moved = app.world().get::<Transform>(pole).expect("a pole").translation.x - before;
    assert!((moved / (20.0 * TICK) - 1.0).abs() < 1e-3, "{moved}");
    assert_eq!(effort(&app, cloth).cause(), EffortCause::Frame);
    assert!(substeps(&app, cloth) >= 12, "{}", substeps(&app, cloth));
    for _ in 0..30 {
        run(&mut app, 1);
        assert!(stretches(&app, cloth).all(|stretch| stretch < 1.5));
    }
    assert!(!state(&app, cloth).positions().is_empty());
}
