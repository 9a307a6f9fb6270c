//! Tests of cloth that is sewn together.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bunting_tests::{Seen, TICK, app, assert_finite, bits, greatest, greatest_speed, run, state};

/// A sheet of 60 by 30 cm.
const COLUMNS: u32 = 25;
const ROWS: u32 = 13;
const WIDTH: f32 = 0.6;
const SHEET: ClothMesh = ClothMesh::grid(COLUMNS, ROWS, WIDTH, 0.3);
/// Length of a link, m.
const LINK: f32 = WIDTH / (COLUMNS - 1) as f32;

/// Material that comes to rest.
const DAMPED: FabricMaterial = FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON };

/// An app that collects the events of seams.
fn app_with_events() -> App {
    let mut app = app();
    app.insert_resource(Seen::<ClothSeamClosed>(Vec::new()))
        .insert_resource(Seen::<ClothSeamOpened>(Vec::new()))
        .add_observer(|event: On<ClothSeamClosed>, mut seen: ResMut<Seen<ClothSeamClosed>>| {
            seen.0.push(*event.event());
        })
        .add_observer(|event: On<ClothSeamOpened>, mut seen: ResMut<Seen<ClothSeamOpened>>| {
            seen.0.push(*event.event());
        });
    app
}

fn sides() -> Seam {
    Seam::new(ClothEdge::Left, ClothEdge::Right)
}

/// A sheet that hangs by the middle of its upper edge.
fn hung_sheet(app: &mut App, seams: ClothSeams) -> Entity {
    let held = Attachment::in_place(AttachedVertices::List(vec![COLUMNS / 2]));
    app.world_mut().spawn((SHEET, ClothMaterial(DAMPED), held, seams)).id()
}

/// The distance of the two ends of each row of a sheet, m.
fn gaps(app: &App, cloth: Entity) -> Vec<f32> {
    let at = state(app, cloth).positions();
    at.chunks(COLUMNS as usize).map(|row| row[0].distance(row[row.len() - 1])).collect()
}

fn seams(app: &mut App, cloth: Entity) -> Mut<'_, ClothSeams> {
    app.world_mut().get_mut::<ClothSeams>(cloth).expect("seams")
}

#[test]
fn a_sheet_is_drawn_together_to_a_tube_without_a_jolt() {
    let mut app = app_with_events();
    app.insert_resource(ClothSettings { gravity: Vec3::ZERO, ..ClothSettings::default() });
    let sleeve = hung_sheet(&mut app, ClothSeams::new([sides().with_closing(1.0)]));
    run(&mut app, 2);
    let mut before = greatest(gaps(&app, sleeve));
    // One second has 64 ticks.
    for _ in 0..62 {
        app.update();
        let gap = greatest(gaps(&app, sleeve));
        assert!(gap > before - 1.05 * WIDTH * TICK, "from {before} to {gap} m");
        assert!(app.world().resource::<Seen<ClothSeamClosed>>().0.is_empty());
        // A flat sheet must buckle, and its middle goes farther than its sides at first.
        assert!(greatest_speed(&app, sleeve) < 3.0 * WIDTH);
        before = gap;
    }
    run(&mut app, 3);
    let told = &app.world().resource::<Seen<ClothSeamClosed>>().0;
    assert_eq!(told[..], [ClothSeamClosed { entity: sleeve, seam: 0 }]);
    let gap = greatest(gaps(&app, sleeve));
    assert!(gap < 0.01 * LINK, "{gap} m apart");
    run(&mut app, 200);
    let gap = greatest(gaps(&app, sleeve));
    assert!(gap < 0.01 * LINK, "{gap} m apart at rest");
    assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
}

/// A wind that blows the sides of open seams apart.
fn storm(app: &mut App) {
    app.world_mut().spawn(WindField::steady(Vec3::new(5.0, 0.0, 4.0)).with_gusts(2.0, 0.5, 1));
}

/// The greatest distance of the two ends of each row of a sheet in some ticks, m.
fn greatest_gaps(app: &mut App, cloth: Entity, ticks: usize) -> Vec<f32> {
    let mut all = vec![0.0; ROWS as usize];
    for _ in 0..ticks {
        app.update();
        all.iter_mut().zip(gaps(app, cloth)).for_each(|(all, now)| *all = now.max(*all));
    }
    all
}

#[test]
fn a_zip_is_closed_up_to_its_slider_and_opened_at_run_time() {
    let mut app = app_with_events();
    storm(&mut app);
    let jacket = hung_sheet(&mut app, ClothSeams::new([sides().zipped_to(0.5)]));
    run(&mut app, 200);
    let half = (ROWS / 2) as usize;
    let found = greatest_gaps(&mut app, jacket, 200);
    let (closed, open) = found.split_at(half + 1);
    assert!(greatest(closed.iter().copied()) < 0.1 * LINK, "{closed:?}");
    assert!(open[open.len() - 1] > LINK, "{open:?}");
    assert!(app.world().resource::<Seen<ClothSeamClosed>>().0.is_empty());
    seams(&mut app, jacket).seams[0].close();
    run(&mut app, 200);
    assert!(greatest(greatest_gaps(&mut app, jacket, 100)) < 0.1 * LINK);
    assert_eq!(app.world().resource::<Seen<ClothSeamClosed>>().0.len(), 1);
    seams(&mut app, jacket).seams[0].open();
    let open = greatest_gaps(&mut app, jacket, 200);
    assert!(open[open.len() - 1] > LINK, "{open:?}");
    let told = &app.world().resource::<Seen<ClothSeamOpened>>().0;
    assert_eq!(told[..], [ClothSeamOpened { entity: jacket, seam: 0 }]);
}

#[test]
fn a_lacing_keeps_its_length() {
    let mut app = app();
    storm(&mut app);
    let length = 0.03;
    let corset = hung_sheet(&mut app, ClothSeams::new([sides().with_length(length)]));
    run(&mut app, 200);
    let found = greatest(greatest_gaps(&mut app, corset, 200));
    assert!(found < length + 0.1 * LINK && found > 0.9 * length, "{found} m");
}

#[test]
fn sewn_cloth_sleeps_and_a_seam_that_changes_wakes_it() {
    let mut app = app();
    let skirt = hung_sheet(&mut app, ClothSeams::new([sides()]));
    run(&mut app, 1500);
    assert_eq!(state(&app, skirt).activity(), ClothActivity::AtRest);
    let before = bits(&app, skirt);
    seams(&mut app, skirt).seams[0].open();
    run(&mut app, 60);
    assert_ne!(bits(&app, skirt), before);
    assert_eq!(state(&app, skirt).activity(), ClothActivity::Ticking);
}

/// Two square panels of 40 cm one below the other, 5 cm apart, with other numbers of vertices along their edges, as pieces of one mesh.
fn panels() -> ClothMesh {
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for (cells, top) in [(8_u32, 0.0), (12, -0.45)] {
        let first = positions.len() as u32;
        let step = 0.4 / cells as f32;
        for row in 0..=cells {
            let across = (0..=cells)
                .map(|column| Vec3::new(step * column as f32, top - step * row as f32, 0.0));
            positions.extend(across);
        }
        for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |at| (row, at))) {
            let a = first + row * (cells + 1) + column;
            let [b, c, d] = [a + 1, a + cells + 1, a + cells + 2];
            indices.extend([a, c, b, b, c, d]);
        }
    }
    let uv = positions.iter().map(|at: &Vec3| Vec2::new(at.x, -at.y)).collect();
    ClothMesh::triangles(positions, indices, uv)
}

#[test]
fn a_panel_below_another_one_hangs_as_long_as_both_at_every_level() {
    let seam = Seam::new(
        // The lower edge of the upper panel, by its corners, and the upper edge of the lower one.
        vec![72, 80],
        SeamRun::Through(vec![Vec3::new(0.0, -0.45, 0.0), Vec3::new(0.4, -0.45, 0.0)]),
    );
    for level in [0, 1] {
        let mut app = app();
        let cloth = (
            panels(),
            ClothMaterial(DAMPED),
            ClothSeams::new([seam.clone().with_closing(0.5)]),
            Attachment::in_place(ClothEdge::Top),
            LodSet::new([10.0]).pinned_to(level),
        );
        let cloth = app.world_mut().spawn(cloth).id();
        run(&mut app, 500);
        assert_finite(&app, cloth);
        let at = state(&app, cloth).positions();
        let longest = greatest(at.iter().map(|at| -at.y));
        let error = longest / 0.8 - 1.0;
        assert!(error.abs() < 0.01, "level {level}: {longest} m");
        assert!(app.world().resource::<Seen<ClothFailed>>().0.is_empty());
    }
}

#[test]
fn seams_that_cannot_be_sewn_are_reported_and_the_others_are_sewn() {
    let bad = [
        Seam::new(vec![0, COLUMNS * ROWS], ClothEdge::Right),
        Seam::new(ClothEdge::Left, Vec::new()),
        Seam::new(SeamRun::Through(vec![Vec3::NAN]), ClothEdge::Right),
        sides().with_length(f32::NAN),
        sides().with_closing(-1.0),
        sides().zipped_to(1.5),
    ];
    let expected = |error: &ClothError, entity: Entity, seam: usize| match *error {
        ClothError::Seam { entity: of, seam: index, source } => {
            of == entity
                && index == seam
                && match seam {
                    0 => source == SeamError::Vertex { vertex: COLUMNS * ROWS },
                    1 => source == SeamError::Empty { side: 1 },
                    2 => source == SeamError::Place,
                    3 => matches!(source, SeamError::Number { name: "length", .. }),
                    4 => matches!(source, SeamError::Number { name: "closing", .. }),
                    _ => matches!(source, SeamError::Number { name: "closed", .. }),
                }
        }
        _ => false,
    };
    let mut app = app();
    let good = hung_sheet(&mut app, ClothSeams::new([sides()]));
    let count = bad.len();
    let cloth = hung_sheet(&mut app, ClothSeams::new(bad.into_iter().chain([sides()])));
    run(&mut app, 300);
    let failed = &app.world().resource::<Seen<ClothFailed>>().0;
    assert_eq!(failed.len(), count, "{failed:?}");
    for (index, failed) in failed.iter().enumerate() {
        assert!(expected(&failed.error, cloth, index), "{failed:?}");
    }
    assert!(greatest(gaps(&app, cloth)) < 0.01 * LINK);
    assert_eq!(bits(&app, cloth), bits(&app, good));
}

#[test]
fn a_sewn_cloth_has_the_same_bits_alone_and_among_others() {
    let fly = |others: usize| {
        let mut app = app();
        // Substeps are shared with the others otherwise.
        app.insert_resource(ClothSettings { share_batches: false, ..ClothSettings::default() });
        app.world_mut().spawn(WindField::steady(Vec3::new(3.0, 0.0, 1.0)));
        let sewn = hung_sheet(&mut app, ClothSeams::new([sides().with_closing(0.5)]));
        let mut all = vec![sewn];
        for _ in 0..others {
            let held = Attachment::in_place(AttachedVertices::List(vec![COLUMNS / 2]));
            all.push(app.world_mut().spawn((SHEET, ClothMaterial(DAMPED), held)).id());
        }
        run(&mut app, 90);
        (bits(&app, sewn), all.last().map(|last| bits(&app, *last)))
    };
    let (alone, _) = fly(0);
    let (among, unsewn) = fly(7);
    assert_eq!(alone, among);
    assert_ne!(Some(alone), unsewn);
}

#[test]
fn a_seam_that_is_being_closed_goes_on_after_a_snapshot() {
    let mut app = app_with_events();
    let sleeve = hung_sheet(&mut app, ClothSeams::new([sides().with_closing(1.0)]));
    run(&mut app, 30);
    let snapshot = app.world().save_cloth(sleeve).expect("a cloth at work");
    let rest = |app: &mut App| {
        run(app, (1.5 / TICK) as usize);
        bits(app, sleeve)
    };
    let first = rest(&mut app);
    app.world_mut().restore_cloth(sleeve, &snapshot).expect("the same cloth");
    assert_eq!(rest(&mut app), first);
    assert_eq!(app.world().resource::<Seen<ClothSeamClosed>>().0.len(), 2);
}
