use std::sync::Arc;

use glam::Vec3;

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch};
use crate::fabric::{Fabric, FabricBuilder, LinkFamily};

const AROUND: u32 = 24;
const ROWS: u32 = 15;
/// Row in which the slit ends.
const TIP: u32 = 7;

/// A tube with a slit from below, whose vertices are moved along it by a part of a cell in turns.
fn slit_tube(moved: f32) -> FabricBuilder {
    let place = |column: u32, row: u32| {
        let (sin, cos) = libm::sincosf(core::f32::consts::TAU * column as f32 / AROUND as f32);
        // Below its tip the slit opens a little.
        let gap = if column == AROUND && row > TIP { 1e-3 } else { 0.0 };
        let zigzag = if column % 2 == 1 { moved } else { 0.0 };
        Vec3::new(0.2 * sin - gap, -0.05 * (row as f32 + zigzag), 0.2 * cos)
    };
    let rows = 0..ROWS - 1;
    let quads = rows.flat_map(|row| (0..AROUND).map(move |column| (column, row)));
    let positions = quads.flat_map(|(column, row)| {
        [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(right, down)| place(column + right, row + down))
    });
    let positions: Vec<Vec3> = positions.collect();
    let first = (0..positions.len() as u32).step_by(4);
    let corners = first.flat_map(|at| [0, 1, 2, 0, 2, 3].map(|by| at + by)).collect();
    FabricBuilder::new(positions, corners).weld_distance(1e-4)
}

fn net(builder: FabricBuilder) -> Option<Fabric> {
    let fabric = builder.build().expect("a good fabric");
    let background = fabric.background()?;
    background.fabric.grid().is_none().then(|| (*background.fabric).clone())
}

#[test]
fn lines_close_around_a_tube_and_end_at_a_slit() {
    let net = net(slit_tube(0.0)).expect("a net");
    let lines = || net.yarns().iter().filter(|yarn| yarn.links.len() > 1);
    let rings = lines().filter(|yarn| yarn.particles.first() == yarn.particles.last());
    let around = lines().filter(|yarn| yarn.links.len() == AROUND as usize);
    assert_eq!(rings.count(), TIP as usize + 1);
    assert_eq!(around.count(), ROWS as usize);
    let down = lines().filter(|yarn| yarn.links.len() == ROWS as usize - 1);
    // At the tip one side of the slit goes on upwards, and the other one ends.
    assert_eq!(down.count(), AROUND as usize);
    assert_eq!(net.chains().cells.len() as u32, AROUND * (ROWS - 1));
}

/// Rows and columns stand for all of the cloth, each by itself.
#[test]
fn links_stand_for_all_of_the_cloth() {
    let net = net(slit_tube(0.0)).expect("a net");
    let area: f32 = net.particle_areas().iter().sum();
    for family in [0, 1] {
        let of_link = |link: &crate::fabric::Link| {
            net.link_classes()[link.class as usize].coefficients[family] * link.rest_length.powi(2)
        };
        let cloth: f32 = net.links().iter().map(of_link).sum();
        assert!((cloth / area - 1.0).abs() < 0.01, "{family}: {cloth} of {area} m²");
    }
}

/// Lines that zigzag straighten under load.
#[test]
fn lines_that_zigzag_are_no_net() {
    assert!(net(slit_tube(0.02)).is_some());
    assert!(net(slit_tube(0.2)).is_none());
}

/// Of each quad at the rims one triangle is cut off.
#[test]
fn a_net_may_have_a_few_triangles() {
    let whole = slit_tube(0.0);
    let is_at_rim = |quad: u32| [0, ROWS - 2].contains(&(quad / AROUND));
    let quads = (0..).zip(whole.indices().chunks(6));
    let left = quads.map(|(quad, corners)| if is_at_rim(quad) { &corners[..3] } else { corners });
    let indices = left.flatten().copied().collect();
    let mesh = FabricBuilder::new(whole.positions().to_vec(), indices).weld_distance(1e-4);
    let serrated = net(mesh.repair().expect("a mesh that can be repaired").0).expect("a net");
    assert_eq!(serrated.chains().cells.len() as u32, AROUND * (ROWS - 3));
}

/// The lines of a lid of two rings of cells meet at the node in its middle.
#[test]
fn a_lid_of_a_tube_has_a_pole() {
    let tube = slit_tube(0.0);
    let rim = |quad: u32| tube.positions()[4 * (quad % AROUND) as usize];
    let inner = |quad: u32| 0.5 * rim(quad) + 0.01 * Vec3::Y;
    let cells = (0..AROUND).flat_map(|at| {
        let (outer, outer_next) = (rim(at), rim(at + 1));
        let (inner, inner_next) = (inner(at), inner(at + 1));
        let quad = [outer, outer_next, inner_next, outer, inner_next, inner];
        quad.into_iter().chain([inner, inner_next, 0.01 * Vec3::Y])
    });
    let places: Vec<Vec3> = cells.collect();
    let first = tube.positions().len() as u32;
    let indices = tube.indices().iter().copied().chain(first..first + places.len() as u32);
    let positions = tube.positions().iter().copied().chain(places.iter().copied()).collect();
    let closed = FabricBuilder::new(positions, indices.collect()).weld_distance(1e-4);
    let net = net(closed).expect("a net");
    let is_pole = |at: &u32| net.rest_positions()[*at as usize] == 0.01 * Vec3::Y;
    let at_pole = net.links().iter().filter(|link| link.particles.iter().any(is_pole));
    let straight = at_pole.filter(|link| link.family != LinkFamily::Diagonal);
    assert_eq!(straight.count(), AROUND as usize);
}

#[test]
fn a_strip_whose_triangles_face_both_ways_has_no_net() {
    const LENGTH: u32 = 60;
    let place = |column: u32, row: u32| {
        let turn = core::f32::consts::TAU * column as f32 / LENGTH as f32;
        let ((sin, cos), (rise, out)) = (libm::sincosf(turn), libm::sincosf(0.5 * turn));
        let across = 0.05 * (row as f32 - 1.0);
        Vec3::new((0.5 + out * across) * sin, rise * across, (0.5 + out * across) * cos)
    };
    let quads = (0..2).flat_map(|row| (0..LENGTH).map(move |column| (column, row)));
    let positions: Vec<Vec3> = quads
        .flat_map(|(column, row)| {
            [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(right, down)| place(column + right, row + down))
        })
        .collect();
    let first = (0..positions.len() as u32).step_by(4);
    let corners = first.flat_map(|at| [0, 1, 2, 0, 2, 3].map(|by| at + by)).collect();
    let strip = FabricBuilder::new(positions, corners).weld_distance(1e-4);
    let strip = strip.build().expect("a Möbius strip");
    assert!(strip.background().is_none());
}

/// A lone one is solved eight lines at once.
#[test]
fn the_net_of_a_single_mesh_lies_across_the_lanes() {
    let fabric = Arc::new(slit_tube(0.0).build().expect("a good fabric"));
    let single = LaneBatch::single_mesh(&fabric).expect("a mesh with a net");
    assert!(matches!(single.background, Some(BackgroundGrid::SingleNet(_))));
}
