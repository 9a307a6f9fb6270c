//! The pins of a fabric in groups, as of the anchors that hold them.

use crate::fabric::{Fabric, FabricMaterial, LinkFamily};

/// Least distance of a particle from a pin by which the loads of groups are weighted, m.
const LEAST_DISTANCE: f32 = 1e-6;

/// The pins of a fabric in groups, for [`ClothBatch::report_pins`](crate::ClothBatch::report_pins).
///
/// The force of all pins together follows from the corrections of the free particles. To divide it among groups, each
/// particle has a share in each group: one at the group's own pins, zero at those of others, and between them by the
/// inverse distance. The force of a group is the sum of all corrections by its shares, less what links carry from
/// particles of one share to those of another (the principle of virtual work with the shares as displacements). A cloth
/// with one group needs no shares, and no tension of links.
///
/// ```
/// use bunting_solver::{FabricBuilder, Grid, PinGroups};
///
/// // A banner between two masts, which are groups 0 and 1.
/// let grid = FabricBuilder::grid(Grid::new(3, 2, 1.0, 1.0));
/// let fabric = grid.pin_where(|_, uv| uv.x == 0.0 || uv.x == 1.0).build()?;
/// let masts = PinGroups::new(&fabric, &[vec![0, 3], vec![2, 5]]);
/// assert_eq!(masts.particles(1).count(), 2);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PinGroups {
    /// The group and the particle of each pin.
    pub(crate) pins: Vec<(usize, u32)>,
    /// For each group, the share of each particle; empty if there is one group.
    pub(crate) shares: Vec<Vec<f32>>,
    /// Number of groups.
    pub(crate) count: usize,
}

impl PinGroups {
    /// The groups of these particles. Pins that none of them holds are those of the first group, and particles that are
    /// not pinned count for nothing.
    #[must_use]
    pub fn new(fabric: &Fabric, groups: &[Vec<u32>]) -> Self {
        let mut group_of = vec![0; fabric.particle_count()];
        for (group, particles) in groups.iter().enumerate().rev() {
            for &particle in particles {
                if let Some(of_particle) = group_of.get_mut(particle as usize) {
                    *of_particle = group;
                }
            }
        }
        let pins = (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle));
        let pins: Vec<(usize, u32)> =
            pins.map(|particle| (group_of[particle], particle as u32)).collect();
        let count = groups.len().max(1);
        let shares = if count > 1 { shares(fabric, &pins, count) } else { Vec::new() };
        Self { pins, shares, count }
    }

    /// The particles of a group's pins.
    pub fn particles(&self, group: usize) -> impl Iterator<Item = u32> + '_ {
        self.pins.iter().filter(move |(of, _)| *of == group).map(|&(_, particle)| particle)
    }
}

/// For each group, the share of each particle in it.
fn shares(fabric: &Fabric, pins: &[(usize, u32)], count: usize) -> Vec<Vec<f32>> {
    let rest = fabric.rest_positions();
    let mut shares = vec![vec![0.0; rest.len()]; count];
    for (particle, &at) in rest.iter().enumerate() {
        let mut nearness = vec![0.0_f32; count];
        for &(group, pin) in pins {
            let distance = at.distance(rest[pin as usize]).max(LEAST_DISTANCE);
            nearness[group] = nearness[group].max(1.0 / distance);
        }
        let sum: f32 = nearness.iter().sum();
        for (group, nearness) in nearness.into_iter().enumerate() {
            shares[group][particle] = if sum > 0.0 { nearness / sum } else { 0.0 };
        }
    }
    for &(group, pin) in pins {
        for (of, shares) in shares.iter_mut().enumerate() {
            shares[pin as usize] = f32::from(u8::from(of == group));
        }
    }
    shares
}

/// A link between particles of different shares.
pub(crate) struct CarryingLink {
    pub particles: [u32; 2],
    pub rest_length: f32,
    /// N/m.
    pub stiffness: f32,
}

/// The links of a fabric that carry tension, with their stiffness. Diagonals that resist shear alone are left out.
pub(crate) fn carrying_links<'a>(
    fabric: &'a Fabric,
    material: &'a FabricMaterial,
) -> impl Iterator<Item = CarryingLink> + 'a {
    let straight = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    straight.map(|link| CarryingLink {
        particles: link.particles,
        rest_length: link.rest_length,
        stiffness: fabric.link_classes()[link.class as usize].uncoupled_stiffness(material),
    })
}
