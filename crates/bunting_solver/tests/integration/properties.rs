//! Properties that hold of any input: nothing panics, and what is wrong in one lane changes no bit of another one. Each run tries
//! the same inputs; `PROPTEST_RNG_SEED` and `PROPTEST_CASES` try others, and more.

use std::env;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, OnceLock};

use bunting_solver::{
    Backstop, ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial,
    FrameMotion, Grid, Guide, Hold, Holder, Lacing, LaneCount, MeshPoint, MovingPin, Pressure,
    Resolution, Seams, SelfCollision, StepSettings, Stitch,
};
use glam::{Quat, Vec2, Vec3};
use parry3d::shape::SharedShape;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

const TICK: f32 = 1.0 / 60.0;

/// Numbers at which arithmetic breaks.
const SPECIAL: [f32; 12] = [
    0.0,
    -0.0,
    1.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN_POSITIVE,
    1e-42,
    1e-12,
    1e12,
    1e25,
];

/// Checks a property of so many inputs at random, and of ever simpler ones once it does not hold: a panic shows the simplest.
fn for_all<S: Strategy>(cases: u32, inputs: S, property: impl Fn(S::Value)) {
    let asked = |name: &str| env::var(name).ok().and_then(|asked| asked.parse::<u64>().ok());
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&asked("PROPTEST_RNG_SEED").unwrap_or(1).to_le_bytes());
    let cases = asked("PROPTEST_CASES").map_or(cases, |asked| asked as u32);
    let config = Config { failure_persistence: None, ..Config::with_cases(cases) };
    let random = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let held = TestRunner::new_with_rng(config, random).run(&inputs, |input| {
        panic::catch_unwind(AssertUnwindSafe(|| property(input)))
            .map_err(|_| TestCaseError::fail("it panics, as told above"))
    });
    held.unwrap_or_else(|failure| panic!("{failure}"));
}

fn number() -> BoxedStrategy<f32> {
    prop_oneof![
        16 => (-3..3_i32, 1_f32..10.0, any::<u8>())
            .prop_map(|(power, part, sign)| part * 10_f32.powi(power) * if sign < 50 { -1.0 } else { 1.0 }),
        3 => select(&SPECIAL[..]),
        1 => any::<u32>().prop_map(f32::from_bits),
    ].boxed()
}

fn vector() -> BoxedStrategy<Vec3> {
    prop_oneof![
        4 => [-1_f32..1.0, -1.0..1.0, -1.0..1.0].prop_map(Vec3::from_array),
        1 => [number(), number(), number()].prop_map(Vec3::from_array),
    ]
    .boxed()
}

fn turn() -> BoxedStrategy<Quat> {
    prop_oneof![
        4 => Just(Quat::IDENTITY),
        1 => [-1_f32..1.0, -1.0..1.0, -1.0..1.0, 0.1..1.0]
            .prop_map(|it| Quat::from_array(it).normalize()),
        1 => [number(), number(), number(), number()].prop_map(Quat::from_array),
    ]
    .boxed()
}

fn pose() -> BoxedStrategy<(Vec3, Quat)> {
    (vector(), turn()).boxed()
}

/// What a batch is told of one of its cloths.
#[derive(Clone, Debug)]
enum Told {
    Drive(Drive),
    Pins(Vec<MovingPin>),
    Guides(Guide, usize),
    Winds(Vec3, usize),
    Air(Option<Pressure>),
    Colliders(Vec<Collider>),
    Holds(Vec<Hold>),
    Sewn(Vec<Stitch>, Lacing),
    Layers(f32),
    Material(usize, f32),
    Restored(Vec3, Vec3, usize),
    Particle(usize, Vec3, Vec3),
    Step,
}

/// Lists of as many elements as there are particles, or not.
fn count() -> BoxedStrategy<usize> {
    prop_oneof![4 => Just(PARTICLES), 1 => 0..60_usize].boxed()
}

/// Columns and rows of the cloths.
const COLUMNS: u32 = 9;
const ROWS: u32 = 5;
const PARTICLES: usize = (COLUMNS * ROWS) as usize;

fn told() -> BoxedStrategy<Told> {
    let particle = || 0..PARTICLES as u32 + 2;
    let drive = (pose(), vector(), vector(), number()).prop_map(
        |((translation, rotation), gravity, wind, air_density)| Drive {
            motion: FrameMotion { translation, rotation },
            gravity,
            wind,
            air_density,
        },
    );
    let pin = (particle(), vector(), vector()).prop_map(|(particle, from, to)| MovingPin {
        particle,
        from,
        to,
    });
    let guide = ([vector(), vector()], [vector(), vector()], [number(), number(), number()])
        .prop_map(|(places, normals, [max_distance, distance, radius])| Guide {
            places,
            normals,
            max_distance,
            backstop: Backstop { distance, radius },
        });
    let air = prop_oneof![
        number().prop_map(|pressure| Pressure::Constant { pressure }),
        (number(), number()).prop_map(|(pressure, ambient)| Pressure::Sealed { pressure, ambient }),
        number().prop_map(|coefficient| Pressure::Canopy { coefficient }),
    ];
    let shape = prop_oneof![
        (0.01_f32..1.0).prop_map(SharedShape::ball),
        (0.01_f32..1.0, 0.01_f32..1.0)
            .prop_map(|(half, radius)| SharedShape::capsule_y(half, radius)),
        [0.01_f32..1.0, 0.01..1.0, 0.01..1.0].prop_map(|[x, y, z]| SharedShape::cuboid(x, y, z)),
        Just(SharedShape::halfspace(Vec3::Y)),
    ];
    let collider = (shape, pose(), pose(), number(), number(), any::<bool>()).prop_map(
        |(shape, from, to, margin, friction, features)| Collider {
            from,
            to,
            margin,
            friction,
            features,
            ..Collider::fixed(shape, Vec3::ZERO, Quat::IDENTITY)
        },
    );
    let spring = ([vector(), vector()], number(), number())
        .prop_map(|(place, stiffness, max_force)| Holder::Spring { place, stiffness, max_force });
    let ring = (vec(vector(), 0..4), [pose(), pose()], number(), number()).prop_map(
        |(rail, pose, mass, friction)| Holder::Ring { rail: rail.into(), pose, mass, friction },
    );
    let hold =
        (particle(), prop_oneof![spring, ring]).prop_map(|(particle, by)| Hold { particle, by });
    let stitch =
        (particle(), [particle(), particle()], prop_oneof![3 => 0_f32..1.0, 1 => number()])
            .prop_map(|(particle, onto, part)| Stitch { particle, onto, part });
    // Where it is as large as cloth, all of it touches all of it, which takes long.
    let thickness =
        prop_oneof![2 => 1e-4_f32..0.02, 1 => select(vec![f32::NAN, f32::INFINITY, -1.0, 0.0])];
    prop_oneof![
        1 => drive.prop_map(Told::Drive),
        1 => vec(pin, 0..4).prop_map(Told::Pins),
        1 => (guide, count()).prop_map(|(guide, count)| Told::Guides(guide, count)),
        1 => (vector(), count()).prop_map(|(wind, count)| Told::Winds(wind, count)),
        1 => prop_oneof![3 => air.prop_map(Some), 1 => Just(None)].prop_map(Told::Air),
        1 => vec(collider, 0..3).prop_map(Told::Colliders),
        1 => vec(hold, 0..4).prop_map(Told::Holds),
        1 => (vec(stitch, 0..4), 0..6_usize, number(), number()).prop_map(
            |(stitches, end, length, closing)| {
                Told::Sewn(stitches, Lacing { stitches: 0..end, length, closing })
            }
        ),
        1 => thickness.prop_map(Told::Layers),
        1 => (0..11_usize, number()).prop_map(|(field, number)| Told::Material(field, number)),
        1 => (vector(), vector(), count())
            .prop_map(|(at, velocity, count)| Told::Restored(at, velocity, count)),
        1 => (0..PARTICLES, vector(), vector())
            .prop_map(|(particle, at, velocity)| Told::Particle(particle, at, velocity)),
        4 => Just(Told::Step),
    ]
    .boxed()
}

/// A fabric that is a grid, or a net.
fn fabric(is_grid: bool) -> Arc<Fabric> {
    static BOTH: OnceLock<[Arc<Fabric>; 2]> = OnceLock::new();
    let both = BOTH.get_or_init(|| {
        let grid = FabricBuilder::grid(Grid::new(COLUMNS, ROWS, 1.0, 0.6));
        let taper = |at: &Vec3| Vec3::new(at.x * (1.0 + 0.5 * at.y), at.y, 0.0);
        let tapered = grid.positions().iter().map(taper).collect();
        let net = FabricBuilder::new(tapered, grid.indices().to_vec());
        let net = net.pin_where(|at, _| at.y == 0.0).resampled(Resolution::Particles(60));
        let grid = grid.pin_where(|at, _| at.x == 0.0).build().expect("a grid");
        [Arc::new(grid), net.expect("a net").fabric]
    });
    Arc::clone(&both[usize::from(!is_grid)])
}

/// Tells a batch. It may refuse.
fn tell(batch: &mut ClothBatch, lane: usize, told: &Told, settings: StepSettings) {
    let fabric = Arc::clone(batch.fabric());
    let own = fabric.particle_count();
    // A list of as many as the grid has particles is as long as those of the fabric.
    let of_fabric = |count: usize| if count == PARTICLES { own } else { count };
    let mut material = FabricMaterial::SILK;
    _ = match told.clone() {
        Told::Drive(drive) => batch.drive(lane, drive),
        Told::Pins(pins) => batch.move_pins(lane, pins),
        Told::Guides(guide, count) => batch.set_guides(lane, vec![guide; of_fabric(count)]),
        Told::Winds(wind, count) => batch.set_local_wind(lane, vec![wind; of_fabric(count)]),
        Told::Air(air) => batch.set_pressure(lane, air),
        Told::Colliders(colliders) => batch.set_colliders(lane, colliders),
        Told::Holds(holds) => batch.hold(lane, holds),
        Told::Sewn(stitches, lacing) => Seams::new(&fabric, &stitches)
            .and_then(|seams| batch.sew(lane, &Arc::new(seams), vec![lacing])),
        Told::Layers(thickness) => {
            batch.set_self_collision(lane, Some(SelfCollision { thickness }))
        }
        Told::Material(field, number) => {
            let fields = [
                &mut material.area_density,
                &mut material.warp_stiffness,
                &mut material.weft_stiffness,
                &mut material.shear_stiffness,
                &mut material.bend_stiffness,
                &mut material.damping,
                &mut material.internal_damping,
                &mut material.pressure_coefficient,
                &mut material.friction_coefficient,
                &mut material.thickness,
                &mut material.surface_friction,
            ];
            *fields.into_iter().nth(field).expect("a field") = number;
            batch.set_material(lane, material)
        }
        Told::Restored(at, velocity, count) => {
            let mut state = batch.snapshot(lane);
            state.positions.resize(of_fabric(count), at);
            state.velocities.fill(velocity);
            batch.restore(lane, &state)
        }
        Told::Particle(particle, at, velocity) => {
            if let Some(mut particles) = batch.particles_mut(lane) {
                particles.set_position(particle % own, at);
                particles.add_velocity(particle % own, velocity);
            }
            Ok(())
        }
        Told::Step => {
            batch.step(TICK, settings);
            Ok(())
        }
    };
}

/// The bits of a cloth after some ticks in a batch of eight, in another lane of which another cloth is told something.
fn beside(fabric: &Arc<Fabric>, settings: StepSettings, told: &[Told]) -> Vec<[u32; 3]> {
    const OWN: usize = 0;
    const OTHER: usize = 3;
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::Eight);
    let start = ClothSnapshot::at_rest(fabric);
    for lane in [OWN, OTHER] {
        batch.replace(lane, &start, FabricMaterial::COTTON).expect("a good material");
    }
    let wind = Vec3::new(1.0, 0.0, 4.0);
    batch.drive(OWN, Drive { wind, ..Drive::default() }).expect("a good drive");
    let steps = told.iter().filter(|it| matches!(it, Told::Step)).count();
    told.iter().for_each(|it| tell(&mut batch, OTHER, it, settings));
    // As many in sum, whatever was told.
    (steps..TICKS).for_each(|_| batch.step(TICK, settings));
    batch.compute_normals();
    let state = batch.snapshot(OWN);
    state.positions.iter().map(|at| at.to_array().map(f32::to_bits)).collect()
}

/// Ticks of a cloth beside another one.
const TICKS: usize = 16;

/// Any triangles of any vertices.
fn soup() -> BoxedStrategy<FabricBuilder> {
    let corners = prop_oneof![3 => vec([0..8_u32, 0..8, 0..8], 0..8), 1 => vec([0..20_u32, 0..20, 0..20], 0..4)];
    let uv = prop_oneof![2 => Just(0), 1 => Just(8), 1 => 0..20_usize];
    let point = ([0..9_u32, 0..9, 0..9], [number(), number(), number()])
        .prop_map(|(vertices, weights)| MeshPoint { vertices, weights });
    let merged = prop_oneof![3 => Just(Vec::new()), 1 => vec(0..9_u32, 8)];
    let distance = prop_oneof![3 => Just(None), 1 => number().prop_map(Some)];
    (vec(vector(), 8), corners, uv, vec(0..9_u32, 0..3), vec(point, 0..2), merged, distance)
        .prop_map(|(positions, corners, uvs, pins, points, merged, distance)| {
            let texture = positions.iter().cycle().take(uvs).map(|at| Vec2::new(at.x, at.y));
            let mesh =
                FabricBuilder::new(positions.clone(), corners.into_iter().flatten().collect())
                    .uv(texture.collect())
                    .pin(pins)
                    .pin_points(points);
            let mesh = if merged.is_empty() { mesh } else { mesh.merge(merged) };
            distance.map_or(mesh.clone(), |distance| mesh.weld_distance(distance))
        })
        .boxed()
}

#[test]
fn what_one_cloth_is_told_changes_no_bit_of_another() {
    let inputs = (any::<bool>(), any::<bool>(), vec(told(), 1..TICKS));
    for_all(96, inputs, |(is_grid, is_plain, told)| {
        let settings =
            if is_plain { StepSettings::gauss_seidel(3) } else { StepSettings::yarns(2) };
        let fabric = fabric(is_grid);
        let alone = beside(&fabric, settings, &[]);
        assert!(beside(&fabric, settings, &told) == alone, "the cloth beside it");
    });
}

#[test]
fn any_triangles_are_a_fabric_or_an_error() {
    let inputs = (soup(), 0..80_u32);
    for_all(256, inputs, |(mesh, particles)| {
        let fabrics = [
            mesh.clone().build().map(Arc::new).ok(),
            mesh.resampled(Resolution::Particles(particles)).map(|it| it.fabric).ok(),
            mesh.coarser().and_then(|mesh| mesh.builder.build().ok()).map(Arc::new),
        ];
        for fabric in fabrics.into_iter().flatten() {
            assert!(fabric.rest_positions().iter().all(|at| at.is_finite()));
            assert!(fabric.links().iter().all(|link| link.rest_length.is_finite()));
            let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
            batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::COTTON).expect("a lane");
            (0..3).for_each(|_| batch.step(TICK, StepSettings::yarns(2)));
        }
    });
}
