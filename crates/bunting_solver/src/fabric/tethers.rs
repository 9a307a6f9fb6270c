//! Tethers: bounds on the distance of each free particle from its nearest pin, and from its farthest pin.
//!
//! Distances are geodesic at rest ("long range attachments", Kim 2012): straight on a grid without holes, along the
//! edges of other meshes.

use std::collections::BTreeMap;

use glam::Vec3;

use super::farthest::Places;
use super::mesh::RestMesh;
use super::pin::Pin;
use super::rest_paths::RestPaths;
use super::topology::Edge;

/// A bound on the distance between a free particle and a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tether {
    /// The free particle.
    pub particle: u32,
    /// The pinned particle.
    pub pin: u32,
    /// Greatest distance between the two, m.
    pub length: f32,
}

/// Slack of a tether to a pin with neighbouring pins, as a fraction of its length. Smaller: the tether
/// carries a load that belongs to warp and weft, at the cloth's own strain under its weight. Larger: the
/// tether catches later.
const SLACK_TO_LINE: f32 = 0.005;

/// Slack of a tether to an isolated pin or to the farthest pin, as a fraction of its length. Such tethers run
/// along diagonals, and a cloth that hangs from points shears and hangs farther from them than its rest shape
/// says. Smaller: the tether stops that shear. Larger: the tether catches later.
const SLACK_UNDER_SHEAR: f32 = 0.05;

/// The pins of a fabric and the tethers to them.
#[derive(Clone, Debug)]
pub(crate) struct Tethers {
    /// All pins.
    pub pins: Vec<Pin>,
    /// Tether of each free particle to its nearest pin.
    pub near: Vec<Tether>,
    /// Tethers to the farthest pin, or of many to one that lies far, of free particles that lie farther from it than
    /// [`reach`](Self::reach).
    ///
    /// With tethers to the nearest pin alone, the lower corner of a flag may end up beneath its pole.
    /// Particles closer to their farthest pin are held by tethers to the nearest pin.
    pub far: Vec<Tether>,
    /// Greatest length of a tether to the nearest pin, m; zero without pins.
    pub reach: f32,
}

/// Most pins that are the farthest of some particles. More: a mesh that hangs from a round rim takes long to build, as the paths
/// to each are found by themselves.
const MOST_FAR_PINS: usize = 16;

impl Tethers {
    /// Pins and tethers; without tethers if the fabric is not `tethered`. Paths on a `flat` mesh are straight.
    pub(super) fn of(mesh: &RestMesh, edges: &[Edge], flat: bool, tethered: bool) -> Self {
        let rest = &mesh.positions;
        let pins = pins(mesh, edges);
        let paths = RestPaths::new(rest, edges.iter().map(|edge| edge.ends), flat);
        let near = near_tethers(&paths, &pins);
        let reach = near.iter().map(|tether| tether.length).fold(0.0, f32::max);
        if !tethered {
            return Self { pins, near: Vec::new(), far: Vec::new(), reach };
        }
        let far = far_tethers(rest, &paths, &pins, &near, reach);
        Self { pins, near, far, reach }
    }
}

/// The pinned particles of the edges: nodes of a grid where there is no cloth have none.
pub(super) fn pins(mesh: &RestMesh, edges: &[Edge]) -> Vec<Pin> {
    let mut has_edge = vec![false; mesh.positions.len()];
    edges.iter().flat_map(|edge| edge.ends).for_each(|end| has_edge[end as usize] = true);
    let particles = 0..mesh.positions.len() as u32;
    let mut isolated: Vec<bool> =
        particles.clone().map(|particle| mesh.is_pinned(particle)).collect();
    for [a, b] in edges.iter().map(|edge| edge.ends) {
        if mesh.is_pinned(a) && mesh.is_pinned(b) {
            (isolated[a as usize], isolated[b as usize]) = (false, false);
        }
    }
    particles
        .filter(|&particle| mesh.is_pinned(particle) && has_edge[particle as usize])
        .map(|particle| Pin { particle, isolated: isolated[particle as usize] })
        .collect()
}

/// Tether of each free particle that is connected to a pin, to its nearest pin.
fn near_tethers(paths: &RestPaths, pins: &[Pin]) -> Vec<Tether> {
    (0..)
        .zip(paths.nearest(pins))
        .filter_map(|(particle, nearest)| {
            let (length, pin) = nearest?;
            let Pin { particle: pin, isolated } = pins[pin];
            let slack = if isolated { SLACK_UNDER_SHEAR } else { SLACK_TO_LINE };
            (pin != particle && length > 0.0).then_some(Tether {
                particle,
                pin,
                length: length * (1.0 + slack),
            })
        })
        .collect()
}

/// Tethers to the farthest pins, see [`Tethers::far`].
fn far_tethers(
    rest: &[Vec3],
    paths: &RestPaths,
    pins: &[Pin],
    near: &[Tether],
    reach: f32,
) -> Vec<Tether> {
    let place = |pin: usize| rest[pins[pin].particle as usize];
    let farthest_of = |among: &[usize]| {
        let mut particles_of_pin: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        let places: Vec<Vec3> = among.iter().map(|&pin| place(pin)).collect();
        let places = Places::new(&places);
        for &Tether { particle, .. } in near {
            let farthest = among[places.farthest(rest[particle as usize])];
            particles_of_pin.entry(farthest).or_default().push(particle);
        }
        particles_of_pin
    };
    let all: Vec<usize> = (0..pins.len()).collect();
    let mut particles_of_pin = farthest_of(&all);
    if particles_of_pin.len() > MOST_FAR_PINS {
        let far_pins: Vec<usize> = particles_of_pin.into_keys().collect();
        particles_of_pin = farthest_of(&spread(far_pins, place));
    }
    let tethers_to_pin = |(pin, particles): (usize, Vec<u32>)| {
        let lengths = paths.distances(pins[pin]);
        let pin = pins[pin].particle;
        particles.into_iter().filter_map(move |particle| {
            let length = lengths[particle as usize];
            let is_far = length > reach && length.is_finite();
            let slack = 1.0 + SLACK_UNDER_SHEAR;
            is_far.then_some(Tether { particle, pin, length: length * slack })
        })
    };
    particles_of_pin.into_iter().flat_map(tethers_to_pin).collect()
}

/// [`MOST_FAR_PINS`] of some pins, each the farthest from those before.
fn spread(mut pins: Vec<usize>, place: impl Fn(usize) -> Vec3) -> Vec<usize> {
    let mut chosen = vec![pins.remove(0)];
    let mut distances: Vec<f32> =
        pins.iter().map(|&pin| place(pin).distance(place(chosen[0]))).collect();
    while chosen.len() < MOST_FAR_PINS {
        let Some((next, _)) = distances.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)) else {
            break;
        };
        let next = pins[next];
        for (distance, &pin) in distances.iter_mut().zip(&pins) {
            *distance = distance.min(place(pin).distance(place(next)));
        }
        chosen.push(next);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::{SLACK_TO_LINE, Tether};
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
        // The upper end of the pole is nearer than the reach.
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
        let rest = fabric.rest_positions();
        let at_end = |tether: &&Tether| rest[tether.particle as usize].z > 1.0 - 1e-5;
        let slack = 1.0 + SLACK_TO_LINE;
        let near = fabric.tethers().iter().filter(at_end);
        let near: Vec<f32> = near.map(|tether| tether.length / slack).collect();
        // Paths run along edges, which are not always straight, and cut the fold's edge off.
        assert!(near.len() > 10, "{}", near.len());
        assert!(near.iter().all(|length| (1.95..2.2).contains(length)), "{near:?}");
    }
}
