//! Strain by pins that are farther apart than the length of the cloth between them.
//!
//! A path of rest length s through the cloth, between two pins at a distance d, is strained by at least d/s −
//! 1 in every state of the cloth. A particle whose distances from the two pins along the cloth at rest are s
//! and s' lies on a path of length s + s', and so is strained by at least d/(s + s') − 1. Pins do not move in
//! the cloth's frame, so this bound is known before anything moves.

use glam::Vec3;

use crate::fabric::{DistancesFromPin, Fabric};

/// Strain below which the bound is ignored. Smaller: pins that were only rotated or moved together are too
/// far apart by rounding. Larger: a cloth of 33 × 33 particles a square metre oscillates at high frequency
/// with two substeps.
const LEAST_STRAIN: f32 = 1e-4;

/// Lower bounds on the strain of a cloth, by its pins.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PinStrain {
    /// Greatest strain between two pins. A flat sheet can be laid between its pins so that no two of its
    /// points are strained by more (Kirszbraun 1934).
    pub greatest: f32,
    /// Least strain about each particle; empty where no pins are too far apart.
    pub of_particles: Vec<f32>,
}

/// Two pins that are too far apart.
struct Pair {
    pins: [usize; 2],
    /// Distance of the pins, m.
    distance: f32,
    /// Ratio of this distance to the distance at rest, along the cloth or straight.
    stretch: f32,
}

impl PinStrain {
    /// Mean of the strains about all particles.
    pub fn mean(&self) -> f32 {
        self.of_particles.iter().sum::<f32>() / self.of_particles.len().max(1) as f32
    }

    /// The strain of a cloth with its particles at these positions, m.
    pub fn of(fabric: &Fabric, positions: &[Vec3]) -> Self {
        if fabric.are_pins_at_rest(positions) || are_pins_near(fabric, positions) {
            return Self::default();
        }
        let rest = fabric.rest_positions();
        let of_pins = |positions: &[Vec3]| -> Vec<Vec3> {
            fabric.pins().iter().map(|pin| positions[pin.particle as usize]).collect()
        };
        let [at, at_rest] = [positions, rest].map(of_pins);
        // Straight distances at rest are no longer than distances along the cloth, and decide most cases.
        let straight = too_far(&at, |one, other| at_rest[one].distance(at_rest[other]));
        if straight.is_empty() {
            return Self::default();
        }
        let mut is_apart = vec![false; at.len()];
        straight.iter().flat_map(|pair| pair.pins).for_each(|pin| is_apart[pin] = true);
        let along = fabric.distances_from_pins(|pin| is_apart[pin]);
        let along_cloth = |pair: Pair| {
            let to = fabric.pins()[pair.pins[1]].particle as usize;
            let stretch = pair.distance / along[pair.pins[0]]?.of_particles[to];
            (stretch > 1.0 + LEAST_STRAIN).then_some(Pair { stretch, ..pair })
        };
        let mut pairs: Vec<Pair> = straight.into_iter().filter_map(along_cloth).collect();
        pairs.sort_by(|one, other| other.stretch.total_cmp(&one.stretch));
        let Some(worst) = pairs.first() else { return Self::default() };
        let mut of_particles = vec![1.0; rest.len()];
        for pair in &pairs {
            if let [Some(one), Some(other)] = pair.pins.map(|pin| along[pin]) {
                pair.stretch_about(one, other, &mut of_particles);
            }
        }
        of_particles.iter_mut().for_each(|stretch| *stretch -= 1.0);
        Self { greatest: worst.stretch - 1.0, of_particles }
    }
}

impl Pair {
    /// Raises the least stretch about each particle to that of the path between the pins that leads through it, given the
    /// distances from both. Pairs of more stretch come first.
    fn stretch_about(
        &self,
        one: &DistancesFromPin,
        other: &DistancesFromPin,
        of_particles: &mut [f32],
    ) {
        for particle in one.by_distance.iter().map(|&particle| particle as usize) {
            let from_one = one.of_particles[particle];
            if from_one >= self.distance {
                break;
            }
            let greatest = &mut of_particles[particle];
            // A path through the particle is no shorter than the shortest path, so it is stretched no more.
            if self.stretch > *greatest {
                *greatest = greatest.max(self.distance / (from_one + other.of_particles[particle]));
            }
        }
    }
}

/// Whether no pair of pins is farther apart than at rest by almost [`LEAST_STRAIN`], given the positions of all particles,
/// m: then pins do not strain the cloth. Pins that a skeleton moves are mostly nearer, which squares tell without roots
/// and divisions.
pub(crate) fn are_pins_near(fabric: &Fabric, positions: &[Vec3]) -> bool {
    let most = (1.0 + 0.99 * LEAST_STRAIN) * (1.0 + 0.99 * LEAST_STRAIN);
    let rest = fabric.rest_positions();
    let places = |pin: u32| [positions, rest].map(|all| all[pin as usize]);
    fabric.pins().iter().enumerate().all(|(count, other)| {
        let [there, there_at_rest] = places(other.particle);
        fabric.pins()[..count].iter().all(|one| {
            let [here, here_at_rest] = places(one.particle);
            here.distance_squared(there) <= most * here_at_rest.distance_squared(there_at_rest)
        })
    })
}

/// The pairs of pins that are too far apart, given their positions, m, and the length of the cloth between
/// two pins, m.
fn too_far(at: &[Vec3], length: impl Fn(usize, usize) -> f32) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (other, there) in at.iter().enumerate() {
        for (one, here) in at[..other].iter().enumerate() {
            let distance = here.distance(*there);
            let stretch = distance / length(one, other);
            if stretch > 1.0 + LEAST_STRAIN {
                pairs.push(Pair { pins: [one, other], distance, stretch });
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::{LEAST_STRAIN, PinStrain};
    use crate::fabric::{Fabric, FabricBuilder, Grid};

    fn sheet(pins: impl IntoIterator<Item = u32>) -> Fabric {
        FabricBuilder::grid(Grid::new(5, 5, 1.0, 1.0)).pin(pins).build().expect("a good fabric")
    }

    fn moved(fabric: &Fabric, to: impl Fn(Vec3) -> Vec3) -> PinStrain {
        let positions: Vec<Vec3> = fabric.rest_positions().iter().map(|&at| to(at)).collect();
        PinStrain::of(fabric, &positions)
    }

    #[test]
    fn two_edges_strain_all_particles_between_them() {
        let fabric = sheet((0..5).chain(20..25));
        let PinStrain { greatest, of_particles: strains } =
            moved(&fabric, |at| at * Vec3::new(1.0, 1.1, 1.0));
        let off = |strain: &f32| (strain - 0.1).abs() < 1e-5;
        assert!(off(&greatest) && strains.iter().all(off), "{strains:?}");
    }

    #[test]
    fn two_corners_strain_the_particles_between_them() {
        let PinStrain { greatest, of_particles: strains } = moved(&sheet([0, 4]), |at| 1.1 * at);
        assert!((greatest - 0.1).abs() < 1e-5);
        assert!((strains[2] - 0.1).abs() < 1e-5);
        // A quarter of a metre below the middle of the pins, the cloth is slack: 1.1 m is less than 2 √(½² +
        // ¼²) m.
        assert_eq!(strains[7], 0.0);
        // A corner of the next row: ¼ m and √(1 + ¼²) m.
        assert_eq!(strains[5], 0.0);
    }

    #[test]
    fn a_moved_turned_or_slack_cloth_is_not_strained() {
        let fabric = sheet([0, 4, 24]);
        let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.3, -0.7, 1.9);
        assert_eq!(moved(&fabric, |at| turn * at + Vec3::splat(3.0)), PinStrain::default());
        assert_eq!(moved(&fabric, |at| 0.5 * at), PinStrain::default());
    }

    #[test]
    fn opening_a_folded_mesh_does_not_strain_it() {
        // Two squares at a right angle, folded about x = 1, held by their outer edges.
        let positions: Vec<Vec3> = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
            .into_iter()
            .flat_map(|(x, z)| [Vec3::new(x, 0.0, z), Vec3::new(x, 1.0, z)])
            .collect();
        let indices = vec![0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5];
        let fabric = FabricBuilder::new(positions, indices).pin([0, 1, 4, 5]).build();
        let fabric = fabric.expect("a good fabric");
        let open = |at: Vec3, stretch: f32| Vec3::new(stretch * (at.x + at.z), at.y, 0.0);
        // Cells between the two squares cut the fold's edge off, and are a little shorter.
        assert!(moved(&fabric, |at| open(at, 1.0)).greatest < 0.01);
        let PinStrain { greatest, of_particles } = moved(&fabric, |at| open(at, 1.2));
        let mean = of_particles.iter().sum::<f32>() / of_particles.len() as f32;
        assert!((greatest - 0.2).abs() < 0.01, "{greatest}");
        assert!(mean > 0.15, "{mean}");
    }

    /// The strain by the distances of all particles from all pins, as it is defined.
    fn by_all_paths(fabric: &Fabric, positions: &[Vec3]) -> PinStrain {
        let along = fabric.distances_from_pins(|_| true);
        let along = |pin: usize, particle: u32| {
            along[pin].expect("all are wanted").of_particles[particle as usize]
        };
        let pins: Vec<u32> = fabric.pins().iter().map(|pin| pin.particle).collect();
        let at = |pin: usize| positions[pins[pin] as usize];
        let pairs = (0..pins.len()).flat_map(|other| (0..other).map(move |one| [one, other]));
        let stretch =
            |&[one, other]: &[usize; 2]| at(one).distance(at(other)) / along(one, pins[other]);
        let mut pairs: Vec<[usize; 2]> =
            pairs.filter(|pair| stretch(pair) > 1.0 + LEAST_STRAIN).collect();
        pairs.sort_by(|one, other| stretch(other).total_cmp(&stretch(one)));
        let Some(worst) = pairs.first() else { return PinStrain::default() };
        let about = |particle: u32| {
            let longer = |greatest: f32, pair: &[usize; 2]| {
                let [one, other] = *pair;
                let way = along(one, particle) + along(other, particle);
                let is_longer = stretch(pair) > greatest;
                if is_longer { greatest.max(at(one).distance(at(other)) / way) } else { greatest }
            };
            pairs.iter().fold(1.0, longer) - 1.0
        };
        PinStrain {
            greatest: stretch(worst) - 1.0,
            of_particles: (0..fabric.particle_count() as u32).map(about).collect(),
        }
    }

    /// A skirt whose waist is a ring of pins.
    fn skirt(around: u32, rows: u32) -> Fabric {
        let at = |row: u32, place: u32| {
            let (sin, cos) = libm::sincosf(core::f32::consts::TAU * place as f32 / around as f32);
            let radius = 0.12 + 0.01 * row as f32;
            Vec3::new(radius * cos, -0.02 * row as f32, radius * sin)
        };
        let rings = (0..rows).flat_map(|row| (0..around).map(move |place| (row, place)));
        let positions = rings.clone().map(|(row, place)| at(row, place)).collect();
        let index = |row: u32, place: u32| row * around + place % around;
        let quads = rings.filter(|(row, _)| *row + 1 < rows).flat_map(|(row, place)| {
            let [a, b] = [0, 1].map(|by| index(row, place + by));
            let [c, d] = [0, 1].map(|by| index(row + 1, place + by));
            [a, b, c, c, b, d]
        });
        let skirt = FabricBuilder::new(positions, quads.collect()).pin(0..around);
        skirt.build().expect("a good fabric")
    }

    #[test]
    fn near_paths_from_pins_that_are_apart_tell_the_strain_of_all_paths() {
        let skirt = skirt(24, 12);
        let sheet = sheet([0, 4, 12, 20, 23]);
        for fabric in [&skirt, &sheet] {
            for (count, spread) in [0.999, 1.0, 1.0005, 1.02, 1.3, 4.0].into_iter().enumerate() {
                let shear = Vec3::new(0.02, 0.0, 0.1) * count as f32;
                let move_to = |at: &Vec3| *at * spread + shear * at.x;
                let positions: Vec<Vec3> = fabric.rest_positions().iter().map(move_to).collect();
                let found = PinStrain::of(fabric, &positions);
                assert!(found == by_all_paths(fabric, &positions), "{spread}");
                assert_eq!(found.greatest > 0.0, count > 0, "{spread}: {}", found.greatest);
            }
        }
    }

    #[test]
    fn paths_are_found_once_and_only_from_pins_that_are_apart() {
        let skirt = skirt(24, 12);
        let pin = skirt.pins()[3].particle as usize;
        let is_moved = |particle: usize| particle == pin;
        let moved = |(particle, at): (usize, &Vec3)| {
            *at + if is_moved(particle) { Vec3::new(0.0, 0.0, 0.02) } else { Vec3::ZERO }
        };
        let positions: Vec<Vec3> = skirt.rest_positions().iter().enumerate().map(moved).collect();
        let known =
            || skirt.known_distances().map(|of| of.of_particles.as_ptr()).collect::<Vec<_>>();
        assert!(known().is_empty());
        let first = PinStrain::of(&skirt, &positions);
        let found = known();
        assert!(
            first.greatest > 0.0 && !found.is_empty() && found.len() < skirt.pins().len(),
            "{}",
            found.len()
        );
        assert!(PinStrain::of(&skirt, &positions) == first && known() == found);
    }
}
