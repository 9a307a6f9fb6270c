//! Edges of a cloth that are sewn together.

use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid,
    Lacing, LaneCount, Resolution, Scheme, Seams, SelfCollision, StepSettings, Stitch,
};
use glam::Vec3;

const TICK: f32 = 1.0 / 60.0;

/// Columns of a panel, and its links from top to bottom.
const COLUMNS: u32 = 9;
const LINKS: u32 = 16;
/// Length of a link, m.
const LINK: f32 = 0.05;

/// Panels one below the other, a link apart, each a piece of one net. The first one is pinned at its upper edge.
fn panels(count: u32) -> Arc<Fabric> {
    let grid = Grid::new(COLUMNS, LINKS + 1, LINK * (COLUMNS - 1) as f32, LINK * LINKS as f32);
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for panel in 0..count {
        let first = positions.len() as u32;
        let down = panel as f32 * (grid.height + LINK) * Vec3::NEG_Y;
        let panel = FabricBuilder::grid(grid);
        positions.extend(panel.positions().iter().map(|at| *at + down));
        indices.extend(panel.indices().iter().map(|at| at + first));
    }
    let builder = FabricBuilder::new(positions, indices).pin(0..COLUMNS);
    builder.resampled(Resolution::CellSize(LINK)).expect("a good mesh").fabric
}

/// The particles at a height at rest, from left to right.
fn row(fabric: &Fabric, height: f32) -> Vec<u32> {
    let rest = fabric.rest_positions();
    let there = |at: &u32| (rest[*at as usize].y - height).abs() < 0.1 * LINK;
    let mut row: Vec<u32> = (0..rest.len() as u32).filter(there).collect();
    row.sort_by(|a, b| rest[*a as usize].x.total_cmp(&rest[*b as usize].x));
    row
}

/// The stitches that sew each panel to the one above it.
fn stitches(fabric: &Fabric, panels: u32) -> Vec<Stitch> {
    let height = LINK * LINKS as f32;
    let seam = |panel: u32| {
        let below = -(panel as f32) * (height + LINK);
        let [upper, lower] = [row(fabric, below + LINK), row(fabric, below)];
        assert_eq!((upper.len(), lower.len()), (COLUMNS as usize, COLUMNS as usize));
        let pairs: Vec<(u32, u32)> = upper.into_iter().zip(lower).collect();
        pairs.into_iter().map(|(one, other)| Stitch::to_particle(one, other))
    };
    (1..panels).flat_map(seam).collect()
}

/// Greatest distance of the two sides of stitches to particles, m.
fn greatest_gap(positions: &[Vec3], stitches: &[Stitch]) -> f32 {
    let gap = |stitch: &Stitch| {
        positions[stitch.particle as usize].distance(
            positions[stitch.onto[0] as usize]
                .lerp(positions[stitch.onto[1] as usize], stitch.part),
        )
    };
    stitches.iter().map(gap).fold(0.0, f32::max)
}

fn positions(batch: &ClothBatch) -> Vec<Vec3> {
    batch.snapshot(0).positions
}

/// Root mean square speed, m/s.
fn speed(batch: &ClothBatch) -> f32 {
    let velocities = batch.snapshot(0).velocities;
    (velocities.iter().map(|v| v.length_squared()).sum::<f32>() / velocities.len() as f32).sqrt()
}

/// A cloth whose stitches are all closed.
fn sewn(
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    stitches: &[Stitch],
    lanes: LaneCount,
) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    batch.insert(&almost_at_rest(fabric), material).expect("a good cloth");
    let seams = Arc::new(Seams::new(fabric, stitches).expect("good stitches"));
    batch.sew(0, &seams, vec![Lacing::closed(0..stitches.len())]).expect("good seams");
    batch
}

/// A state at rest with a small imperfection, since nothing buckles in a perfect plane.
fn almost_at_rest(fabric: &Arc<Fabric>) -> ClothSnapshot {
    let mut state = ClothSnapshot::at_rest(fabric);
    for (particle, at) in state.positions.iter_mut().enumerate() {
        if !fabric.is_pinned(particle) {
            at.z += 1e-4 * libm::sinf(37.0 * at.x) * libm::cosf(23.0 * at.y);
        }
    }
    state
}

#[test]
fn a_panel_hangs_from_another_one_as_if_both_were_one() {
    for (count, stiffness) in [(2, 100.0), (2, 20_000.0), (3, 1_000.0), (3, 20_000.0)] {
        let fabric = panels(count);
        let stitches = stitches(&fabric, count);
        let material = FabricMaterial {
            warp_stiffness: stiffness,
            weft_stiffness: stiffness,
            damping: 2.0,
            ..FabricMaterial::COTTON
        };
        let mut batch = sewn(&fabric, material, &stitches, LaneCount::One);
        (0..900).for_each(|_| batch.step(TICK, StepSettings::default()));
        let mut rms = 0.0_f32;
        for _ in 0..60 {
            batch.step(TICK, StepSettings::default());
            rms = rms.max(speed(&batch));
        }
        let at = positions(&batch);
        let low = at.iter().map(|at| at.y).fold(0.0, f32::min);
        let natural = LINK * (LINKS * count) as f32;
        let strain = 0.5 * 9.81 * material.area_density * natural / stiffness;
        let error = -low / (natural * (1.0 + strain)) - 1.0;
        let gap = greatest_gap(&at, &stitches) / LINK;
        let figures = format!("{count} panels of {stiffness} N/m: {error}, {gap} links, {rms} m/s");
        assert!(error.abs() < 0.01 && gap < 0.01 && rms < 2e-3, "{figures}");
    }
}

/// A sheet of a metre by half a metre, as a grid or as a net.
fn sheet(is_grid: bool, held: bool) -> Arc<Fabric> {
    let grid = FabricBuilder::grid(Grid::new(33, 17, 1.0, 0.5));
    let pins = if held { 16..17 } else { 0..0 };
    if is_grid {
        return Arc::new(grid.pin(pins).build().expect("a good sheet"));
    }
    let mesh = FabricBuilder::new(grid.positions().to_vec(), grid.indices().to_vec()).pin(pins);
    mesh.resampled(Resolution::CellSize(1.0 / 32.0)).expect("a good mesh").fabric
}

/// The stitches that make a tube of a sheet.
fn tube(fabric: &Fabric) -> Vec<Stitch> {
    let rest = fabric.rest_positions();
    let side = |x: f32| {
        let there = |at: &u32| (rest[*at as usize].x - x).abs() < 1e-4;
        let mut side: Vec<u32> = (0..rest.len() as u32).filter(there).collect();
        side.sort_by(|a, b| rest[*b as usize].y.total_cmp(&rest[*a as usize].y));
        side
    };
    let (left, right) = (side(0.0), side(1.0));
    assert_eq!((left.len(), right.len()), (17, 17));
    left.into_iter().zip(right).map(|(one, other)| Stitch::to_particle(one, other)).collect()
}

#[test]
fn seams_hold_in_storms_and_a_tube_comes_to_rest() {
    for (is_grid, scheme) in [
        (true, StepSettings::default()),
        (false, StepSettings::default()),
        (true, StepSettings::gauss_seidel(4)),
    ] {
        let fabric = sheet(is_grid, true);
        let stitches = tube(&fabric);
        let material = FabricMaterial { damping: 1.0, ..FabricMaterial::COTTON };
        let mut batch = sewn(&fabric, material, &stitches, LaneCount::One);
        (0..120).for_each(|_| batch.step(TICK, scheme));
        batch
            .drive(0, Drive { wind: Vec3::new(20.0, 2.0, 5.0), ..Drive::default() })
            .expect("good");
        let mut gap = 0.0_f32;
        for _ in 0..300 {
            batch.step(TICK, scheme);
            gap = gap.max(greatest_gap(&positions(&batch), &stitches) * 32.0);
        }
        batch.drive(0, Drive { air_density: 1.2, ..Drive::default() }).expect("good");
        (0..1200).for_each(|_| batch.step(TICK, scheme));
        let mut rms = 0.0_f32;
        for _ in 0..60 {
            batch.step(TICK, scheme);
            rms = rms.max(speed(&batch));
        }
        let figures = format!("grid {is_grid}: {gap} links in the storm, {rms} m/s at rest");
        // Sheets without seams tremble as much by the scheme of Gauss–Seidel.
        let trembles = scheme.scheme == Scheme::GaussSeidel;
        assert!(gap < 0.1 && (rms < 2e-3 || trembles), "{figures}");
    }
}

#[test]
fn layers_are_kept_apart_but_not_the_sides_of_a_seam() {
    let fabric = panels(3);
    let stitches = stitches(&fabric, 3);
    let material = FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON };
    let mut batch = sewn(&fabric, material, &stitches, LaneCount::One);
    let layers = SelfCollision { thickness: 5e-3 };
    batch.set_self_collision(0, Some(layers)).expect("a good thickness");
    (0..600).for_each(|_| batch.step(TICK, StepSettings::default()));
    let gap = greatest_gap(&positions(&batch), &stitches) / LINK;
    let rms = speed(&batch);
    assert!(gap < 0.01 && rms < 2e-3, "{gap} links, {rms} m/s");
}

#[test]
fn closing_keeps_momentum_and_angular_momentum_and_gives_no_energy() {
    for is_grid in [true, false] {
        let fabric = sheet(is_grid, false);
        let stitches = tube(&fabric);
        let mut state = almost_at_rest(&fabric);
        let (drift, spin) = (Vec3::new(0.3, 0.0, 0.2), Vec3::new(0.5, 1.0, 0.3));
        let middle = Vec3::new(0.5, -0.25, 0.0);
        for (at, velocity) in state.positions.iter().zip(&mut state.velocities) {
            *velocity = drift + spin.cross(*at - middle);
        }
        let material = FabricMaterial { damping: 0.0, ..FabricMaterial::COTTON };
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        batch.insert(&state, material).expect("a good cloth");
        batch
            .drive(0, Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() })
            .expect("good");
        let seams = Arc::new(Seams::new(&fabric, &stitches).expect("good stitches"));
        let moments = |batch: &ClothBatch| {
            let state = batch.snapshot(0);
            let areas = fabric.particle_areas();
            let of_all = state.positions.iter().zip(&state.velocities).zip(areas);
            let (mut linear, mut angular, mut energy) = (Vec3::ZERO, Vec3::ZERO, 0.0_f32);
            for ((at, velocity), area) in of_all {
                linear += *velocity * *area;
                angular += (*at - middle).cross(*velocity * *area);
                energy += 0.5 * area * velocity.length_squared();
            }
            (linear, angular, energy)
        };
        let before = moments(&batch);
        let mut centre = middle;
        // The greatest kinetic energy in each two seconds.
        let mut greatest = [0.0_f32; 5];
        for tick in 0..600_u16 {
            let closing = (1.0 - f32::from(tick) * TICK).max(0.0);
            let lacing = Lacing { closing, ..Lacing::closed(0..stitches.len()) };
            batch.sew(0, &seams, vec![lacing]).expect("good seams");
            batch.step(TICK, StepSettings::default());
            centre += drift * TICK;
            let greatest = &mut greatest[usize::from(tick) / 120];
            *greatest = greatest.max(moments(&batch).2);
        }
        let after = moments(&batch);
        let linear = after.0.distance(before.0) / before.0.length();
        // About the centre of mass, which has moved.
        let angular = after.1 - (centre - middle).cross(after.0);
        let angular = angular.distance(before.1) / before.1.length();
        let gap = greatest_gap(&positions(&batch), &stitches) * 32.0;
        let figures = format!(
            "grid {is_grid}: momentum {linear}, angular {angular}, energies {greatest:?}, gap {gap}"
        );
        assert!(linear < 3e-3 && angular < 0.01 && gap < 0.01, "{figures}");
        // What closing has given is not added to later.
        assert!(greatest[1..].is_sorted_by(|before, after| *after < 1.01 * before), "{figures}");
    }
}

#[test]
fn sewn_cloth_has_the_same_bits_in_all_lanes() {
    for is_grid in [true, false] {
        let fabric = sheet(is_grid, true);
        let stitches = tube(&fabric);
        let blown = |lanes: LaneCount, lane: usize| {
            let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
            let state = almost_at_rest(&fabric);
            for _ in 0..=lane {
                batch.insert(&state, FabricMaterial::NYLON).expect("a free lane");
            }
            let seams = Arc::new(Seams::new(&fabric, &stitches).expect("good stitches"));
            batch.sew(lane, &seams, vec![Lacing::closed(0..12)]).expect("good seams");
            let wind = Vec3::new(6.0, 0.0, 2.0);
            batch.drive(lane, Drive { wind, ..Drive::default() }).expect("good");
            (0..30).for_each(|_| batch.step(TICK, StepSettings::default()));
            batch.snapshot(lane)
        };
        let alone = blown(LaneCount::One, 0);
        assert!(alone == blown(LaneCount::Eight, 0), "others in a pack");
        assert!(alone == blown(LaneCount::Eight, 5), "others among others");
    }
}

#[test]
fn a_side_with_more_particles_follows_the_edge_of_the_other() {
    // Two panels of one net, of which the lower one is narrower by a link and lies half a link to the right.
    let mut places = Vec::new();
    let mut indices = Vec::new();
    for (cells, corner) in [(8_u32, Vec3::ZERO), (7, Vec3::new(0.5 * LINK, -9.0 * LINK, 0.0))] {
        let first = places.len() as u32;
        let grid = Grid::new(cells + 1, 9, LINK * cells as f32, 8.0 * LINK);
        let panel = FabricBuilder::grid(grid);
        places.extend(panel.positions().iter().map(|at| *at + corner));
        indices.extend(panel.indices().iter().map(|at| at + first));
    }
    let builder = FabricBuilder::new(places, indices).pin(0..9);
    let fabric = builder.resampled(Resolution::CellSize(LINK)).expect("a good mesh").fabric;
    let [upper, lower] = [row(&fabric, -8.0 * LINK), row(&fabric, -9.0 * LINK)];
    assert_eq!((upper.len(), lower.len()), (9, 8));
    let stitch = |(at, particle): (usize, u32)| Stitch {
        particle,
        onto: [upper[at], upper[at + 1]],
        part: 0.5,
    };
    let stitches: Vec<Stitch> = lower.iter().copied().enumerate().map(stitch).collect();
    let material = FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON };
    let mut batch = sewn(&fabric, material, &stitches, LaneCount::One);
    (0..900).for_each(|_| batch.step(TICK, StepSettings::default()));
    let at = positions(&batch);
    let gap = greatest_gap(&at, &stitches) / LINK;
    let low = at.iter().map(|at| at.y).fold(0.0, f32::min);
    let rms = speed(&batch);
    let figures = format!("{low} m, {gap} links, {rms} m/s");
    assert!((-low / 0.8 - 1.0).abs() < 0.01 && gap < 0.01 && rms < 2e-3, "{figures}");
}

#[test]
fn bad_stitches_and_lacings_are_errors() {
    let fabric = sheet(true, false);
    let last = fabric.particle_count() as u32;
    let good = Stitch::to_particle(0, 32);
    for bad in [
        Stitch::to_particle(0, last),
        Stitch::to_particle(3, 3),
        Stitch { particle: 0, onto: [31, 32], part: f32::NAN },
        Stitch { particle: 0, onto: [31, 32], part: 1.5 },
    ] {
        let found = Seams::new(&fabric, &[good, bad]).map(|_| ());
        assert_eq!(found, Err(BatchError::Stitch { stitch: 1 }), "{bad:?}");
    }
    let seams = Arc::new(Seams::new(&fabric, &[good]).expect("good stitches"));
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::SILK).expect("a free lane");
    for bad in [-1.0, f32::NAN, f32::INFINITY] {
        let lacings = vec![Lacing { length: bad, ..Lacing::closed(0..1) }];
        assert_eq!(batch.sew(0, &seams, lacings), Err(BatchError::Lacing { lacing: 0 }));
    }
    let other = FabricBuilder::grid(Grid::new(3, 3, 1.0, 1.0)).build().expect("a good sheet");
    let of_other = Arc::new(Seams::new(&other, &[]).expect("no stitches"));
    assert_eq!(batch.sew(0, &of_other, Vec::new()), Err(BatchError::Fabric));
    assert!(batch.sew(0, &seams, vec![Lacing::closed(0..9)]).is_ok());
    batch.step(TICK, StepSettings::default());
    assert!(batch.unsew(0).is_ok());
}
