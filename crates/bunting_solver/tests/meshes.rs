//! Irregular meshes: the material's own strain and the same bits at every width.

#[path = "common/irregular.rs"]
mod irregular;
#[path = "common/trousers.rs"]
mod trousers;

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion, Grid,
    LaneCount, StepLimits, StepSettings, StretchSolver,
};
use glam::{Quat, Vec2, Vec3};
use irregular::irregular;
use trousers::trousers;

const TICK: f32 = 1.0 / 60.0;
/// Magnitude of gravity, m/s².
const GRAVITY: f32 = 9.81;

/// A material that hardly stretches and is isotropic but for Poisson's ratio, damped.
const ISOTROPIC: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 5e3,
    damping: 4.0,
    ..FabricMaterial::FLAG_POLYESTER
};

/// A cloth that has hung from its top for four seconds: how far its lower edge has sunk, m, and its speed, m/s RMS.
fn hung(fabric: &Arc<Fabric>, material: FabricMaterial) -> [f32; 2] {
    hung_at(fabric, material, StepLimits::default().of_fabric(fabric, TICK, GRAVITY))
}

/// A lone cloth after some ticks under gravity.
fn after(
    ticks: u32,
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    settings: StepSettings,
) -> ClothSnapshot {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let cloth = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("room");
    for _ in 0..ticks {
        batch.step(TICK, settings);
    }
    batch.snapshot(cloth)
}

/// The same with other settings than those of its own.
fn hung_at(fabric: &Arc<Fabric>, material: FabricMaterial, settings: StepSettings) -> [f32; 2] {
    let ClothSnapshot { positions, velocities, .. } = after(240, fabric, material, settings);
    let rest = fabric.rest_positions();
    let lower = rest.iter().zip(&positions).filter(|(rest, _)| rest.y == -1.0);
    let sunk: Vec<f32> = lower.map(|(rest, at)| rest.y - at.y).collect();
    let squares: f32 = velocities.iter().map(|velocity| velocity.length_squared()).sum();
    [sunk.iter().sum::<f32>() / sunk.len() as f32, (squares / rest.len() as f32).sqrt()]
}

/// How far the lower edge of a square metre sinks, m, after four seconds.
fn sinking(fabric: &Arc<Fabric>, material: FabricMaterial) -> f32 {
    let [sunk, _] = hung(fabric, material);
    sunk
}

#[test]
fn a_hanging_mesh_has_its_materials_strain() {
    let expected = ISOTROPIC.area_density * GRAVITY / (2.0 * ISOTROPIC.weft_stiffness);
    for (n, angle) in [(17, 0.0), (17, 1.57), (17, 0.785), (33, 0.0), (33, 0.5)] {
        let error = sinking(&Arc::new(irregular(n, angle)), ISOTROPIC) / expected - 1.0;
        assert!(error.abs() < 0.03, "{n} × {n} at {angle} rad: {error}");
    }
}

/// A material that stretches as cloth does, damped.
const CLOTH: FabricMaterial =
    FabricMaterial { warp_stiffness: 1e3, weft_stiffness: 1e3, shear_stiffness: 50.0, ..ISOTROPIC };

/// A sheet that becomes narrower downwards by a part of its width.
fn narrowed(flat: &Fabric, by: f32) -> FabricBuilder {
    let narrow = |at: &Vec3| Vec3::new(0.4 * (at.x - 0.5) * (1.0 + by * at.y), at.y, 0.0);
    let positions = flat.rest_positions().iter().map(narrow).collect();
    FabricBuilder::new(positions, flat.triangles().as_flattened().to_vec())
}

#[test]
fn a_pennant_hangs_with_its_materials_strain() {
    const NARROWER: f32 = 0.95;
    let material = FabricMaterial {
        warp_stiffness: 2e3,
        weft_stiffness: 2e3,
        shear_stiffness: 1e3,
        ..ISOTROPIC
    };
    let pennant = narrowed(&irregular(25, 0.0), NARROWER).pin_where(|at, _| at.y == 0.0);
    let fabric = Arc::new(pennant.build().expect("a good fabric"));
    let [sunk, speed] =
        hung_at(&fabric, material, StepSettings { passes: 4, ..StepSettings::yarns(16) });
    // At a depth of y of a sheet of width 1 − t y hang σ g ((1 − y) − t (1 − y²)/2), on that width.
    let strain = |y: f32| ((1.0 - y) - 0.5 * NARROWER * (1.0 - y * y)) / (1.0 - NARROWER * y);
    let mean = (0..1000).map(|part| strain((part as f32 + 0.5) / 1000.0)).sum::<f32>() / 1000.0;
    let error = sunk / (material.area_density * GRAVITY / material.weft_stiffness * mean) - 1.0;
    assert!(speed < 1e-3, "{speed} m/s");
    assert!(error.abs() < 0.05, "{error}");
}

/// Radius of a square metre that is rolled up until its sides meet, m.
const CLOSED: f32 = 1.0 / core::f32::consts::TAU;

/// A mesh of a square metre that is bent about a vertical axis, and closed where the radius is 1 m/2π: there its
/// texture has a seam.
fn bent(flat: &Fabric, radius: f32) -> Fabric {
    bent_with(flat, radius, flat.uvs().to_vec())
}

/// The same with another texture, or none.
fn bent_with(flat: &Fabric, radius: f32, uv: Vec<Vec2>) -> Fabric {
    let around = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / radius);
        Vec3::new(radius * sin, at.y, radius * cos)
    };
    let positions = flat.rest_positions().iter().map(around).collect();
    let builder = FabricBuilder::new(positions, flat.triangles().as_flattened().to_vec());
    let builder = builder.uv(uv).weld_distance(1e-5);
    builder.pin_where(|at, _| at.y == 0.0).build().expect("a good fabric")
}

#[test]
fn a_curved_mesh_with_a_texture_rests_with_its_materials_strain() {
    let expected = ISOTROPIC.area_density * GRAVITY / (2.0 * ISOTROPIC.weft_stiffness);
    for (n, radius) in [(17, 0.5), (25, 0.3), (25, CLOSED), (33, CLOSED)] {
        let fabric = Arc::new(bent(&irregular(n, 0.0), radius));
        assert_eq!(fabric.particle_count(), (n * (n - u32::from(radius == CLOSED))) as usize);
        let [sunk, speed] = hung(&fabric, ISOTROPIC);
        let error = sunk / expected - 1.0;
        assert!(speed < 1e-3, "{n} × {n}, radius {radius} m: {speed} m/s");
        assert!(error.abs() < 0.01, "{n} × {n}, radius {radius} m: {error}");
    }
}

#[test]
fn a_curved_mesh_without_texture_hangs_with_its_materials_strain() {
    for material in [CLOTH, ISOTROPIC] {
        let expected = material.area_density * GRAVITY / (2.0 * material.weft_stiffness);
        for (n, radius) in [(17, 0.5), (25, 0.3), (25, CLOSED), (33, CLOSED)] {
            let fabric = Arc::new(bent_with(&irregular(n, 0.0), radius, Vec::new()));
            let [sunk, speed] = hung(&fabric, material);
            let error = sunk / expected - 1.0;
            assert!(speed < 1e-3, "{n} × {n}, radius {radius} m: {speed} m/s");
            assert!(error.abs() < 0.02, "{n} × {n}, radius {radius} m: {error}");
        }
    }
}

/// The mesh of a square metre rolled up to a funnel with an upper and a lower radius, m.
fn funnel(flat: &Fabric, [upper, lower]: [f32; 2]) -> Fabric {
    let place = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / CLOSED);
        let wide = upper + (upper - lower) * at.y;
        Vec3::new(wide * sin, at.y, wide * cos)
    };
    let positions = flat.rest_positions().iter().map(place).collect();
    let builder = FabricBuilder::new(positions, flat.triangles().as_flattened().to_vec());
    builder.weld_distance(1e-5).pin_where(|at, _| at.y == 0.0).build().expect("a good fabric")
}

/// Around a funnel runs tension, as its weight points outwards. With rings that are solved as open chains it sank 14 % too
/// far, with laid yarns 51 %.
#[test]
fn a_funnel_hangs_with_its_materials_strain() {
    let [upper, lower] = [0.4, 0.1];
    for (material, limit) in [(CLOTH, 0.04), (ISOTROPIC, 0.03)] {
        let fabric = Arc::new(funnel(&irregular(33, 0.0), [upper, lower]));
        let [sunk, speed] = hung(&fabric, material);
        // Of a cone of half the angle φ; the weight below a circle of radius r is σ g π (r² − r₀²)/sin φ.
        let slant = libm::hypotf(1.0, upper - lower);
        let [sin, cos] = [(upper - lower) / slant, 1.0 / slant];
        let strain = |part: u16| {
            let radius = upper - (upper - lower) * (f32::from(part) + 0.5) / 1000.0;
            (radius * radius - lower * lower) / (2.0 * radius * sin * cos)
        };
        let longer = slant * (0..1000).map(strain).sum::<f32>() / 1000.0;
        let load = material.area_density * GRAVITY / material.warp_stiffness;
        let expected = load * (longer + sin * lower * lower * sin / cos) / cos;
        let error = sunk / expected - 1.0;
        assert!(speed < 1e-3, "{speed} m/s");
        assert!(error.abs() < limit, "{error}");
    }
}

/// With laid yarns it sank 31 % too far.
#[test]
fn a_tapered_sheet_hangs_with_its_materials_strain() {
    const TAPER: f32 = 0.2;
    let flat = irregular(25, 0.0);
    let narrower = |at: &Vec3| Vec3::new((at.x - 0.5) * 0.5 * (1.0 + TAPER * at.y), at.y, 0.0);
    let positions = flat.rest_positions().iter().map(narrower).collect();
    let builder = FabricBuilder::new(positions, flat.triangles().as_flattened().to_vec());
    let fabric = builder.pin_where(|at, _| at.y == 0.0).build().expect("a good fabric");
    let [sunk, speed] = hung(&Arc::new(fabric), ISOTROPIC);
    let strain = |part: u16| {
        let y = (f32::from(part) + 0.5) / 1000.0;
        ((1.0 - y) - 0.5 * TAPER * (1.0 - y * y)) / (1.0 - TAPER * y)
    };
    let load = ISOTROPIC.area_density * GRAVITY / ISOTROPIC.warp_stiffness;
    let expected = load * (0..1000).map(strain).sum::<f32>() / 1000.0;
    let error = sunk / expected - 1.0;
    assert!(speed < 1e-3, "{speed} m/s");
    assert!(error.abs() < 0.03, "{error}");
}

/// A flat mesh of a square metre of two pieces that share a seam halfway down; the warp of the lower one runs down.
fn of_two_pieces(flat: &Fabric, is_pinned: fn(Vec3) -> bool) -> Fabric {
    let (mut positions, mut uv) = (Vec::new(), Vec::new());
    for corners in flat.triangles() {
        let corners = corners.map(|corner| flat.rest_positions()[corner as usize]);
        let is_low = corners.iter().map(|at| at.y).sum::<f32>() < -1.5;
        for at in corners {
            positions.push(at);
            uv.push(if is_low { Vec2::new(3.0 + at.y, at.x) } else { Vec2::new(at.x, at.y) });
        }
    }
    let indices = (0..positions.len() as u32).collect();
    let builder = FabricBuilder::new(positions, indices).uv(uv).weld_distance(1e-6);
    builder.pin_where(|at, _| is_pinned(at)).build().expect("a good fabric")
}

#[test]
fn each_piece_of_a_texture_stretches_by_its_own_warp() {
    const WARP: f32 = 1e3;
    const WEFT: f32 = 4e3;
    let material = FabricMaterial { warp_stiffness: WARP, weft_stiffness: WEFT, ..CLOTH };
    // The upper half carries the lower one as well, on its weft.
    let load = material.area_density * GRAVITY;
    let expected = load * (0.375 / WEFT + 0.125 / WARP);
    for n in [17, 33] {
        let fabric = Arc::new(of_two_pieces(&irregular(n, 0.0), |at| at.y == 0.0));
        let [sunk, speed] = hung(&fabric, material);
        let error = sunk / expected - 1.0;
        assert!(speed < 1e-3 && error.abs() < 0.03, "{n} × {n}: {error}, {speed} m/s");
    }
}

/// A sheet with a slit of a millimetre from the middle of its lower edge up to its centre. Its nodes lie beside its particles.
fn with_a_slit(flat: &Fabric, is_pinned: fn(Vec3) -> bool) -> Fabric {
    let count = flat.particle_count() as u32;
    let n = libm::sqrtf(count as f32) as u32;
    let middle = n / 2;
    let in_slit = |vertex: u32| vertex % n == middle && vertex / n > middle;
    let mut positions = flat.rest_positions().to_vec();
    let mut other_side = Vec::new();
    for vertex in (0..count).filter(|&vertex| in_slit(vertex)) {
        positions[vertex as usize].x -= 5e-4;
        other_side.push(flat.rest_positions()[vertex as usize] + Vec3::X * 5e-4);
    }
    positions.extend(other_side);
    let mut indices = flat.triangles().to_vec();
    for corners in &mut indices {
        let is_right = corners.iter().any(|vertex| vertex % n > middle);
        let opened = corners.iter_mut().filter(|vertex| is_right && in_slit(**vertex));
        opened.for_each(|vertex| *vertex = count + *vertex / n - middle - 1);
    }
    let builder = FabricBuilder::new(positions, indices.into_flattened());
    builder.pin_where(|at, _| is_pinned(at)).build().expect("a good fabric")
}

/// With laid yarns it sank 12 % too far, and along the lines of its uneven quads 200 %.
#[test]
fn a_sheet_with_a_slit_has_its_materials_strain() {
    let expected = ISOTROPIC.area_density * GRAVITY / (2.0 * ISOTROPIC.weft_stiffness);
    for n in [17, 33] {
        let fabric = Arc::new(with_a_slit(&irregular(n, 0.0), |at| at.y == 0.0));
        assert_eq!(fabric.stretch_solver(), StretchSolver::QuadLines);
        let [sunk, speed] = hung(&fabric, ISOTROPIC);
        let error = sunk / expected - 1.0;
        assert!(speed < 1e-3 && error.abs() < 0.04, "{n} × {n}: {error}, {speed} m/s");
    }
}

/// A mesh of quads with three openings is held by its own lines. With laid yarns a tick took 2.5 times as long.
#[test]
fn trousers_hang_as_at_a_high_effort() {
    let fabric = Arc::new(trousers());
    let sunk = |effort: Option<[u32; 2]>| {
        let mut settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
        if let Some([substeps, passes]) = effort {
            settings = StepSettings { substeps, passes, ..settings };
        }
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        let material = FabricMaterial { damping: 4.0, ..CLOTH };
        batch.insert(&ClothSnapshot::at_rest(&fabric), material).expect("room");
        (0..360).for_each(|_| batch.step(TICK, settings));
        let state = batch.snapshot(0);
        let speed = state.velocities.iter().map(|v| v.length()).fold(0.0, f32::max);
        let sunk =
            state.positions.iter().zip(fabric.rest_positions()).map(|(at, rest)| rest.y - at.y);
        (sunk.sum::<f32>() / fabric.particle_count() as f32, speed)
    };
    let ((chosen, speed), (high, _)) = (sunk(None), sunk(Some([16, 4])));
    assert!(speed < 1e-3, "{speed} m/s");
    assert!((chosen / high - 1.0).abs() < 0.15, "{chosen} m for {high} m");
}

/// Both halves hang on their own: in a wind from the front the lower ends of the slit part.
#[test]
fn a_slit_is_not_sewn_up() {
    let at_sides = |at: Vec3| at.y == 0.0 && (at.x - 0.5).abs() > 0.4;
    let fabric = Arc::new(with_a_slit(&irregular(21, 0.0), at_sides));
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::FLAG_POLYESTER).expect("room");
    batch.drive(0, Drive { wind: Vec3::Z * 4.0, ..Drive::default() }).expect("a lane");
    for _ in 0..120 {
        batch.step(TICK, StepLimits::default().of_fabric(&fabric, TICK, GRAVITY));
    }
    let at = batch.snapshot(0).positions;
    let ends = fabric.rest_positions().iter().zip(&at);
    let ends = ends.filter(|(rest, _)| rest.y == -1.0 && (rest.x - 0.5).abs() < 1e-3);
    let ends: Vec<Vec3> = ends.map(|(_, at)| *at).collect();
    assert!(ends.len() == 2 && ends[0].distance(ends[1]) > 0.02, "{ends:?}");
}

/// The families of yarns agree slowly. Without a first pass that goes farther the error is +40 %, with it +32 %.
#[test]
fn the_yarns_of_a_stiff_mesh_come_nearer_to_one_another_in_a_pass_that_goes_farther() {
    let expected = ISOTROPIC.area_density * GRAVITY / (2.0 * ISOTROPIC.weft_stiffness);
    let fabric = Arc::new(with_a_slit(&irregular(5, 0.0), |at| at.y == 0.0));
    assert_eq!(fabric.stretch_solver(), StretchSolver::LaidYarns);
    let [sunk, speed] = hung(&fabric, ISOTROPIC);
    let error = sunk / expected - 1.0;
    assert!(speed < 1e-3 && error.abs() < 0.36, "{error}, {speed} m/s");
}

/// The first and the last row of nodes are one. Where they are not joined the seam opens: 38 % and 67 %.
#[test]
fn a_closed_mesh_does_not_open_at_its_seam() {
    let fabric = Arc::new(bent_with(&irregular(17, 0.0), CLOSED, Vec::new()));
    let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::FLAG_POLYESTER).expect("room");
    let wind = Vec3::new(5.0, 0.0, 3.0);
    batch.drive(0, Drive { wind, ..Drive::default() }).expect("a lane");
    let mut strains = Vec::new();
    for _ in 0..240 {
        batch.step(TICK, settings);
        let at = batch.snapshot(0).positions;
        let length = |of: &[Vec3], [a, b]: [u32; 2]| of[a as usize].distance(of[b as usize]);
        let sides = fabric.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let rest = fabric.rest_positions();
        strains.extend(sides.map(|ends| length(&at, ends) / length(rest, ends) - 1.0));
    }
    strains.sort_by(f32::total_cmp);
    let (large, greatest) = (strains[strains.len() * 999 / 1000], strains[strains.len() - 1]);
    assert!(large < 0.33 && greatest < 0.5, "99.9 %: {large}, greatest: {greatest}");
}

#[test]
fn a_flag_without_a_background_grid_keeps_its_edges_in_wind() {
    let fabric = Arc::new(with_a_slit(&irregular(17, 0.0), |at| at.x == 0.0));
    let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::FLAG_POLYESTER).expect("room");
    let wind = Vec3::new(5.0, 0.0, 3.0);
    batch.drive(0, Drive { wind, ..Drive::default() }).expect("a lane");
    let (mut positions, mut strains) = (Vec::new(), Vec::new());
    let length = |of: &[Vec3], [a, b]: [u32; 2]| of[a as usize].distance(of[b as usize]);
    for tick in 0..480 {
        batch.step(TICK, settings);
        if tick > 120 {
            batch.copy_positions(0, &mut positions);
            let sides = fabric.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let rest = fabric.rest_positions();
            strains.extend(sides.map(|ends| length(&positions, ends) / length(rest, ends) - 1.0));
        }
    }
    strains.sort_by(f32::total_cmp);
    let (large, greatest) = (strains[strains.len() * 999 / 1000], strains[strains.len() - 1]);
    assert!(large < 0.2 && greatest < 0.35, "99.9 %: {large}, greatest: {greatest}");
}

#[test]
fn a_mesh_that_is_cut_on_the_bias_stretches_by_shear() {
    let material = FabricMaterial { shear_stiffness: 500.0, ..ISOTROPIC };
    let fabric = Arc::new(irregular(17, core::f32::consts::FRAC_PI_4));
    // One over Young's modulus at 45°, without Poisson's ratio.
    let softness = 0.25 * (2.0 / material.warp_stiffness + 1.0 / material.shear_stiffness);
    let expected = material.area_density * GRAVITY / 2.0 * softness;
    let error = sinking(&fabric, material) / expected - 1.0;
    assert!(error.abs() < 0.05, "{error}");
}

/// The node nearest to a pin without neighbours that are pinned is moved to it. Where it stayed, most of a cell away, edges at
/// these pins were strained by 54 to 62 %.
#[test]
fn a_curved_mesh_that_hangs_from_single_vertices_keeps_its_edges() {
    let flat = irregular(21, 0.0);
    let curved = bent(&flat, 0.3);
    let rest = curved.rest_positions();
    for pins in [[76, 117], [385, 354], [316, 87]] {
        let builder = FabricBuilder::new(rest.to_vec(), flat.triangles().as_flattened().to_vec());
        let fabric = Arc::new(builder.pin(pins).build().expect("a good fabric"));
        let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
        let at = after(480, &fabric, CLOTH, settings).positions;
        let sides = fabric.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        for [a, b] in sides.filter(|ends| ends.iter().any(|end| pins.contains(end))) {
            let [a, b] = [a, b].map(|end| end as usize);
            let strain = at[a].distance(at[b]) / rest[a].distance(rest[b]) - 1.0;
            assert!(strain < 0.25, "{} – {}: {strain}", rest[a], rest[b]);
        }
    }
}

/// The part by which the particles of a cloth sink farther at its own effort than at a high one, in the mean.
fn excess(fabric: Fabric, material: FabricMaterial) -> f32 {
    let fabric = Arc::new(fabric);
    let mean = |settings: StepSettings| {
        let at = after(240, &fabric, material, settings).positions;
        let sunk: f32 = fabric.rest_positions().iter().zip(&at).map(|(a, b)| a.y - b.y).sum();
        sunk / at.len() as f32
    };
    let own = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
    mean(own) / mean(StepSettings { substeps: 16, passes: 4, ..own }) - 1.0
}

/// Curved meshes with round borders and holes sink nearly as far as they do at a high effort.
#[test]
fn curved_meshes_with_any_border_sink_as_at_a_high_effort() {
    let flat = irregular(21, 0.0);
    let fabrics = [
        ("hole", bent(&with_a_hole(&flat), 0.3)),
        ("closed with a hole", bent(&with_a_hole(&flat), CLOSED)),
        ("cap", cap(&flat)),
    ];
    for (name, fabric) in fabrics {
        let excess = excess(fabric, CLOTH);
        assert!(excess.abs() < 0.15, "{name}: {excess}");
    }
}

/// So does a flat one of stiff cloth, as its last pass is extrapolated: else it sinks 18 % farther.
#[test]
fn a_stiff_sheet_with_a_hole_sinks_as_at_a_high_effort() {
    let excess = excess(with_a_hole(&irregular(25, 0.0)), ISOTROPIC);
    assert!(excess.abs() < 0.12, "{excess}");
}

/// Positions of the last of some cloths, each in its own wind, m/s, after half a second.
fn flown(
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    lanes: LaneCount,
    winds: &[f32],
) -> Vec<Vec3> {
    let settings = StepLimits::default().of_fabric(fabric, TICK, GRAVITY);
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    for &wind in winds {
        let lane = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("room");
        let wind = Vec3::new(wind, 0.0, 4.0);
        batch.drive(lane, Drive { wind, ..Drive::default() }).expect("a lane");
    }
    for _ in 0..30 {
        batch.step(TICK, settings);
    }
    let mut positions = Vec::new();
    batch.copy_positions(winds.len() - 1, &mut positions);
    positions
}

/// The triangles of a mesh outside a circle, hung from its top.
fn with_a_hole(fabric: &Fabric) -> Fabric {
    let at = fabric.rest_positions();
    let is_kept = |corner: &u32| at[*corner as usize].distance(Vec3::new(0.4, -0.6, 0.0)) > 0.21;
    let kept = fabric.triangles().iter().filter(|corners| corners.iter().all(is_kept));
    let mut used: Vec<u32> = kept.clone().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number = |corner: &u32| used.binary_search(corner).expect("a corner") as u32;
    let indices = kept.flatten().map(number).collect();
    let of_used = |from: &[Vec2]| used.iter().map(|&at| from[at as usize]).collect();
    let builder = FabricBuilder::new(used.iter().map(|&it| at[it as usize]).collect(), indices);
    let builder = builder.uv(of_used(fabric.uvs())).pin_where(|at, _| at.y == 0.0);
    builder.build().expect("a good fabric")
}

/// A sheet drawn out to a disk, hung from two vertices of its rim: nodes of its grid are moved to them.
fn disk(flat: &Fabric) -> Fabric {
    let round = |at: &Vec3| {
        let (x, y) = (2.0 * at.x - 1.0, 2.0 * at.y + 1.0);
        let wide = |other: f32| libm::sqrtf(1.0 - 0.5 * other * other);
        Vec3::new(x * wide(y), y * wide(x), 0.0) * 0.56
    };
    let positions: Vec<Vec3> = flat.rest_positions().iter().map(round).collect();
    let is_at_rim = |at: &Vec3| at.length() > 0.559 && at.y > 0.0;
    let rim: Vec<u32> =
        (0..).zip(&positions).filter(|(_, at)| is_at_rim(at)).map(|(it, _)| it).collect();
    let builder = FabricBuilder::new(positions, flat.triangles().as_flattened().to_vec());
    builder.pin([rim[1], rim[rim.len() / 2]]).build().expect("a good fabric")
}

/// A round part of a ball of 0.7 m, hung from its upper rim: it is unfolded with curved lines.
fn cap(flat: &Fabric) -> Fabric {
    let disk = disk(flat);
    let on_ball = |at: &Vec3| {
        let (out, up) = libm::sincosf(at.length() / 0.7);
        (at.normalize_or_zero() * out + Vec3::Z * up) * 0.7
    };
    let positions = disk.rest_positions().iter().map(on_ball).collect();
    let builder = FabricBuilder::new(positions, disk.triangles().as_flattened().to_vec());
    builder.pin_where(|at, _| at.y > 0.42).build().expect("a good fabric")
}

/// One row of quads, hung from a corner: of two columns of nodes diagonals join consecutive ones.
fn ribbon() -> Fabric {
    let place = |at: u32| Vec3::new((at % 40) as f32 / 39.0, -0.03 * (at / 40) as f32, 0.0);
    let quad = |at: u32| [at, at + 40, at + 1, at + 1, at + 40, at + 41];
    let builder =
        FabricBuilder::new((0..80).map(place).collect(), (0..39).flat_map(quad).collect());
    builder.pin([0]).build().expect("a good fabric")
}

/// A mesh of each kind, by name.
fn of_all_kinds() -> [(&'static str, Fabric); 9] {
    let flat = irregular(21, 0.0);
    let holed = with_a_hole(&flat);
    [
        ("hole", bent(&holed, 0.3)),
        ("closed with a hole", bent(&holed, CLOSED)),
        ("closed", bent(&flat, CLOSED)),
        ("disk", bent(&disk(&flat), 0.4)),
        ("cap", cap(&flat)),
        ("pieces", of_two_pieces(&flat, |at| at.y == 0.0)),
        ("slit", with_a_slit(&flat, |at| at.y == 0.0)),
        ("trousers", trousers()),
        ("funnel", funnel(&flat, [CLOSED, 2.0 * CLOSED])),
    ]
}

/// A mesh without its pins.
fn unpinned(fabric: &Fabric) -> Fabric {
    let triangles = fabric.triangles().as_flattened().to_vec();
    let builder = FabricBuilder::new(fabric.rest_positions().to_vec(), triangles);
    builder.uv(fabric.uvs().to_vec()).build().expect("a good fabric")
}

/// Displacement of each particle from rest after 20 ticks without air.
fn moved_by(gravity: Vec3, fabric: Fabric) -> Vec<Vec3> {
    let fabric = Arc::new(fabric);
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    let rest = ClothSnapshot::at_rest(&fabric);
    let undamped = FabricMaterial { damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };
    batch.insert(&rest, undamped).expect("room");
    let drive = Drive { gravity, air_density: 0.0, ..Drive::default() };
    batch.drive(0, drive).expect("a lane");
    for _ in 0..20 {
        batch.step(TICK, StepLimits::default().of_fabric(&fabric, TICK, GRAVITY));
    }
    rest.positions.iter().zip(&batch.snapshot(0).positions).map(|(a, b)| *b - *a).collect()
}

/// Without loads nothing moves: each mesh has its shape at rest. Cells beside holes of curved ones pulled by 0.8 mm.
#[test]
fn a_mesh_without_loads_keeps_its_shape() {
    for (name, fabric) in of_all_kinds() {
        let moved = moved_by(Vec3::ZERO, fabric).into_iter().map(Vec3::length).fold(0.0, f32::max);
        assert!(moved < 1e-4, "{name}: {moved} m");
    }
}

/// The diagonals of a curved mesh are not alike. As if they were, those of closed ones pulled by a millimetre.
#[test]
fn closed_meshes_of_many_sizes_keep_their_shape() {
    for n in 12..36 {
        let fabric = unpinned(&bent(&irregular(n, 0.0), CLOSED));
        let moved = moved_by(Vec3::ZERO, fabric).into_iter().map(Vec3::length).fold(0.0, f32::max);
        assert!(moved < 3e-5, "{n}: {moved} m");
    }
}

/// Nothing holds a mesh without pins. Closed ones hung from nodes in the middle of their holes, where there is no cloth.
#[test]
fn a_mesh_without_pins_falls() {
    for (name, fabric) in of_all_kinds() {
        let time = 20.0 * TICK;
        let height = 0.5 * GRAVITY * time * time;
        for moved in moved_by(Vec3::NEG_Y * GRAVITY, unpinned(&fabric)) {
            // In its first substep BDF2 has the error of backward Euler.
            assert!((moved + Vec3::Y * height).length() < 0.02 * height, "{name}: {moved} m");
        }
    }
}

#[test]
fn a_mesh_has_the_same_bits_at_every_width() {
    let limp = FabricMaterial::FLAG_POLYESTER;
    // Stiff enough to be bent at positions that contain the displacement by stretch, and to resist twist.
    let stiff = FabricMaterial { bend_stiffness: 10.0, ..limp };
    let flat = irregular(21, 0.0);
    let fabrics = [
        irregular(13, 0.0),
        irregular(30, 0.5),
        with_a_hole(&flat),
        bent(&with_a_hole(&flat), 0.3),
        disk(&flat),
        bent(&disk(&flat), 0.4),
        cap(&flat),
        of_two_pieces(&flat, |at| at.y == 0.0),
        with_a_slit(&flat, |at| at.y == 0.0),
        // Uneven meshes without pins have laid yarns.
        unpinned(&with_a_slit(&flat, |at| at.y == 0.0)),
        trousers(),
        bent(&with_a_hole(&flat), CLOSED),
        ribbon(),
        bent(&flat, 0.3),
        bent_with(&irregular(12, 0.0), CLOSED, Vec::new()),
        funnel(&irregular(20, 0.0), [CLOSED, 2.0 * CLOSED]),
    ];
    for fabric in fabrics.map(Arc::new) {
        for material in [limp, stiff] {
            let alone = flown(&fabric, material, LaneCount::One, &[6.0]);
            assert!(alone.iter().all(|at| at.is_finite()));
            let [eight, sixteen] = [LaneCount::Eight, LaneCount::Sixteen];
            assert_eq!(alone, flown(&fabric, material, eight, &[3.0, -2.0, 6.0]));
            assert_eq!(alone, flown(&fabric, material, sixteen, &[9.0, 6.0]));
        }
    }
}

#[test]
fn a_mesh_that_moves_to_another_batch_keeps_its_bits() {
    let flat = irregular(21, 0.0);
    let untextured = bent_with(&irregular(12, 0.0), CLOSED, Vec::new());
    let funnel = funnel(&irregular(20, 0.0), [CLOSED, 2.0 * CLOSED]);
    let holed = with_a_hole(&flat);
    let bent_holed = bent(&holed, 0.3);
    let pieces = of_two_pieces(&flat, |at| at.y == 0.0);
    let slit = with_a_slit(&flat, |at| at.y == 0.0);
    let closed_holed = bent(&holed, CLOSED);
    let (plane, bent) = (irregular(13, 0.0), bent(&flat, 0.3));
    let disk = disk(&flat);
    let curved = [cap(&flat), bent, bent_holed, closed_holed, untextured, funnel];
    for fabric in [plane, holed, disk, pieces, unpinned(&slit), slit, trousers()]
        .into_iter()
        .chain(curved)
        .map(Arc::new)
    {
        let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
        let wind = Vec3::new(6.0, 0.0, 4.0);
        let drive = || Drive { wind, ..Drive::default() };
        let mut stays = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        let rest = ClothSnapshot::at_rest(&fabric);
        stays.insert(&rest, FabricMaterial::FLAG_POLYESTER).expect("room");
        stays.drive(0, drive()).expect("a lane");
        for _ in 0..20 {
            stays.step(TICK, settings);
        }
        let mut other = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
        for snapshot in [rest, stays.snapshot(0)] {
            let lane = other.insert(&snapshot, FabricMaterial::FLAG_POLYESTER).expect("room");
            other.drive(lane, drive()).expect("a lane");
        }
        for _ in 0..10 {
            stays.step(TICK, settings);
            other.step(TICK, settings);
        }
        assert_eq!(stays.snapshot(0), other.snapshot(1));
    }
}

/// Energy of a cloth in J/kg: of its motion and of its height.
fn energy(fabric: &Fabric, state: &ClothSnapshot) -> f32 {
    let particles = state.positions.iter().zip(&state.velocities).zip(fabric.particle_areas());
    let of = |((at, v), area): ((&Vec3, &Vec3), &f32)| area * (0.5 * v.dot(*v) + GRAVITY * at.y);
    particles.map(of).sum::<f32>() / fabric.area()
}

/// A mesh whose nodes were found from its particles anew gained 0.6 J/kg in a second of 32 substeps a tick.
#[test]
fn a_swinging_mesh_keeps_its_energy_at_any_substeps() {
    let fabric = Arc::new(irregular(33, 0.0));
    let material = FabricMaterial { damping: 0.0, ..ISOTROPIC };
    let (sin, cos) = (libm::sinf(0.5), libm::cosf(0.5));
    let mut start = ClothSnapshot::at_rest(&fabric);
    start.positions.iter_mut().for_each(|at| *at = Vec3::new(at.x, at.y * cos, at.y * sin));
    for substeps in [2, 8, 32] {
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        batch.insert(&start, material).expect("room");
        batch.drive(0, Drive { air_density: 0.0, ..Drive::default() }).expect("a lane");
        for _ in 0..60 {
            batch.step(TICK, StepSettings::yarns(substeps));
        }
        let gained = energy(&fabric, &batch.snapshot(0)) - energy(&fabric, &start);
        assert!(gained.abs() < 0.01, "{substeps}: {gained} J/kg");
    }
}

/// The motion of a free mesh in the world does not depend on the frame in which it is computed.
#[test]
fn a_mesh_moves_alike_in_a_moving_frame() {
    let flat = irregular(13, 0.0);
    let free = FabricBuilder::new(
        flat.rest_positions().to_vec(),
        flat.triangles().iter().flatten().copied().collect(),
    );
    let fabric = Arc::new(free.build().expect("a good fabric"));
    let mut start = ClothSnapshot::at_rest(&fabric);
    let swirl = |at: &Vec3| Vec3::new(0.3 * at.y, -0.5 * at.x, libm::sinf(9.0 * at.x) * at.y);
    start.velocities = start.positions.iter().map(swirl).collect();
    let motion = FrameMotion {
        rotation: Quat::from_rotation_y(0.05),
        translation: Vec3::new(0.2, 0.0, 0.1),
    };
    let mut still = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    let mut moving = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    for batch in [&mut still, &mut moving] {
        batch.insert(&start, FabricMaterial { damping: 0.0, ..ISOTROPIC }).expect("room");
    }
    let calm = |motion, gravity| Drive { motion, gravity, air_density: 0.0, ..Drive::default() };
    still.drive(0, calm(FrameMotion::NONE, Vec3::ZERO)).expect("a lane");
    let (mut origin, mut axes) = (Vec3::ZERO, Quat::IDENTITY);
    for _ in 0..30 {
        origin += axes * motion.translation;
        axes = (axes * motion.rotation).normalize();
        moving.drive(0, calm(motion, Vec3::ZERO)).expect("a lane");
        still.step(TICK, StepSettings::yarns(2));
        moving.step(TICK, StepSettings::yarns(2));
    }
    let (still, moving) = (still.snapshot(0).positions, moving.snapshot(0).positions);
    let apart = still.iter().zip(&moving).map(|(still, at)| still.distance(origin + axes * *at));
    let apart = apart.fold(0.0, f32::max);
    assert!(apart < 1e-3, "{apart} m");
}

#[test]
fn gauss_seidel_holds_a_mesh_with_a_background_grid() {
    let fabric = Arc::new(irregular(13, 0.0));
    for lanes in [LaneCount::One, LaneCount::Eight] {
        let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
        batch.insert(&ClothSnapshot::at_rest(&fabric), ISOTROPIC).expect("room");
        for _ in 0..60 {
            batch.step(TICK, StepSettings::gauss_seidel(8));
        }
        let positions = batch.snapshot(0).positions;
        let moved =
            positions.iter().zip(fabric.rest_positions()).map(|(at, rest)| at.distance(*rest));
        let farthest = moved.fold(0.0, f32::max);
        assert!(farthest < 0.1, "{farthest} m, {lanes:?}");
    }
}

/// A sheet of a metre whose columns are ten times as wide at one end as at the other, bent about its rows to a radius, held by its
/// narrow or its wide end.
fn graded(radius: Option<f32>, is_held: fn(f32) -> bool) -> Fabric {
    const COLUMNS: u32 = 21;
    let even = FabricBuilder::grid(Grid::new(COLUMNS, 17, 1.0, 1.0)).build().expect("good");
    let place = |at: &Vec3| {
        let x = (libm::powf(10.0, at.x) - 1.0) / 9.0;
        match radius {
            Some(radius) => {
                let (sin, cos) = libm::sincosf(at.y / radius);
                Vec3::new(x, radius * sin, radius * cos)
            }
            None => Vec3::new(x, at.y, 0.0),
        }
    };
    let positions = even.rest_positions().iter().map(place).collect();
    let mesh = FabricBuilder::new(positions, even.triangles().as_flattened().to_vec());
    mesh.pin_where(|at, _| is_held(at.x)).build().expect("a good fabric")
}

/// Nodes beside pins were held as well in triangles of several cells: a cloth that hung from them stretched by a sixth too little. On
/// curved ones nodes were read from single triangles, and stretched many times too far.
#[test]
fn graded_meshes_stretch_as_their_material_does() {
    for radius in [None, Some(0.5)] {
        for (is_held, down) in [
            ((|x: f32| x < 1e-5) as fn(f32) -> bool, Vec3::X),
            (|x: f32| x > 1.0 - 1e-5, Vec3::NEG_X),
        ] {
            let fabric = Arc::new(graded(radius, is_held));
            let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
            batch.insert(&ClothSnapshot::at_rest(&fabric), ISOTROPIC).expect("room");
            let gravity = down * GRAVITY;
            batch
                .drive(0, Drive { gravity, air_density: 0.0, ..Drive::default() })
                .expect("a lane");
            let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
            (0..240).for_each(|_| batch.step(TICK, settings));
            let state = batch.snapshot(0);
            let moved = state.positions.iter().zip(fabric.rest_positions());
            let is_free_end = |rest: &Vec3| rest.dot(down) > down.x.max(0.0) - 1e-5;
            let sunk = moved
                .filter(|(_, rest)| is_free_end(rest))
                .map(|(at, rest)| (*at - *rest).dot(down));
            let sunk: Vec<f32> = sunk.collect();
            let mean = sunk.iter().sum::<f32>() / sunk.len() as f32;
            let expected = 0.5 * ISOTROPIC.area_density * GRAVITY / ISOTROPIC.warp_stiffness;
            assert!(
                (mean / expected - 1.0).abs() < 0.03,
                "{radius:?}, {down}: {mean} for {expected}"
            );
        }
    }
}
