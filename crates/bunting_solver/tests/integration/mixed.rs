//! Cloths of different fabrics in one batch have the bits that each has among cloths of its own fabric.

use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Collider, Entering, Fabric, FabricBuilder, Grid,
    LaneCount, LaneSurface, Loads, StepSettings,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use crate::common::{drive, material};

const TICK: f32 = 1.0 / 60.0;
const SETTINGS: [StepSettings; 3] = [
    StepSettings::yarns(3),
    StepSettings { passes: 2, ..StepSettings::yarns(2) },
    // Both orders of the stages.
    StepSettings::yarns(17),
];

/// Which particles are pinned.
#[derive(Clone, Copy, Debug)]
enum Pins {
    /// The left edge: a pole.
    Edge,
    /// Two corners that stand alone.
    Corners,
    /// None: internal damping.
    None,
}

/// A cloth of a size of its own. From seed to seed the nearest and the farthest pins and the classes of links differ.
fn fabric(seed: usize, pins: Pins) -> Arc<Fabric> {
    let width = 0.6 + 0.13 * seed as f32;
    let builder = FabricBuilder::grid(Grid::new(9, 7, width, 0.8 + 0.01 * (seed % 3) as f32));
    let builder = match pins {
        Pins::Edge => builder.pin_where(|_, uv| uv.x == 0.0),
        Pins::Corners => builder.pin([0, 8]),
        Pins::None => builder,
    };
    Arc::new(builder.build().expect("a good fabric"))
}

/// Sets what acts on a cloth in a tick.
fn set(batch: &mut ClothBatch, lane: usize, seed: usize, at: usize) {
    batch.drive(lane, drive(seed, at)).expect("a good drive");
    let ball = Collider {
        features: true,
        ..Collider::fixed(SharedShape::ball(0.2), Vec3::new(0.5, -0.4, 0.3), Quat::IDENTITY)
    };
    let balls = (seed % 4 == 2).then_some(ball);
    batch.set_colliders(lane, balls).expect("good shapes");
}

/// The state of a cloth after some ticks in a batch of its own fabric.
fn alone(seed: usize, pins: Pins, settings: StepSettings, ticks: usize) -> ClothSnapshot {
    let fabric = fabric(seed, pins);
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::Eight);
    batch.replace(3, &ClothSnapshot::at_rest(&fabric), material(seed)).expect("a lane");
    for at in 0..ticks {
        set(&mut batch, 3, seed, at);
        batch.step(TICK, settings);
    }
    batch.snapshot(3)
}

/// A batch with a cloth at rest of each fabric, in their order.
fn at_rest(fabrics: &[Arc<Fabric>]) -> ClothBatch {
    let mut batch = ClothBatch::mixed(&fabrics[2]).expect("grids");
    let states: Vec<_> = fabrics.iter().map(|it| ClothSnapshot::at_rest(it)).collect();
    let entering = |lane: usize| Entering {
        lane,
        fabric: &fabrics[lane],
        snapshot: &states[lane],
        material: material(lane),
    };
    let cloths: Vec<Entering> = (0..fabrics.len()).map(entering).collect();
    batch.exchange(&[], &cloths).expect("one topology");
    batch
}

#[test]
fn a_cloth_among_others_has_the_bits_of_one_alone() {
    const TICKS: usize = 40;
    for pins in [Pins::Edge, Pins::Corners, Pins::None] {
        for count in [5, 8] {
            for settings in SETTINGS {
                let fabrics: Vec<_> = (0..count).map(|seed| fabric(seed, pins)).collect();
                let mut batch = at_rest(&fabrics);
                for at in 0..TICKS {
                    (0..count).for_each(|lane| set(&mut batch, lane, lane, at));
                    batch.step(TICK, settings);
                }
                for seed in 0..count {
                    let expected = alone(seed, pins, settings, TICKS);
                    assert!(expected.is_finite());
                    assert_eq!(batch.snapshot(seed), expected, "cloth {seed} of {count}, {pins:?}");
                }
            }
        }
    }
}

#[test]
fn a_cloth_may_enter_and_leave_in_mid_flight() {
    let (settings, pins) = (SETTINGS[1], Pins::Edge);
    let fabrics: Vec<_> = (0..4).map(|seed| fabric(seed, pins)).collect();
    let mut batch = ClothBatch::mixed(&fabrics[0]).expect("grids");
    // One cloth of another size has flown in the lane before.
    let rest = ClothSnapshot::at_rest(&fabrics[3]);
    let other = Entering { lane: 5, fabric: &fabrics[3], snapshot: &rest, material: material(1) };
    batch.exchange(&[], &[other]).expect("one topology");
    (0..5).for_each(|_| batch.step(TICK, settings));
    let snapshot = alone(2, pins, settings, 20);
    let own = Entering { lane: 5, fabric: &fabrics[2], snapshot: &snapshot, material: material(2) };
    batch.exchange(&[5], &[own]).expect("one topology");
    for at in 20..40 {
        set(&mut batch, 5, 2, at);
        batch.step(TICK, settings);
    }
    assert_eq!(batch.snapshot(5), alone(2, pins, settings, 40));
    // And on in a batch of its own.
    let mut own = ClothBatch::new(fabrics[2].clone(), LaneCount::One);
    own.insert(&batch.snapshot(5), material(2)).expect("a free lane");
    for at in 40..60 {
        set(&mut own, 0, 2, at);
        own.step(TICK, settings);
    }
    assert_eq!(own.snapshot(0), alone(2, pins, settings, 60));
}

#[test]
fn fabrics_of_cloths_that_have_left_are_not_kept() {
    let (settings, pins) = (SETTINGS[0], Pins::Corners);
    let fabrics: Vec<_> = (0..5).map(|seed| fabric(seed, pins)).collect();
    let mut batch = at_rest(&fabrics);
    for at in 0..20 {
        (0..5).for_each(|lane| set(&mut batch, lane, lane, at));
        batch.step(TICK, settings);
    }
    batch.exchange(&[0, 1, 2, 4], &[]).expect("these lanes");
    batch.replace_unused_fabrics(&fabrics[3]);
    let kept: Vec<_> = fabrics.iter().map(Arc::downgrade).collect();
    drop(fabrics);
    let kept: Vec<bool> = kept.iter().map(|fabric| fabric.strong_count() > 0).collect();
    assert_eq!(kept, [false, false, false, true, false]);
    for at in 20..40 {
        set(&mut batch, 3, 3, at);
        batch.step(TICK, settings);
    }
    assert_eq!(batch.snapshot(3), alone(3, pins, settings, 40));
    // A cloth of another size may enter again.
    let (other, rest) = (fabric(1, pins), ClothSnapshot::at_rest(&fabric(1, pins)));
    let entering = Entering { lane: 0, fabric: &other, snapshot: &rest, material: material(1) };
    batch.exchange(&[], &[entering]).expect("one topology");
    for at in 0..20 {
        set(&mut batch, 0, 1, at);
        batch.step(TICK, settings);
    }
    assert_eq!(batch.snapshot(0), alone(1, pins, settings, 20));
}

#[test]
fn other_topologies_are_refused() {
    let [flag, hung] = [Pins::Edge, Pins::Corners].map(|pins| fabric(0, pins));
    let mut batch = ClothBatch::mixed(&flag).expect("a grid");
    let snapshot = ClothSnapshot::at_rest(&hung);
    let entering = Entering { lane: 0, fabric: &hung, snapshot: &snapshot, material: material(0) };
    assert_eq!(batch.exchange(&[], &[entering]), Err(BatchError::Fabric));
    let mut of_one = ClothBatch::new(flag.clone(), LaneCount::Eight);
    let same = fabric(0, Pins::Edge);
    let snapshot = ClothSnapshot::at_rest(&same);
    let entering = Entering { lane: 0, fabric: &same, snapshot: &snapshot, material: material(0) };
    assert_eq!(of_one.exchange(&[], &[entering]), Err(BatchError::Fabric));
    let triangles = vec![0, 1, 2];
    let mesh = FabricBuilder::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles).build();
    assert!(ClothBatch::mixed(&Arc::new(mesh.expect("good"))).is_none());
}

#[test]
fn motion_is_measured_by_the_links_of_each_cloth() {
    let fabrics: Vec<_> = (0..8).map(|seed| fabric(seed, Pins::Edge)).collect();
    let mut batch = at_rest(&fabrics);
    (0..8).for_each(|lane| set(&mut batch, lane, lane, 0));
    batch.step(TICK, SETTINGS[0]);
    let mut surfaces = vec![LaneSurface::default(); 8];
    batch.copy_surfaces(&mut surfaces);
    for (lane, surface) in surfaces.iter().enumerate() {
        let before = fabrics[lane].rest_positions();
        let motion = Loads::of_motion(&fabrics[lane], before, &surface.positions, TICK);
        assert!(motion > 0.0 && surface.motion == motion, "{motion} {}", surface.motion);
    }
}
