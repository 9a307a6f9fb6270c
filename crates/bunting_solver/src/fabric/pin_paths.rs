//! The paths along the cloth at rest from its pins. They are found for a pin when their lengths are first asked for, as pins that
//! move apart do in each substep.

use std::sync::OnceLock;

use super::fabric::Fabric;
use super::pin::Pin;
use super::pin_distances::DistancesFromPin;
use super::rest_paths::RestPaths;

impl Fabric {
    /// The distances from those pins that are wanted, and none from the others.
    pub(crate) fn distances_from_pins(
        &self,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Vec<Option<&DistancesFromPin>> {
        let known =
            self.pin_distances.0.get_or_init(|| vec![OnceLock::new(); self.pins().len()].into());
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
        self.pin_distances.0.get().into_iter().flatten().filter_map(OnceLock::get)
    }

    fn rest_paths(&self) -> RestPaths<'_> {
        let edges = self.mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        RestPaths::new(&self.mesh.positions, edges, self.grid.is_some())
    }
}
