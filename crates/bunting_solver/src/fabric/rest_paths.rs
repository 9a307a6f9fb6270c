//! Shortest paths between particles at rest.

use glam::Vec3;

use super::pin::Pin;

/// How paths run over a fabric at rest.
pub(super) enum RestPaths<'a> {
    /// Straight between these particles, m.
    Straight(&'a [Vec3]),
    /// Along edges. They are never shorter than paths across the triangles.
    AlongEdges(Neighbours),
}

impl<'a> RestPaths<'a> {
    /// On a `flat` mesh the shortest path between two particles is straight.
    pub fn new(
        rest: &'a [Vec3],
        edges: impl Iterator<Item = [u32; 2]> + Clone,
        flat: bool,
    ) -> Self {
        if flat { Self::Straight(rest) } else { Self::AlongEdges(Neighbours::new(rest, edges)) }
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

/// The bits of the length of a path, m, which are ordered like lengths, above the index of its pin.
type Path = u64;

/// Longer than any path.
const NO_PATH: Path = Path::MAX;

fn path(length: f32, pin: u32) -> Path {
    Path::from(length.to_bits()) << u32::BITS | Path::from(pin)
}

fn length_of(path: Path) -> f32 {
    f32::from_bits((path >> u32::BITS) as u32)
}

/// By Dijkstra 1959, but with paths that are about as long in any order.
fn nearest_along(neighbours: &Neighbours, pins: &[Pin]) -> Vec<Option<(f32, usize)>> {
    let mut paths = OpenPaths {
        shortest: vec![NO_PATH; neighbours.count()],
        by_length: Vec::new(),
        steps_per_metre: 1.0 / neighbours.mean_length(),
    };
    for (index, pin) in (0..).zip(pins) {
        paths.offer(0.0, index, pin.particle);
    }
    let mut steps = 0;
    while let Some(open) = paths.by_length.get_mut(steps) {
        let Some((path, particle)) = open.pop() else {
            steps += 1;
            continue;
        };
        // Else a shorter path was found since.
        if paths.shortest[particle as usize] == path {
            for &(neighbour, edge) in neighbours.of(particle) {
                paths.offer(length_of(path) + edge, path as u32, neighbour);
            }
        }
    }
    let nearest = |path: Path| (path != NO_PATH).then(|| (length_of(path), path as u32 as usize));
    paths.shortest.into_iter().map(nearest).collect()
}

/// Paths from which longer ones may lead on.
struct OpenPaths {
    /// The shortest path known to each particle.
    shortest: Vec<Path>,
    /// Paths and the particles at their ends, by the number of whole steps in their lengths.
    by_length: Vec<Vec<(Path, u32)>>,
    /// One over the mean length of an edge, 1/m: there are about as many steps in a path as edges, at most. Larger: more lists. Smaller:
    /// more paths are followed before a shorter one is found.
    steps_per_metre: f32,
}

impl OpenPaths {
    fn offer(&mut self, length: f32, pin: u32, particle: u32) {
        let known = &mut self.shortest[particle as usize];
        let path = path(length, pin);
        if path < *known {
            *known = path;
            let steps = (length * self.steps_per_metre) as usize;
            if self.by_length.len() <= steps {
                self.by_length.resize_with(steps + 1, Vec::new);
            }
            self.by_length[steps].push((path, particle));
        }
    }
}

/// The neighbours of each particle along edges, one particle after the other.
pub(super) struct Neighbours {
    /// For each particle the index of its first neighbour, and one beyond the last.
    starts: Vec<u32>,
    /// Particles and their distances, m.
    neighbours: Vec<(u32, f32)>,
}

impl Neighbours {
    fn new(rest: &[Vec3], edges: impl Iterator<Item = [u32; 2]> + Clone) -> Self {
        let mut starts = vec![0; rest.len() + 1];
        edges.clone().flatten().for_each(|end| starts[end as usize + 1] += 1);
        for particle in 0..rest.len() {
            starts[particle + 1] += starts[particle];
        }
        let mut next = starts.clone();
        let mut neighbours = vec![(0, 0.0); 2 * edges.clone().count()];
        for [a, b] in edges {
            let length = rest[a as usize].distance(rest[b as usize]);
            for (from, to) in [(a, b), (b, a)] {
                let next = &mut next[from as usize];
                neighbours[*next as usize] = (to, length);
                *next += 1;
            }
        }
        Self { starts, neighbours }
    }

    fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The mean length of an edge, m.
    fn mean_length(&self) -> f32 {
        let sum: f32 = self.neighbours.iter().map(|(_, length)| length).sum();
        sum / self.neighbours.len() as f32
    }

    fn of(&self, particle: u32) -> &[(u32, f32)] {
        let [start, end] = [0, 1].map(|by| self.starts[particle as usize + by] as usize);
        &self.neighbours[start..end]
    }
}
