//! Tests of contacts with parry shapes.

use std::sync::Arc;

use bunting_solver::{
    Backstop, ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial,
    Grid, Guide, Hold, Holder, LaneCount, LinkFamily, MovingPin, StepSettings,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

const TICK: f32 = 1.0 / 60.0;
const THICKNESS: f32 = 0.002;

/// The default settings, and Gauss–Seidel with the given number of substeps.
fn schemes(substeps: u32) -> [StepSettings; 2] {
    [StepSettings::default(), StepSettings::gauss_seidel(substeps)]
}

fn horizontal(n: u32, pinned: bool) -> Arc<Fabric> {
    let grid = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0));
    Arc::new(
        grid.pin_where(|_, uv| pinned && (uv.x == 0.0 || uv.x == 1.0))
            .build()
            .expect("a good fabric"),
    )
}

/// Gravity along −z: the cloth lies in its xy plane, so −z is down.
fn fall() -> Drive {
    Drive { gravity: Vec3::new(0.0, 0.0, -9.81), ..Drive::default() }
}

fn cloth(fabric: &Arc<Fabric>, material: FabricMaterial) -> ClothBatch {
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
    let lane = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("a free lane");
    batch.drive(lane, fall()).expect("a good drive");
    batch
}

fn material() -> FabricMaterial {
    FabricMaterial { thickness: THICKNESS, surface_friction: 0.5, ..FabricMaterial::COTTON }
}

fn deepest(batch: &ClothBatch, shape: &SharedShape, position: Vec3) -> f32 {
    let state = batch.snapshot(0);
    let depth = |at: &Vec3| {
        let nearest = shape.project_local_point(*at - position, true);
        if nearest.is_inside {
            shape.project_local_point(*at - position, false).point.distance(*at - position)
        } else {
            0.0
        }
    };
    state.positions.iter().map(depth).fold(0.0, f32::max)
}

/// Particles of a sheet that lies on a floor are pressed with their weight. Free cloth is chosen to be strained by a tenth at
/// most under its weight, and may be strained by a fifth where a shape presses it: that is a load of half of what presses.
#[test]
fn a_sheet_on_a_floor_is_loaded_by_its_weight() {
    let fabric = horizontal(17, false);
    let mut batch = cloth(&fabric, material());
    batch.step(TICK, StepSettings::default());
    assert_eq!(batch.contact_load(0), 0.0);
    let floor =
        Collider::fixed(SharedShape::halfspace(Vec3::Z), -THICKNESS * Vec3::Z, Quat::IDENTITY);
    batch.set_colliders(0, [floor]).expect("a good shape");
    (0..60).for_each(|_| batch.step(TICK, StepSettings::default()));
    let load = batch.contact_load(0);
    assert!((load / (0.5 * 9.81) - 1.0).abs() < 1e-3, "{load}");
}

/// A sheet falls on a shape below its centre. Its centre comes to lie on the top, a thickness above it, or above a round
/// shape at most so much higher that no triangle beside it cuts the shape. No particle hangs lower than half a diagonal of
/// the sheet below the top; without contacts the sheet falls 2.8 m.
#[test]
fn cloth_comes_to_lie_on_every_shape() {
    /// Factor by which a corner may hang lower than half a diagonal at rest, since diagonals shear.
    const SHEAR: f32 = 1.05;
    /// Height of the centre above the shape beyond the thickness, m: the distance kept for rounding.
    const CLEARANCE: f32 = 1e-4;
    let centre = Vec3::new(0.5, -0.5, -0.4);
    // Each shape is given with its height above its centre, m, and its curvature, 1/m.
    let shapes = [
        (SharedShape::ball(0.3), 0.3, 1.0 / 0.3),
        (SharedShape::capsule_x(0.3, 0.15), 0.15, 1.0 / 0.15),
        (SharedShape::cuboid(0.3, 0.3, 0.2), 0.2, 0.0),
        (SharedShape::halfspace(Vec3::Z), 0.0, 0.0),
    ];
    // Gauss–Seidel stretches the cells, so that the bound does not hold.
    let [yarns, gauss_seidel] = schemes(8);
    for (settings, features) in [(yarns, false), (yarns, true), (gauss_seidel, false)] {
        for (shape, height, curvature) in &shapes {
            let context = format!("{:?}, {settings:?}, {features}", shape.shape_type());
            let top = centre.z + height;
            let fabric = horizontal(17, false);
            let mut batch = cloth(&fabric, material());
            let collider = Collider::fixed(shape.clone(), centre, Quat::IDENTITY);
            batch.set_colliders(0, [Collider { features, ..collider }]).expect("good shapes");
            for _ in 0..45 {
                batch.step(TICK, settings);
                assert!(deepest(&batch, shape, centre) < 1e-3, "{context}");
            }
            let positions = batch.snapshot(0).positions;
            let above = positions[8 * 17 + 8].z - top - THICKNESS;
            let middle = 8 * 17 + 8;
            let diagonals = [middle - 18, middle - 16, middle + 16, middle + 18];
            let lengths = diagonals.map(|at| positions[at].distance(positions[middle]));
            let longest = lengths.into_iter().fold(0.0, f32::max);
            let sag = if features { curvature * longest * longest / 8.0 } else { 0.0 };
            assert!(above > -CLEARANCE && above < sag + CLEARANCE, "{context}: {above} m above");
            let lowest = positions.iter().map(|at| at.z).fold(f32::MAX, f32::min);
            let hangs = (top - lowest) / (0.5 * core::f32::consts::SQRT_2);
            assert!(hangs < SHEAR, "{context}: down to {lowest} m");
        }
    }
}

#[test]
fn a_fast_ball_does_not_tunnel() {
    // 20 m/s, 5 cm, through a 65 × 65 cloth held on two sides.
    let fabric = horizontal(65, true);
    let shape = SharedShape::ball(0.05);
    let at = |tick: usize| Vec3::new(0.5, -0.5, -0.5 + 20.0 * TICK * tick as f32);
    for settings in schemes(8) {
        let mut batch = cloth(&fabric, material());
        for tick in 0..4 {
            let pose = |tick| (at(tick), Quat::IDENTITY);
            let ball = Collider {
                from: pose(tick),
                to: pose(tick + 1),
                // Particles alone slip round the ball with Gauss–Seidel.
                features: true,
                ..Collider::fixed(shape.clone(), at(tick), Quat::IDENTITY)
            };
            batch.set_colliders(0, [ball]).expect("good shapes");
            batch.step(TICK, settings);
            let ball = at(tick + 1);
            for at in batch.snapshot(0).positions {
                let (beside, below) = ((at - ball).truncate().length(), at.z < ball.z - 0.05);
                let is_behind = beside < 0.04 && below;
                assert!(!is_behind, "{settings:?}: {at} is behind the ball at {ball}");
            }
        }
    }
}

/// Particles that are far from a fast shape at the beginning of a tick are pulled into it in the same tick by
/// particles that the shape has hit.
#[test]
fn nothing_stays_inside_a_fast_shape() {
    let turned = Quat::from_rotation_x(core::f32::consts::FRAC_PI_4);
    let shapes = [SharedShape::capsule_x(0.2, 0.05), SharedShape::cuboid(0.2, 0.05, 0.05)];
    for shape in shapes {
        let grid = FabricBuilder::grid(Grid::new(65, 65, 1.0, 1.0));
        let fabric = Arc::new(grid.pin_where(|_, uv| uv.y == 0.0).build().expect("good"));
        let mut batch = cloth(
            &fabric,
            FabricMaterial {
                thickness: 0.0,
                warp_stiffness: 1e4,
                weft_stiffness: 1e4,
                shear_stiffness: 200.0,
                ..material()
            },
        );
        batch.drive(0, Drive { air_density: 0.0, ..Drive::default() }).expect("a good drive");
        let at = |tick: usize| Vec3::new(0.5, -0.5, -0.5 + 20.0 * TICK * tick as f32);
        for tick in 0..4 {
            let from = (at(tick), turned);
            let to = (at(tick + 1), turned);
            batch
                .set_colliders(
                    0,
                    [Collider { from, to, ..Collider::fixed(shape.clone(), at(tick), turned) }],
                )
                .expect("good shapes");
            batch.step(TICK, StepSettings { passes: 2, ..StepSettings::yarns(2) });
            for position in batch.snapshot(0).positions {
                let local = turned.inverse() * (position - at(tick + 1));
                let nearest = shape.project_local_point(local, false);
                let depth = if nearest.is_inside { nearest.point.distance(local) } else { 0.0 };
                assert!(depth < 1e-3, "{depth} m inside {:?} in tick {tick}", shape.shape_type());
            }
            // The shape crosses the cloth's plane, z = 0, in tick 1, and drags cloth along.
            let front = batch.snapshot(0).positions.iter().map(|at| at.z).fold(0.0, f32::max);
            let reached = tick == 0 || front > at(tick + 1).z;
            assert!(reached, "{:?} in tick {tick}: {front} m", shape.shape_type());
        }
    }
}

#[test]
fn friction_holds_a_cloth_on_a_slope_and_its_absence_does_not() {
    let slope = 0.3_f32; // rad; tan = 0.31
    let gravity = 9.81 * Vec3::new(libm::sinf(slope), 0.0, -libm::cosf(slope));
    let ground =
        Collider::fixed(SharedShape::halfspace(Vec3::Z), Vec3::Z * -THICKNESS, Quat::IDENTITY);
    for settings in schemes(4) {
        for (friction, holds) in [(0.6, true), (0.0, false)] {
            let fabric = horizontal(9, false);
            let material = FabricMaterial { surface_friction: friction, ..material() };
            let mut batch = cloth(&fabric, material);
            batch
                .drive(0, Drive { gravity, air_density: 0.0, ..Drive::default() })
                .expect("a good drive");
            // The coefficient of a contact is the geometric mean of the cloth's and the collider's.
            batch.set_colliders(0, [Collider { friction, ..ground.clone() }]).expect("good shapes");
            for _ in 0..60 {
                batch.step(TICK, settings);
            }
            let slid = batch.snapshot(0).positions[40].x - 0.5;
            let free = 0.5 * 9.81 * libm::sinf(slope);
            if holds {
                assert!(slid.abs() < 0.01, "{settings:?}: slid {slid} m");
            } else {
                assert!((slid / free - 1.0).abs() < 0.15, "{settings:?}: slid {slid} m of {free}");
            }
        }
    }
}

#[test]
fn a_cloth_that_starts_inside_is_pushed_out_slowly() {
    let fabric = horizontal(9, false);
    let shape = SharedShape::ball(0.2);
    let centre = Vec3::new(0.5, -0.5, -0.1);
    for settings in schemes(4) {
        let mut batch = cloth(&fabric, material());
        batch.drive(0, Drive::NONE).expect("a good drive");
        batch
            .set_colliders(0, [Collider::fixed(shape.clone(), centre, Quat::IDENTITY)])
            .expect("good shapes");
        for _ in 0..30 {
            batch.step(TICK, settings);
        }
        assert!(deepest(&batch, &shape, centre) < 1e-3, "{settings:?}");
        let fastest = batch.snapshot(0).velocities.iter().map(|v| v.length()).fold(0.0, f32::max);
        // A projection whose correction becomes velocity gives 0.1 m × 240 Hz = 24 m/s; the rest is the tension that
        // the push puts into the cloth.
        assert!(fastest < 3.0, "{settings:?}: {fastest} m/s");
    }
}

/// The solver removes the angular momentum about a pole that errors of the constraints cause, but not the
/// angular momentum that a contact causes.
#[test]
fn a_pushed_flag_turns_about_its_pole() {
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric"));
    let mut batch = cloth(&fabric, material());
    batch.drive(0, Drive::NONE).expect("a good drive");
    let shape = SharedShape::cuboid(0.4, 0.6, 0.05);
    let at = |tick: usize| Vec3::new(0.6, -0.5, -0.06 + TICK * tick as f32);
    for tick in 0..6 {
        let [from, to] = [tick, tick + 1].map(|tick| (at(tick), Quat::IDENTITY));
        let plate = Collider { from, to, ..Collider::fixed(shape.clone(), at(tick), to.1) };
        batch.set_colliders(0, [plate]).expect("good shapes");
        batch.step(TICK, StepSettings::yarns(2));
    }
    batch.set_colliders(0, []).expect("good shapes");
    batch.step(TICK, StepSettings::yarns(2));
    let state = batch.snapshot(0);
    let areas = fabric.particle_areas();
    let moving = state.positions.iter().zip(&state.velocities).zip(areas);
    let momentum: f32 = moving.map(|((at, v), area)| area * (at.x * v.z - at.z * v.x)).sum();
    let inertia: f32 = state.positions.iter().zip(areas).map(|(at, area)| area * at.x * at.x).sum();
    // If all of the flag moved at a metre a second, it would turn at 1.5 rad/s.
    let rate = momentum / inertia;
    assert!((1.0..2.0).contains(&rate), "{rate} rad/s");
}

/// A sheet that falls on a floor at 2.4 m/s does not bounce. If the history from which the integrator
/// extrapolates contained the impact, the sheet would rise again at nine tenths of its speed.
#[test]
fn a_sheet_that_falls_on_a_floor_stays_there() {
    for (substeps, passes) in [(1, 4), (2, 2), (4, 2)] {
        let fabric = horizontal(9, false);
        let mut batch = cloth(&fabric, material());
        batch.drive(0, Drive { air_density: 0.0, ..fall() }).expect("a good drive");
        let floor =
            Collider::fixed(SharedShape::halfspace(Vec3::Z), -0.3 * Vec3::Z, Quat::IDENTITY);
        batch.set_colliders(0, [floor]).expect("good shapes");
        let mut fastest = 0.0_f32;
        for _ in 0..40 {
            batch.step(TICK, StepSettings { passes, ..StepSettings::yarns(substeps) });
            let state = batch.snapshot(0);
            let rises = state.velocities.iter().map(|v| v.z).fold(f32::MIN, f32::max);
            fastest = fastest.max(rises);
        }
        assert!(fastest < 0.05, "{substeps} × {passes}: {fastest} m/s");
        let lowest = batch.snapshot(0).positions.iter().map(|p| p.z).fold(f32::MAX, f32::min);
        assert!((lowest + 0.3 - THICKNESS).abs() < 1e-3, "{lowest} m");
    }
}

/// The box of [`ClothBatch::swept_bounds`] contains all particles at the end of the tick, in every layout, and is not
/// much larger than the cloth.
#[test]
fn a_swept_box_contains_the_cloth() {
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric"));
    for &lanes in LaneCount::available() {
        let mut batch = ClothBatch::new(fabric.clone(), lanes);
        let lane = lanes.get() - 1;
        let mut thrown = ClothSnapshot::at_rest(&fabric);
        (0..thrown.velocities.len())
            .filter(|&particle| !fabric.is_pinned(particle))
            .for_each(|particle| thrown.velocities[particle] = Vec3::new(0.0, 1.0, 4.0));
        batch.replace(lane, &thrown, material()).expect("a lane");
        let mut least_room = f32::INFINITY;
        for _ in 0..60 {
            batch.drive(lane, fall()).expect("a good drive");
            let bounds = batch.swept_bounds(TICK);
            assert!(bounds.iter().enumerate().all(|(at, bounds)| bounds.is_some() == (at == lane)));
            let bounds = bounds[lane].expect("a cloth");
            batch.step(TICK, StepSettings::yarns(2));
            for &at in &batch.snapshot(lane).positions {
                let room = (at - bounds.mins).min(bounds.maxs - at).min_element();
                least_room = least_room.min(room);
            }
            assert!(bounds.extents().max_element() < 3.0);
        }
        assert!(least_room >= 0.0, "{lanes:?}: {least_room} m");
        assert!(least_room < 0.2, "{lanes:?}: {least_room} m");
    }
}

/// What drags a sheet that rests by 6 cm in a tick.
#[derive(Clone, Copy, Debug)]
enum Dragging {
    Pins,
    Spring,
    Guide,
}

/// A sheet that rests is dragged by 6 cm in one tick, and a post stands in the way of one of its particles, 3 cm away. Nothing
/// of the sheet's velocity says so when the tick begins.
#[test]
fn cloth_that_is_dragged_from_rest_meets_what_lies_in_the_way() {
    const WAY: Vec3 = Vec3::new(-0.06, 0.0, 0.0);
    /// The particle in the middle of 17 × 17.
    const MIDDLE: usize = 8 * 17 + 8;
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric"));
    let rest = fabric.rest_positions();
    let post = SharedShape::cuboid(0.005, 0.02, 0.2);
    let surface = rest[MIDDLE].x - 0.03;
    let at = Vec3::new(surface - 0.005, rest[MIDDLE].y, 0.0);
    let post = Collider { features: false, ..Collider::fixed(post, at, Quat::IDENTITY) };
    for dragging in [Dragging::Pins, Dragging::Spring, Dragging::Guide] {
        for &lanes in LaneCount::available() {
            let mut batch = ClothBatch::new(fabric.clone(), lanes);
            batch.insert(&ClothSnapshot::at_rest(&fabric), material()).expect("a free lane");
            batch.drive(0, Drive { gravity: Vec3::ZERO, ..Drive::default() }).expect("good");
            batch.set_colliders(0, [post.clone()]).expect("a good shape");
            match dragging {
                Dragging::Pins => {
                    let pins = (0..rest.len()).filter(|&at| fabric.is_pinned(at)).map(|at| {
                        MovingPin { particle: at as u32, from: rest[at], to: rest[at] + WAY }
                    });
                    batch.move_pins(0, pins.collect()).expect("good pins");
                }
                Dragging::Spring => {
                    let place = [rest[MIDDLE], rest[MIDDLE] + WAY];
                    let by = Holder::Spring { place, stiffness: 1e5, max_force: f32::INFINITY };
                    batch.hold(0, vec![Hold { particle: MIDDLE as u32, by }]).expect("good");
                }
                Dragging::Guide => {
                    // The others follow, so that the post strains no link.
                    let guide = |(particle, at): (usize, &Vec3)| Guide {
                        places: [*at, *at + WAY],
                        normals: [Vec3::Z; 2],
                        max_distance: if particle == MIDDLE { 0.0 } else { 1.0 },
                        backstop: Backstop::default(),
                    };
                    let guides = rest.iter().enumerate().map(guide).collect();
                    batch.set_guides(0, guides).expect("good");
                }
            }
            let bounds = batch.swept_bounds(TICK)[0].expect("a cloth");
            batch.step(TICK, StepSettings::yarns(2));
            let after = batch.snapshot(0).positions;
            let outside = |at: &&Vec3| (**at - at.clamp(bounds.mins, bounds.maxs)).length() > 1e-5;
            assert_eq!(after.iter().find(outside), None, "{dragging:?} {bounds:?}");
            let x = after[MIDDLE].x;
            assert!(x > surface, "{dragging:?}: {} m beyond", surface - x);
            // It was dragged up to the post.
            assert!(x < surface + 0.01, "{dragging:?}: {} m before", x - surface);
        }
    }
}

/// Moves a ball of 2.5 cm at 20 m/s at a curtain of 33 × 33 particles, with 62 mm between them, in each width; returns
/// the state after some ticks.
fn curtain_and_small_ball(lanes: LaneCount, features: bool) -> ClothSnapshot {
    let grid = FabricBuilder::grid(Grid::new(33, 33, 2.0, 2.0)).pin(0..33);
    let fabric = Arc::new(grid.build().expect("a good fabric"));
    let mut batch = ClothBatch::new(fabric.clone(), lanes);
    let lane = lanes.get() - 1;
    batch.replace(lane, &ClothSnapshot::at_rest(&fabric), material()).expect("a lane");
    batch.drive(lane, Drive::NONE).expect("a good drive");
    // The ball flies at the middle of a cell.
    let at = |tick: usize| Vec3::new(1.03, -1.03, 20.0 * TICK * (tick as f32 - 1.4));
    for tick in 0..4 {
        let [from, to] = [tick, tick + 1].map(|tick| (at(tick), Quat::IDENTITY));
        let shape = SharedShape::ball(0.025);
        let ball = Collider { from, to, features, ..Collider::fixed(shape, from.0, from.1) };
        batch.set_colliders(lane, [ball]).expect("good shapes");
        batch.step(TICK, StepSettings::default());
    }
    batch.snapshot(lane)
}

#[test]
fn a_small_fast_ball_does_not_pass_between_particles() {
    // Cells around the middle are carried ahead of the ball, which ends at 0.87 m.
    let front = |features: bool| {
        let state = curtain_and_small_ball(LaneCount::One, features);
        state.positions.iter().map(|at| at.z).fold(f32::MIN, f32::max)
    };
    let (with, without) = (front(true), front(false));
    assert!(with > 0.86, "{with} m");
    assert!(without < 0.01, "{without} m");
}

#[test]
fn triangle_contacts_have_the_same_bits_at_every_width() {
    let bits = |lanes| {
        let state = curtain_and_small_ball(lanes, true);
        let vectors = state.positions.into_iter().chain(state.velocities);
        vectors.map(|vector| vector.to_array().map(f32::to_bits)).collect::<Vec<_>>()
    };
    let one = bits(LaneCount::One);
    assert!(LaneCount::available().iter().all(|&lanes| bits(lanes) == one));
}

/// Shapes of every kind of which contacts are solved in lanes, and others.
fn shapes() -> [SharedShape; 8] {
    [
        SharedShape::ball(0.2),
        SharedShape::halfspace(Vec3::new(0.0, 0.6, 0.8)),
        SharedShape::cuboid(0.15, 0.2, 0.1),
        SharedShape::capsule(Vec3::new(-0.3, 0.0, 0.0), Vec3::new(0.2, 0.1, 0.1), 0.1),
        SharedShape::round_cuboid(0.1, 0.15, 0.1, 0.05),
        SharedShape::cylinder(0.3, 0.1),
        SharedShape::round_cylinder(0.3, 0.1, 0.03),
        SharedShape::cone(0.2, 0.2),
    ]
}

/// Sheets that fall on two moving shapes each. Cloths that share a batch touch other kinds in other orders.
#[test]
fn every_kind_of_shape_gives_the_same_bits_at_every_width() {
    let fabric = horizontal(9, false);
    let shapes = shapes();
    let colliders = |seed: usize, tick: usize| {
        let place = |time: f32, side: f32| {
            let turn = Quat::from_rotation_y(0.3 * seed as f32 + 0.5 * time);
            (Vec3::new(0.5 + 0.3 * side, -0.4 + 0.2 * time, -0.3), turn)
        };
        let [from, to] = [tick, tick + 1].map(|tick| tick as f32 * TICK);
        let of = |shape: usize, side: f32| {
            let shape = shapes[shape % shapes.len()].clone();
            let (from, to) = (place(from, side), place(to, side));
            Collider { from, to, ..Collider::fixed(shape, from.0, from.1) }
        };
        [of(seed, -1.0), of(3 * seed + 1, 1.0)]
    };
    let states = |lanes: LaneCount, seeds: &[usize]| -> Vec<Vec<u32>> {
        let mut batch = ClothBatch::new(fabric.clone(), lanes);
        for _ in seeds {
            let lane = batch.insert(&ClothSnapshot::at_rest(&fabric), material()).expect("a lane");
            batch.drive(lane, fall()).expect("a good drive");
        }
        for tick in 0..40 {
            for (lane, &seed) in seeds.iter().enumerate() {
                batch.set_colliders(lane, colliders(seed, tick)).expect("good shapes");
            }
            batch.step(TICK, StepSettings::default());
        }
        let bits = |state: ClothSnapshot| -> Vec<u32> {
            assert!(state.is_finite());
            let vectors = state.positions.into_iter().chain(state.velocities);
            vectors.flat_map(|vector| vector.to_array().map(f32::to_bits)).collect()
        };
        (0..seeds.len()).map(|lane| bits(batch.snapshot(lane))).collect()
    };
    let seeds: Vec<usize> = (0..16).collect();
    let alone: Vec<_> = seeds.iter().flat_map(|&seed| states(LaneCount::One, &[seed])).collect();
    for &lanes in LaneCount::available() {
        let batches = seeds.chunks(lanes.get());
        let together: Vec<_> = batches.flat_map(|seeds| states(lanes, seeds)).collect();
        for seed in &seeds {
            assert!(alone[*seed] == together[*seed], "{lanes:?}, cloth {seed}");
        }
    }
}

/// Lines pull a sheet that hangs over a ball into it. Contacts at the end of a substep alone strain it by 8 %.
#[test]
fn contacts_after_each_pass_leave_a_sheet_on_a_ball_unstrained() {
    let fabric = horizontal(33, false);
    let mut batch = cloth(&fabric, FabricMaterial::COTTON);
    let at = Vec3::new(0.5, -0.5, -0.32);
    let ball = Collider::fixed(SharedShape::ball(0.3), at, Quat::IDENTITY);
    batch.set_colliders(0, [ball]).expect("a good shape");
    let mut greatest = 0.0_f32;
    for tick in 0..240 {
        batch.step(TICK, StepSettings::default());
        if tick < 120 {
            continue;
        }
        let positions = batch.snapshot(0).positions;
        let straight = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
        let mut strains: Vec<f32> = straight
            .map(|link| {
                let [from, to] = link.particles.map(|end| positions[end as usize]);
                (from.distance(to) / link.rest_length - 1.0).abs()
            })
            .collect();
        strains.sort_by(f32::total_cmp);
        greatest = greatest.max(strains[strains.len() * 999 / 1000]);
    }
    assert!(greatest < 0.04, "{greatest}");
}

/// The impulses on a floor are the sheet's weight times the tick at rest, and its momentum as it lands.
#[test]
fn reactions_are_the_impulses_on_the_collider() {
    for settings in [StepSettings::default(), StepSettings::yarns(4)] {
        let fabric = horizontal(9, false);
        let mut batch = cloth(&fabric, material());
        batch.drive(0, Drive { air_density: 0.0, ..fall() }).expect("a good drive");
        let shape = SharedShape::halfspace(Vec3::Z);
        let floor = Collider {
            reports_as: Some(7),
            ..Collider::fixed(shape.clone(), -0.1 * Vec3::Z, Quat::IDENTITY)
        };
        let silent = Collider::fixed(shape, -5.0 * Vec3::Z, Quat::IDENTITY);
        batch.set_colliders(0, [silent, floor]).expect("good shapes");
        let mut total = Vec3::ZERO;
        let ticks = 120;
        for tick in 0..ticks {
            batch.step(TICK, settings);
            let reactions: Vec<_> = batch.reactions(0).collect();
            assert!(reactions.len() == 1 && reactions[0].collider == 7);
            total += reactions[0].impulse;
            let is_down = tick > 60;
            assert!(!is_down || (reactions[0].area - 1.0).abs() < 1e-5, "{settings:?}");
            // The middle of the sheet is at (0.5, −0.5), the floor's origin at (0, 0).
            let arm = Vec3::new(0.5, -0.5, 0.0).cross(reactions[0].impulse);
            let off = reactions[0].angular_impulse - arm;
            let length = reactions[0].impulse.length();
            assert!(!is_down || off.length() < 0.01 * length, "{settings:?}: {off}");
        }
        let weight = material().area_density * 9.81 * TICK * ticks as f32;
        let error = (total + weight * Vec3::Z).length() / weight;
        assert!(error < 0.02, "{settings:?}: {total} N·s, not {weight} down");
    }
}
