//! Where particles lie among the packs of a batch, and what the fabric says of those of each.

use glam::Vec3;

use crate::batch::places::Constant;
use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::reduce::PARTS;
use crate::simd::vec3::{Pack3, lane3, set_lane3, splat3};

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

    /// Reads the vectors of one cloth, particle by particle.
    pub fn read<P: Pack, C: Constant<P>>(
        self,
        packs: &[Pack3<P>],
        cloth: usize,
        into: &mut Vec<Vec3>,
    ) {
        // Once, and not for every number.
        assert!(C::lanes(cloth).end <= P::WIDTH, "lanes of the batch");
        into.resize(self.columns * self.rows, Vec3::ZERO);
        let rows = into.chunks_mut(self.columns).zip(packs.chunks(self.blocks()));
        for (values, packs) in rows {
            for (side, pack) in values.chunks_mut(C::SIDE).zip(packs) {
                for (lane, value) in (cloth..).zip(side) {
                    *value = lane3(pack, lane);
                }
            }
        }
    }

    /// Writes the vectors of cloths, particle by particle; zero where there are none, and where no particle
    /// lies.
    pub fn write<P: Pack, C: Constant<P>>(
        self,
        packs: &mut [Pack3<P>],
        cloths: &[(usize, Option<&[Vec3]>)],
    ) {
        let zero = |of: &[Vec3], at: usize| of.get(at).copied().unwrap_or(Vec3::ZERO);
        if C::SIDE == 1 {
            // Pack by pack, so that each is fetched once for all lanes.
            for (particle, pack) in packs.iter_mut().enumerate() {
                for &(lane, values) in cloths {
                    set_lane3(pack, lane, zero(values.unwrap_or_default(), particle));
                }
            }
            return;
        }
        for &(_, values) in cloths {
            // Not a lane, but all of a pack is the cloth's.
            packs.fill(splat3(Vec3::ZERO));
            let values = values.unwrap_or_default();
            let rows = values.chunks(self.columns).zip(packs.chunks_mut(self.blocks()));
            for (side, pack) in rows.flat_map(|(row, packs)| row.chunks(C::SIDE).zip(packs)) {
                for (lane, &value) in side.iter().enumerate() {
                    set_lane3(pack, lane, value);
                }
            }
        }
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
