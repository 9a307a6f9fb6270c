use glam::{Vec2, Vec3};

use super::Term;
use crate::fabric::{Fabric, FabricBuilder, Grid, Interpolation, LinkFamily};

/// A sheet of `n` × `n` vertices over a square metre, those within moved by up to a fifth of a cell.
fn sheet(n: u32) -> FabricBuilder {
    let grid = Grid::new(n, n, 1.0, 1.0);
    let last = n - 1;
    let shift = |(index, at): (u32, &Vec3)| {
        let (column, row) = (index % n, index / n);
        let is_within = column % last != 0 && row % last != 0;
        let phase = index as f32;
        let away = Vec3::new(libm::sinf(2.3 * phase), libm::cosf(1.7 * phase), 0.0);
        *at + if is_within { away * (0.2 / last as f32) } else { Vec3::ZERO }
    };
    let positions = (0..).zip(&grid.positions()).map(shift).collect();
    FabricBuilder::new(positions, grid.triangles(false).into_flattened())
}

/// A disk of six sectors of `rings` rings.
fn disk(rings: u32) -> FabricBuilder {
    let around = 6 * rings;
    let at = |place: u32, ring: u32| {
        let (sin, cos) = libm::sincosf(core::f32::consts::TAU * place as f32 / around as f32);
        Vec3::new(cos, sin, 0.0) * (0.5 * ring as f32 / rings as f32)
    };
    let rim = |ring: u32| (0..around).map(move |place| at(place, ring));
    let positions = core::iter::once(Vec3::ZERO).chain((1..=rings).flat_map(rim)).collect();
    let index = |place: u32, ring: u32| match ring {
        0 => 0,
        _ => 1 + (ring - 1) * around + place % around,
    };
    let quads = (0..rings).flat_map(|ring| (0..around).map(move |place| [place, ring]));
    let indices = quads.flat_map(|[place, ring]| {
        let [a, b] = [place, place + 1].map(|place| index(place, ring));
        let [c, d] = [place, place + 1].map(|place| index(place, ring + 1));
        if ring == 0 { vec![a, c, d] } else { vec![a, c, d, a, d, b] }
    });
    FabricBuilder::new(positions, indices.collect())
}

/// Greatest difference of a plane's values from what a row interpolates from them.
fn error(rows: &Interpolation, from: &[Vec3], to: &[Vec3]) -> f32 {
    let plane = |at: &Vec3| 0.3 + at.dot(Vec3::new(1.0, -2.0, 0.0));
    let of_row = |(row, to): (&[Term], &Vec3)| {
        let sum: f32 = row.iter().map(|term| plane(&from[term.from as usize]) * term.weight).sum();
        (sum - plane(to)).abs()
    };
    rows.rows().zip(to).map(of_row).fold(0.0, f32::max)
}

#[test]
fn weights_reproduce_planes_and_keep_the_mass() {
    let fabric = sheet(22).build().expect("a good fabric");
    let background = fabric.background().expect("a flat mesh has a grid");
    let [particles, nodes] = [&fabric, &*background.fabric].map(|of| of.rest_positions());
    let transfer = &background.transfer;
    assert!(background.fabric.rest_bends().is_none(), "flat");
    assert!(error(&transfer.nodes, particles, nodes) < 1e-5);
    assert!(error(&transfer.particles, nodes, particles) < 1e-5);
    let masses = transfer.node_masses(fabric.particle_areas());
    let mass: f32 = masses.iter().sum();
    assert!((mass / fabric.area() - 1.0).abs() < 1e-3, "{mass}");
}

#[test]
fn a_disk_has_a_grid_that_reaches_beyond_its_border() {
    // A vertex on the border, and the first that lies between nodes.
    let pinned = |vertex| disk(12).pin([793, vertex]).build().expect("a good fabric");
    let is_between = |fabric: &Fabric| {
        let background = fabric.background().expect("a flat mesh has a grid");
        !background.transfer.heights.is_empty()
    };
    let fabric = (0..700).map(pinned).find(is_between).expect("vertices between nodes");
    let background = fabric.background().expect("a flat mesh has a grid");
    let (grid, transfer) = (&background.fabric, &background.transfer);
    let [particles, nodes] = [&fabric, &**grid].map(|of| of.rest_positions());
    assert!(nodes.iter().any(|at| at.length() > 0.6), "outside the disk");
    assert!((grid.area() / fabric.area() - 1.0).abs() < 0.01, "{} m²", grid.area());
    // Two nodes are moved to the pins, and no others are held.
    let pins: Vec<Vec3> =
        fabric.pins().iter().map(|pin| particles[pin.particle as usize]).collect();
    let held: Vec<Vec3> = grid.pins().iter().map(|pin| nodes[pin.particle as usize]).collect();
    let is_there = |pin: &Vec3| held.iter().any(|at| at.distance(*pin) < 1e-6);
    assert!(held.len() == 2 && pins.iter().all(is_there), "{held:?} {pins:?}");
    let with_cloth = transfer.nodes.rows_where(|node| grid.particle_areas()[node] > 0.0);
    let plane = |at: &Vec3| 0.3 + at.dot(Vec3::new(1.0, -2.0, 0.0));
    for (row, at) in with_cloth.rows().zip(nodes).filter(|(row, _)| !row.is_empty()) {
        let sum: f32 = row.iter().map(|it| plane(&particles[it.from as usize]) * it.weight).sum();
        assert!((sum - plane(at)).abs() < 1e-4, "{at}");
    }
    // Heights make up for what nodes were moved by.
    let is_moved = |row: &[Term]| row.iter().any(|term| grid.is_pinned(term.from as usize));
    for (particle, row) in transfer.particles.rows().enumerate().filter(|(_, row)| !is_moved(row)) {
        let sum: f32 = row.iter().map(|term| plane(&nodes[term.from as usize]) * term.weight).sum();
        assert!(row.is_empty() || (sum - plane(&particles[particle])).abs() < 1e-5);
    }
    assert_eq!(transfer.heights.len(), fabric.particle_count() - 2);
}

#[test]
fn cells_stand_for_all_of_the_cloth() {
    for n in [8, 12, 20] {
        let fabric = sheet(n).build().expect("a good fabric");
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
        assert!((area / fabric.area() - 1.0).abs() < 0.05, "{n}: {area}");
    }
}

/// A square metre of `n` × `n` vertices, rolled up about a vertical axis until its sides meet, without texture.
fn cylinder(n: u32) -> FabricBuilder {
    let sheet = Grid::new(n, n, 1.0, 1.0);
    rolled_up(&sheet.positions(), sheet.triangles(false).into_flattened())
}

fn rolled_up(flat: &[Vec3], triangles: Vec<u32>) -> FabricBuilder {
    let radius = 1.0 / core::f32::consts::TAU;
    let roll = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / radius);
        Vec3::new(radius * sin, at.y, radius * cos)
    };
    FabricBuilder::new(flat.iter().map(roll).collect(), triangles).weld_distance(1e-4)
}

/// The cylinder with its lower half cut open along the line where its sides meet.
fn slit_cylinder(n: u32) -> FabricBuilder {
    let whole = cylinder(n);
    let mut positions = whole.positions().to_vec();
    for row in n / 2..n {
        positions[(row * n) as usize] += Vec3::X * 1e-3;
    }
    FabricBuilder::new(positions, whole.indices().to_vec()).weld_distance(1e-4)
}

#[test]
fn edges_that_zigzag_take_no_more_effort_than_a_grid() {
    let grid = Grid::new(12, 12, 1.0, 1.0);
    let shift = |at: &Vec3| {
        let is_odd = (at.x * 11.0).round() as u32 % 2 == 1;
        let is_inside = at.y < 0.0 && at.y > -1.0 && at.x < 1.0;
        if is_odd && is_inside { *at + Vec3::Y * 0.03 } else { *at }
    };
    let positions = grid.positions().iter().map(shift).collect();
    let mesh = FabricBuilder::new(positions, grid.triangles(false).into_flattened());
    let [mesh, grid] = [mesh, FabricBuilder::grid(grid)]
        .map(|builder| builder.pin_where(|at, _| at.x == 0.0).build().expect("a good fabric"));
    assert!(mesh.background().is_some() && mesh.reach() > 1.01 * grid.reach());
    assert!((mesh.tautness() / grid.tautness() - 1.0).abs() < 1e-3, "{}", mesh.tautness());
}

#[test]
fn a_closed_mesh_has_a_grid_around_its_axis() {
    let fabric = cylinder(25).build().expect("a good fabric");
    let background = fabric.background().expect("it can be unfolded");
    let grid = background.fabric.grid().expect("a grid");
    assert_eq!([grid.columns, grid.rows], [25, 25], "one node at each vertex");
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

/// Nodes are moved to pins between nodes, on both sides of the seam.
#[test]
fn a_closed_mesh_is_held_at_single_pins() {
    let flat = sheet(24);
    for pin in [24 * 7 + 11, 24 * 9, 24 * 12 + 1] {
        let mesh = rolled_up(flat.positions(), flat.indices().to_vec()).pin([pin]);
        let fabric = mesh.build().expect("a good fabric");
        let particle = fabric.particle_of_vertex()[pin as usize] as usize;
        let nodes = &fabric.background().expect("it can be unfolded").fabric;
        let pinned = (0..nodes.particle_count()).filter(|&node| nodes.is_pinned(node));
        let at = |node: usize| nodes.rest_positions()[node];
        let away = pinned.map(|node| at(node).distance(fabric.rest_positions()[particle]));
        let farthest = away.clone().fold(0.0, f32::max);
        assert!(away.count() > 0 && farthest < 0.1 / 23.0, "{farthest} m");
    }
}

/// Nodes lie on the vertices of a mesh in rows and columns, whatever its sides.
#[test]
fn the_grid_of_a_regular_mesh_is_its_own() {
    for (columns, rows) in [(12, 12), (31, 11), (9, 40)] {
        let own = Grid::new(columns, rows, (columns - 1) as f32 * 0.1, (rows - 1) as f32 * 0.1);
        let mesh = FabricBuilder::new(own.positions(), own.triangles(true).into_flattened());
        let fabric = mesh.build().expect("a good fabric");
        let nodes = &fabric.background().expect("a flat mesh has a grid").fabric;
        let near =
            |node: &Vec3| own.positions().iter().map(|at| at.distance(*node)).fold(1.0, f32::min);
        assert_eq!(nodes.particle_count(), own.positions().len());
        assert!(nodes.rest_positions().iter().all(|node| near(node) < 1e-4), "{columns} × {rows}");
    }
}

fn bent_disk() -> FabricBuilder {
    let bent = disk(8).positions().iter().map(|at| *at + Vec3::Z * at.x * at.x).collect();
    FabricBuilder::new(bent, disk(8).indices().to_vec())
}

/// Planes that are fitted to free places alone do not exist there: nodes beyond the border were all at one place.
#[test]
fn nodes_of_a_curved_mesh_with_few_free_vertices_are_apart() {
    for pinned in [|_: Vec3| true, |at: Vec3| at.y.abs() > 1e-3, |at: Vec3| at.length() > 1e-3] {
        let fabric = bent_disk().pin_where(move |at, _| pinned(at)).build().expect("a fabric");
        let nodes = &fabric.background().expect("it has a grid").fabric;
        let shortest = nodes.links().iter().map(|link| link.rest_length).fold(f32::MAX, f32::min);
        assert!(shortest > 1e-3, "{shortest} m");
    }
}

#[test]
fn the_parts_of_a_curved_grid_are_those_of_a_flat_one() {
    let part = |builder: FabricBuilder| {
        let fabric = builder.build().expect("a good fabric");
        let nodes = &fabric.background().expect("it has a grid").fabric;
        let with_cloth = (0..nodes.particle_count()).filter(|at| nodes.particle_areas()[*at] > 0.0);
        let parts: Vec<f32> = with_cloth.map(|at| nodes.part_of(at)).collect();
        (parts.iter().sum::<f32>() / parts.len() as f32, parts.into_iter().fold(1.0, f32::min))
    };
    let ((flat, least_flat), (bent, least_bent)) = (part(disk(8)), part(bent_disk()));
    assert!((bent / flat - 1.0).abs() < 0.05, "{bent} for {flat}");
    assert!(least_bent > 0.5 * least_flat, "{least_bent} for {least_flat}");
}

#[test]
fn meshes_that_are_no_charts_keep_their_own_chains() {
    // The nodes of a mesh of quads may be its own particles, in no rows and columns.
    let has_grid = |builder: FabricBuilder| {
        let fabric = builder.build().expect("a good fabric");
        fabric.background().is_some_and(|background| background.fabric.grid().is_some())
    };
    assert!(has_grid(sheet(12)));
    let indices = sheet(12).indices().to_vec();
    let from_above: Vec<Vec2> = sheet(12).positions().iter().map(|at| at.truncate()).collect();
    let raised_by = |height: fn(Vec3) -> f32| {
        let up = |at: &Vec3| *at + Vec3::Z * height(*at);
        FabricBuilder::new(sheet(12).positions().iter().map(up).collect(), indices.clone())
    };
    let arch = raised_by(|at| 2.0 * at.x * at.x);
    assert!(has_grid(arch.clone()), "not flat, without texture, but it can be unfolded");
    assert!(has_grid(arch.uv(from_above.clone())), "a distorted texture");
    let flat_dome = raised_by(|at| -0.2 * (at - Vec3::new(0.5, -0.5, 0.0)).length_squared());
    assert!(has_grid(flat_dome.clone().uv(from_above.clone())), "a texture like the shape");
    let dome = raised_by(|at| -3.0 * at.length_squared());
    assert!(has_grid(dome.clone()), "unfolded with curved lines");
    assert!(has_grid(dome.uv(from_above)), "a distorted texture");
    let doubled: Vec<Vec3> =
        sheet(12).positions().iter().chain(sheet(12).positions()).copied().collect();
    let count = doubled.len() as u32 / 2;
    let twice = indices.iter().copied().chain(indices.iter().map(|at| at + count)).collect();
    let overlapping = FabricBuilder::new(doubled, twice).weld_distance(0.0);
    assert!(!has_grid(overlapping), "two sheets at one place");
    assert!(!has_grid(sheet(4)), "small");
    // From the middle of a side to the middle of the sheet, between columns of nodes.
    let slit = |corners: &&[u32]| {
        let corner = |at: &u32| sheet(22).positions()[*at as usize];
        let middle: Vec3 = corners.iter().map(corner).sum::<Vec3>() / 3.0;
        (middle.x - 0.5).abs() > 0.02 || middle.y > -0.5
    };
    let kept: Vec<u32> = sheet(22).indices().chunks(3).filter(slit).flatten().copied().collect();
    assert!(has_grid(sheet(22)) && kept.len() < sheet(22).indices().len());
    let with_slit = FabricBuilder::new(sheet(22).positions().to_vec(), kept);
    assert!(!has_grid(with_slit.repair().expect("a mesh").0), "a slit");
    assert!(!has_grid(slit_cylinder(25)), "a narrow slit across the seam of a closed grid");
    assert!(has_grid(bent_disk()), "curved, with nodes outside");
    assert!(!has_grid(FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0))), "a grid");
}

#[test]
fn rows_run_along_the_warp() {
    for warp in [Vec2::X, Vec2::Y] {
        let uv = |at: &Vec3| Vec2::new(warp.dot(at.truncate()), warp.perp_dot(at.truncate()));
        let uv = sheet(12).positions().iter().map(uv).collect();
        let fabric = sheet(12).uv(uv).build().expect("a good fabric");
        let background = fabric.background().expect("a flat mesh has a grid");
        assert!((background.warp_cos2 - 1.0).abs() < 1e-3, "{}", background.warp_cos2);
        let nodes = background.fabric.rest_positions();
        let row = (nodes[1] - nodes[0]).normalize();
        assert!(row.dot(warp.extend(0.0)).abs() > 0.999, "{row} for a warp along {warp}");
    }
}

#[test]
fn links_of_curved_lines_stand_for_all_of_the_cloth() {
    let tapered = |at: Vec3| Vec3::new((at.x - 0.5) * (1.0 + 0.3 * at.y), at.y, 0.0);
    let positions = sheet(16).positions().iter().map(|at| tapered(*at)).collect();
    let fabric = FabricBuilder::new(positions, sheet(16).indices().to_vec());
    let fabric = fabric.build().expect("a good fabric");
    let background = fabric.background().expect("it maps onto a rectangle");
    let grid = &background.fabric;
    assert_eq!(grid.chains().diagonal_lengths.len(), grid.chains().cells.len());
    for family in [LinkFamily::Warp, LinkFamily::Weft] {
        let links = grid.links().iter().filter(|link| link.family == family);
        let area: f32 = links
            .map(|link| {
                let factors = grid.link_classes()[link.class as usize].coefficients;
                factors.iter().sum::<f32>() * link.rest_length * link.rest_length
            })
            .sum();
        assert!((area / fabric.area() - 1.0).abs() < 0.02, "{family:?}: {area}");
    }
    let corners = [0, grid.grid().expect("a grid").columns - 1].map(|at| at as usize);
    let nodes = grid.rest_positions();
    for node in corners {
        let nearest = fabric.rest_positions().iter().map(|at| at.distance(nodes[node]));
        assert!(
            nearest.fold(f32::MAX, f32::min) < 5e-3,
            "a corner of the grid lies at {}",
            nodes[node]
        );
    }
}
