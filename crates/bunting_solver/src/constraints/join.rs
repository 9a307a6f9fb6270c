//! The ends of closed grids, whose first and last row are at one place.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Order, Particles, Positions};
use crate::fabric::Fabric;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

/// Indices in row-major order of the packs of the first row of a closed grid and of the last; none of other fabrics.
pub(crate) fn joined_rows<P: Pack, Y: Layout<P>>(fabric: &Fabric, layout: &Y) -> Vec<[u32; 2]> {
    let Some(grid) = fabric.grid().filter(|_| fabric.is_closed()) else { return Vec::new() };
    let index = |node: u32| layout.index_of_pack(layout.locate(node as usize, 0).0);
    let mut joined: Vec<[u32; 2]> = grid.ends_of_columns().map(|ends| ends.map(index)).collect();
    joined.dedup();
    joined
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Moves the nodes at both ends of the columns of a closed grid to the middle between them.
    pub(super) fn join_ends(&mut self) {
        if self.joined.is_empty() {
            return;
        }
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        let particles = self.positions.particles(Order::RowMajor, masses, linked);
        P::run(Join { joined: &self.joined, particles });
    }
}

struct Join<'a, S> {
    joined: &'a [[u32; 2]],
    particles: S,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for Join<'_, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let half = L::splat(token, 0.5);
        for &[first, second] in self.joined {
            let from: V3<L> = self.particles.position(token, first);
            let to: V3<L> = self.particles.position(token, second);
            let middle = from.plus_scaled(to - from, half);
            self.particles.set_position(token, first, middle);
            self.particles.set_position(token, second, middle);
        }
    }
}
