//! Tests that the bits of a lane depend only on the lane's own history: not on the other lanes, the batch's
//! width or the instruction set.

use std::f32::consts::TAU;
use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Collider, Drive, Entering, Fabric, FabricBuilder,
    FabricMaterial, FrameMotion, Grid, LaneCount, LaneSurface, Loads, StepSettings,
    has_fused_products, instruction_set, with_every_instruction_set,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use crate::common::{drive, material};

const TICK: f32 = 1.0 / 60.0;

const EVERY_SCHEME: [StepSettings; 5] = [
    StepSettings::gauss_seidel(5),
    StepSettings { passes: 3, ..StepSettings::gauss_seidel(2) },
    StepSettings::yarns(3),
    StepSettings { passes: 2, ..StepSettings::yarns(2) },
    // Both orders of the stages.
    StepSettings::yarns(17),
];

fn flag() -> Arc<Fabric> {
    let builder = FabricBuilder::grid(Grid::new(9, 7, 1.2, 0.8)).pin_where(|_, uv| uv.x == 0.0);
    Arc::new(builder.build().expect("a good fabric"))
}

fn colliders(seed: usize) -> Vec<Collider> {
    let ball = Collider {
        features: true,
        ..Collider::fixed(SharedShape::ball(0.2), Vec3::new(0.7, -0.4, 0.3), Quat::IDENTITY)
    };
    if seed % 4 == 2 { vec![ball] } else { Vec::new() }
}

/// States of cloths with these seeds after a second in a batch of the given width.
fn fly(
    fabric: &Arc<Fabric>,
    lanes: LaneCount,
    seeds: &[usize],
    settings: StepSettings,
) -> Vec<ClothSnapshot> {
    let mut batch = ClothBatch::new(fabric.clone(), lanes);
    for &seed in seeds {
        let lane =
            batch.insert(&ClothSnapshot::at_rest(fabric), material(seed)).expect("a free lane");
        batch.set_colliders(lane, colliders(seed)).expect("good shapes");
    }
    for tick in 0..60 {
        for (lane, &seed) in seeds.iter().enumerate() {
            batch.drive(lane, drive(seed, tick)).expect("a good drive");
        }
        batch.step(TICK, settings);
    }
    (0..seeds.len()).map(|lane| batch.snapshot(lane)).collect()
}

fn bits(snapshot: &ClothSnapshot) -> Vec<u32> {
    let vectors = snapshot.positions.iter().chain(&snapshot.velocities);
    vectors.flat_map(|vector| vector.to_array().map(f32::to_bits)).collect()
}

#[test]
fn every_width_gives_the_scalar_bits() {
    let fabric = flag();
    for settings in EVERY_SCHEME {
        let alone: Vec<_> =
            (0..16).map(|seed| fly(&fabric, LaneCount::One, &[seed], settings).remove(0)).collect();
        let seeds: Vec<usize> = (0..16).collect();
        for &lanes in LaneCount::available() {
            let batches = seeds.chunks(lanes.get());
            let together: Vec<_> =
                batches.flat_map(|seeds| fly(&fabric, lanes, seeds, settings)).collect();
            for seed in 0..16 {
                assert!(alone[seed].is_finite());
                assert_eq!(bits(&alone[seed]), bits(&together[seed]), "{lanes:?}, cloth {seed}");
            }
        }
    }
}

/// Instruction sets without a fused multiply-add have bits of their own, which widths have in common.
#[test]
fn instruction_sets_with_fused_products_give_the_same_bits() {
    let fabric = flag();
    for settings in EVERY_SCHEME {
        let runs = with_every_instruction_set(|| {
            let fly = |lanes| fly(&fabric, lanes, &[2], settings).remove(0);
            let [alone, together] = [LaneCount::One, LaneCount::Eight].map(fly);
            assert!(alone.is_finite());
            assert_eq!(bits(&alone), bits(&together), "{}", instruction_set());
            (has_fused_products(), alone)
        });
        let (is_fused, best) = &runs[0];
        for (is_other_fused, other) in &runs[1..] {
            assert_eq!(is_fused == is_other_fused, bits(best) == bits(other), "{settings:?}");
        }
    }
    if cfg!(target_arch = "x86_64") {
        let sets = with_every_instruction_set(instruction_set);
        assert_eq!(sets.last(), Some(&"SSE2"));
        assert_eq!(sets[0], instruction_set());
    }
}

#[test]
fn a_lane_that_is_not_finite_does_not_change_its_neighbours() {
    let fabric = flag();
    let settings = StepSettings::gauss_seidel(4);
    let alone = fly(&fabric, LaneCount::Eight, &[0, 1], settings);
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::Eight);
    for seed in [0, 1] {
        batch.insert(&ClothSnapshot::at_rest(&fabric), material(seed)).expect("a free lane");
    }
    let bad = batch.insert(&ClothSnapshot::at_rest(&fabric), material(2)).expect("a free lane");
    for tick in 0..60 {
        for seed in [0, 1] {
            batch.drive(seed, drive(seed, tick)).expect("a good drive");
        }
        batch
            .drive(bad, Drive { wind: Vec3::splat(f32::MAX), ..Drive::default() })
            .expect("a good drive");
        batch.step(TICK, settings);
    }
    assert!(!batch.is_finite(bad));
    for (lane, alone) in alone.iter().enumerate() {
        assert_eq!(bits(alone), bits(&batch.snapshot(lane)));
    }
}

#[test]
fn a_cloth_moved_between_batches_keeps_its_bits() {
    let fabric = flag();
    for settings in EVERY_SCHEME {
        let stayed = fly(&fabric, LaneCount::One, &[1], settings).remove(0);
        let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
        let mut lane =
            batch.insert(&ClothSnapshot::at_rest(&fabric), material(1)).expect("a free lane");
        for tick in 0..60 {
            if tick == 30 {
                let moving = batch.snapshot(lane);
                batch = ClothBatch::new(fabric.clone(), LaneCount::Eight);
                batch.insert(&ClothSnapshot::at_rest(&fabric), material(0)).expect("a free lane");
                lane = batch.insert(&moving, material(1)).expect("a free lane");
            }
            batch.drive(lane, drive(1, tick)).expect("a good drive");
            batch.step(TICK, settings);
        }
        assert_eq!(bits(&stayed), bits(&batch.snapshot(lane)));
    }
}

#[test]
fn a_lane_that_was_not_finite_can_be_used_again() {
    let fabric = flag();
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::Eight);
    let rest = ClothSnapshot::at_rest(&fabric);
    let lane = batch.insert(&rest, material(1)).expect("a free lane");
    batch
        .drive(lane, Drive { wind: Vec3::splat(f32::MAX), ..Drive::default() })
        .expect("a good drive");
    batch.step(TICK, StepSettings::default());
    assert!(!batch.is_finite(lane));
    batch.remove(lane).expect("an occupied lane");
    assert_eq!(batch.insert(&rest, material(1)), Ok(lane));
    for _ in 0..10 {
        batch.step(TICK, StepSettings::default());
    }
    assert!(batch.is_finite(lane));
}

/// An exchange of several lanes gives the same states as single replacements one after the other, and lanes
/// that become empty come to rest.
#[test]
fn an_exchange_of_many_lanes_equals_single_replacements() {
    let fabric = flag();
    let settings = EVERY_SCHEME[3];
    for &lanes in LaneCount::available() {
        let count = lanes.get();
        let seeds: Vec<usize> = (0..count).collect();
        let states = fly(&fabric, lanes, &seeds, settings);
        let begun = || {
            let mut batch = ClothBatch::new(fabric.clone(), lanes);
            for &seed in &seeds {
                let rest = ClothSnapshot::at_rest(&fabric);
                batch.insert(&rest, material(seed)).expect("a free lane");
            }
            batch.step(TICK, settings);
            batch
        };
        let (mut at_once, mut one_by_one) = (begun(), begun());
        let stays = |lane: &usize| lane.is_multiple_of(3);
        let come: Vec<_> = seeds
            .iter()
            .copied()
            .filter(stays)
            .map(|lane| Entering {
                lane,
                fabric: &fabric,
                snapshot: &states[count - 1 - lane],
                material: material(lane),
            })
            .collect();
        let leave: Vec<usize> = seeds.iter().copied().filter(|lane| !stays(lane)).collect();
        at_once.exchange(&leave, &come).expect("good states");
        leave.iter().for_each(|&lane| one_by_one.remove(lane).expect("a lane"));
        for &Entering { lane, snapshot, material, .. } in &come {
            one_by_one.replace(lane, snapshot, material).expect("a good state");
        }
        for batch in [&mut at_once, &mut one_by_one] {
            (0..10).for_each(|_| batch.step(TICK, settings));
        }
        for lane in 0..count {
            assert_eq!(at_once.is_occupied(lane), stays(&lane));
            let [one, other] = [&at_once, &one_by_one].map(|batch| batch.snapshot(lane));
            assert_eq!(bits(&one), bits(&other), "{lanes:?}, lane {lane}");
            let moves = one.velocities.iter().any(|&velocity| velocity != Vec3::ZERO);
            assert_eq!(moves, stays(&lane), "{lanes:?}, lane {lane}");
        }
    }
}

#[test]
fn a_lane_keeps_nothing_of_the_cloth_before() {
    let fabric = flag();
    for settings in EVERY_SCHEME {
        let flown = fly(&fabric, LaneCount::Eight, &[0, 1, 2, 3, 4, 5, 6, 7], settings);
        let mut used = ClothBatch::new(fabric.clone(), LaneCount::Eight);
        let mut unused = used.clone();
        for (lane, state) in flown.iter().enumerate() {
            used.replace(lane, state, material(lane)).expect("a good state");
            used.drive(lane, drive(lane, 0)).expect("a good drive");
        }
        used.step(TICK, settings);
        // Lane 1 replaces a cloth; lanes 2 and 3 have been empty for a tick.
        let left = [2, 3];
        used.exchange(&left, &[]).expect("two cloths leave");
        used.step(TICK, settings);
        for lane in 1..4 {
            // Stiff cloth replaces stiff cloth, since only stiff bending depends on stretch.
            let seed = lane + 3;
            let state = flown[seed].clone().without_history();
            for batch in [&mut used, &mut unused] {
                batch.replace(lane, &state, material(seed)).expect("a good state");
                batch.drive(lane, drive(seed, 0)).expect("a good drive");
            }
        }
        for batch in [&mut used, &mut unused] {
            (0..10).for_each(|_| batch.step(TICK, settings));
        }
        for lane in 1..4 {
            let [one, other] = [&used, &unused].map(|batch| batch.snapshot(lane));
            assert_eq!(bits(&one), bits(&other), "{settings:?}, lane {lane}");
        }
    }
}

#[test]
fn surfaces_are_copies_of_the_lanes() {
    let fabric = flag();
    for &lanes in LaneCount::available() {
        let mut batch = ClothBatch::new(fabric.clone(), lanes);
        for seed in 0..lanes.get() {
            let lane = batch.insert(&ClothSnapshot::at_rest(&fabric), material(seed));
            batch.drive(lane.expect("a free lane"), drive(seed, 0)).expect("a good drive");
        }
        batch.step(TICK, EVERY_SCHEME[3]);
        let before: Vec<Vec<Vec3>> =
            (0..lanes.get()).map(|lane| batch.snapshot(lane).positions).collect();
        batch.step(TICK, EVERY_SCHEME[3]);
        let empty = lanes.get() / 2;
        let untouched = vec![Vec3::ONE; 3];
        if empty > 0 {
            batch.remove(empty).expect("a lane");
        }
        let begun = LaneSurface { positions: untouched.clone(), ..LaneSurface::default() };
        let mut surfaces = vec![begun; lanes.get()];
        batch.copy_surfaces(&mut surfaces);
        for (lane, surface) in surfaces.iter().enumerate() {
            if empty > 0 && lane == empty {
                assert_eq!(surface.positions, untouched, "left alone");
                continue;
            }
            let (mut positions, mut normals) = (Vec::new(), Vec::new());
            batch.copy_positions(lane, &mut positions);
            batch.copy_normals(lane, &mut normals);
            assert!(surface.is_finite);
            assert_eq!((&surface.positions, &surface.normals), (&positions, &normals), "{lane}");
            let motion = Loads::of_motion(&fabric, &before[lane], &positions, TICK);
            assert!(motion > 0.0 && surface.motion == motion, "{motion} {}", surface.motion);
        }
    }
}

/// A cloth hung by two corners in still air oscillates with one substep, and is under-relaxed: with the same
/// bits alone, beside cloths that fly, and after a move to another batch.
#[test]
fn under_relaxation_at_rest_gives_the_same_bits() {
    const SETTINGS: StepSettings = StepSettings { passes: 4, ..StepSettings::yarns(1) };
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0)).pin([0, 16]);
    let fabric = Arc::new(grid.build().expect("a good fabric"));
    let rest = ClothSnapshot::at_rest(&fabric);
    let mut rippled = rest.clone();
    for at in &mut rippled.positions {
        at.z += 1e-3 * libm::sinf(TAU * at.x) * libm::sinf(0.75 * TAU * at.y);
    }
    let material = FabricMaterial {
        warp_stiffness: 1e4,
        weft_stiffness: 1e4,
        shear_stiffness: 200.0,
        bend_stiffness: 2e-5,
        damping: 2.0,
        ..FabricMaterial::COTTON
    };
    let mut shared = ClothBatch::new(fabric.clone(), LaneCount::Eight);
    let mut batches = [LaneCount::One, LaneCount::Sixteen]
        .map(|lanes| (ClothBatch::new(fabric.clone(), lanes), 0))
        .to_vec();
    shared.insert(&rest, FabricMaterial::SILK).expect("a free lane");
    batches.push((shared, 1));
    for (batch, lane) in &mut batches {
        assert_eq!(batch.insert(&rippled, material), Ok(*lane));
    }
    for tick in 0..300 {
        for (batch, lane) in &mut batches {
            let still = Drive { air_density: 0.0, ..Drive::default() };
            batch.drive(*lane, still).expect("a good drive");
            if *lane == 1 {
                batch.drive(0, drive(1, tick)).expect("a good drive");
                let moving = batch.snapshot(1);
                let mut other = ClothBatch::new(fabric.clone(), LaneCount::Eight);
                other.insert(&batch.snapshot(0), FabricMaterial::SILK).expect("a free lane");
                other.insert(&moving, material).expect("a free lane");
                other.drive(0, drive(1, tick)).expect("a good drive");
                other.drive(1, still).expect("a good drive");
                *batch = other;
            }
            batch.step(TICK, SETTINGS);
        }
        let [first, others @ ..] = &batches[..] else { unreachable!() };
        for (batch, lane) in others {
            assert_eq!(bits(&first.0.snapshot(0)), bits(&batch.snapshot(*lane)), "tick {tick}");
        }
    }
}

#[test]
fn a_drive_that_is_not_finite_is_refused() {
    let mut batch = ClothBatch::new(flag(), LaneCount::Eight);
    let rest = ClothSnapshot::at_rest(&flag());
    let lane = batch.insert(&rest, material(0)).expect("a free lane");
    let nan = Vec3::splat(f32::NAN);
    let motion = FrameMotion { translation: nan, ..FrameMotion::NONE };
    for (name, bad) in [
        ("motion", Drive { motion, ..Drive::default() }),
        ("gravity", Drive { gravity: nan, ..Drive::default() }),
        ("wind", Drive { wind: Vec3::splat(f32::INFINITY), ..Drive::default() }),
        ("air_density", Drive { air_density: -1.0, ..Drive::default() }),
    ] {
        assert_eq!(batch.drive(lane, bad), Err(BatchError::Drive { name }));
    }
    batch.step(TICK, StepSettings::default());
    assert!(batch.is_finite(lane));
    let beyond = Err(BatchError::NoLane { lane: 8, lanes: 8 });
    assert_eq!(batch.drive(8, Drive::NONE), beyond);
    assert_eq!(batch.restore(8, &rest), beyond);
    assert_eq!(batch.set_material(8, material(0)), beyond);
    assert_eq!(batch.replace(8, &rest, material(0)), beyond);
    assert_eq!(batch.exchange(&[8], &[]), beyond);
    assert_eq!(batch.remove(8), beyond);
    assert_eq!(batch.set_colliders(8, colliders(0)), beyond);
    assert!(batch.particles_mut(8).is_none());
}

#[test]
fn a_collider_that_is_not_finite_is_refused_alone() {
    let mut batch = ClothBatch::new(flag(), LaneCount::One);
    let rest = ClothSnapshot::at_rest(&flag());
    batch.insert(&rest, material(0)).expect("a free lane");
    let good = colliders(2);
    let bad = Collider { margin: f32::NAN, ..good[0].clone() };
    let given = [good[0].clone(), bad];
    assert_eq!(batch.set_colliders(0, given), Err(BatchError::Collider { index: 1 }));
    batch.step(TICK, StepSettings::default());
    assert!(batch.is_finite(0));
}

#[test]
#[should_panic(expected = "there is no lane 1")]
fn a_single_cloth_answers_for_its_own_lane_only() {
    let batch = ClothBatch::new(flag(), LaneCount::One);
    let _ = batch.snapshot(1);
}
