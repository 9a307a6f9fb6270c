//! Guides: greatest distances from animated places, and backstops.

use std::sync::Arc;

use bunting_solver::{
    Backstop, BatchError, ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial,
    FrameMotion, Grid, Guide, LaneCount, StepSettings,
};
use glam::{Quat, Vec3};

use crate::common::{drive, material, net};

const TICK: f32 = 1.0 / 60.0;
const GRAVITY: f32 = 9.81;

/// Greatest distance of a particle from the sphere that holds it, m: rounding.
const ROUNDING: f32 = 1e-5;

fn guide(place: Vec3) -> Guide {
    Guide {
        places: [place; 2],
        normals: [Vec3::Z; 2],
        max_distance: f32::INFINITY,
        backstop: Backstop::default(),
    }
}

/// A grid of 9 × 7 particles whose left edge is pinned, or a free one.
fn grid(is_pinned: bool) -> Arc<Fabric> {
    let builder = FabricBuilder::grid(Grid::new(9, 7, 1.2, 0.8));
    let builder = builder.pin_where(|_, uv| is_pinned && uv.x == 0.0);
    Arc::new(builder.build().expect("a good fabric"))
}

/// The same cloth as a mesh of triangles.
fn mesh() -> Arc<Fabric> {
    let grid = FabricBuilder::grid(Grid::new(12, 10, 1.2, 0.8));
    let mesh = FabricBuilder::new(grid.positions().to_vec(), grid.indices().to_vec())
        .uv(Grid::new(12, 10, 1.2, 0.8).uvs())
        .pin_where(|_, uv| uv.x == 0.0);
    net(&mesh)
}

fn undamped() -> FabricMaterial {
    FabricMaterial { damping: 0.0, internal_damping: 0.0, ..FabricMaterial::FLAG_POLYESTER }
}

/// A bob: a free square of a centimetre whose particles are all within a metre of places that are as far from one another
/// as they are. It begins at rest at a place, seen from those. Positions of its first particle seen from its place, and
/// speeds.
fn swing(from: Vec3, seconds: f32, substeps: u32) -> Vec<(Vec3, f32)> {
    let fabric = FabricBuilder::grid(Grid::new(2, 2, 0.01, 0.01)).build().expect("a good fabric");
    let fabric = Arc::new(fabric);
    let rest = fabric.rest_positions();
    let start = rest.iter().map(|&at| at + from).collect();
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    let snapshot = ClothSnapshot::new(start, vec![Vec3::ZERO; rest.len()]);
    batch.insert(&snapshot, undamped()).expect("a good cloth");
    let drive = Drive { air_density: 0.0, ..Drive::default() };
    batch.drive(0, drive).expect("a good drive");
    let guides = rest.iter().map(|&at| Guide { max_distance: 1.0, ..guide(at) });
    batch.set_guides(0, guides.collect()).expect("good guides");
    let settings = StepSettings { substeps, ..StepSettings::default() };
    (0..(seconds / TICK) as u32)
        .map(|_| {
            batch.step(TICK, settings);
            let state = batch.snapshot(0);
            (state.positions[0] - rest[0], state.velocities[0].length())
        })
        .collect()
}

fn arm(angle: f32) -> Vec3 {
    Vec3::new(libm::sinf(angle), -libm::cosf(angle), 0.0)
}

#[test]
fn a_taut_limit_is_the_rod_of_a_pendulum() {
    let way = swing(arm(0.1), 20.0, 8);
    for (at, _) in &way {
        assert!((at.length() - 1.0).abs() < ROUNDING, "the limit stays taut: {at}");
    }
    // From one passage to the left through the lowest point to the next.
    let crossings: Vec<f32> = (1..way.len())
        .filter(|&tick| way[tick - 1].0.x > 0.0 && way[tick].0.x <= 0.0)
        .map(|tick| {
            let [before, after] = [way[tick - 1].0.x, way[tick].0.x];
            (tick as f32 + before / (before - after)) * TICK
        })
        .collect();
    let periods = crossings.len() - 1;
    let period = (crossings[periods] - crossings[0]) / periods as f32;
    let expected = std::f32::consts::TAU / GRAVITY.sqrt() * (1.0 + 0.1 * 0.1 / 16.0);
    assert!((period / expected - 1.0).abs() < 5e-3, "{period} s for {expected} s");
}

#[test]
fn a_limit_gives_no_energy() {
    for substeps in [1, 2, 8] {
        for angle in [0.5, 1.5, 2.5] {
            let first = -GRAVITY * libm::cosf(angle);
            let energies = swing(arm(angle), 10.0, substeps);
            let greatest = energies
                .iter()
                .map(|(at, speed)| GRAVITY * at.y + speed * speed / 2.0)
                .fold(f32::NEG_INFINITY, f32::max);
            let gain = (greatest - first) / GRAVITY;
            assert!(gain < 5e-3, "{gain} m at {angle} rad, {substeps} substeps");
        }
    }
}

#[test]
fn a_limit_does_not_throw_back() {
    for substeps in [1, 2, 3, 8] {
        let fall = swing(0.5 * Vec3::Y, 2.0, substeps);
        let hit = fall.iter().position(|(at, _)| at.y < -0.999).expect("it falls to its limit");
        let highest = fall[hit..].iter().map(|(at, _)| at.y).fold(-1.0, f32::max);
        assert!(highest + 1.0 < 5e-3, "{} m with {substeps} substeps", highest + 1.0);
    }
}

/// Steps a cloth with a drive and guides in each tick, and calls `check` after each.
fn fly(
    fabric: &Arc<Fabric>,
    lanes: LaneCount,
    guides: impl Fn(usize) -> Vec<Guide>,
    mut check: impl FnMut(usize, &[Vec3]),
) {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    batch.insert(&ClothSnapshot::at_rest(fabric), material(2)).expect("a good cloth");
    for tick in 0..60 {
        batch.drive(0, drive(1, tick)).expect("a good drive");
        batch.set_guides(0, guides(tick)).expect("good guides");
        batch.step(TICK, StepSettings::default());
        check(tick, &batch.snapshot(0).positions);
    }
}

/// Place of a particle at the end of a tick, m.
fn place(rest: Vec3, tick: usize) -> Vec3 {
    rest + 0.1 * Vec3::new(0.0, libm::sinf(0.3 * tick as f32), libm::sinf(0.2 * tick as f32))
}

fn moving(rest: Vec3, tick: usize) -> Guide {
    Guide { places: [tick, tick + 1].map(|tick| place(rest, tick)), ..guide(rest) }
}

#[test]
fn free_particles_keep_their_distance_from_moving_places() {
    for fabric in [grid(true), grid(false), mesh()] {
        for lanes in [LaneCount::One, LaneCount::Eight] {
            let rest = fabric.rest_positions();
            let limit = |tick| rest.iter().map(move |&at| moving(at, tick));
            let guides = |tick| limit(tick).map(|it| Guide { max_distance: 0.05, ..it }).collect();
            let mut farthest = 0.0_f32;
            fly(&fabric, lanes, guides, |tick, positions| {
                for (particle, (&at, &rest)) in positions.iter().zip(rest).enumerate() {
                    if !fabric.is_pinned(particle) {
                        farthest = farthest.max(at.distance(place(rest, tick + 1)));
                    }
                }
            });
            assert!((0.049..0.05 + ROUNDING).contains(&farthest), "{farthest} m");
        }
    }
}

#[test]
fn free_particles_stay_out_of_moving_backstops() {
    let backstop = Backstop { distance: 0.02, radius: 0.3 };
    for fabric in [grid(true), mesh()] {
        for lanes in [LaneCount::One, LaneCount::Eight] {
            let rest = fabric.rest_positions();
            // The wind blows along +z.
            let normals = [Vec3::NEG_Z; 2];
            let guides = |tick| {
                let all = rest.iter().map(|&at| Guide { backstop, normals, ..moving(at, tick) });
                all.collect()
            };
            let mut deepest = f32::INFINITY;
            fly(&fabric, lanes, guides, |tick, positions| {
                for (particle, (&at, &rest)) in positions.iter().zip(rest).enumerate() {
                    let centre = place(rest, tick + 1) + 0.32 * Vec3::Z;
                    if !fabric.is_pinned(particle) {
                        deepest = deepest.min(at.distance(centre));
                    }
                }
            });
            assert!((0.3 - ROUNDING..0.301).contains(&deepest), "{deepest} m");
        }
    }
}

#[test]
fn cloth_that_is_held_in_its_places_moves_with_the_frame() {
    // The places are fixed in a frame that turns by 3 rad/s, then rests.
    let fabric = grid(true);
    let rest = fabric.rest_positions();
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    batch.insert(&ClothSnapshot::at_rest(&fabric), undamped()).expect("a good cloth");
    let guides = rest.iter().map(|&at| Guide { max_distance: 1e-3, ..guide(at) });
    batch.set_guides(0, guides.collect()).expect("good guides");
    for tick in 0..60 {
        let rate = if tick < 30 { 3.0 } else { 0.0 };
        let rotation = Quat::from_rotation_y(rate * TICK);
        let motion = FrameMotion { rotation, translation: Vec3::ZERO };
        batch.drive(0, Drive { motion, ..Drive::default() }).expect("a good drive");
        batch.step(TICK, StepSettings::default());
        if tick % 30 < 20 {
            continue;
        }
        let state = batch.snapshot(0);
        for (particle, (velocity, rest)) in state.velocities.iter().zip(rest).enumerate() {
            let expected = (rate * Vec3::Y).cross(*rest);
            let error = velocity.distance(expected);
            assert!(error < 0.1, "{velocity} for {expected}, particle {particle}, tick {tick}");
        }
    }
}

fn bits(snapshot: &ClothSnapshot) -> Vec<u32> {
    let vectors = snapshot.positions.iter().chain(&snapshot.velocities);
    vectors.flat_map(|vector| vector.to_array().map(f32::to_bits)).collect()
}

/// States of cloths after a second, of which every second one is guided if `guided`.
fn together(
    fabric: &Arc<Fabric>,
    lanes: LaneCount,
    seeds: &[usize],
    guided: bool,
) -> Vec<Vec<u32>> {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    let cloths: Vec<usize> = seeds
        .iter()
        .map(|&seed| {
            batch.insert(&ClothSnapshot::at_rest(fabric), material(seed)).expect("a free lane")
        })
        .collect();
    for tick in 0..60 {
        for (&lane, &seed) in cloths.iter().zip(seeds) {
            batch.drive(lane, drive(seed, tick)).expect("a good drive");
            if guided && seed % 2 == 1 {
                let backstop = Backstop { distance: 0.01, radius: 0.5 };
                let limits = fabric.rest_positions().iter().map(|&at| Guide {
                    max_distance: 0.2,
                    backstop,
                    ..moving(at, tick)
                });
                batch.set_guides(lane, limits.collect()).expect("good guides");
            }
        }
        batch.step(TICK, StepSettings::default());
    }
    cloths.iter().map(|&lane| bits(&batch.snapshot(lane))).collect()
}

#[test]
fn bits_depend_neither_on_the_width_nor_on_other_cloths() {
    let fabric = grid(true);
    let seeds: Vec<usize> = (0..8).collect();
    let alone: Vec<_> = seeds
        .iter()
        .map(|&seed| together(&fabric, LaneCount::One, &[seed], true).remove(0))
        .collect();
    for &lanes in LaneCount::available() {
        if lanes.get() >= seeds.len() {
            assert!(together(&fabric, lanes, &seeds, true) == alone, "{lanes:?}");
        }
    }
    let free = together(&fabric, LaneCount::Eight, &seeds, false);
    for &seed in &seeds {
        assert_eq!(free[seed] == alone[seed], seed % 2 == 0, "cloth {seed}");
    }
}

#[test]
fn cloth_whose_guides_are_taken_is_free() {
    let fabric = grid(false);
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    let lane = batch.insert(&ClothSnapshot::at_rest(&fabric), undamped()).expect("good");
    let guides = fabric.rest_positions().iter().map(|&at| Guide { max_distance: 0.1, ..guide(at) });
    batch.set_guides(lane, guides.collect()).expect("good guides");
    let fall = |batch: &mut ClothBatch| {
        (0..30).for_each(|_| batch.step(TICK, StepSettings::default()));
        batch.snapshot(lane).positions[0].y
    };
    assert!((fall(&mut batch) + 0.1).abs() < 0.01, "it hangs from its guides");
    batch.set_guides(lane, Vec::new()).expect("no guides");
    assert!(fall(&mut batch) < -0.5, "it falls");
}

#[test]
fn bad_guides_are_refused() {
    let fabric = grid(true);
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    batch.insert(&ClothSnapshot::at_rest(&fabric), undamped()).expect("good");
    let all = vec![guide(Vec3::ZERO); fabric.particle_count()];
    let count = BatchError::ParticleCount { given: 3, expected: fabric.particle_count() };
    assert_eq!(batch.set_guides(0, all[..3].to_vec()), Err(count));
    assert_eq!(batch.set_guides(0, all.clone()), Ok(()));
    let bad: [fn(&mut Guide); 4] = [
        |guide| guide.places[1].x = f32::NAN,
        |guide| guide.normals[0].x = f32::INFINITY,
        |guide| guide.max_distance = -1.0,
        |guide| guide.backstop.radius = f32::NAN,
    ];
    for spoil in bad {
        let mut guides = all.clone();
        spoil(&mut guides[5]);
        assert_eq!(batch.set_guides(0, guides), Err(BatchError::Guide { particle: 5 }));
    }
}

/// The centre of the backstop lies at the particle, so that no direction leads out of it but that of the animated normal.
#[test]
fn a_particle_at_the_centre_of_a_backstop_leaves_it_along_the_normal() {
    const RADIUS: f32 = 0.1;
    let fabric = grid(false);
    let rest = fabric.rest_positions();
    let normal = Vec3::new(0.6, 0.0, 0.8);
    let backstop = Backstop { distance: 0.02, radius: RADIUS };
    let out = normal * (backstop.distance + RADIUS);
    for &lanes in LaneCount::available() {
        let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
        batch.insert(&ClothSnapshot::at_rest(&fabric), undamped()).expect("a good cloth");
        let drive = Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() };
        batch.drive(0, drive).expect("a good drive");
        let guides = rest.iter().map(|&at| Guide {
            places: [at + out; 2],
            normals: [normal; 2],
            backstop,
            ..guide(at)
        });
        batch.set_guides(0, guides.collect()).expect("good guides");
        batch.step(TICK, StepSettings::default());
        for (after, at) in batch.snapshot(0).positions.iter().zip(rest) {
            let moved = *after - *at;
            // It may move on beyond the surface, but to no side.
            let along = moved.dot(normal);
            assert!(along > RADIUS - ROUNDING && along < 2.0 * RADIUS, "{moved}");
            assert!(moved.distance(along * normal) < ROUNDING, "{moved}");
        }
    }
}
