//! The correspondence of two neighbouring levels, and the transfer of states between them.

use core::slice;
use std::borrow::Cow;
use std::sync::Arc;

use glam::Vec3;

use super::error::TransferError;
use super::interpolation::Interpolation;
use super::mesh::RestOffsets;
use super::motion::{free_areas, internal_motion, limit_internal_motion, match_momentum};
use super::relax::relax;
use super::settle::Settler;
use super::{grid, mesh};
use crate::batch::snapshot::ClothSnapshot;
use crate::fabric::{Fabric, FabricMaterial, Grid};
use crate::geometry::energy::{area_moment, elastic};

/// Fraction of the elastic and the kinetic energy that a transfer may add as strain energy, which is taken
/// from the motion. Smaller: cloth at rest is settled without need. Larger: motion is lost.
const ALLOWED_STRAIN: f64 = 0.01;

/// Correspondence of the particles of a finer and a coarser fabric of one cloth.
///
/// ```
/// use std::sync::Arc;
///
/// use bunting_solver::{ClothSnapshot, FabricBuilder, FabricMaterial, Grid, LevelTransfer};
/// use glam::Vec3;
///
/// let fabric = |n| FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0)).build().map(Arc::new);
/// let (fine, coarse) = (fabric(17)?, fabric(9)?);
/// let between = LevelTransfer::between(&fine, &coarse)?;
/// let flat = ClothSnapshot::at_rest(&fine);
/// let coarser = between.restrict(&flat, &FabricMaterial::COTTON, 9.81 * Vec3::NEG_Y);
/// assert_eq!(coarser.positions.len(), 81);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LevelTransfer {
    /// Settler of cloths that became finer.
    fine: Arc<Settler>,
    /// Settler of cloths that became coarser.
    coarse: Arc<Settler>,
    /// Smooth interpolation from coarse to fine particles.
    pub(super) smooth: Interpolation,
    /// Linear interpolation from coarse to fine particles, along the displayed coarse triangles.
    flat: Interpolation,
    /// Offsets of fine particles from the interpolated surface at rest.
    pub(super) offsets: RestOffsets,
    /// For each coarse particle, the fine particle at the same position, or the nearest one.
    pub(super) shared: Vec<u32>,
    /// Interpolation from fine to coarse particles, where they are not at the same positions.
    picked: Option<(Interpolation, RestOffsets)>,
    /// For each coarse particle, the sum of the free fine particles' areas weighted by the transposed smooth
    /// stencil, m².
    gathered_areas: Vec<f32>,
}

impl LevelTransfer {
    /// The correspondence of a grid and the next coarser one: every second column and row.
    ///
    /// # Errors
    ///
    /// The fabrics are not grids, or the coarser grid is not every second column and row of the finer.
    pub fn between(fine: &Arc<Fabric>, coarse: &Arc<Fabric>) -> Result<Self, TransferError> {
        Self::of_grids(Settler::new(fine), Settler::new(coarse))
    }

    /// The correspondence of this transfer's coarser grid and the next coarser one, as by [`between`](Self::between). Both transfers
    /// share the batch in which cloths of the fabric between them settle.
    ///
    /// # Errors
    ///
    /// As for [`between`](Self::between).
    pub fn then(&self, coarser: &Arc<Fabric>) -> Result<Self, TransferError> {
        Self::of_grids(Arc::clone(&self.coarse), Settler::new(coarser))
    }

    /// The correspondence of two fabrics of one surface, whose particles need not be at the same positions: those of a mesh that was
    /// [resampled](crate::FabricBuilder::resampled) at two resolutions. They correspond by their positions at rest.
    ///
    /// # Errors
    ///
    /// One of them has no triangles that can be searched.
    pub fn of_surface(fine: &Arc<Fabric>, coarse: &Arc<Fabric>) -> Result<Self, TransferError> {
        Self::of_one_surface(Settler::new(fine), Settler::new(coarse))
    }

    /// The correspondence of this transfer's coarser fabric and a coarser one of the same surface, as by
    /// [`of_surface`](Self::of_surface).
    ///
    /// # Errors
    ///
    /// As for [`of_surface`](Self::of_surface).
    pub fn then_of_surface(&self, coarser: &Arc<Fabric>) -> Result<Self, TransferError> {
        Self::of_one_surface(Arc::clone(&self.coarse), Settler::new(coarser))
    }

    fn of_one_surface(fine: Arc<Settler>, coarse: Arc<Settler>) -> Result<Self, TransferError> {
        let nearest =
            |of: &Fabric, on: &Fabric| mesh::nearest(of, on).ok_or(TransferError::NoSurface);
        let (rows, offsets) = nearest(fine.fabric(), coarse.fabric())?;
        let picked = nearest(coarse.fabric(), fine.fabric())?;
        let heaviest = |row: &[(u32, f32)]| {
            row.iter().max_by(|one, other| one.1.total_cmp(&other.1)).map_or(0, |it| it.0)
        };
        let shared = picked.0.rows().map(heaviest).collect();
        let transfer = Self::new(fine, coarse, shared, [rows.clone(), rows], offsets);
        Ok(Self { picked: Some(picked), ..transfer })
    }

    fn of_grids(fine: Arc<Settler>, coarse: Arc<Settler>) -> Result<Self, TransferError> {
        let (Some(&fine_grid), Some(&coarse_grid)) = (fine.fabric().grid(), coarse.fabric().grid())
        else {
            return Err(TransferError::NotAGrid);
        };
        let size = |grid: Grid| (grid.columns, grid.rows);
        if fine_grid.halved().map(size) != Some(size(coarse_grid)) {
            return Err(TransferError::NotNested {
                fine: size(fine_grid),
                coarse: size(coarse_grid),
            });
        }
        let shared = (0..coarse_grid.rows)
            .flat_map(|row| (0..coarse_grid.columns).map(move |column| (column, row)))
            .map(|(column, row)| fine_grid.index(2 * column, 2 * row))
            .collect();
        let stencils =
            [grid::smooth(&fine_grid, &coarse_grid), grid::flat(&fine_grid, &coarse_grid)];
        Ok(Self::new(fine, coarse, shared, stencils, RestOffsets::default()))
    }

    fn new(
        fine: Arc<Settler>,
        coarse: Arc<Settler>,
        shared: Vec<u32>,
        [smooth, flat]: [Interpolation; 2],
        offsets: RestOffsets,
    ) -> Self {
        let gathered_areas =
            smooth.gather(free_areas(fine.fabric()), coarse.fabric().particle_count());
        Self { fine, coarse, smooth, flat, offsets, shared, picked: None, gathered_areas }
    }

    /// Converts a coarser state to a finer one, for a cloth with a material and gravity along the axes of its
    /// frame, m/s².
    #[must_use]
    pub fn prolong(
        &self,
        coarse: &ClothSnapshot,
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        let mut positions: Vec<Vec3> = self.smooth.interpolate(&coarse.positions).collect();
        self.offsets.add(&coarse.positions, &mut positions);
        let velocities = self.smooth.interpolate(&coarse.velocities).collect();
        let before = Before { fabric: self.coarse.fabric(), state: coarse };
        before.conserve(&self.fine, positions, velocities, material, gravity)
    }

    /// Converts a finer state to a coarser one, for a cloth with a material and gravity along the axes of its
    /// frame, m/s².
    #[must_use]
    pub fn restrict(
        &self,
        fine: &ClothSnapshot,
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        Self::restrict_through(slice::from_ref(self), fine, material, gravity)
    }

    /// Converts a state of the finest fabric of a chain of transfers, the finest first, to one of the
    /// coarsest. Strain is removed at the coarsest level only, which is cheaper than single transfers one
    /// after the other.
    ///
    /// # Panics
    ///
    /// If the chain is empty, or its transfers are not neighbours.
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
            positions = transfer.pick_positions(&positions).into();
            velocities = transfer.gather_velocities(&velocities).into();
        }
        let (finest, coarsest) = (&chain[0], &chain[chain.len() - 1]);
        let before = Before { fabric: finest.fine.fabric(), state: fine };
        let (positions, velocities) = (positions.into_owned(), velocities.into_owned());
        before.conserve(&coarsest.coarse, positions, velocities, material, gravity)
    }

    /// For each coarse particle, the fine particle at the same position, or that which is nearest to it at rest.
    #[must_use]
    pub fn shared(&self) -> &[u32] {
        &self.shared
    }

    /// Relaxes a coarse state with the shared particles' positions and velocities: removes nearly all strain of
    /// warp and weft. This is much cheaper than [`restrict`](Self::restrict), but conserves neither
    /// momentum nor energy, and is meant for cloth that no viewer sees.
    #[must_use]
    pub fn relax(&self, coarse: ClothSnapshot) -> ClothSnapshot {
        let ClothSnapshot { mut positions, velocities, .. } = coarse;
        relax(self.coarse.fabric(), &mut positions);
        ClothSnapshot::new(positions, velocities)
    }

    /// Values at the coarse particles, from values at all fine particles: those of the shared particles, or interpolated.
    #[must_use]
    pub fn pick(&self, fine: &[Vec3]) -> Vec<Vec3> {
        match &self.picked {
            Some((rows, _)) => rows.interpolate(fine).collect(),
            None => self.shared.iter().map(|&particle| fine[particle as usize]).collect(),
        }
    }

    /// Positions of the coarse particles, m, from those of all fine particles, m.
    fn pick_positions(&self, fine: &[Vec3]) -> Vec<Vec3> {
        let mut coarse = self.pick(fine);
        if let Some((_, offsets)) = &self.picked {
            offsets.add(fine, &mut coarse);
        }
        coarse
    }

    /// Values at the fine particles, interpolated linearly over the displayed coarse triangles from values at
    /// the coarse particles. Of positions, this is where each fine particle would lie on the displayed coarse
    /// surface.
    pub fn spread<'a>(&'a self, coarse: &'a [Vec3]) -> impl Iterator<Item = Vec3> + 'a {
        self.flat.interpolate(coarse)
    }

    /// Coarse velocities v_c = v_s + D⁻¹ Pᵀ M (v − P v_s), with v the fine velocities, v_s those of the
    /// shared particles, P the smooth stencil, M the masses of the free fine particles and D = Pᵀ M 1. The
    /// velocity of a shared particle is increased by the mean difference between the fine velocities around
    /// it and the interpolated ones. After prolongation this difference is zero, so that prolongation and
    /// restriction give back the velocities.
    pub(super) fn gather_velocities(&self, fine: &[Vec3]) -> Vec<Vec3> {
        let mut coarse = self.pick(fine);
        let interpolated = self.smooth.interpolate(&coarse);
        let beyond = interpolated.zip(fine).zip(free_areas(self.fine.fabric()));
        let beyond = beyond.map(|((smooth, &fine), area)| (fine - smooth) * area);
        let gathered = self.smooth.gather(beyond, coarse.len());
        for (particle, velocity) in coarse.iter_mut().enumerate() {
            let area = self.gathered_areas[particle];
            if !self.coarse.fabric().is_pinned(particle) && area > 0.0 {
                *velocity += gathered[particle] / area;
            }
        }
        coarse
    }
}

#[cfg(test)]
impl LevelTransfer {
    /// Whether the next coarser transfer uses the same settler for the fabric between them.
    pub(super) fn shares_settler_with(&self, next: &Self) -> bool {
        Arc::ptr_eq(&self.coarse, &next.fine)
    }
}

/// A cloth before its change of level.
struct Before<'a> {
    fabric: &'a Fabric,
    state: &'a ClothSnapshot,
}

impl Before<'_> {
    /// Whether all pins are where they are at rest.
    fn pins_rest(&self) -> bool {
        let rest = self.fabric.rest_positions();
        let mut pins = self.fabric.pins().iter().map(|pin| pin.particle as usize);
        pins.all(|pin| self.state.positions[pin] == rest[pin])
    }

    /// Completes the state on the settler's fabric from positions and velocities there: removes the strain of
    /// the change, conserves the momentum, and limits the energy to that before.
    fn conserve(
        &self,
        settler: &Settler,
        mut positions: Vec<Vec3>,
        mut velocities: Vec<Vec3>,
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        let fabric = settler.fabric();
        // Pins that have been moved stay where the other level has them.
        if self.pins_rest() {
            for pin in fabric.pins() {
                positions[pin.particle as usize] = fabric.rest_positions()[pin.particle as usize];
            }
        }
        let density = f64::from(material.area_density);
        let motion = internal_motion(self.fabric, &self.state.velocities);
        let kinetic = 0.5 * density * motion;
        let stored = elastic(self.fabric, material, &self.state.positions);
        let limit = stored + ALLOWED_STRAIN * (stored + kinetic);
        // Cloth in flight is folded, and its folds are strained by new particles or by the lack of old ones.
        let folded = kinetic > stored;
        let stretched = settler.settle(material, &mut positions, limit, folded) - stored;
        let sunk =
            area_moment(self.fabric, &self.state.positions) - area_moment(fabric, &positions);
        let gained = stretched / density + sunk.dot(gravity.as_dvec3());
        match_momentum(fabric, area_moment(self.fabric, &self.state.velocities), &mut velocities);
        limit_internal_motion(fabric, motion - 2.0 * gained.max(0.0), &mut velocities);
        ClothSnapshot::new(positions, velocities)
    }
}
