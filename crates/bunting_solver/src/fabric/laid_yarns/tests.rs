use std::collections::HashMap;

use glam::Vec3;

use super::lay::MOST_PIECES;
use super::{BAND, LaidYarn, Towards};
use crate::fabric::{Fabric, FabricBuilder, LinkFamily};

/// A mesh of `n` × `n` vertices in uneven cells, rolled up about a vertical axis to a closed funnel twice as wide
/// below. Its warp cannot be laid into the plane without distortion, and a cell is missing, so that it has no background
/// grid.
fn funnel(n: u32) -> Fabric {
    let radius = 1.0 / core::f32::consts::TAU;
    let place = |index: u32| {
        let (column, row) = ((index % n) as f32, (index / n) as f32);
        let shift = 0.2 * libm::sinf(7.0 * column + 11.0 * row);
        let is_inside = column > 0.0 && column < (n - 1) as f32;
        let across = (column + if is_inside { shift } else { 0.0 }) / (n - 1) as f32;
        let (sin, cos) = libm::sincosf(across / radius);
        let down = row / (n - 1) as f32;
        let wide = radius * (1.0 + down);
        Vec3::new(wide * sin, -down, wide * cos)
    };
    let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
    let hole = n / 2 * n + n / 2;
    let cells = cells.filter(|&at| at != hole);
    let indices = cells.flat_map(|at| [at, at + n, at + n + 1, at, at + n + 1, at + 1]);
    let builder = FabricBuilder::new((0..n * n).map(place).collect(), indices.collect());
    builder.weld_distance(1e-5).build().expect("a good fabric")
}

fn fabrics() -> [Fabric; 3] {
    [16, 20, 25].map(funnel)
}

/// The area that the links of a family stand for.
fn area(yarns: &[LaidYarn], family: LinkFamily) -> f32 {
    let links = yarns.iter().flat_map(|yarn| &yarn.links).filter(|link| link.family == family);
    links.map(|link| link.rest_length * link.rest_length / link.slenderness).sum()
}

#[test]
fn links_of_each_direction_stand_for_all_of_the_cloth() {
    for fabric in fabrics() {
        let yarns = &fabric.laid_yarns().list;
        let expected =
            [(LinkFamily::Warp, 1.0), (LinkFamily::Weft, 1.0), (LinkFamily::Diagonal, 2.0)];
        for (family, directions) in expected {
            let error = area(yarns, family) / (directions * fabric.area()) - 1.0;
            assert!(error.abs() < 0.08, "{family:?}: {error}");
        }
    }
}

#[test]
fn no_particle_moves_links_that_are_farther_apart_than_the_band() {
    for fabric in fabrics() {
        for yarn in &fabric.laid_yarns().list {
            assert_eq!(yarn.nodes.len(), yarn.links.len() + 1);
            let mut moved: HashMap<u32, (usize, usize)> = HashMap::new();
            for (link, ends) in yarn.nodes.windows(2).enumerate() {
                for particle in ends.iter().flat_map(|node| node.particles) {
                    moved.entry(particle).or_insert((link, link)).1 = link;
                }
            }
            assert!(moved.values().all(|(first, last)| last - first <= BAND));
            let couplings: usize =
                yarn.links.iter().flat_map(|link| link.couplings).map(usize::from).sum();
            assert_eq!(couplings, yarn.couplings.len());
        }
    }
}

#[test]
fn yarns_of_one_colour_share_no_particle_and_are_sorted_by_length() {
    for fabric in fabrics() {
        let yarns = fabric.laid_yarns();
        let mut next = 0;
        for colour in yarns.colours.ranges() {
            assert_eq!(colour.start, next);
            next = colour.end;
            let yarns = &yarns.list[colour.clone()];
            assert!(yarns.is_sorted_by(|one, next| one.links.len() >= next.links.len()));
            let mut moved_by: HashMap<u32, usize> = HashMap::new();
            for (index, yarn) in yarns.iter().enumerate() {
                for particle in yarn.nodes.iter().flat_map(|node| node.particles) {
                    assert_eq!(*moved_by.entry(particle).or_insert(index), index);
                }
            }
        }
        assert_eq!(next, yarns.list.len());
    }
}

#[test]
fn yarns_move_each_particle_and_close_rings() {
    for fabric in fabrics() {
        let yarns = &fabric.laid_yarns().list;
        let mut is_moved = vec![false; fabric.particle_count()];
        for node in yarns.iter().flat_map(|yarn| &yarn.nodes) {
            node.particles.iter().for_each(|&particle| is_moved[particle as usize] = true);
        }
        assert!(is_moved.iter().all(|&is_moved| is_moved));
    }
    // Around the funnel run some 24 rings. Each has one link that closes it.
    let closing = funnel(25).laid_yarns().list.iter().filter(|yarn| yarn.links.len() == 1).count();
    assert!(closing >= 20, "{closing} links close rings");
}

/// A ball of 0.3 m with rings of quads between two poles, whose directions turn about the poles.
fn ball(rings: u32, around: u32) -> FabricBuilder {
    let place = |ring: u32, at: u32| {
        let (up, out) = libm::sincosf(core::f32::consts::PI * ring as f32 / rings as f32);
        let (sin, cos) = libm::sincosf(core::f32::consts::TAU * at as f32 / around as f32);
        0.3 * Vec3::new(up * cos, out, up * sin)
    };
    let inner = (1..rings).flat_map(|ring| (0..around).map(move |at| place(ring, at)));
    let poles = [place(0, 0), place(rings, 0)];
    let positions: Vec<Vec3> = inner.chain(poles).collect();
    let [top, bottom] = [2, 1].map(|back| positions.len() as u32 - back);
    let vertex = |ring: u32, at: u32| (ring - 1) * around + at % around;
    let mut indices = Vec::new();
    for at in 0..around {
        indices.extend([top, vertex(1, at + 1), vertex(1, at)]);
        indices.extend([bottom, vertex(rings - 1, at), vertex(rings - 1, at + 1)]);
        for ring in 1..rings - 1 {
            let [a, b] = [vertex(ring, at), vertex(ring, at + 1)];
            let [c, d] = [vertex(ring + 1, at), vertex(ring + 1, at + 1)];
            indices.extend([a, b, c, b, d, c]);
        }
    }
    FabricBuilder::new(positions, indices)
}

#[test]
fn laying_ends_where_directions_turn_about_points() {
    for [rings, around] in [[16, 16], [24, 24], [16, 32]] {
        let fabric = ball(rings, around).build().expect("a good fabric");
        let links = fabric.laid_yarns().link_count();
        assert!((1..50 * fabric.particle_count()).contains(&links), "{links} links");
    }
}

/// A closed prism with edges of 1 m around, rings of vertices a distance apart, m, and ends of triangles about a vertex.
fn prism(around: u32, rings: u32, apart: f32) -> FabricBuilder {
    let radius = 0.5 / libm::sinf(core::f32::consts::PI / around as f32);
    let place = |ring: u32, at: u32| {
        let (sin, cos) = libm::sincosf(core::f32::consts::TAU * at as f32 / around as f32);
        Vec3::new(radius * cos, apart * ring as f32, radius * sin)
    };
    let positions = (0..rings).flat_map(|ring| (0..around).map(move |at| place(ring, at)));
    let vertex = |ring: u32, at: u32| ring * around + at % around;
    let mut indices = Vec::new();
    for at in 0..around {
        for ring in 0..rings - 1 {
            let [a, b] = [vertex(ring, at), vertex(ring, at + 1)];
            let [c, d] = [vertex(ring + 1, at), vertex(ring + 1, at + 1)];
            indices.extend([a, c, b, b, c, d]);
        }
    }
    for at in 1..around - 1 {
        indices.extend([0, at, at + 1].map(|at| vertex(0, at)));
        indices.extend([0, at + 1, at].map(|at| vertex(rings - 1, at)));
    }
    FabricBuilder::new(positions.collect(), indices)
}

#[test]
fn laying_ends_on_closed_prisms() {
    // The ends are at right angles to the warp of the sides. About the narrower one, lines wind hundreds of times.
    for (around, rings, apart) in [(5, 14, 30.0), (24, 2, 8000.0)] {
        let fabric = prism(around, rings, apart).build().expect("a good fabric");
        let yarns = fabric.laid_yarns();
        let most = MOST_PIECES * Towards::ALL.len() * fabric.triangles().len();
        assert!((1..most).contains(&yarns.link_count()), "{} links", yarns.link_count());
        let mut links = yarns.list.iter().flat_map(|yarn| &yarn.links);
        assert!(links.all(|link| link.rest_length.is_finite() && link.slenderness.is_finite()));
    }
}
