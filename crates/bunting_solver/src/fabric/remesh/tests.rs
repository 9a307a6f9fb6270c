use glam::{DVec3, Vec3};

use super::triangle::{barycentric, nearest};
use crate::fabric::topology;
use crate::fabric::{FabricBuilder, Resampled, Resolution};

/// Columns and rows of quads of a sheet, and the row in which a slit from below ends.
const COLUMNS: u32 = 24;
const ROWS: u32 = 20;
const TIP: u32 = 9;

/// A sheet of a metre with a slit from below, whose inner vertices are moved by up to a part of a cell and whose quads are halved either
/// way at random.
fn slit_sheet(moved: f32) -> FabricBuilder {
    let mut state = 1_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 8_388_608.0 - 1.0
    };
    let cell = 1.0 / COLUMNS as f32;
    let middle = COLUMNS / 2;
    let mut positions = Vec::new();
    for row in 0..=ROWS {
        for column in 0..=COLUMNS {
            let is_inner = (1..ROWS).contains(&row) && (1..COLUMNS).contains(&column);
            let shift = if is_inner && column != middle { moved } else { 0.0 };
            let at = [column as f32 + shift * random(), -(row as f32 + shift * random()), 0.0];
            positions.push(Vec3::from(at) * cell);
        }
    }
    let mut numbers = vec![None; positions.len()];
    let mut beside = |column: u32, at: u32| {
        let at_slit = at % (COLUMNS + 1) == middle && at / (COLUMNS + 1) > TIP;
        if !at_slit || column < middle {
            return at;
        }
        // The other side of the slit, half of a millimetre away.
        let next = positions.len() as u32;
        *numbers[at as usize].get_or_insert_with(|| {
            positions.push(positions[at as usize] + Vec3::X * 5e-4);
            next
        })
    };
    let mut indices = Vec::new();
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let first = row * (COLUMNS + 1) + column;
            let corners = [first, first + COLUMNS + 1, first + COLUMNS + 2, first + 1];
            let [a, b, c, d] = corners.map(|at| beside(column, at));
            let falls = random() < 0.0;
            indices.extend(if falls { [a, b, c, a, c, d] } else { [b, c, d, b, d, a] });
        }
    }
    FabricBuilder::new(positions, indices).pin_where(|at, _| at.y == 0.0)
}

/// A ball of a decimetre of triangles around the corners of an icosahedron, each halved three times.
fn ball() -> FabricBuilder {
    let long = 0.5 * (1.0 + 5.0_f32.sqrt());
    let corner = |one: f32, other: f32| {
        [Vec3::new(0.0, one, other), Vec3::new(one, other, 0.0), Vec3::new(other, 0.0, one)]
    };
    let signs = [(1.0, long), (1.0, -long), (-1.0, long), (-1.0, -long)];
    let corners: Vec<Vec3> =
        signs.into_iter().flat_map(|(one, other)| corner(one, other)).collect();
    let mut faces = Vec::new();
    for (at, &a) in corners.iter().enumerate() {
        for (next, &b) in corners.iter().enumerate().skip(at + 1) {
            for &c in &corners[next + 1..] {
                let are_near = [(a, b), (b, c), (c, a)].iter().all(|(a, b)| a.distance(*b) < 2.1);
                if are_near {
                    let is_outside = (b - a).cross(c - a).dot(a) > 0.0;
                    faces.push(if is_outside { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..3 {
        let halved = faces.into_iter().flat_map(|[a, b, c]| {
            let [ab, bc, ca] = [a.midpoint(b), b.midpoint(c), c.midpoint(a)];
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        });
        faces = halved.collect();
    }
    let positions: Vec<Vec3> = faces.iter().flatten().map(|at| at.normalize() * 0.1).collect();
    let indices = (0..positions.len() as u32).collect();
    FabricBuilder::new(positions, indices).weld_distance(1e-4).pin_where(|at, _| at.y > 0.095)
}

fn resampled(builder: &FabricBuilder) -> Resampled {
    let resolution = Resolution::Particles(builder.particle_count() as u32);
    builder.resampled(resolution).expect("a good mesh")
}

/// Vertices less edges plus triangles.
fn euler(triangles: &[[u32; 3]], count: usize) -> i64 {
    let edges = topology::edges(triangles).expect("a manifold").len();
    (count + triangles.len()) as i64 - edges as i64
}

#[test]
fn nodes_have_the_topology_of_the_mesh() {
    for builder in [slit_sheet(0.45), ball()] {
        let (mesh, _) = builder.rest_mesh().expect("a good mesh");
        let net = resampled(&builder).fabric;
        assert_eq!(
            euler(net.triangles(), net.particle_count()),
            euler(&mesh.triangles, mesh.positions.len()),
        );
    }
}

/// A vertex on one side of a slit follows no particle of the other side.
#[test]
fn a_lattice_ends_at_a_slit() {
    let builder = slit_sheet(0.45);
    let Resampled { fabric, carried, .. } = resampled(&builder);
    let slit = 0.5 + 2.5e-4;
    let below_tip = |at: Vec3| at.y < -(TIP as f32 + 3.0) / COLUMNS as f32;
    let far = |at: &Vec3| if at.x < slit { *at } else { *at + Vec3::Z };
    let opened: Vec<Vec3> = fabric.rest_positions().iter().map(far).collect();
    for (at, rest) in carried.positions(&opened).iter().zip(builder.positions()) {
        let expected = if rest.x < slit { 0.0 } else { 1.0 };
        assert!(!below_tip(*rest) || (at.z - expected).abs() < 1e-5, "{rest} goes to {at}");
    }
}

/// Lines through uneven quads are straight.
#[test]
fn links_along_lines_are_alike() {
    for moved in [0.15, 0.45] {
        let net = resampled(&slit_sheet(moved)).fabric;
        let lines = net.yarns().iter().filter(|yarn| yarn.links.len() > 1);
        let turns = lines.flat_map(|line| line.particles.windows(3)).map(|three| {
            let [a, b, c] = [0, 1, 2].map(|at| net.rest_positions()[three[at] as usize]);
            (b - a).angle_between(c - b)
        });
        let turns: Vec<f32> = turns.collect();
        let mean = turns.iter().sum::<f32>() / turns.len() as f32;
        assert!(mean < 0.01, "moved by {moved}: {mean} rad");
    }
}

/// Two or three corners in one place, and three on a line.
#[test]
fn triangles_without_area_have_nearest_points() {
    let [a, b] = [DVec3::ZERO, 2.0 * DVec3::X];
    let at = DVec3::new(0.5, 1.0, 0.0);
    let triangles = [[a, a, b], [a, b, a], [b, a, a], [a, DVec3::X, b], [b, a, DVec3::X]];
    for triangle in triangles {
        let found = nearest(at, triangle);
        assert!(found.distance(DVec3::new(0.5, 0.0, 0.0)) < 1e-12, "{triangle:?}: {found}");
        let weights = barycentric(found, triangle);
        let sum: DVec3 =
            triangle.iter().zip(weights).map(|(corner, weight)| *corner * weight).sum();
        assert!(sum.distance(found) < 1e-12, "{triangle:?}: {weights:?}");
        // Beyond the ends.
        assert_eq!(nearest(DVec3::new(3.0, 1.0, 0.0), triangle), b);
    }
    assert_eq!(nearest(at, [b; 3]), b);
    assert_eq!(barycentric(at, [b; 3]).iter().sum::<f64>(), 1.0);
}

/// A strap around half a ring, of one quad across its width, m.
fn strap(width: f32) -> FabricBuilder {
    const ALONG: u32 = 40;
    const RADIUS: f32 = 0.15;
    let ends = |at: u32| {
        let (sin, cos) = libm::sincosf(core::f32::consts::PI * at as f32 / ALONG as f32);
        [RADIUS, RADIUS + width].map(|radius| Vec3::new(radius * cos, -radius * sin, 0.0))
    };
    let quads = (0..ALONG).map(|at| 2 * at).flat_map(|a| [a, a + 2, a + 1, a + 1, a + 2, a + 3]);
    let strap = FabricBuilder::new((0..=ALONG).flat_map(ends).collect(), quads.collect());
    strap.pin([0, 1, 2 * ALONG, 2 * ALONG + 1])
}

#[test]
fn straps_have_nodes_along_their_middle() {
    const WIDTH: f32 = 0.02;
    for cells in [0.7, 1.0, 1.4, 2.5] {
        let strap = strap(WIDTH).resampled(Resolution::CellSize(WIDTH * cells)).expect("good");
        let mut counts = [0; 3];
        for at in strap.fabric.rest_positions() {
            let across = (at.length() - 0.15) / WIDTH;
            counts[(2.0 * across).round() as usize] += 1;
        }
        let [inner, middle, _] = counts;
        assert!(2 * middle >= inner && middle <= inner + 2, "{counts:?} in cells of {cells}");
    }
}
