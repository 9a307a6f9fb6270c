//! Air inside cloths.

use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial,
    Grid, LaneCount, PinGroups, Pressure, StepLimits, StepSettings,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use crate::common::{hemisphere, sphere, tube, volume};

const TICK: f32 = 1.0 / 60.0;

const RADIUS: f32 = 0.2;

/// Woven cloth of a cushion.
const COVER: FabricMaterial = FabricMaterial { area_density: 0.2, ..FabricMaterial::NYLON };

fn ball() -> Arc<Fabric> {
    Arc::new(sphere(8, RADIUS).build().expect("a good fabric"))
}

fn batch_of(fabric: &Arc<Fabric>, air: Option<Pressure>, drive: Drive) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let lane = batch.insert(&ClothSnapshot::at_rest(fabric), COVER).expect("a good state");
    batch.set_pressure(lane, air).expect("a good pressure");
    batch.drive(lane, drive).expect("a good drive");
    batch
}

fn positions(batch: &ClothBatch) -> Vec<Vec3> {
    let mut positions = Vec::new();
    batch.copy_positions(0, &mut positions);
    positions
}

fn velocities(batch: &ClothBatch) -> Vec<Vec3> {
    let mut velocities = Vec::new();
    batch.copy_velocities(0, &mut velocities);
    velocities
}

/// Volume over that at rest.
fn filled(batch: &ClothBatch) -> f32 {
    let fabric = batch.fabric();
    let of = |at: &[Vec3]| volume(fabric.triangles(), at);
    of(&positions(batch)) / of(fabric.rest_positions())
}

/// A horizontal plane at a height, m, that nothing passes downwards, or upwards.
fn plate(height: f32, normal: Vec3) -> Collider {
    Collider::fixed(SharedShape::halfspace(normal), Vec3::Y * height, Quat::IDENTITY)
}

#[test]
fn a_tube_is_stretched_around_by_pressure_times_radius() {
    const PRESSURE: f32 = 60.0;
    let fabric = Arc::new(tube(32, RADIUS, 24, 1.0).build().expect("a good fabric"));
    let stiff = FabricMaterial { warp_stiffness: 800.0, weft_stiffness: 800.0, ..COVER };
    let mut batch = batch_of(
        &fabric,
        Some(Pressure::Constant { pressure: PRESSURE }),
        Drive { gravity: Vec3::ZERO, ..Drive::default() },
    );
    batch.set_material(0, stiff).expect("a good material");
    (0..300).for_each(|_| batch.step(TICK, StepSettings { passes: 2, ..StepSettings::yarns(16) }));
    let around = |at: &[Vec3]| {
        let middle: Vec<f32> = at
            .iter()
            .zip(fabric.rest_positions())
            .filter(|(_, rest)| (rest.y - 0.5).abs() < 0.1)
            .map(|(at, _)| at.x.hypot(at.z))
            .collect();
        middle.iter().sum::<f32>() / middle.len() as f32
    };
    let stretch = around(&positions(&batch)) / around(fabric.rest_positions()) - 1.0;
    // T = p r, with the radius under load.
    let expected = PRESSURE * RADIUS / (800.0 - PRESSURE * RADIUS);
    assert!((stretch / expected - 1.0).abs() < 0.1, "{stretch} for {expected}");
}

#[test]
fn sealed_air_keeps_the_volume_of_a_squeezed_ball() {
    let fabric = ball();
    let squeezed = |air: Option<Pressure>| {
        let mut batch = batch_of(&fabric, air, Drive::default());
        for tick in 0..240 {
            let sunk = 0.3 * RADIUS * (tick as f32 / 120.0).min(1.0);
            let plates = [plate(-RADIUS, Vec3::Y), plate(RADIUS - sunk, Vec3::NEG_Y)];
            batch.set_colliders(0, plates).expect("good plates");
            batch.step(TICK, StepSettings { passes: 2, ..StepSettings::yarns(4) });
        }
        (filled(&batch), batch.pressure(0).unwrap_or_default())
    };
    let (empty, _) = squeezed(None);
    let (full, pressure) = squeezed(Some(Pressure::sealed(20.0)));
    assert!(empty < 0.9, "without air {empty}");
    assert!(full > 0.95, "sealed {full}");
    assert!(pressure > 22.0, "{pressure} Pa");
    let (soft, _) = squeezed(Some(Pressure::Sealed { pressure: 20.0, ambient: 0.0 }));
    assert!(soft < full, "soft air {soft}");
}

#[test]
fn the_air_of_a_closed_cloth_pushes_it_nowhere() {
    let fabric = ball();
    let calm = Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() };
    for air in [Pressure::Constant { pressure: 50.0 }, Pressure::sealed(50.0)] {
        let mut batch = batch_of(&fabric, Some(air), calm);
        let turn = Vec3::new(1.0, 2.0, -1.0);
        let mut state = ClothSnapshot::at_rest(&fabric);
        for (particle, at) in fabric.rest_positions().iter().enumerate() {
            state.add_velocity(particle, turn.cross(*at));
        }
        batch.restore(0, &state).expect("a good state");
        let moments = |batch: &ClothBatch| {
            let (at, speeds) = (positions(batch), velocities(batch));
            let of = |moment: fn(Vec3, Vec3) -> Vec3| -> Vec3 {
                let parts = at.iter().zip(&speeds).zip(fabric.particle_areas());
                parts.map(|((at, speed), &area)| area * moment(*at, *speed)).sum()
            };
            [of(|_, speed| speed), of(|at, speed| at.cross(speed))]
        };
        let material = FabricMaterial { damping: 0.0, ..COVER };
        batch.set_material(0, material).expect("a good material");
        let [linear, angular] = moments(&batch);
        (0..120).for_each(|_| batch.step(TICK, StepLimits::default()));
        let [now, turning] = moments(&batch);
        let velocity = (now - linear).length() / fabric.area();
        assert!(velocity < 1e-3, "{air:?} {velocity} m/s");
        let lost = (turning - angular).length() / angular.length();
        assert!(lost < 0.02, "{air:?} spin changed by {lost}");
    }
}

/// Root mean square of the speeds in the last ten of some seconds, m/s, of a ball that falls onto the ground.
fn restless(air: Pressure, seconds: u32) -> f32 {
    let fabric = ball();
    let mut batch = batch_of(&fabric, Some(air), Drive::default());
    batch.set_colliders(0, [plate(-1.5 * RADIUS, Vec3::Y)]).expect("a good plate");
    let mut squares = 0.0;
    for tick in 0..60 * seconds {
        batch.step(TICK, StepLimits::default());
        if tick >= 60 * (seconds - 10) {
            let speeds = velocities(&batch);
            let sum: f32 = speeds.iter().map(|speed| speed.length_squared()).sum();
            squares += sum / speeds.len() as f32 / 600.0;
        }
    }
    squares.sqrt()
}

#[test]
fn balls_that_fall_come_to_rest_within_a_minute() {
    for air in [Pressure::Constant { pressure: 30.0 }, Pressure::sealed(10.0)] {
        let speed = restless(air, 60);
        assert!(speed < 0.02, "{air:?} {speed} m/s");
    }
}

#[test]
fn pressure_that_substeps_do_not_resolve_is_less_and_no_ball_bursts() {
    for air in [Pressure::Constant { pressure: 1e5 }, Pressure::sealed(1e5)] {
        let speed = restless(air, 20);
        assert!(speed < 0.3, "{air:?} {speed} m/s");
    }
}

#[test]
fn air_has_the_same_bits_beside_other_cloths_and_leaves_theirs() {
    let fabric = ball();
    let airs = [
        None,
        Some(Pressure::Constant { pressure: 30.0 }),
        Some(Pressure::sealed(20.0)),
        Some(Pressure::CANOPY),
    ];
    let drive = Drive { wind: Vec3::new(3.0, 1.0, 0.0), ..Drive::default() };
    let alone = airs.map(|air| {
        let mut batch = batch_of(&fabric, air, drive);
        (0..20).for_each(|_| batch.step(TICK, StepLimits::default()));
        positions(&batch)
    });
    let mut together = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    for air in airs {
        let lane = together.insert(&ClothSnapshot::at_rest(&fabric), COVER).expect("a lane");
        together.set_pressure(lane, air).expect("a good pressure");
        together.drive(lane, drive).expect("a good drive");
    }
    (0..20).for_each(|_| together.step(TICK, StepLimits::default()));
    for (lane, expected) in alone.iter().enumerate() {
        let mut at = Vec::new();
        together.copy_positions(lane, &mut at);
        assert_eq!(&at, expected, "lane {lane}");
    }
    // Without air, the cloth is as if there had never been any.
    let mut emptied = batch_of(&fabric, airs[1], drive);
    emptied.set_pressure(0, None).expect("a lane");
    (0..20).for_each(|_| emptied.step(TICK, StepLimits::default()));
    assert_eq!(positions(&emptied), alone[0]);
}

#[test]
fn air_cannot_be_sealed_in_open_cloth_but_can_push_on_it() {
    let fabric = Arc::new(hemisphere(6, 16, 0.5).build().expect("a good fabric"));
    let mut batch = batch_of(&fabric, None, Drive::default());
    let Err(BatchError::Open { area }) = batch.set_pressure(0, Some(Pressure::sealed(10.0))) else {
        panic!("an open cloth was sealed");
    };
    assert!((area / (core::f32::consts::PI * 0.25) - 1.0).abs() < 0.1, "{area} m²");
    let bad = Pressure::Constant { pressure: f32::NAN };
    assert_eq!(batch.set_pressure(0, Some(bad)), Err(BatchError::Pressure { name: "pressure" }));
    let sheet = FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0));
    let sheet = Arc::new(sheet.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric"));
    let drive = Drive { gravity: Vec3::ZERO, ..Drive::default() };
    let mut batch = batch_of(&sheet, Some(Pressure::Constant { pressure: 10.0 }), drive);
    let normal = sheet.normals(sheet.rest_positions())[0];
    (0..10).for_each(|_| batch.step(TICK, StepLimits::default()));
    assert!(positions(&batch)[40].dot(normal) > 0.05, "{:?}", positions(&batch)[40]);
}

#[test]
fn a_ball_with_a_valve_is_closed() {
    let whole = sphere(8, RADIUS);
    let holed = whole.indices()[6..].to_vec();
    let holed = FabricBuilder::new(whole.positions().to_vec(), holed).weld_distance(1e-5);
    let fabric = Arc::new(holed.build().expect("a good fabric"));
    let calm = Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() };
    let mut batch = batch_of(&fabric, Some(Pressure::sealed(10.0)), calm);
    (0..60).for_each(|_| batch.step(TICK, StepLimits::default()));
    let areas = fabric.particle_areas().iter().zip(velocities(&batch));
    let momentum: Vec3 = areas.map(|(&area, velocity)| velocity * area).sum();
    let velocity = momentum.length() / fabric.area();
    assert!(velocity < 1e-3, "{velocity} m/s");
}

/// Drag coefficient of a hemisphere of a metre that is held at its rim, in a wind along an axis, m/s.
fn drag(air: Option<Pressure>, wind: Vec3) -> f32 {
    let fabric = Arc::new(hemisphere(8, 24, 1.0).build().expect("a good fabric"));
    let drive = Drive { gravity: Vec3::ZERO, wind, ..Drive::default() };
    let mut batch = batch_of(&fabric, air, drive);
    let groups = Arc::new(PinGroups::new(&fabric, &[]));
    let mut impulse = Vec3::ZERO;
    for tick in 0..180 {
        batch.report_pins(0, Some((&groups, vec![[Vec3::ZERO; 2]]))).expect("a lane");
        batch.step(TICK, StepSettings { passes: 2, ..StepSettings::yarns(8) });
        if tick >= 120 {
            impulse += batch.pin_reactions(0)[0].impulse;
        }
    }
    let outline = core::f32::consts::PI;
    let dynamic = 0.5 * drive.air_density * wind.length_squared();
    (impulse / (60.0 * TICK)).dot(wind.normalize()) / (dynamic * outline)
}

#[test]
fn a_hemisphere_that_is_open_towards_the_wind_carries() {
    let wind = 4.0 * Vec3::Y;
    let of_stream = drag(None, wind);
    assert!((0.4..0.7).contains(&of_stream), "triangles in a free stream: {of_stream}");
    let trapped = drag(Some(Pressure::CANOPY), wind);
    assert!((1.2..1.4).contains(&trapped), "{trapped}");
    // Across its mouth the wind is not trapped.
    let across = drag(Some(Pressure::CANOPY), 4.0 * Vec3::X);
    assert!((across / drag(None, 4.0 * Vec3::X) - 1.0).abs() < 0.3, "{across}");
}

#[test]
fn a_canopy_goes_on_with_the_same_bits() {
    let fabric = Arc::new(hemisphere(6, 16, 1.0).build().expect("a good fabric"));
    let drive = Drive { wind: 4.0 * Vec3::Y, ..Drive::default() };
    let mut batch = batch_of(&fabric, Some(Pressure::CANOPY), drive);
    (0..10).for_each(|_| batch.step(TICK, StepLimits::default()));
    let mut other = batch_of(&fabric, None, drive);
    other.restore(0, &batch.snapshot(0)).expect("a good state");
    other.set_pressure(0, Some(Pressure::CANOPY)).expect("a lane");
    for batch in [&mut batch, &mut other] {
        (0..10).for_each(|_| batch.step(TICK, StepLimits::default()));
    }
    assert_eq!(positions(&batch), positions(&other));
}
