//! Cloths whose material differs in regions.

use bevy_app::prelude::*;
use bevy_bunting::bunting_solver::{Fabric, RegionError};
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, bits, run, spawn_flag, state};

/// A sheet of a square metre that is held at its top.
fn sheet() -> (ClothMesh, Attachment, Transform) {
    (ClothMesh::grid(17, 17, 1.0, 1.0), Attachment::in_place(ClothEdge::Top), Transform::default())
}

fn hem() -> MaterialRegion {
    MaterialRegion::uv_box(Vec2::new(0.0, 0.9), Vec2::ONE)
}

fn fabric(app: &App, cloth: Entity) -> &Fabric {
    state(app, cloth).fabric().expect("it is simulated")
}

fn errors(app: &App) -> Vec<ClothError> {
    app.world().resource::<Seen<ClothFailed>>().0.iter().map(|failed| failed.error).collect()
}

/// How far the free side of a sail that is held at its mast and by two corners is blown out of the line between these, m: the mean over
/// a second.
fn bulge(regions: ClothRegions) -> f32 {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(0.5, 0.0, 3.0)));
    let held =
        AttachedVertices::List((0..25).map(|row| row * 17).chain([16, 24 * 17 + 16]).collect());
    let sail = (ClothMesh::grid(17, 25, 0.6, 0.8), regions, Attachment::in_place(held));
    let nylon = FabricMaterial { bend_stiffness: 2e-5, ..FabricMaterial::NYLON };
    let sail = app.world_mut().spawn((sail, ClothMaterial(nylon))).id();
    run(&mut app, 200);
    let mut sum = 0.0;
    for _ in 0..60 {
        run(&mut app, 1);
        let at = state(&app, sail).positions();
        let side = (0..25).map(|row| at[row * 17 + 16].z.abs());
        sum += side.fold(0.0, f32::max) / 60.0;
    }
    assert!(errors(&app).is_empty());
    sum
}

#[test]
fn a_batten_holds_the_leech_of_a_sail_straighter() {
    let batten = MaterialRegion::uv_line(Vec2::X, Vec2::ONE, 0.05).bending(1e6);
    let (limp, battened) = (bulge(ClothRegions::default()), bulge(ClothRegions::new([batten])));
    assert!(battened < 0.5 * limp && limp > 0.05, "{battened} m with the batten, {limp} m without");
}

#[test]
fn every_level_has_the_regions() {
    let mut app = app();
    let batten = MaterialRegion::uv_line(Vec2::new(0.0, 0.4), Vec2::new(1.0, 0.4), 0.03);
    let weights: Vec<f32> = (0..17 * 17).map(|at| if at % 17 > 13 { 1.0 } else { 0.0 }).collect();
    let regions = || {
        let painted = MaterialRegion::vertices(weights.clone()).density(2.0);
        let deep = MaterialRegion::depth(|depth| depth * depth).density(1.5);
        ClothRegions::new([hem().density(4.0), batten.clone().density(9.0), painted, deep])
    };
    let sheets = [ClothMesh::grid(17, 17, 1.0, 1.0), of_triangles()];
    for mesh in sheets {
        let of_level = |app: &mut App, level: usize, regions: ClothRegions| {
            let lods = LodSet::new([5.0, 10.0]).pinned_to(level);
            let held = Attachment::in_place(ClothEdge::Top);
            let cell = ClothResolution::CellSize(0.05);
            app.world_mut().spawn((mesh.clone(), regions, held, lods, cell)).id()
        };
        let cloths = [0, 1, 2].map(|level| of_level(&mut app, level, regions()));
        let plain = of_level(&mut app, 0, ClothRegions::default());
        run(&mut app, 20);
        let [first, others @ ..] = cloths.map(|cloth| fabric(&app, cloth).mass_area());
        assert!((fabric(&app, plain).mass_area() - 1.0).abs() < 1e-3);
        assert!(first > 2.0 && first < 3.5, "{first}");
        for other in others {
            assert!((other / first - 1.0).abs() < 0.06, "{other}, the finest has {first}");
        }
        let counts = cloths.map(|cloth| state(&app, cloth).positions().len());
        assert!(counts[0] > 3 * counts[1] && counts[1] > 2 * counts[2], "{counts:?}");
    }
    assert!(errors(&app).is_empty(), "{:?}", errors(&app));
}

/// The same sheet as triangles, with a corner out of its plane so that it is no grid.
fn of_triangles() -> ClothMesh {
    let grid = ClothMesh::grid(17, 17, 1.0, 1.0).with_weights(Vec::new());
    let ClothMesh::Triangles { mut positions, indices, uv, .. } = grid else { return grid };
    positions[16 * 17 + 16].z += 0.002;
    ClothMesh::triangles(positions, indices, uv)
}

#[test]
fn bad_regions_are_told_and_other_cloths_go_on() {
    let alone = {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        run(&mut app, 40);
        bits(&app, flag)
    };
    let line = |width| MaterialRegion::uv_line(Vec2::ZERO, Vec2::ONE, width);
    for (bad, expected) in [
        (
            MaterialRegion::vertices(vec![1.0; 5]).density(2.0),
            RegionError::WeightCount { weights: 5, vertices: 289 },
        ),
        (hem().density(-1.0), RegionError::Factor { name: "density", value: -1.0 }),
        (
            MaterialRegion::depth(|depth| 2.0 * depth),
            RegionError::Weight { index: 17, weight: 1.0625 },
        ),
        (line(-0.1), RegionError::Place { name: "width", value: -0.1 }),
    ] {
        let mut app = app();
        let flag = spawn_flag(&mut app, Vec3::ZERO);
        let cloth = app.world_mut().spawn((sheet(), ClothRegions::new([hem(), bad]))).id();
        run(&mut app, 40);
        let [error] = errors(&app)[..] else { panic!("{:?}", errors(&app)) };
        assert_eq!(error, ClothError::Region { entity: cloth, region: 1, source: expected });
        let text = error.to_string();
        assert!(text.contains(&cloth.to_string()) && text.contains("give"), "{text}");
        assert!(state(&app, cloth).positions().is_empty());
        assert_eq!(bits(&app, flag), alone);
        app.world_mut().entity_mut(cloth).insert(ClothRegions::new([hem().density(2.0)]));
        run(&mut app, 5);
        assert_finite(&app, cloth);
        assert_eq!(errors(&app).len(), 1);
    }
    // Not a number is not equal to itself.
    let mut app = app();
    app.world_mut().spawn((sheet(), ClothRegions::new([hem().bending(f32::NAN)])));
    let no_uv = ClothMesh::triangles(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![0, 1, 2], vec![]);
    app.world_mut().spawn((no_uv, ClothRegions::new([hem()])));
    run(&mut app, 5);
    let sources = errors(&app).into_iter().map(|error| match error {
        ClothError::Region { source, .. } => source,
        other => panic!("{other}"),
    });
    let sources: Vec<RegionError> = sources.collect();
    assert!(sources.contains(&RegionError::NoUv) && sources.len() == 2, "{sources:?}");
    let is_factor = |it: &RegionError| matches!(it, RegionError::Factor { name: "bending", .. });
    assert!(sources.iter().any(is_factor), "{sources:?}");
}

#[test]
fn regions_change_while_the_cloth_moves_on() {
    let mut app = app();
    app.world_mut().spawn(WindField::steady(Vec3::new(0.0, 0.0, 3.0)));
    let cloth = app.world_mut().spawn(sheet()).id();
    run(&mut app, 60);
    let plain = fabric(&app, cloth).mass_area();
    let lowest = |app: &App| state(app, cloth).positions()[16 * 17 + 8];
    let blown = lowest(&app);
    assert!(blown.z > 0.2, "{blown}");
    app.world_mut().entity_mut(cloth).insert(ClothRegions::new([hem().density(20.0)]));
    run(&mut app, 1);
    assert!(lowest(&app).distance(blown) < 0.1, "{}, before {blown}", lowest(&app));
    assert!(fabric(&app, cloth).mass_area() > 1.5 * plain);
    run(&mut app, 120);
    assert!(lowest(&app).y < blown.y - 0.2, "it hangs at {}, before {blown}", lowest(&app));
    app.world_mut().entity_mut(cloth).remove::<ClothRegions>();
    run(&mut app, 2);
    assert_eq!(fabric(&app, cloth).mass_area(), plain);
    assert!(errors(&app).is_empty());
}

#[test]
fn tensions_count_with_the_stiffness_of_the_region() {
    let mut app = app();
    let stiff = MaterialRegion::uv_box(Vec2::ZERO, Vec2::new(1.0, 0.5)).stretch(8.0);
    let soft = FabricMaterial { weft_stiffness: 200.0, damping: 5.0, ..FabricMaterial::COTTON };
    let cloth = (sheet(), ClothMaterial(soft));
    let [plain, varied] = [ClothRegions::default(), ClothRegions::new([stiff])]
        .map(|regions| app.world_mut().spawn((cloth.clone(), regions)).id());
    run(&mut app, 400);
    // Links of the middle column, from the top.
    let tension = |app: &App, row: u32| {
        let ends = [row * 17 + 8, (row + 1) * 17 + 8];
        [plain, varied].map(|cloth| {
            let links = fabric(app, cloth).links().iter();
            let mut of = links.zip(state(app, cloth).tensions(&soft));
            let (_, tension) = of.find(|(link, _)| link.particles == ends).expect("a link");
            tension
        })
    };
    for row in [1, 4, 11] {
        let [plain, varied] = tension(&app, row);
        let expected = soft.area_density * 9.81 * (1.0 - (row as f32 + 0.5) / 16.0);
        assert!((varied / expected - 1.0).abs() < 0.05, "{varied} N/m, {expected}");
        assert!((varied / plain - 1.0).abs() < 0.05, "{varied} N/m, {plain} without");
    }
}
