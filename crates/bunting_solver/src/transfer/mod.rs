//! Moves a cloth's state from one level of detail to another.
//!
//! Up (to more particles): a new particle takes its position and its velocity from the coarse ones
//! about it, by a smooth stencil, so that folds are not flattened. Down: shared particles keep their
//! positions (thesis, 5.1.3), and velocities are gathered from all.
//!
//! Either way the strain that comes with it is taken off the positions alone, linear momentum is kept,
//! and the total energy does not grow: what strain and height gain, the motion about the mean gives.
//! The integrator begins anew.

mod grid;
mod mesh;
mod motion;
mod rows;
mod settle;

use core::slice;
use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;

use crate::batch::snapshot::ClothSnapshot;
use crate::fabric::{Fabric, FabricMaterial};
use crate::geometry::energy::{area_moment, elastic};
use mesh::Relief;
use rows::Rows;
use settle::Settler;

/// Part of the elastic and the kinetic energy that may be added as strain, and is taken from the motion.
/// Smaller: cloth at rest is settled that need not be. Larger: motion is lost.
const PAID: f64 = 0.01;

/// Why two fabrics are not neighbours in a chain of levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// Only grids know their neighbours by themselves.
    #[error("the fabrics are no grids: say which vertices they share")]
    NotAGrid,
    /// The coarser fabric must have some of the finer one's vertices.
    #[error(
        "{given} shared vertices do not fit a fabric of {expected}, or are not the finer one's"
    )]
    NotShared {
        /// Vertices that are said to be shared.
        given: usize,
        /// Vertices of the coarser fabric.
        expected: usize,
    },
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
    fine: Arc<Fabric>,
    coarse: Arc<Fabric>,
    /// Where cloths that become finer, and coarser, settle.
    settlers: [Arc<Settler>; 2],
    /// Where new particles come from.
    smooth: Rows,
    /// Where they lie on the coarse triangles.
    flat: Rows,
    /// What stands out from them at rest.
    relief: Relief,
    /// For each coarse particle the fine one that it is.
    shared: Vec<u32>,
    /// For each coarse particle what it has of the fine ones' masses, in units of the density, m².
    masses: Vec<f32>,
}

impl LevelTransfer {
    /// The correspondence of a fabric and the next coarser one: every second column and row.
    ///
    /// # Errors
    ///
    /// The fabrics are not grids, or the coarser is not every second column and row of the finer.
    pub fn between(fine: &Arc<Fabric>, coarse: &Arc<Fabric>) -> Result<Self, TransferError> {
        let (Some(fine_grid), Some(coarse_grid)) = (fine.grid(), coarse.grid()) else {
            return Err(TransferError::NotAGrid);
        };
        let halved = fine_grid.halved().map(|grid| (grid.columns, grid.rows));
        if halved != Some((coarse_grid.columns, coarse_grid.rows)) {
            return Err(TransferError::NotNested {
                fine: (fine_grid.columns, fine_grid.rows),
                coarse: (coarse_grid.columns, coarse_grid.rows),
            });
        }
        let shared = (0..coarse_grid.rows)
            .flat_map(|row| (0..coarse_grid.columns).map(move |column| (column, row)))
            .map(|(column, row)| fine_grid.index(2 * column, 2 * row))
            .collect();
        let smooth = grid::smooth(fine_grid, coarse_grid);
        Ok(Self {
            fine: Arc::clone(fine),
            coarse: Arc::clone(coarse),
            settlers: [fine, coarse].map(|fabric| Arc::new(Settler::new(fabric))),
            masses: motion::gather_masses(&smooth, fine, coarse.particle_count()),
            smooth,
            flat: grid::flat(fine_grid, coarse_grid),
            relief: Relief::default(),
            shared,
        })
    }

    /// The correspondence of a fabric and one whose mesh has some of its mesh's vertices, as
    /// [`FabricBuilder::coarser`](crate::FabricBuilder::coarser) tells them: grids as in
    /// [`between`](Self::between), other meshes by where they lie at rest.
    ///
    /// # Errors
    ///
    /// The vertices are not those of the coarser fabric, or a grid is not half of the other.
    pub fn nested(
        fine: &Arc<Fabric>,
        coarse: &Arc<Fabric>,
        vertices: &[u32],
    ) -> Result<Self, TransferError> {
        if fine.grid().is_some() && coarse.grid().is_some() {
            return Self::between(fine, coarse);
        }
        let expected = coarse.particle_of_vertex().len();
        let wrong = TransferError::NotShared { given: vertices.len(), expected };
        if vertices.len() != expected {
            return Err(wrong);
        }
        let mut shared = vec![0; coarse.particle_count()];
        for (&particle, &vertex) in coarse.particle_of_vertex().iter().zip(vertices) {
            shared[particle as usize] =
                *fine.particle_of_vertex().get(vertex as usize).ok_or(wrong)?;
        }
        let (rows, relief) = mesh::nearest(fine, coarse, &shared).ok_or(wrong)?;
        Ok(Self {
            fine: Arc::clone(fine),
            coarse: Arc::clone(coarse),
            settlers: [fine, coarse].map(|fabric| Arc::new(Settler::new(fabric))),
            masses: motion::gather_masses(&rows, fine, coarse.particle_count()),
            smooth: rows.clone(),
            flat: rows,
            relief,
            shared,
        })
    }

    /// Coarse to fine, for a cloth of a material under a gravity along the axes of its frame, m/s².
    #[must_use]
    pub fn prolong(
        &self,
        coarse: &ClothSnapshot,
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        let mut positions: Vec<Vec3> = self.smooth.interpolate(&coarse.positions).collect();
        self.relief.add(&coarse.positions, &mut positions);
        let velocities = self.smooth.interpolate(&coarse.velocities).collect();
        let before = Side { fabric: &self.coarse, state: coarse };
        before.arrive(&self.settlers[0], positions, velocities, material, gravity)
    }

    /// Fine to coarse, for a cloth of a material under a gravity along the axes of its frame, m/s².
    #[must_use]
    pub fn restrict(
        &self,
        fine: &ClothSnapshot,
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        Self::restrict_through(slice::from_ref(self), fine, material, gravity)
    }

    /// From the finest to the coarsest fabric of a chain, the finest neighbours first. The levels between
    /// are only passed through: strain is taken off where the cloth arrives.
    ///
    /// # Panics
    ///
    /// When the chain is empty, or not of neighbours.
    #[must_use]
    pub fn restrict_through(
        chain: &[Self],
        fine: &ClothSnapshot,
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        let (mut positions, mut velocities) =
            (Cow::from(&fine.positions), Cow::from(&fine.velocities));
        for transfer in chain {
            positions = transfer.pick(&positions).collect::<Vec<_>>().into();
            velocities = transfer.gather_velocities(&velocities).into();
        }
        let (finest, coarsest) = (&chain[0], &chain[chain.len() - 1]);
        let before = Side { fabric: &finest.fine, state: fine };
        let settler = &coarsest.settlers[1];
        before.arrive(settler, positions.into_owned(), velocities.into_owned(), material, gravity)
    }

    /// For each coarse particle the fine one that it is.
    #[must_use]
    pub fn shared(&self) -> &[u32] {
        &self.shared
    }

    /// Takes the strain off a coarse state that has only the shared particles' positions and velocities,
    /// until it stores hardly more than moves. For what nobody sees: much cheaper than
    /// [`restrict`](Self::restrict), but neither momentum nor energy are those of the fine cloth.
    #[must_use]
    pub fn calm(&self, coarse: ClothSnapshot, material: &FabricMaterial) -> ClothSnapshot {
        let ClothSnapshot { mut positions, velocities, .. } = coarse;
        let moves =
            0.5 * f64::from(material.area_density) * motion::agitation(&self.coarse, &velocities);
        self.settlers[1].settle(material, &mut positions, PAID * moves, true);
        ClothSnapshot::new(positions, velocities)
    }

    /// Values at the fine particles, of those that are shared: one a coarse particle.
    pub fn pick<'a>(&'a self, fine: &'a [Vec3]) -> impl Iterator<Item = Vec3> + 'a {
        self.shared.iter().map(|&particle| fine[particle as usize])
    }

    /// Values at the coarse particles, spread over the coarse triangles as these are drawn: what each
    /// fine particle would show of them.
    pub fn spread<'a>(&'a self, coarse: &'a [Vec3]) -> impl Iterator<Item = Vec3> + 'a {
        self.flat.interpolate(coarse)
    }
}

/// A cloth before its change of level.
struct Side<'a> {
    fabric: &'a Fabric,
    state: &'a ClothSnapshot,
}

impl Side<'_> {
    /// The state on another fabric, made sound.
    fn arrive(
        &self,
        settler: &Settler,
        mut positions: Vec<Vec3>,
        mut velocities: Vec<Vec3>,
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        let fabric = settler.fabric();
        for pin in fabric.pins() {
            positions[pin.particle as usize] = fabric.rest_positions()[pin.particle as usize];
        }
        let density = f64::from(material.area_density);
        let agitation = motion::agitation(self.fabric, &self.state.velocities);
        let had = elastic(self.fabric, material, &self.state.positions);
        // So little more that the motion hardly notices when it pays.
        let moves = 0.5 * density * agitation;
        let limit = had + PAID * (had + moves);
        // What flies is folded, and folds strain what is new or has nowhere to go.
        let stretched = settler.settle(material, &mut positions, limit, moves > had) - had;
        let height =
            area_moment(self.fabric, &self.state.positions) - area_moment(fabric, &positions);
        let gained = stretched / density + height.dot(gravity.as_dvec3());
        motion::match_momentum(
            fabric,
            area_moment(self.fabric, &self.state.velocities),
            &mut velocities,
        );
        motion::calm(fabric, agitation - 2.0 * gained.max(0.0), &mut velocities);
        ClothSnapshot::new(positions, velocities)
    }
}

#[cfg(test)]
mod tests;
