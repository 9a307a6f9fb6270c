//! Pins that move in the frame of their cloth.

use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, FrameMotion, Grid,
    LaneCount, MovingPin, StepSettings,
};
use glam::{Quat, Vec2, Vec3};

const TICK: f32 = 1.0 / 60.0;

/// Ticks in which rounding has not grown to more than 3 × 10⁻⁵ m yet: the sheet folds, and rounding grows by a half in each.
const TICKS: u32 = 10;

/// A square sheet of a metre that hangs from its upper edge and a lower corner, and its pins. Without the corner, the sheet
/// would be free to turn about its pins, and the spurious part of that turn is removed at rest only.
fn sheet(lanes: LaneCount) -> (ClothBatch, Vec<(u32, Vec3)>) {
    let builder = FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0))
        .pin_where(|_, uv| uv.y == 0.0 || uv == Vec2::new(0.0, 1.0));
    let fabric = Arc::new(builder.build().expect("a good grid"));
    let rest = fabric.rest_positions();
    let pins = (0..rest.len()).filter(|&particle| fabric.is_pinned(particle));
    let pins = pins.map(|particle| (particle as u32, rest[particle])).collect();
    let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
    let material = FabricMaterial { damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };
    batch.insert(&ClothSnapshot::at_rest(&fabric), material).expect("a good cloth");
    (batch, pins)
}

/// Way of the upper edge until a time, m.
fn way(seconds: f32) -> Vec3 {
    Vec3::new(0.4 * libm::sinf(5.0 * seconds), 0.0, 0.3 * libm::sinf(3.0 * seconds))
}

fn drive(motion: FrameMotion) -> Drive {
    Drive { motion, wind: Vec3::new(1.0, 0.0, 2.0), ..Drive::default() }
}

#[test]
fn pins_that_move_as_one_are_like_a_frame_that_moves() {
    for lanes in [LaneCount::One, LaneCount::Eight] {
        for substeps in [2, 8] {
            let settings = StepSettings { substeps, ..StepSettings::default() };
            let (mut by_frame, _) = sheet(lanes);
            let (mut by_pins, pins) = sheet(lanes);
            for tick in 0..TICKS {
                let [from, to] = [tick, tick + 1].map(|tick| way(tick as f32 * TICK));
                let motion = FrameMotion { rotation: Quat::IDENTITY, translation: to - from };
                by_frame.drive(0, drive(motion)).expect("good");
                by_frame.step(TICK, settings);
                let moved = pins.iter().map(|&(particle, rest)| MovingPin {
                    particle,
                    from: rest + from,
                    to: rest + to,
                });
                by_pins.move_pins(0, moved.collect()).expect("good");
                by_pins.drive(0, drive(FrameMotion::NONE)).expect("good");
                by_pins.step(TICK, settings);
                let positions = [&by_frame, &by_pins].map(|batch| batch.snapshot(0).positions);
                for (frame, pins) in positions[0].iter().zip(&positions[1]) {
                    let apart = (*frame + to).distance(*pins);
                    assert!(apart < 3e-5, "{apart} m in tick {tick}, {lanes:?}, {substeps}");
                }
            }
        }
    }
}

#[test]
fn pins_rest_when_their_motion_has_ended() {
    let (mut batch, pins) = sheet(LaneCount::Eight);
    let (particle, rest) = pins[0];
    let to = rest + 0.1 * Vec3::X;
    batch.move_pins(0, vec![MovingPin { particle, from: rest, to }]).expect("good");
    batch.step(TICK, StepSettings::default());
    let state = batch.snapshot(0);
    assert_eq!(state.positions[particle as usize], to);
    assert!((state.velocities[particle as usize].x - 0.1 / TICK).abs() < 1e-3);
    batch.step(TICK, StepSettings::default());
    let state = batch.snapshot(0);
    assert_eq!(state.positions[particle as usize], to);
    assert_eq!(state.velocities[particle as usize], Vec3::ZERO);
}

#[test]
fn only_pins_can_be_moved_and_only_by_a_finite_way() {
    let (mut batch, pins) = sheet(LaneCount::One);
    let (particle, from) = pins[0];
    let free = 9 * 9 - 1;
    for (particle, to) in [(free, from), (1000, from), (particle, Vec3::NAN)] {
        let refused = batch.move_pins(0, vec![MovingPin { particle, from, to }]);
        assert_eq!(refused, Err(BatchError::Pin { particle }));
    }
}
