//! The single-cloth layout: one cloth on a grid across the lanes.
//!
//! Chains of one colour share no particle, so that they can be solved in any order, or at once. The chains of
//! a grid are its rows, columns and diagonals. In row-major order consecutive particles belong to consecutive
//! columns, so that a pack holds one particle of each of as many columns as there are lanes; the same holds
//! for diagonals, if each row begins one particle further on. In column-major order it holds for rows. The
//! kernels are those of cloths side by side, and every chain has the bits of scalar code.
//!
//! Operations on single particles are done to packs of one row, and triangles are summed in packs of cells.

mod bend_lines;
mod cells;
mod chains;
mod grid_shape;
mod lane_indices;
mod position_grids;
mod ribbons;
mod vector_grid;

use core::ops::Range;

use glam::Vec3;

use self::bend_lines::BendLinePacks;
use self::cells::Cells;
use self::chains::ChainPacks;
use self::grid_shape::GridShape;
use self::lane_indices::{LaneIndices, NO_INDEX};
use self::position_grids::PositionGrids;
use self::ribbons::RibbonPacks;
use self::vector_grid::VectorGrid;
use crate::batch::layout::{Layout, OfCloth, Order};
use crate::batch::single_tethers::TetherPacks;
use crate::batch::tether_pack::TetherPack;
use crate::constraints::bend_factors::BendFactors;
use crate::constraints::factors::{ClothFactors, Factors};
use crate::constraints::stiffness::Stiffness;
use crate::constraints::twist_factors::TwistFactors;
use crate::fabric::{BendLine, Chains, Fabric, Ribbon};
use crate::simd::constant::Constant;
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, lane3, set_lane3, splat3};

/// One cloth across the lanes, with the constraints of its grid in packs.
#[derive(Clone, Debug)]
pub(crate) struct SingleCloth<P: Pack> {
    shape: GridShape,
    chains: ChainPacks<P>,
    /// For each class of links, one in lanes that have a link, zero in others.
    linked: Vec<P>,
    bend_lines: BendLinePacks,
    ribbons: RibbonPacks,
    factors: Factors<P, P>,
    /// Tethers to the farthest pins, and to the nearest pins.
    tethers: [TetherPacks<P>; 2],
    cells: Cells<P>,
    /// Velocities in the form that sums over triangles read, m/s.
    velocity: VectorGrid,
}

impl<P: Pack> SingleCloth<P> {
    /// The layout of a fabric; none unless it is a grid whose yarns run straight, and so wide that it is not
    /// solved by strips, whose rows follow one on another.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        if !fabric.strips().is_empty() {
            return None;
        }
        let shape = GridShape::new::<P>(fabric.grid()?);
        let chains = ChainPacks::new(fabric, shape)?;
        let cells = Cells::new(fabric, shape)?;
        let bend_lines = BendLinePacks::new::<P>(fabric, shape);
        let ribbons = RibbonPacks::new::<P>(fabric, shape);
        let linked = |of_lanes: &LaneIndices| P::of(|lane| f32::from(of_lanes[lane] != NO_INDEX));
        let bending = bend_lines.profiles.iter().map(|of_lanes| {
            BendFactors::new(&of_lanes_in::<P, _>(of_lanes, fabric.bend_profiles()))
        });
        let twist = ribbons.profiles.iter().map(|of_lanes| {
            TwistFactors::new(&of_lanes_in::<P, _>(of_lanes, fabric.ribbon_profiles()))
        });
        let locate = |particle: u32| locate::<P>(shape, particle as usize);
        Some(Self {
            factors: Factors {
                link_compliance: vec![P::splat(0.0); chains.classes.len()],
                bending: bending.collect(),
                twist: twist.collect(),
                resists_twist: P::splat(0.0),
            },
            linked: chains.classes.iter().map(linked).collect(),
            tethers: [fabric.far_tethers(), fabric.tethers()]
                .map(|tethers| TetherPacks::new(tethers, locate, GridShape::start_of_pack::<P>)),
            velocity: VectorGrid::new(shape.column_stride, shape.row_stride),
            shape,
            chains,
            bend_lines,
            ribbons,
            cells,
        })
    }
}

/// The elements of a list of the fabric that the lanes' indices refer to.
fn of_lanes_in<'a, P: Pack, T>(of_lanes: &LaneIndices, list: &'a [T]) -> Vec<Option<&'a T>> {
    of_lanes[..P::WIDTH].iter().map(|&index| list.get(index as usize)).collect()
}

/// The pack and the lane of a particle.
#[inline]
fn locate<P: Pack>(shape: GridShape, particle: usize) -> (usize, usize) {
    let (row, column) = shape.place(particle);
    (row * shape.packs_in_row::<P>() + column / P::WIDTH, column % P::WIDTH)
}

impl<P: Pack> Layout<P> for SingleCloth<P> {
    type Constant = P;
    type Positions = PositionGrids<P>;
    type Tether = TetherPack<P>;
    type Triangles<'a> = &'a mut Cells<P>;

    const CLOTHS: usize = 1;

    fn lanes(_: usize) -> Range<usize> {
        0..P::WIDTH
    }

    fn pack_count(&self) -> usize {
        self.shape.rows * self.shape.packs_in_row::<P>()
    }

    #[inline]
    fn locate(&self, particle: usize, _: usize) -> (usize, usize) {
        locate::<P>(self.shape, particle)
    }

    fn read(&self, packs: &[Pack3<P>], _: usize, into: &mut Vec<Vec3>) {
        let GridShape { columns, rows, .. } = self.shape;
        into.resize(columns * rows, Vec3::ZERO);
        let packs = packs.chunks(self.shape.packs_in_row::<P>());
        for (values, packs) in into.chunks_mut(columns).zip(packs) {
            for (values, pack) in values.chunks_mut(P::WIDTH).zip(packs) {
                for (lane, value) in values.iter_mut().enumerate() {
                    *value = lane3(pack, lane);
                }
            }
        }
    }

    /// Without a division for each particle.
    fn read_numbers(&self, packs: &[P], _: usize, into: &mut [f32]) {
        let packs = packs.chunks(self.shape.packs_in_row::<P>());
        for (values, packs) in into.chunks_mut(self.shape.columns).zip(packs) {
            for (values, pack) in values.chunks_mut(P::WIDTH).zip(packs) {
                values.copy_from_slice(&pack.lanes()[..values.len()]);
            }
        }
    }

    fn write(&self, packs: &mut [Pack3<P>], cloths: &[OfCloth]) {
        for &(_, values) in cloths {
            packs.fill(splat3(Vec3::ZERO));
            let rows = values.unwrap_or_default().chunks(self.shape.columns);
            let packs = packs.chunks_mut(self.shape.packs_in_row::<P>());
            for (row, packs) in rows.zip(packs) {
                for (values, pack) in row.chunks(P::WIDTH).zip(packs) {
                    for (lane, &value) in values.iter().enumerate() {
                        set_lane3(pack, lane, value);
                    }
                }
            }
        }
    }

    fn constants(&self, of_particles: &[f32]) -> Vec<P> {
        let rows = of_particles.chunks(self.shape.columns);
        let packs = rows.flat_map(|row| row.chunks(P::WIDTH));
        packs.map(|pack| P::of(|lane| pack.get(lane).copied().unwrap_or(0.0))).collect()
    }

    /// All packs add to the first partial sum, whose lanes are the partial sums of the cloth.
    fn partial_sums(&self) -> Vec<u8> {
        vec![0; self.pack_count()]
    }

    fn positions(&self, packs: Vec<Pack3<P>>) -> PositionGrids<P> {
        PositionGrids::new(self.shape, packs)
    }

    fn chains<'a>(&'a self, _: &'a Fabric) -> &'a Chains<P> {
        &self.chains.chains
    }

    fn index_of_pack(&self, pack: usize) -> u32 {
        GridShape::start_of_pack::<P>(pack)
    }

    fn particle_at(&self, order: Order, index: u32, lane: usize) -> Option<u32> {
        self.shape.particle_in(order, index + lane as u32).map(|particle| particle as u32)
    }

    fn order_of_chains(&self, colour: usize) -> Order {
        self.chains.orders[colour]
    }

    fn linked(&self) -> &[P] {
        &self.linked
    }

    fn bend_lines<'a>(&'a self, _: &'a Fabric) -> impl Iterator<Item = (Order, &'a [BendLine])> {
        self.bend_lines.lines.iter().map(|(order, lines)| (*order, &lines[..]))
    }

    fn ribbons<'a>(&'a self, _: &'a Fabric) -> (Order, &'a [Ribbon]) {
        (self.ribbons.order, &self.ribbons.ribbons)
    }

    fn tethers<'a>(&'a self, _: &'a Fabric) -> [&'a [TetherPack<P>]; 2] {
        self.tethers.each_ref().map(|tethers| &tethers.packs[..])
    }

    fn factors(&self) -> &Factors<P, P> {
        &self.factors
    }

    fn set_stiffness(&mut self, _: usize, fabric: &Fabric, stiffness: &Stiffness) {
        let of_cloth = ClothFactors::new(fabric, stiffness);
        self.factors.set_resists_twist(0..P::WIDTH, &of_cloth);
        let Factors { link_compliance, bending, twist, .. } = &mut self.factors;
        for (pack, classes) in link_compliance.iter_mut().zip(&self.chains.classes) {
            let of_class = |class: u32| of_cloth.link_compliance.get(class as usize);
            *pack = P::of(|lane| of_class(classes[lane]).copied().unwrap_or(0.0));
        }
        for (factors, profiles) in bending.iter_mut().zip(&self.bend_lines.profiles) {
            for (lane, rows) in of_lanes_in::<P, _>(profiles, &of_cloth.bending).iter().enumerate()
            {
                rows.iter().for_each(|rows| factors.set_lane(lane, rows));
            }
        }
        for (factors, profiles) in twist.iter_mut().zip(&self.ribbons.profiles) {
            for (lane, rows) in of_lanes_in::<P, _>(profiles, &of_cloth.twist).iter().enumerate() {
                rows.iter().for_each(|rows| factors.set_lane(lane, rows));
            }
        }
    }

    fn set_pins(&mut self, _: usize, _: &Fabric, positions: &[Vec3]) {
        self.tethers.iter_mut().for_each(|tethers| tethers.set_pins(positions));
    }

    fn triangles<'a>(&'a mut self, _: &'a Fabric) -> &'a mut Cells<P> {
        &mut self.cells
    }

    fn moving_triangles<'a>(
        &'a mut self,
        _: &'a Fabric,
        velocity: &'a [Pack3<P>],
    ) -> (&'a mut Cells<P>, &'a VectorGrid) {
        self.velocity.read(velocity);
        (&mut self.cells, &self.velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::SingleCloth;
    use crate::fabric::{Fabric, FabricBuilder, Grid};
    use crate::simd::registers::Pack8;

    fn flag(columns: u32, rows: u32, cell_height: f32) -> Fabric {
        let (width, height) = ((columns - 1) as f32, (rows - 1) as f32 * cell_height);
        let grid = FabricBuilder::grid(Grid::new(columns, rows, width, height));
        grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric")
    }

    #[test]
    fn grids_with_straight_yarns_have_the_layout() {
        for (columns, rows) in [(33, 33), (17, 9), (5, 16), (8, 16), (3, 8), (2, 2)] {
            let layout = SingleCloth::<Pack8>::of(&flag(columns, rows, 0.8));
            assert!(layout.is_some(), "{columns} × {rows}");
        }
    }

    #[test]
    fn narrow_grids_have_not() {
        for (columns, rows) in [(2, 9), (9, 2), (5, 17), (9, 3)] {
            let layout = SingleCloth::<Pack8>::of(&flag(columns, rows, 0.8));
            assert!(layout.is_none(), "{columns} × {rows}");
        }
    }

    #[test]
    fn grids_whose_diagonals_zigzag_have_not() {
        assert!(SingleCloth::<Pack8>::of(&flag(5, 17, 0.1)).is_none());
    }
}
