//! How far each particle may be from the pin that is nearest to it, and from the one that is farthest.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use glam::Vec3;

use super::topology::Edge;

/// A particle and the pin that it must not stray from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tether {
    /// The free particle.
    pub particle: u32,
    /// The pinned one.
    pub pin: u32,
    /// Greatest distance between the two, m.
    pub length: f32,
}

/// Slack of a tether to a pin among pins, as a part of its length: more than a cloth's own strain.
const LINE_SLACK: f32 = 0.005;

/// Slack of a tether along the bias, to a pin that stands alone or to the farthest: a cloth that hangs by
/// points shears, and lies further from them than its rest shape says.
const BIAS_SLACK: f32 = 0.05;

/// A pinned particle, and whether it stands alone: no edge joins it to another pinned one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pin {
    pub particle: u32,
    pub alone: bool,
}

/// All pins.
pub(crate) fn pins(edges: &[Edge], pinned: &[bool]) -> Vec<Pin> {
    let mut alone = pinned.to_vec();
    for [a, b] in edges.iter().map(|edge| edge.ends.map(|end| end as usize)) {
        if pinned[a] && pinned[b] {
            (alone[a], alone[b]) = (false, false);
        }
    }
    (0..)
        .zip(pinned)
        .filter(|(_, pinned)| **pinned)
        .map(|(particle, _)| Pin { particle, alone: alone[particle as usize] })
        .collect()
}

/// The tether of each free particle that a pin can be reached from. `flat` says that the shortest
/// way between two particles at rest is straight.
pub(crate) fn tethers(rest: &[Vec3], edges: &[Edge], pins: &[Pin], flat: bool) -> Vec<Tether> {
    let edges = edges.iter().map(|edge| edge.ends);
    let nearest =
        if flat { nearest_straight(rest, pins) } else { nearest_along(rest, edges, pins) };
    (0..)
        .zip(nearest)
        .filter_map(|(particle, nearest)| {
            let (length, pin) = nearest?;
            let Pin { particle: pin, alone } = pins[pin];
            let slack = if alone { BIAS_SLACK } else { LINE_SLACK };
            (pin != particle && length > 0.0).then_some(Tether {
                particle,
                pin,
                length: length * (1.0 + slack),
            })
        })
        .collect()
}

/// The tethers of free particles to the pins that are farthest from them at rest: to the nearest alone, the
/// lower corner of a flag may come to lie beneath its pole. Only of those that lie further from it than any
/// lies from its nearest, the `reach`; they hold the others. Given the tethers to the nearest, and `flat` as
/// above.
pub(crate) fn far_tethers(
    rest: &[Vec3],
    edges: &[Edge],
    pins: &[Pin],
    near: &[Tether],
    reach: f32,
    flat: bool,
) -> Vec<Tether> {
    let mut of_pins: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for &Tether { particle, .. } in near {
        let distance = |pin: &Pin| rest[particle as usize].distance(rest[pin.particle as usize]);
        let distances = pins.iter().map(distance).enumerate();
        if let Some((farthest, _)) = distances.max_by(|one, other| one.1.total_cmp(&other.1)) {
            of_pins.entry(farthest).or_default().push(particle);
        }
    }
    let of_pin = |(pin, particles): (usize, Vec<u32>)| {
        let lengths = distances(rest, edges.iter().map(|edge| edge.ends), pins[pin], flat);
        let pin = pins[pin].particle;
        particles.into_iter().filter_map(move |particle| {
            let length = lengths[particle as usize];
            let far = length > reach && length.is_finite();
            far.then_some(Tether { particle, pin, length: length * (1.0 + BIAS_SLACK) })
        })
    };
    of_pins.into_iter().flat_map(of_pin).collect()
}

/// For each particle the distance to the nearest pin, and which it is.
fn nearest_straight(rest: &[Vec3], pins: &[Pin]) -> Vec<Option<(f32, usize)>> {
    let distance = |at: Vec3, pin: &Pin| at.distance(rest[pin.particle as usize]);
    rest.iter()
        .map(|&at| {
            let distances = pins.iter().enumerate().map(|(index, pin)| (distance(at, pin), index));
            distances.min_by(|one, other| one.0.total_cmp(&other.0))
        })
        .collect()
}

/// The distance of each particle from a pin at rest; infinite where no way leads. `flat` and edges as above.
pub(crate) fn distances(
    rest: &[Vec3],
    edges: impl Iterator<Item = [u32; 2]>,
    pin: Pin,
    flat: bool,
) -> Vec<f32> {
    let nearest =
        if flat { nearest_straight(rest, &[pin]) } else { nearest_along(rest, edges, &[pin]) };
    nearest.into_iter().map(|nearest| nearest.map_or(f32::INFINITY, |(length, _)| length)).collect()
}

/// The same along the edges of the mesh (Dijkstra 1959): no shorter than the way across them.
fn nearest_along(
    rest: &[Vec3],
    edges: impl Iterator<Item = [u32; 2]>,
    pins: &[Pin],
) -> Vec<Option<(f32, usize)>> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); rest.len()];
    for [a, b] in edges {
        neighbours[a as usize].push(b);
        neighbours[b as usize].push(a);
    }
    let mut nearest: Vec<Option<(f32, usize)>> = vec![None; rest.len()];
    // Distances are not negative, so their bits are in their order.
    let mut open: BinaryHeap<Reverse<(u32, usize, u32)>> =
        pins.iter().enumerate().map(|(index, pin)| Reverse((0, index, pin.particle))).collect();
    while let Some(Reverse((bits, pin, particle))) = open.pop() {
        let reached = &mut nearest[particle as usize];
        if reached.is_some() {
            continue;
        }
        let distance = f32::from_bits(bits);
        *reached = Some((distance, pin));
        for &neighbour in &neighbours[particle as usize] {
            if nearest[neighbour as usize].is_none() {
                let edge = rest[particle as usize].distance(rest[neighbour as usize]);
                open.push(Reverse(((distance + edge).to_bits(), pin, neighbour)));
            }
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::fabric::{Fabric, FabricBuilder, Grid};

    #[test]
    fn a_flag_is_tethered_to_its_pole_and_a_hammock_to_its_corners() {
        let grid = Grid::new(5, 4, 2.0, 1.5);
        let flag = FabricBuilder::grid(grid).pin_where(|_, uv| uv.x == 0.0).build().expect("good");
        assert_eq!(flag.tethers().len(), 16);
        for tether in flag.tethers() {
            let [at, pin] =
                [tether.particle, tether.pin].map(|p| flag.rest_positions()[p as usize]);
            assert_eq!((pin.x, pin.y), (0.0, at.y));
            assert!((tether.length / at.x - 1.005).abs() < 1e-4);
        }
        let hung = FabricBuilder::grid(grid).pin([0, 4]).build().expect("good");
        let lowest = hung.tethers().iter().find(|tether| tether.particle == 15).expect("tethered");
        assert!((lowest.length / 1.5 - 1.05).abs() < 1e-4);
        assert!(FabricBuilder::grid(grid).build().expect("good").tethers().is_empty());
        let lengths = |fabric: &Fabric, particle: u32| -> Vec<(u32, f32)> {
            let of = fabric.far_tethers().iter().filter(|tether| tether.particle == particle);
            of.map(|tether| (tether.pin, tether.length / 1.05)).collect()
        };
        let [(0, length)] = lengths(&flag, 19)[..] else { panic!("the lower corner") };
        assert!((length - 2.5).abs() < 1e-4, "{length}");
        // The upper end of the pole is not so far.
        assert!(lengths(&flag, 16).is_empty());
        let [(4, length)] = lengths(&hung, 15)[..] else { panic!("a lower corner") };
        assert!((length - 2.5).abs() < 1e-4, "{length}");
        let untethered = FabricBuilder::grid(grid).pin([0, 4]).tethered(false);
        let untethered = untethered.build().expect("good");
        assert!(untethered.tethers().is_empty() && untethered.far_tethers().is_empty());
    }

    #[test]
    fn a_folded_mesh_is_measured_along_its_surface() {
        // Two squares at a right angle, folded about x = 1.
        let positions = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
            .into_iter()
            .flat_map(|(x, z)| [Vec3::new(x, 0.0, z), Vec3::new(x, 1.0, z)])
            .collect();
        let indices = vec![0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5];
        let fabric = FabricBuilder::new(positions, indices).pin([0, 1]).build().expect("good");
        let far = fabric.tethers().iter().find(|tether| tether.particle == 4).expect("tethered");
        assert!((far.length / 2.0 - 1.005).abs() < 1e-4, "{}", far.length);
        // The shortest way along the edges: a diagonal of one of the squares, and a side of the other.
        let far = fabric.far_tethers().iter().find(|tether| tether.particle == 4).expect("far");
        let way = 1.0 + core::f32::consts::SQRT_2;
        assert!((far.length / way - 1.05).abs() < 1e-4, "{}", far.length);
    }
}
