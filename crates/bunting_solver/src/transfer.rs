//! Moves a cloth's state from one level of detail to another.

use glam::Vec3;

use crate::fabric::{Fabric, Grid};
use crate::snapshot::ClothSnapshot;

/// Why two fabrics are not neighbours in a chain of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// Only grids know their neighbours.
    #[error("a level of detail must be a grid")]
    NotAGrid,
    /// The finer grid must have a particle halfway between any two of the coarser.
    #[error(
        "{fine:?} particles do not halve to {coarse:?}: use 2ⁿ + 1 columns and rows, or any that halve"
    )]
    NotNested {
        /// Columns and rows of the finer grid.
        fine: (u32, u32),
        /// Columns and rows of the coarser grid.
        coarse: (u32, u32),
    },
}

/// How the particles of a finer and a coarser fabric of one cloth correspond.
#[derive(Clone, Debug)]
pub struct LevelTransfer {
    /// For each fine particle the coarse ones that it is the mean of: itself alone, if shared.
    parents: Vec<Parents>,
    /// For each coarse particle the fine one that it is.
    shared: Vec<u32>,
}

/// One, two or four coarse particles.
#[derive(Clone, Copy, Debug)]
struct Parents {
    coarse: [u32; 4],
    count: u8,
}

impl Parents {
    fn mean(&self, values: &[Vec3]) -> Vec3 {
        let parents = &self.coarse[..usize::from(self.count)];
        let sum: Vec3 = parents.iter().map(|&parent| values[parent as usize]).sum();
        sum / f32::from(self.count)
    }
}

impl LevelTransfer {
    /// The correspondence of a fabric and the next coarser one: every second column and row.
    ///
    /// # Errors
    ///
    /// The fabrics are not grids, or the coarser is not every second column and row of the finer.
    pub fn between(fine: &Fabric, coarse: &Fabric) -> Result<Self, TransferError> {
        let (Some(fine), Some(coarse)) = (fine.grid(), coarse.grid()) else {
            return Err(TransferError::NotAGrid);
        };
        let halved = fine.halved().map(|grid| (grid.columns, grid.rows));
        if halved != Some((coarse.columns, coarse.rows)) {
            return Err(TransferError::NotNested {
                fine: (fine.columns, fine.rows),
                coarse: (coarse.columns, coarse.rows),
            });
        }
        let nodes = |grid: &Grid| {
            let columns = grid.columns;
            (0..grid.rows).flat_map(move |row| (0..columns).map(move |column| (column, row)))
        };
        let parents = nodes(fine)
            .map(|(column, row)| {
                let between = |index: u32| (index / 2)..=index.div_ceil(2);
                let mut parents = Parents { coarse: [0; 4], count: 0 };
                for row in between(row) {
                    for column in between(column) {
                        parents.coarse[usize::from(parents.count)] = coarse.index(column, row);
                        parents.count += 1;
                    }
                }
                parents
            })
            .collect();
        let shared = nodes(coarse).map(|(column, row)| fine.index(2 * column, 2 * row)).collect();
        Ok(Self { parents, shared })
    }

    /// Coarse to fine: a new particle takes the mean position and velocity of its assigned
    /// neighbours (thesis, 5.1.3), a shared one keeps its own.
    #[must_use]
    pub fn prolong(&self, coarse: &ClothSnapshot) -> ClothSnapshot {
        let mean =
            |values: &[Vec3]| self.parents.iter().map(|parents| parents.mean(values)).collect();
        ClothSnapshot::new(mean(&coarse.positions), mean(&coarse.velocities))
    }

    /// Fine to coarse: shared particles keep position and velocity (thesis, 5.1.3).
    #[must_use]
    pub fn restrict(&self, fine: &ClothSnapshot) -> ClothSnapshot {
        let shared = |values: &[Vec3]| {
            self.shared.iter().map(|&particle| values[particle as usize]).collect()
        };
        ClothSnapshot::new(shared(&fine.positions), shared(&fine.velocities))
    }
}
