//! Meshes that are simulated with particles of their own.

use std::f32::consts::TAU;
use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricError, FabricMaterial,
    Grid, LaneCount, LevelTransfer, LinkFamily, MovingPin, Resampled, Resolution, StepLimits,
};
use glam::{Quat, Vec2, Vec3};
use parry3d::shape::SharedShape;

const TICK: f32 = 1.0 / 60.0;

/// Triangles around the skirt's waist, and from there to the hem.
const AROUND: u32 = 30;
const DOWN: u32 = 20;

/// A skirt that widens from its waist, which is held, with a seam. Its inner vertices are moved by up to a part of a cell, and its
/// cells are cut either way.
fn skirt(moved: f32) -> FabricBuilder {
    let mut state = 1_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 8_388_608.0 - 1.0
    };
    let (mut positions, mut uv, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..=DOWN {
        for column in 0..=AROUND {
            let is_inner = (1..DOWN).contains(&row) && (1..AROUND).contains(&column);
            let [across, down] =
                if is_inner { [random(), random()].map(|by| moved * by) } else { [0.0; 2] };
            let (turn, along) =
                ((column as f32 + across) / AROUND as f32, (row as f32 + down) / DOWN as f32);
            let radius = 0.15 + 0.2 * along;
            let (sin, cos) = libm::sincosf(TAU * (turn % 1.0));
            positions.push(Vec3::new(radius * cos, -0.6 * along, radius * sin));
            uv.push(Vec2::new(turn, along));
        }
    }
    for row in 0..DOWN {
        for column in 0..AROUND {
            let a = row * (AROUND + 1) + column;
            let [b, c, d] = [a + AROUND + 1, a + AROUND + 2, a + 1];
            indices.extend(if random() < 0.0 { [a, d, b, b, d, c] } else { [a, d, c, a, c, b] });
        }
    }
    FabricBuilder::new(positions, indices).uv(uv).weld_distance(1e-4).pin_where(|_, uv| uv.y == 0.0)
}

fn resampled(builder: &FabricBuilder, resolution: Resolution) -> Resampled {
    builder.resampled(resolution).expect("a good mesh")
}

fn begun(fabric: &Arc<Fabric>, lanes: LaneCount, material: FabricMaterial) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("room");
    batch
}

fn strains<'a>(fabric: &'a Fabric, positions: &'a [Vec3]) -> impl Iterator<Item = f32> + 'a {
    let links = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    links.map(|link| {
        let [a, b] = link.particles.map(|at| positions[at as usize]);
        a.distance(b) / link.rest_length - 1.0
    })
}

fn areas<'a>(fabric: &'a Fabric, positions: &'a [Vec3]) -> impl Iterator<Item = f32> + 'a {
    let area = |corners: &[u32; 3], of: &[Vec3]| {
        let [a, b, c] = corners.map(|at| of[at as usize]);
        (b - a).cross(c - a).length()
    };
    let rest = fabric.rest_positions();
    fabric.triangles().iter().map(move |it| area(it, positions) / area(it, rest))
}

#[test]
fn the_vertices_follow_from_their_own_places() {
    let builder = skirt(0.3);
    for resolution in
        [Resolution::Particles(630), Resolution::CellSize(0.05), Resolution::CellSize(0.015)]
    {
        let Resampled { fabric, carried, .. } = resampled(&builder, resolution);
        let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
        let moved = |at: &Vec3| turn * *at + Vec3::new(0.3, -1.0, 2.0);
        let particles: Vec<Vec3> = fabric.rest_positions().iter().map(moved).collect();
        let positions = carried.positions(&particles);
        // Pinned vertices between pinned particles are held aside of these by a constant.
        let waist = AROUND as usize + 1;
        for (vertex, (at, rest)) in positions.iter().zip(builder.positions()).enumerate() {
            let limit = if vertex < waist { 5e-3 } else { 1e-5 };
            assert!(at.distance(moved(rest)) < limit, "{resolution:?}, vertex {vertex}");
            assert_eq!(carried.position(vertex, &particles), *at);
        }
        let at_rest = carried.positions(fabric.rest_positions());
        for (vertex, (at, rest)) in at_rest.iter().zip(builder.positions()).enumerate() {
            assert!(at.distance(*rest) < 1e-5, "{resolution:?}, vertex {vertex}");
        }
    }
}

#[test]
fn cells_are_as_large_as_asked() {
    let builder = skirt(0.3);
    let area = resampled(&builder, Resolution::Particles(600)).fabric.area();
    for size in [0.06, 0.03, 0.015] {
        let fabric = resampled(&builder, Resolution::CellSize(size)).fabric;
        let cells = fabric.triangles().len() as f32 / 2.0;
        let expected = area / (size * size);
        assert!((cells / expected - 1.0).abs() < 0.2, "{cells} of {expected} cells of {size} m");
        // Lines of a skirt end where it gets narrower.
        let straight = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
        let longest = straight.map(|link| link.rest_length).fold(0.0, f32::max);
        assert!(longest < 3.0 * size, "{longest} m in cells of {size} m");
        assert!((fabric.area() / area - 1.0).abs() < 0.03, "{} of {area} m²", fabric.area());
    }
    let count = resampled(&builder, Resolution::Particles(600)).fabric.particle_count();
    assert!((480..720).contains(&count), "{count}");
}

#[test]
fn pinned_vertices_have_pinned_particles() {
    let builder = skirt(0.3);
    for size in [0.06, 0.015] {
        let Resampled { fabric, corners, .. } = resampled(&builder, Resolution::CellSize(size));
        let particles = fabric.particle_of_vertex();
        assert_eq!(
            (particles.len(), corners.len()),
            (builder.positions().len(), fabric.particle_count())
        );
        for (at, &particle) in builder.positions().iter().zip(particles) {
            let rest = fabric.rest_positions()[particle as usize];
            assert!(rest.distance(*at) < 1.5 * size, "{at}, and its particle at {rest}");
            assert_eq!(fabric.is_pinned(particle as usize), at.y == 0.0 || rest.y == 0.0);
            assert!(at.y < 0.0 || rest.y == 0.0, "{at} is pinned, and its particle at {rest}");
        }
        let pins = (0..fabric.particle_count()).filter(|particle| fabric.is_pinned(*particle));
        assert!(pins.count() >= 8);
    }
}

/// Also those that lie between others, where there is no particle.
#[test]
fn pinned_vertices_stay_where_they_are_held() {
    let builder = skirt(0.3);
    for size in [0.06, 0.1] {
        let Resampled { fabric, carried, .. } = resampled(&builder, Resolution::CellSize(size));
        let mut moved = fabric.rest_positions().to_vec();
        let free = (0..moved.len()).filter(|particle| !fabric.is_pinned(*particle));
        free.for_each(|particle| moved[particle] += Vec3::new(0.1, -0.2, 0.3));
        let positions = carried.positions(&moved);
        for (vertex, (at, rest)) in positions.iter().zip(builder.positions()).enumerate() {
            assert!(rest.y < 0.0 || at.distance(*rest) < 1e-6, "vertex {vertex}: {at} for {rest}");
        }
    }
}

/// The mean size of the strain is that of the material, and no triangle is folded into itself.
#[test]
fn a_hung_skirt_is_strained_as_its_material() {
    let Resampled { fabric, carried, .. } = resampled(&skirt(0.3), Resolution::Particles(630));
    let material = FabricMaterial {
        warp_stiffness: 1e4,
        weft_stiffness: 1e4,
        damping: 2.0,
        ..FabricMaterial::FLAG_POLYESTER
    };
    let mut batch = begun(&fabric, LaneCount::One, material);
    (0..300).for_each(|_| batch.step(TICK, StepLimits::default()));
    let mut positions = Vec::new();
    batch.copy_positions(0, &mut positions);
    let sizes: Vec<f32> = strains(&fabric, &positions).map(f32::abs).collect();
    let mean = sizes.iter().sum::<f32>() / sizes.len() as f32;
    assert!(mean < 1e-3, "a mean strain of {mean}");
    let least = areas(&fabric, &positions).fold(f32::INFINITY, f32::min);
    assert!(least > 0.95, "a triangle with {least} of its area");
    let mut velocities = Vec::new();
    batch.copy_velocities(0, &mut velocities);
    let fastest = velocities.iter().map(|v| v.length()).fold(0.0, f32::max);
    assert!(fastest < 5e-3, "{fastest} m/s at rest");
    let hem = carried.positions(&positions).iter().map(|at| at.y).fold(0.0, f32::min);
    assert!((-0.65..-0.6).contains(&hem), "the hem hangs at {hem} m");
}

/// How far the upper edge of a sheet of a metre hangs through after one of its two upper corners has moved 40 cm towards the
/// other one, m.
fn depth_of_fold(fabric: &Arc<Fabric>, pin: u32) -> f32 {
    let material = FabricMaterial { damping: 2.0, ..FabricMaterial::SILK };
    let mut batch = begun(fabric, LaneCount::One, material);
    let mut from = fabric.rest_positions()[pin as usize];
    for tick in 0..360 {
        // A draught, so that it leaves its plane.
        let wind = if tick < 60 { Vec3::Z } else { Vec3::ZERO };
        batch.drive(0, Drive { wind, ..Drive::default() }).expect("a good drive");
        let to = Vec3::X * (1.0 - 0.4 * (tick as f32 / 120.0).min(1.0));
        batch.move_pins(0, vec![MovingPin { particle: pin, from, to }]).expect("a pin");
        from = to;
        batch.step(TICK, StepLimits::default());
    }
    let mut positions = Vec::new();
    batch.copy_positions(0, &mut positions);
    assert_eq!(positions[pin as usize], from);
    let upper = fabric.rest_positions().iter().zip(&positions).filter(|(rest, _)| rest.y == 0.0);
    upper.map(|(_, at)| -at.y).fold(0.0, f32::max)
}

/// The coarse cape of a game drapes: its triangles alone could not.
#[test]
fn a_mesh_of_few_triangles_hangs_in_folds() {
    // Eight triangles of half a metre, held at two corners.
    let place = |at: u32| Vec3::new((at % 3) as f32, -((at / 3) as f32), 0.0) * 0.5;
    let quads = [0, 1, 3, 4].map(|a| [a, a + 3, a + 4, a, a + 4, a + 1]);
    let builder = FabricBuilder::new((0..9).map(place).collect(), quads.concat()).pin([0, 2]);
    let fabric = resampled(&builder, Resolution::CellSize(0.05)).fabric;
    let particles = fabric.particle_of_vertex();
    assert!(fabric.particle_count() > 400);
    let rest = [0, 2].map(|vertex| fabric.rest_positions()[particles[vertex] as usize]);
    assert_eq!(rest, [Vec3::ZERO, Vec3::X]);
    let grid = FabricBuilder::grid(Grid::new(21, 21, 1.0, 1.0)).pin([0, 20]);
    let grid = Arc::new(grid.build().expect("a good grid"));
    let [found, of_grid] =
        [(&fabric, particles[2]), (&grid, 20)].map(|(of, pin)| depth_of_fold(of, pin));
    assert!(of_grid > 0.1 && (found - of_grid).abs() < 0.03, "{found}, of a grid {of_grid}");
}

#[test]
fn the_bits_are_those_of_any_width() {
    let Resampled { fabric, .. } = resampled(&skirt(0.3), Resolution::Particles(400));
    let ball = Collider::fixed(SharedShape::ball(0.12), Vec3::new(0.1, -0.5, 0.05), Quat::IDENTITY);
    let stiff = FabricMaterial { bend_stiffness: 1.0, ..FabricMaterial::FLAG_POLYESTER };
    for material in [FabricMaterial::FLAG_POLYESTER, stiff] {
        for touches in [false, true] {
            let flown = |lanes: LaneCount, winds: &[f32]| {
                let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
                for &wind in winds {
                    let lane =
                        batch.insert(&ClothSnapshot::at_rest(&fabric), material).expect("room");
                    let wind = Vec3::new(wind, 0.0, 4.0);
                    batch.drive(lane, Drive { wind, ..Drive::default() }).expect("a lane");
                    let colliders = if touches { vec![ball.clone()] } else { Vec::new() };
                    batch.set_colliders(lane, colliders).expect("a ball");
                }
                (0..30).for_each(|_| batch.step(TICK, StepLimits::default()));
                let (last, mut normals) = (winds.len() - 1, Vec::new());
                batch.copy_normals(last, &mut normals);
                (batch.snapshot(last), normals)
            };
            let alone = flown(LaneCount::One, &[6.0]);
            assert!(alone.0.is_finite());
            assert!(alone == flown(LaneCount::Eight, &[3.0, -2.0, 6.0]), "in eight lanes");
            assert!(alone == flown(LaneCount::Sixteen, &[9.0, 6.0]), "in sixteen lanes");
        }
    }
}

#[test]
fn levels_of_one_surface_agree_at_rest_and_keep_the_momentum() {
    let builder = skirt(0.3);
    let [fine, coarse] = [0.03, 0.06].map(|size| resampled(&builder, Resolution::CellSize(size)));
    assert!(3 * coarse.fabric.particle_count() < fine.fabric.particle_count());
    let transfer = LevelTransfer::of_surface(&fine.fabric, &coarse.fabric).expect("one surface");
    let material = FabricMaterial::FLAG_POLYESTER;
    let at_rest = |of: &Resampled| ClothSnapshot::at_rest(&of.fabric);
    let moved = [
        (transfer.restrict(&at_rest(&fine), &material, Vec3::ZERO), &coarse),
        (transfer.prolong(&at_rest(&coarse), &material, Vec3::ZERO), &fine),
    ];
    for (state, of) in moved {
        let pairs = state.positions.iter().zip(of.fabric.rest_positions());
        let farthest = pairs.map(|(at, rest)| at.distance(*rest)).fold(0.0, f32::max);
        assert!(farthest < 5e-4, "{farthest} m from its place");
    }
    let mut batch = begun(&fine.fabric, LaneCount::One, material);
    batch.drive(0, Drive { wind: 6.0 * Vec3::X, ..Drive::default() }).expect("a good drive");
    (0..60).for_each(|_| batch.step(TICK, StepLimits::default()));
    let momentum = |state: &ClothSnapshot, fabric: &Fabric| -> Vec3 {
        state.velocities.iter().zip(fabric.particle_areas()).map(|(v, area)| *v * *area).sum()
    };
    let before = batch.snapshot(0);
    let after = transfer.restrict(&before, &material, Vec3::NEG_Y * 9.81);
    let [before, after] = [momentum(&before, &fine.fabric), momentum(&after, &coarse.fabric)];
    assert!(before.distance(after) < 1e-3 * before.length().max(0.1), "{before} {after}");
    assert!(after.length() > 0.0);
}

#[test]
fn what_has_no_cells_says_why() {
    let builder = skirt(0.0);
    for size in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e-6] {
        let error = builder.resampled(Resolution::CellSize(size)).expect_err("no size");
        assert!(matches!(error, FabricError::CellSize { .. }), "{size}: {error}");
    }
    assert!(matches!(
        builder.resampled(Resolution::Particles(0)),
        Err(FabricError::CellSize { .. })
    ));
    // A Möbius strip of eight quads.
    let place = |at: u32| {
        let turn = TAU * at as f32 / 8.0;
        let (out, up) = (0.1 * libm::cosf(0.5 * turn), 0.1 * libm::sinf(0.5 * turn));
        let radius = [0.5 - out, 0.5 + out];
        [0, 1].map(|side: usize| {
            let up = if side == 0 { -up } else { up };
            Vec3::new(radius[side] * libm::cosf(turn), up, radius[side] * libm::sinf(turn))
        })
    };
    let positions: Vec<Vec3> = (0..8).flat_map(place).collect();
    let quads = (0..8).flat_map(|at: u32| {
        let [a, b] = [2 * at, 2 * at + 1];
        // The last quad joins the sides crosswise.
        let [c, d] = if at == 7 { [1, 0] } else { [a + 2, b + 2] };
        [a, b, d, a, d, c]
    });
    let strip = FabricBuilder::new(positions, quads.collect());
    let error = strip.resampled(Resolution::CellSize(0.05)).expect_err("no front");
    assert!(matches!(error, FabricError::OneSided { .. }), "{error}");
}
