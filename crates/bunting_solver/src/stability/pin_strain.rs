//! Strain by pins that are farther apart than the length of the cloth between them.
//!
//! A path of rest length s through the cloth, between two pins at a distance d, is strained by at least d/s −
//! 1 in every state of the cloth. A particle whose distances from the two pins along the cloth at rest are s
//! and s' lies on a path of length s + s', and so is strained by at least d/(s + s') − 1. Pins do not move in
//! the cloth's frame, so this bound is known before anything moves.

use glam::Vec3;

use crate::fabric::Fabric;

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
    /// Ratio of this distance to the distance along the cloth at rest.
    stretch: f32,
}

impl PinStrain {
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
        if too_far(&at, |one, other| at_rest[one].distance(at_rest[other])).is_empty() {
            return Self::default();
        }
        let along: Vec<Vec<f32>> =
            fabric.pins().iter().map(|pin| fabric.distances_from(*pin)).collect();
        let mut pairs =
            too_far(&at, |one, other| along[one][fabric.pins()[other].particle as usize]);
        pairs.sort_by(|one, other| other.stretch.total_cmp(&one.stretch));
        let Some(worst) = pairs.first() else { return Self::default() };
        let stretch_about = |particle: usize| {
            let mut greatest = 1.0_f32;
            for pair in &pairs {
                // A path through the particle is no shorter than the shortest path, so it is stretched no
                // more. Pairs are sorted by their stretch.
                if pair.stretch <= greatest {
                    break;
                }
                let [one, other] = pair.pins.map(|pin| along[pin][particle]);
                greatest = greatest.max(pair.distance / (one + other));
            }
            greatest
        };
        Self {
            greatest: worst.stretch - 1.0,
            of_particles: (0..rest.len()).map(|particle| stretch_about(particle) - 1.0).collect(),
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

    use super::PinStrain;
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
        assert_eq!(moved(&fabric, |at| open(at, 1.0)), PinStrain::default());
        let PinStrain { greatest, of_particles: strains } = moved(&fabric, |at| open(at, 1.2));
        assert!(
            [greatest, strains[2], strains[3]].iter().all(|strain| (strain - 0.2).abs() < 1e-5)
        );
    }
}
