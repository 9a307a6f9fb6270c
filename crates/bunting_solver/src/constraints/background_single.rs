//! Interpolation between the particles of a lone mesh and the nodes of its background grid, as in `background.rs`, with
//! the coordinates of a vector in the lanes of a register: neither particles nor nodes of a row are neighbours in
//! memory.

use super::background::PROJECTION_STEPS;
use crate::batch::lane_batch::SingleGrid;
use crate::fabric::{GridTransfer, Interpolation};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::registers::Pack4;
use crate::simd::vec3::{Pack3, set_lane3};

impl SingleGrid {
    /// Finds the nodes' positions from the particles.
    pub fn project(&mut self, transfer: &GridTransfer) {
        let Self { nodes, particles, unresolved, .. } = self;
        nodes.fill(Pack4::splat(0.0));
        Pack4::run(Interpolate { rows: &transfer.nodes, from: particles, to: nodes });
        for _ in 0..PROJECTION_STEPS {
            unresolved.clone_from(particles);
            let rows = &transfer.particles;
            Pack4::run(AddInterpolated { rows, sign: -1.0, from: nodes, to: unresolved });
            let rows = &transfer.means;
            Pack4::run(AddInterpolated { rows, sign: 1.0, from: unresolved, to: nodes });
        }
        self.write_nodes();
    }

    /// Interpolates the positions of the free particles from the nodes.
    pub fn place_particles<P: Pack>(&mut self, rows: &Interpolation, positions: &mut [Pack3<P>]) {
        self.read_nodes();
        let Self { nodes, particles, .. } = self;
        Pack4::run(Interpolate { rows, from: nodes, to: particles });
        for (position, particle) in positions.iter_mut().zip(particles) {
            let [x, y, z, _] = particle.vector();
            set_lane3(position, 0, glam::Vec3::new(x, y, z));
        }
    }
}

/// Overwrites the vector of each row that has terms by the interpolated one.
struct Interpolate<'a> {
    rows: &'a Interpolation,
    from: &'a [Pack4],
    to: &'a mut [Pack4],
}

impl Kernel<Pack4> for Interpolate<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack4>>(self, token: L::Token) {
        let Self { rows, from, to } = self;
        for (row, to) in rows.rows().zip(to) {
            if row.is_empty() {
                continue;
            }
            let mut sum = L::splat(token, 0.0);
            for term in row {
                let from = L::load(token, &from[term.from as usize]);
                sum = sum.plus_product(from, L::splat(token, term.weight));
            }
            sum.store(to);
        }
    }
}

/// Adds the interpolated vector of each row, or subtracts it.
struct AddInterpolated<'a> {
    rows: &'a Interpolation,
    sign: f32,
    from: &'a [Pack4],
    to: &'a mut [Pack4],
}

impl Kernel<Pack4> for AddInterpolated<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack4>>(self, token: L::Token) {
        let Self { rows, sign, from, to } = self;
        for (row, to) in rows.rows().zip(to) {
            let mut sum = L::load(token, to);
            for term in row {
                let from = L::load(token, &from[term.from as usize]);
                sum = sum.plus_product(from, L::splat(token, sign * term.weight));
            }
            sum.store(to);
        }
    }
}
