//! Distances along the cloth at rest from its pins. They are found for a pin when they are first asked for, as pins that move
//! apart do in each substep, and kept with the fabric.

use std::sync::OnceLock;

use super::fabric::Fabric;
use super::rest_paths::RestPaths;
use super::tethers::Pin;

/// Distances along the cloth at rest from a pin.
#[derive(Clone, Debug)]
pub(crate) struct DistancesFromPin {
    /// Distance of each particle, m; infinite if no path leads to it.
    pub of_particles: Vec<f32>,
    /// All particles, the nearest one first.
    pub by_distance: Vec<u32>,
}

impl DistancesFromPin {
    fn new(of_particles: Vec<f32>) -> Self {
        let distance = |particle: &u32| of_particles[*particle as usize];
        let mut by_distance: Vec<u32> = (0..of_particles.len() as u32).collect();
        by_distance.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
        Self { of_particles, by_distance }
    }
}

/// The distances from each pin that are known; empty before any is asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct PinPaths(OnceLock<Box<[OnceLock<DistancesFromPin>]>>);

impl Fabric {
    /// The distances from those pins that are wanted, and none from the others.
    pub(crate) fn distances_from_pins(
        &self,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Vec<Option<&DistancesFromPin>> {
        let known =
            self.pin_paths.0.get_or_init(|| vec![OnceLock::new(); self.pins().len()].into());
        let mut paths = None;
        let mut from = |pin: &Pin| {
            DistancesFromPin::new(paths.get_or_insert_with(|| self.rest_paths()).distances(*pin))
        };
        let pins = known.iter().zip(self.pins()).enumerate();
        pins.map(|(index, (known, pin))| is_wanted(index).then(|| known.get_or_init(|| from(pin))))
            .collect()
    }

    /// The distances from pins that are known.
    #[cfg(test)]
    pub(crate) fn known_distances(&self) -> impl Iterator<Item = &DistancesFromPin> {
        self.pin_paths.0.get().into_iter().flatten().filter_map(OnceLock::get)
    }

    fn rest_paths(&self) -> RestPaths<'_> {
        let edges = self.mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        RestPaths::new(&self.mesh.positions, edges, self.grid.is_some())
    }
}
