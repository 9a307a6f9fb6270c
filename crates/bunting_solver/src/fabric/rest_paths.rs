//! Shortest paths between particles at rest.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::Vec3;

use super::tethers::Pin;

/// How paths run over a fabric at rest.
pub(super) enum RestPaths<'a> {
    /// Straight between these particles, m.
    Straight(&'a [Vec3]),
    /// Along edges: the neighbours of each particle, and their distances, m. They are never shorter than paths across
    /// the triangles.
    AlongEdges(Vec<Vec<(u32, f32)>>),
}

impl<'a> RestPaths<'a> {
    /// On a `flat` mesh the shortest path between two particles is straight.
    pub fn new(rest: &'a [Vec3], edges: impl Iterator<Item = [u32; 2]>, flat: bool) -> Self {
        if flat {
            return Self::Straight(rest);
        }
        let mut neighbours = vec![Vec::new(); rest.len()];
        for [a, b] in edges {
            let length = rest[a as usize].distance(rest[b as usize]);
            neighbours[a as usize].push((b, length));
            neighbours[b as usize].push((a, length));
        }
        Self::AlongEdges(neighbours)
    }

    /// For each particle the distance to the nearest pin, m, and the index of the pin; none if no path leads to one.
    pub fn nearest(&self, pins: &[Pin]) -> Vec<Option<(f32, usize)>> {
        match self {
            Self::Straight(rest) => {
                rest.iter().map(|&at| nearest_straight(rest, at, pins)).collect()
            }
            Self::AlongEdges(neighbours) => nearest_along(neighbours, pins),
        }
    }

    /// Distance of each particle from a pin, m; infinite if no path leads to it.
    pub fn distances(&self, pin: Pin) -> Vec<f32> {
        let nearest = self.nearest(&[pin]).into_iter();
        nearest.map(|nearest| nearest.map_or(f32::INFINITY, |(length, _)| length)).collect()
    }
}

fn nearest_straight(rest: &[Vec3], at: Vec3, pins: &[Pin]) -> Option<(f32, usize)> {
    let distance = |pin: &Pin| at.distance(rest[pin.particle as usize]);
    let distances = pins.iter().enumerate().map(|(index, pin)| (distance(pin), index));
    distances.min_by(|one, other| one.0.total_cmp(&other.0))
}

/// By Dijkstra 1959.
fn nearest_along(neighbours: &[Vec<(u32, f32)>], pins: &[Pin]) -> Vec<Option<(f32, usize)>> {
    /// Bits of the distance, which are ordered like distances, and the index of the pin.
    type Path = (u32, usize);
    let mut shortest: Vec<Option<Path>> = vec![None; neighbours.len()];
    let mut open: BinaryHeap<Reverse<(Path, u32)>> = BinaryHeap::new();
    let mut offer = |open: &mut BinaryHeap<_>, path: Path, particle: u32| {
        let known = &mut shortest[particle as usize];
        if known.is_none_or(|known| path < known) {
            *known = Some(path);
            open.push(Reverse((path, particle)));
        }
    };
    for (index, pin) in pins.iter().enumerate() {
        offer(&mut open, (0, index), pin.particle);
    }
    while let Some(Reverse(((bits, pin), particle))) = open.pop() {
        for &(neighbour, edge) in &neighbours[particle as usize] {
            offer(&mut open, ((f32::from_bits(bits) + edge).to_bits(), pin), neighbour);
        }
    }
    let path = |path: Option<Path>| path.map(|(bits, pin)| (f32::from_bits(bits), pin));
    shortest.into_iter().map(path).collect()
}
