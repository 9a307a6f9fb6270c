//! Where particles lie among the packs of a batch, and what the fabric says of those of each.

use crate::fabric::Fabric;
use crate::lanes::Pack;
use crate::places::Constant;
use crate::sums::PARTS;

/// Where particles lie among the packs of a batch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seating {
    /// Particles in a row.
    columns: usize,
    rows: usize,
    /// Particles of one cloth in a pack.
    side: usize,
}

impl Seating {
    /// A mesh that is no grid is a single row.
    pub fn of<P: Pack, C: Constant<P>>(fabric: &Fabric) -> Self {
        let columns = fabric.grid().map_or(fabric.particle_count(), |grid| grid.columns as usize);
        Self { columns, rows: fabric.particle_count() / columns, side: C::SIDE }
    }

    /// Packs in a row.
    fn blocks(self) -> usize {
        self.columns.div_ceil(self.side)
    }

    /// The pack and the lane of a particle of a cloth.
    #[inline]
    pub fn seat(self, particle: usize, cloth: usize) -> (usize, usize) {
        if self.side == 1 {
            return (particle, cloth);
        }
        let (row, column) = (particle / self.columns, particle % self.columns);
        (row * self.blocks() + column / self.side, column % self.side)
    }

    /// One value for each pack, given one for each particle; none where there are no more particles.
    pub fn lay<P: Pack, C: Constant<P>>(self, values: &[f32]) -> Vec<C> {
        let rows = values.chunks(self.columns);
        rows.flat_map(|row| {
            row.chunks(self.side).map(|side| C::of(|lane| side.get(lane).copied().unwrap_or(0.0)))
        })
        .collect()
    }

    /// Overwrites what a cloth has in the packs, given one value for each particle.
    pub fn put<P: Pack>(self, cloth: usize, values: &[f32], packs: &mut [P]) {
        for (particle, &value) in values.iter().enumerate() {
            let (pack, lane) = self.seat(particle, cloth);
            packs[pack].lanes_mut()[lane] = value;
        }
    }

    /// Into which part of a sum each pack goes.
    pub fn parts(self) -> Vec<u8> {
        let part = |block: usize| (block * self.side % PARTS) as u8;
        (0..self.rows).flat_map(|_| (0..self.blocks()).map(part)).collect()
    }
}

/// What the fabric says of the particles in each pack.
#[derive(Clone, Debug)]
pub(crate) struct Packed<C> {
    /// Area, m².
    pub areas: Vec<C>,
    /// One over the area, 1/m²; zero where pinned.
    pub inverse_areas: Vec<C>,
}

impl<C> Packed<C> {
    pub fn new<P: Pack>(seating: Seating, fabric: &Fabric) -> Self
    where
        C: Constant<P>,
    {
        Self {
            areas: seating.lay(fabric.particle_areas()),
            inverse_areas: seating.lay(fabric.inverse_areas()),
        }
    }
}
