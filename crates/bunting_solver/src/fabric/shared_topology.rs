//! The topology that fabrics share whose cloths can lie side by side in one batch: grids that differ only in lengths
//! and areas.

use std::hash::{DefaultHasher, Hash, Hasher};

use super::fabric::Fabric;
use crate::stability::pole::Pole;

impl Fabric {
    /// A hash of the topology of a grid: of its particles and pins, of the links between them, and of the order in
    /// which they are solved. Cloths of fabrics of one topology can lie in one
    /// [`ClothBatch::mixed`](crate::ClothBatch::mixed). None for meshes that are not grids, and for narrow grids.
    #[must_use]
    pub fn topology(&self) -> Option<u64> {
        self.topology
    }

    /// Whether another fabric has the same topology.
    #[must_use]
    pub fn has_topology_of(&self, other: &Self) -> bool {
        let parts = |fabric: &Self| fabric.grid().map(|grid| [grid.columns, grid.rows]);
        let pairs = self.chains().pairs.iter().zip(&other.chains().pairs);
        self.topology.is_some()
            && self.topology == other.topology
            && parts(self) == parts(other)
            && self.pins() == other.pins()
            && Pole::of(self).is_some() == Pole::of(other).is_some()
            && self.chains().colours == other.chains().colours
            && self.chains().cells == other.chains().cells
            && self.chains().pairs.len() == other.chains().pairs.len()
            && pairs.into_iter().all(|(one, other)| one.particles == other.particles)
    }

    /// The hash of [`topology`](Self::topology).
    pub(super) fn hash_topology(&self) -> Option<u64> {
        let has_strips = !self.strips().is_empty();
        let grid = self.grid().filter(|_| !has_strips)?;
        self.patch_grid_columns()?;
        let mut hash = DefaultHasher::new();
        [grid.columns, grid.rows].hash(&mut hash);
        self.pins().iter().for_each(|pin| pin.particle.hash(&mut hash));
        Pole::of(self).is_some().hash(&mut hash);
        for colour in &self.chains().colours {
            (colour.family, &colour.pairs).hash(&mut hash);
        }
        for pair in &self.chains().pairs {
            pair.particles.hash(&mut hash);
        }
        Some(hash.finish())
    }
}

#[cfg(test)]
mod tests {
    use crate::fabric::{Fabric, FabricBuilder, Grid};

    fn flag(width: f32, height: f32) -> Fabric {
        let grid = FabricBuilder::grid(Grid::new(9, 5, width, height));
        grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric")
    }

    #[test]
    fn flags_of_different_sizes_have_one_topology() {
        let flags = [flag(1.5, 1.0), flag(1.2, 1.0), flag(1.501, 0.999)];
        assert!(flags.iter().all(|other| flags[0].has_topology_of(other)));
    }

    #[test]
    fn other_pins_or_particles_or_directions_are_another_topology() {
        let free = FabricBuilder::grid(Grid::new(9, 5, 1.5, 1.0)).build().expect("good");
        let finer = FabricBuilder::grid(Grid::new(9, 9, 1.5, 1.0));
        let finer = finer.pin_where(|_, uv| uv.x == 0.0).build().expect("good");
        for other in [free, finer] {
            assert!(!flag(1.5, 1.0).has_topology_of(&other));
        }
    }
}
