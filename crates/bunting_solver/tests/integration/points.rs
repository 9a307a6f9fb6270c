//! Meshes that are held at points on their triangles.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Fabric, FabricBuilder, FabricError, FabricMaterial, Grid, LaneCount,
    LinkFamily, MeshPoint, Resampled, Resolution, StepLimits,
};
use glam::Vec3;

const CORNERS: [Vec3; 4] =
    [Vec3::ZERO, Vec3::X, Vec3::new(0.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0)];

/// A square metre of two triangles.
fn square() -> FabricBuilder {
    FabricBuilder::new(CORNERS.to_vec(), vec![0, 2, 1, 1, 2, 3])
}

fn point(vertices: [u32; 3], weights: [f32; 3]) -> MeshPoint {
    MeshPoint { vertices, weights }
}

fn place(builder: &FabricBuilder, point: &MeshPoint) -> Vec3 {
    builder.place(point).expect("good vertices")
}

fn pins(fabric: &Fabric) -> Vec<usize> {
    (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle)).collect()
}

/// Asserts that the particles of points are pinned at these, and nothing else is.
fn assert_held(builder: &FabricBuilder, points: &[MeshPoint], size: f32) -> Resampled {
    let held = builder.clone().pin_points(points.iter().copied());
    let made = held.resampled(Resolution::CellSize(size)).expect("a good mesh");
    let mut particles: Vec<usize> =
        made.fabric.particle_of_point().iter().map(|at| *at as usize).collect();
    for (point, &particle) in points.iter().zip(&particles) {
        let off = made.fabric.rest_positions()[particle].distance(place(builder, point));
        assert!(off < 1e-6, "{point:?} in cells of {size} m: {off} m");
    }
    particles.sort_unstable();
    assert_eq!(particles, pins(&made.fabric), "in cells of {size} m");
    made
}

#[test]
fn points_anywhere_on_large_triangles_are_pinned_there_and_alone() {
    let points = [
        MeshPoint::middle([0, 1, 2]),
        // The corners of a triangle may be named in any order.
        point([1, 0, 2], [0.2, 0.7, 0.1]),
        point([1, 2, 3], [0.5, 0.5, 0.0]),
        point([1, 2, 3], [1e-4, 0.3, 0.6999]),
        point([1, 2, 3], [0.0, 0.25, 0.75]),
        point([0, 2, 1], [0.98, 0.01, 0.01]),
        point([3, 2, 1], [2e-6, 0.5, 0.499_998]),
    ];
    for size in [0.5, 0.2, 0.07, 0.03] {
        for point in points {
            assert_held(&square(), &[point], size);
        }
        let Resampled { fabric, carried, corners, .. } = assert_held(&square(), &points[..6], size);
        assert!((fabric.area() - 1.0).abs() < 1e-3, "{} m²", fabric.area());
        assert_eq!(fabric.particle_of_vertex().len(), 4);
        let vertices = carried.positions(fabric.rest_positions());
        assert_eq!(vertices.len(), 4);
        assert!(vertices.iter().zip(CORNERS).all(|(at, rest)| at.distance(rest) < 1e-5));
        let of_point = &corners[fabric.particle_of_point()[0] as usize];
        assert_eq!(of_point.iter().map(|(vertex, _)| *vertex).sum::<u32>(), 3);
    }
}

#[test]
fn points_hold_nothing_between_them_and_pinned_vertices() {
    // Two pinned vertices hold the edge between them; a point beside them holds itself.
    let beside = [MeshPoint::middle([0, 1, 2]), point([0, 1, 2], [0.6, 0.2, 0.2])];
    let held = square().pin([0, 1]).pin_points(beside);
    let fabric = held.resampled(Resolution::CellSize(0.1)).expect("a good mesh").fabric;
    let (upper, below): (Vec<usize>, Vec<usize>) =
        pins(&fabric).into_iter().partition(|&pin| fabric.rest_positions()[pin].y == 0.0);
    assert!((9..14).contains(&upper.len()), "{upper:?}");
    let mut points: Vec<usize> = fabric.particle_of_point().iter().map(|at| *at as usize).collect();
    points.sort_unstable();
    assert_eq!(below, points);
}

#[test]
fn points_close_together_have_a_particle_each_in_large_cells() {
    let points = [0.0, 0.02, 0.04].map(|along| point([0, 1, 2], [0.6 - along, 0.2 + along, 0.2]));
    for size in [0.01, 0.1, 0.3] {
        assert_held(&square(), &points, size);
    }
}

/// Steps a fabric until it hangs.
fn hung(fabric: &Arc<Fabric>) -> Vec<Vec3> {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let material = FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON };
    batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("room");
    (0..240).for_each(|_| batch.step(1.0 / 60.0, StepLimits::default()));
    batch.snapshot(0).positions
}

#[test]
fn a_sheet_that_hangs_by_two_points_sags_between_them() {
    // In the plane z = 0 of x and y, but for gravity along y: a level sheet.
    let level = CORNERS.map(|at| Vec3::new(at.x, 0.0, at.y));
    let builder = FabricBuilder::new(level.to_vec(), vec![0, 1, 2, 1, 3, 2]);
    let pegs = [point([0, 1, 2], [0.6, 0.2, 0.2]), point([1, 2, 3], [0.2, 0.2, 0.6])];
    let fabric = assert_held(&builder, &pegs, 0.05).fabric;
    let positions = hung(&fabric);
    for (peg, &particle) in pegs.iter().zip(fabric.particle_of_point()) {
        assert!(positions[particle as usize].distance(place(&builder, peg)) < 1e-6);
    }
    let middle = place(&builder, &point([0, 1, 2], [0.0, 0.5, 0.5]));
    let rest = fabric.rest_positions();
    let nearest = (0..rest.len())
        .min_by(|&one, &other| rest[one].distance(middle).total_cmp(&rest[other].distance(middle)))
        .expect("particles");
    assert!(!fabric.is_pinned(nearest));
    let lowest = positions.iter().map(|at| at.y).fold(0.0, f32::min);
    assert!(lowest < -0.4, "the corners hang: {lowest} m");
    assert!(positions[nearest].y < -1e-4, "{} m", positions[nearest].y);
    let straight = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    for link in straight {
        let [a, b] = link.particles.map(|at| positions[at as usize]);
        let strain = a.distance(b) / link.rest_length - 1.0;
        assert!(strain < 0.05, "{strain} from {a} to {b}");
    }
}

#[test]
fn a_grid_that_is_held_beside_its_vertices_is_resampled() {
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
    let peg = grid.nearest_point(Vec3::new(0.31, -0.27, 0.4)).expect("triangles");
    assert!(place(&grid, &peg).distance(Vec3::new(0.31, -0.27, 0.0)) < 1e-6);
    let held = grid.clone().pin_points([peg]);
    assert!(held.coarser().is_none(), "other levels are resampled, too");
    let fabric = held.build().expect("a good grid");
    let particle = fabric.particle_of_point()[0] as usize;
    assert_eq!(pins(&fabric), [particle]);
    assert!(fabric.rest_positions()[particle].distance(place(&grid, &peg)) < 1e-6);
    assert!((250..340).contains(&fabric.particle_count()), "{}", fabric.particle_count());
    // At a vertex it has a particle, too.
    let at_vertex = square().pin_points([MeshPoint::at_vertex(3)]).build().expect("a square");
    let corner = at_vertex.particle_of_point()[0] as usize;
    assert_eq!((at_vertex.rest_positions()[corner], pins(&at_vertex)), (CORNERS[3], vec![corner]));
}

#[test]
fn free_points_have_particles_that_fall() {
    let peg = MeshPoint::middle([0, 1, 2]);
    let held = square().pin([0, 1]).free_points([peg]);
    let fabric = held.resampled(Resolution::CellSize(0.2)).expect("a good mesh").fabric;
    let particle = fabric.particle_of_point()[0] as usize;
    assert!(!fabric.is_pinned(particle));
    assert!(fabric.rest_positions()[particle].distance(place(&square(), &peg)) < 1e-6);
}

#[test]
fn bad_points_say_what_to_do() {
    let error = |bad: MeshPoint| {
        let held = square().pin_points([MeshPoint::middle([1, 2, 3]), bad]);
        let error = held.clone().build().expect_err("a bad point");
        // In words, as a weight that is no number differs from itself.
        let checked = held.check().expect_err("the same");
        assert_eq!(checked.to_string(), error.to_string());
        error
    };
    assert_eq!(
        error(MeshPoint::middle([0, 1, 4])),
        FabricError::PointOutOfRange { vertex: 4, vertices: 4 }
    );
    let vertices = [0, 1, 3];
    assert_eq!(error(MeshPoint::middle(vertices)), FabricError::PointOffMesh { vertices });
    let vertices = [0, 1, 1];
    assert_eq!(error(MeshPoint::middle(vertices)), FabricError::PointOffMesh { vertices });
    let vertices = [0, 1, 2];
    for weights in [
        [-0.1, 0.6, 0.5],
        [f32::NAN, 0.5, 0.5],
        [0.3, 0.3, 0.3],
        [1.0, 1.0, -1.0],
        [f32::INFINITY, 0.0, 0.0],
    ] {
        let found = error(point(vertices, weights));
        assert!(matches!(found, FabricError::PointWeights { .. }), "{weights:?}: {found}");
    }
    let on_grid = FabricBuilder::grid(Grid::new(3, 3, 1.0, 1.0));
    let found = on_grid.pin_points([MeshPoint::middle([0, 4, 8])]).check();
    assert_eq!(found, Err(FabricError::PointOffMesh { vertices: [0, 4, 8] }));
    let repaired = square().pin_points([MeshPoint::middle(vertices)]).repair();
    assert_eq!(repaired.map(|_| ()), Err(FabricError::PointsBeforeRepair));
}
