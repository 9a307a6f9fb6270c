//! Positions of a single cloth: in packs, and in arrays of either order for its constraints.

use super::grid_shape::{GridShape, MARGIN};
use super::vector_grid::VectorGrid;
use crate::batch::layout::{Order, Particles, Positions};
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// Positions of a single cloth, m. They are valid in one of three places: the packs, the row-major arrays or
/// the column-major arrays.
#[derive(Clone, Debug)]
pub(crate) struct PositionGrids<P: Pack> {
    shape: GridShape,
    packs: Vec<Pack3<P>>,
    row_major: ParticleArrays,
    column_major: ParticleArrays,
    /// The order of the arrays that hold the valid positions; none if the packs hold them.
    order: Option<Order>,
}

/// Positions and inverse masses of all particles in one order.
#[derive(Clone, Debug)]
struct ParticleArrays {
    /// Positions, m.
    position: VectorGrid,
    /// Inverse masses per unit area density, 1/m²; zero if pinned, and in places without a particle.
    inverse_mass: Vec<f32>,
}

impl ParticleArrays {
    fn new(lines: usize, stride: usize) -> Self {
        let inverse_mass = vec![0.0; lines * stride + 2 * MARGIN];
        Self { position: VectorGrid::new(lines, stride), inverse_mass }
    }
}

impl<P: Pack> PositionGrids<P> {
    pub fn new(shape: GridShape, packs: Vec<Pack3<P>>) -> Self {
        let GridShape { row_stride, column_stride, .. } = shape;
        Self {
            shape,
            packs,
            row_major: ParticleArrays::new(column_stride, row_stride),
            column_major: ParticleArrays::new(row_stride, column_stride),
            order: None,
        }
    }

    /// Moves the positions to the arrays of an order.
    fn bring(&mut self, order: Order) {
        let GridShape { columns, rows, row_stride, column_stride, .. } = self.shape;
        let Self { row_major, column_major, .. } = self;
        if self.order.is_none() {
            row_major.position.read(&self.packs);
            self.order = Some(Order::RowMajor);
        }
        if self.order == Some(order) {
            return;
        }
        match order {
            Order::RowMajor => row_major.position.transpose_from(
                &column_major.position,
                [column_stride, row_stride],
                [rows, columns],
            ),
            Order::ColumnMajor => column_major.position.transpose_from(
                &row_major.position,
                [row_stride, column_stride],
                [columns, rows],
            ),
        }
        self.order = Some(order);
    }
}

impl<P: Pack> Positions<P> for PositionGrids<P> {
    type Constant = P;
    type Particles<'a> = GridParticles<'a, P>;
    type Lines<'a> = GridParticles<'a, P>;
    type Field = VectorGrid;

    fn packs(&self) -> &[Pack3<P>] {
        debug_assert!(self.order.is_none(), "constraints have the positions");
        &self.packs
    }

    fn packs_mut(&mut self) -> &mut Vec<Pack3<P>> {
        if self.order.is_some() {
            self.bring(Order::RowMajor);
            self.row_major.position.write(&mut self.packs);
            self.order = None;
        }
        &mut self.packs
    }

    fn overwritten(&mut self) -> &mut [Pack3<P>] {
        self.order = None;
        &mut self.packs
    }

    fn particles<'a>(
        &'a mut self,
        order: Order,
        _: &'a [P],
        linked: &'a [P],
    ) -> GridParticles<'a, P> {
        self.bring(order);
        let ParticleArrays { position, inverse_mass } = match order {
            Order::RowMajor => &mut self.row_major,
            Order::ColumnMajor => &mut self.column_major,
        };
        GridParticles { position: position.coordinates_mut(), inverse_mass, linked }
    }

    fn lines<'a>(
        &'a mut self,
        order: Order,
        inverse_masses: &'a [P],
        linked: &'a [P],
    ) -> Self::Lines<'a> {
        self.particles(order, inverse_masses, linked)
    }

    fn field(&mut self) -> &VectorGrid {
        self.packs_mut();
        self.row_major.position.read(&self.packs);
        &self.row_major.position
    }

    fn set_inverse_masses(&mut self, of_particles: &[f32]) {
        let GridShape { columns, row_stride, column_stride, .. } = self.shape;
        for (row, inverse_masses) in of_particles.chunks(columns).enumerate() {
            for (column, &inverse_mass) in inverse_masses.iter().enumerate() {
                self.row_major.inverse_mass[MARGIN + row * row_stride + column] = inverse_mass;
                self.column_major.inverse_mass[MARGIN + column * column_stride + row] =
                    inverse_mass;
            }
        }
    }

    fn clear(&mut self) {
        self.row_major.position.clear();
        self.column_major.position.clear();
        self.order = None;
    }
}

/// Consecutive particles of one cloth in each pack.
pub(crate) struct GridParticles<'a, P: Pack> {
    position: [&'a mut [f32]; 3],
    inverse_mass: &'a [f32],
    linked: &'a [P],
}

impl<P: Pack> Particles<P> for GridParticles<'_, P> {
    type Constant = P;

    #[inline(always)]
    fn position<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> V3<L> {
        let ([x, y, z], at) = (&self.position, at as usize);
        V3 { x: L::load_at(token, x, at), y: L::load_at(token, y, at), z: L::load_at(token, z, at) }
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = P>>(&mut self, _: L::Token, at: u32, position: V3<L>) {
        let ([x, y, z], at) = (&mut self.position, at as usize);
        position.x.store_at(x, at);
        position.y.store_at(y, at);
        position.z.store_at(z, at);
    }

    #[inline(always)]
    fn inverse_mass<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> L {
        L::load_at(token, self.inverse_mass, at as usize)
    }

    #[inline(always)]
    fn one_if_linked<L: Lane<Pack = P>>(&self, token: L::Token, class: u32) -> L {
        L::load(token, &self.linked[class as usize])
    }
}
