use glam::{Vec2, Vec3};

use super::Term;
use crate::fabric::{FabricBuilder, Grid, Interpolation};

/// A disk of half a metre: rings of six, twelve, eighteen … vertices about its centre.
fn disk(rings: u32) -> FabricBuilder {
    let mut positions = vec![Vec3::ZERO];
    let mut indices = Vec::new();
    let first = |ring: u32| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) };
    for ring in 1..=rings {
        let count = 6 * ring;
        for place in 0..count {
            let angle = core::f32::consts::TAU * place as f32 / count as f32;
            let (sin, cos) = (libm::sinf(angle), libm::cosf(angle));
            positions.push(Vec3::new(cos, sin, 0.0) * (0.5 * ring as f32 / rings as f32));
        }
        let inner = |place: u32| first(ring - 1) + if ring > 1 { place % (count - 6) } else { 0 };
        let outer = |place: u32| first(ring) + place % count;
        for sector in 0..6 {
            for at in 0..ring {
                let (out, within) = (sector * ring + at, sector * (ring - 1) + at);
                indices.extend([outer(out), outer(out + 1), inner(within)]);
                if at + 1 < ring {
                    indices.extend([inner(within), outer(out + 1), inner(within + 1)]);
                }
            }
        }
    }
    FabricBuilder::new(positions, indices)
}

/// Greatest difference of a plane's values from what a row interpolates from them.
fn error(rows: &Interpolation, from: &[Vec3], to: &[Vec3]) -> f32 {
    let plane = |at: &Vec3| 0.3 + at.dot(Vec3::new(1.0, -2.0, 0.0));
    let of_row = |(row, to): (&[Term], &Vec3)| {
        let sum: f32 = row.iter().map(|term| plane(&from[term.from as usize]) * term.weight).sum();
        if row.is_empty() { 0.0 } else { (sum - plane(to)).abs() }
    };
    rows.rows().zip(to).map(of_row).fold(0.0, f32::max)
}

#[test]
fn weights_reproduce_planes_and_keep_the_mass() {
    let fabric = disk(12).build().expect("a good fabric");
    let background = fabric.background().expect("a flat mesh has a grid");
    let [particles, nodes] = [&fabric, &*background.fabric].map(|of| of.rest_positions());
    let transfer = &background.transfer;
    assert!(!transfer.is_whole, "nodes lie outside a disk");
    assert!(error(&transfer.nodes, particles, nodes) < 1e-5);
    assert!(error(&transfer.particles, nodes, particles) < 1e-5);
    let masses = transfer.node_masses(fabric.particle_areas());
    let in_mesh = masses.iter().zip(transfer.nodes.rows()).filter(|(_, row)| !row.is_empty());
    let mass: f32 = in_mesh.map(|(mass, _)| mass).sum();
    assert!((mass / fabric.area() - 1.0).abs() < 0.02, "{mass}");
}

#[test]
fn cells_stand_for_all_of_the_cloth() {
    for rings in [8, 12, 20] {
        let fabric = disk(rings).build().expect("a good fabric");
        let mesh = fabric.background().expect("a flat mesh has a grid");
        // Warp links store ½ k l² = ½ Y A at a strain of one, A being the area that they stand for.
        let warp = mesh.fabric.links().iter().filter(|link| link.family as u32 == 0);
        let area: f32 = warp
            .map(|link| {
                let [one, ..] = mesh.fabric.link_classes()[link.class as usize].coefficients;
                one * link.rest_length * link.rest_length
            })
            .sum();
        // Negative coefficients, which make room for diagonals, are left out of none: the sum is the area.
        assert!((area / fabric.area() - 1.0).abs() < 0.05, "{rings}: {area}");
    }
}

/// A square metre of `n` × `n` vertices, rolled up about a vertical axis until its sides meet, without texture.
fn cylinder(n: u32) -> FabricBuilder {
    let sheet = Grid::new(n, n, 1.0, 1.0);
    let radius = 1.0 / core::f32::consts::TAU;
    let roll = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / radius);
        Vec3::new(radius * sin, at.y, radius * cos)
    };
    let positions = sheet.positions().iter().map(roll).collect();
    let triangles = sheet.triangles(false).into_flattened();
    FabricBuilder::new(positions, triangles).weld_distance(1e-4)
}

#[test]
fn a_closed_mesh_has_a_grid_around_its_axis() {
    let fabric = cylinder(25).build().expect("a good fabric");
    let background = fabric.background().expect("it can be unfolded");
    let transfer = &background.transfer;
    let nodes = background.fabric.rest_positions();
    assert_eq!(transfer.joined.len(), 25);
    for joined in &transfer.joined {
        let [first, second] = joined.map(|node| nodes[node as usize]);
        assert!(first.distance(second) < 1e-5, "{first} {second}");
        let [first, second] = joined.map(|node| transfer.moved_areas[node as usize]);
        assert_eq!(first, second);
    }
    let mass: f32 = transfer.moved_areas.iter().sum();
    assert!((mass / fabric.area() - 1.0).abs() < 1e-3, "{mass}");
}

#[test]
fn meshes_that_are_no_charts_keep_their_own_chains() {
    let has_grid =
        |builder: FabricBuilder| builder.build().expect("a good fabric").background().is_some();
    assert!(has_grid(disk(8)));
    let indices = disk(8).indices().to_vec();
    let from_above: Vec<Vec2> = disk(8).positions().iter().map(|at| at.truncate()).collect();
    let raised_by = |height: fn(Vec3) -> f32| {
        let up = |at: &Vec3| *at + Vec3::Z * height(*at);
        FabricBuilder::new(disk(8).positions().iter().map(up).collect(), indices.clone())
    };
    let arch = raised_by(|at| 2.0 * at.x * at.x);
    assert!(has_grid(arch.clone()), "not flat, without texture, but it can be unfolded");
    assert!(has_grid(arch.uv(from_above.clone())), "a distorted texture");
    let flat_dome = raised_by(|at| -0.5 * at.length_squared());
    assert!(has_grid(flat_dome.clone().uv(from_above.clone())), "a texture like the shape");
    let dome = raised_by(|at| -3.0 * at.length_squared());
    assert!(!has_grid(dome.clone()), "a dome");
    assert!(!has_grid(dome.uv(from_above)), "a distorted texture");
    let doubled: Vec<Vec3> =
        disk(8).positions().iter().chain(disk(8).positions()).copied().collect();
    let count = doubled.len() as u32 / 2;
    let twice = indices.iter().copied().chain(indices.iter().map(|at| at + count)).collect();
    let overlapping = FabricBuilder::new(doubled, twice).weld_distance(0.0);
    assert!(!has_grid(overlapping), "two disks at one place");
    assert!(!has_grid(disk(2)), "small");
    // Some vertices lie near a node, and others between nodes.
    let pinned = [true, false].map(|held| (0..60).any(|at| has_grid(disk(8).pin([at])) == held));
    assert_eq!(pinned, [true; 2]);
    assert!(!has_grid(FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0))), "a grid");
}

#[test]
fn rows_run_along_the_warp() {
    for warp in [Vec2::X, Vec2::Y] {
        let uv = |at: &Vec3| Vec2::new(warp.dot(at.truncate()), warp.perp_dot(at.truncate()));
        let uv = disk(8).positions().iter().map(uv).collect();
        let fabric = disk(8).uv(uv).build().expect("a good fabric");
        let background = fabric.background().expect("a flat mesh has a grid");
        assert!((background.warp_cos2 - 1.0).abs() < 1e-3, "{}", background.warp_cos2);
        let nodes = background.fabric.rest_positions();
        let row = (nodes[1] - nodes[0]).normalize();
        assert!(row.dot(warp.extend(0.0)).abs() > 0.999, "{row} for a warp along {warp}");
    }
}

/// A ring of `around` × `across` quads between two radii, m.
fn ring(around: u32, across: u32, [inner, outer]: [f32; 2]) -> FabricBuilder {
    let at = |circle: u32, place: u32| {
        let angle = core::f32::consts::TAU * place as f32 / around as f32;
        let radius = inner + (outer - inner) * circle as f32 / across as f32;
        Vec3::new(libm::cosf(angle), libm::sinf(angle), 0.0) * radius
    };
    let quads = |circle: u32| (0..around).map(move |place| [circle, place]);
    let positions = (0..=across).flat_map(quads).map(|[circle, place]| at(circle, place));
    let index = |circle: u32, place: u32| circle * around + place % around;
    let indices = (0..across).flat_map(quads).flat_map(|[circle, place]| {
        let corner = |out, on| index(circle + out, place + on);
        [corner(0, 0), corner(1, 0), corner(0, 1), corner(0, 1), corner(1, 0), corner(1, 1)]
    });
    FabricBuilder::new(positions.collect(), indices.collect())
}

#[test]
fn a_mesh_whose_particles_do_not_show_the_nodes_has_no_grid() {
    let has_grid =
        |mesh: FabricBuilder| mesh.build().expect("a good fabric").background().is_some();
    assert!(has_grid(ring(48, 8, [0.3, 0.6])), "quads nearly square");
    assert!(!has_grid(ring(27, 24, [0.2, 0.6])), "quads eight times as wide as high outside");
}
