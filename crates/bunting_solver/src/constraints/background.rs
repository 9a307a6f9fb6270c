//! Stretch, shear and bending of a mesh on its background grid.
//!
//! The positions X of the nodes are found from the positions x of the particles, the grid is solved as any other grid,
//! and the particles follow: x = P X, where P interpolates between nodes. A node has the mass that its displacement
//! moves, Pᵀ m, so that momentum is kept. At rest the nodes are in the grid's own equilibrium, whatever the triangles
//! are like: all particles fall by the same length in a substep, and the nodes bring them back by the same length.
//!
//! The nodes begin at X = B x, with B the weights in triangles, which keeps straight rows straight. Steps
//! X ← X + R (x − P X), R = (Pᵀ m)⁻¹ Pᵀ m, lead towards the orthogonal projection onto what the grid can move. An
//! oblique one feeds motion: see [`PROJECTION_STEPS`]. As the projection is orthogonal, taking off what the grid does
//! not resolve, x − P X, neither moves the nodes nor changes the momentum.

use glam::Vec3;

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch};
use crate::batch::layout::Positions;
use crate::batch::side_by_side::SideBySide;
use crate::constants::LEAST_LENGTH;
use crate::fabric::{Fabric, GridTransfer, Height, Interpolation};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3, splat3};

/// Steps towards the orthogonal projection. Fewer: a cloth that hangs by two corners does not rest (160 mm/s without a
/// step, 12 mm/s with one, 0.1 mm/s with two).
pub(super) const PROJECTION_STEPS: usize = 2;

/// The inverse mass of each node, 1/m², from those of the particles; zero where the node is pinned.
pub(crate) fn node_inverse_masses(fabric: &Fabric, of_particles: &[f32]) -> Vec<f32> {
    let Some(background) = fabric.background() else { return Vec::new() };
    let mass = |&inverse: &f32| if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
    let masses: Vec<f32> = of_particles.iter().map(mass).collect();
    let at_rest = background.fabric.inverse_areas();
    let of_nodes = background.transfer.node_masses(&masses);
    let inverse = |(mass, &at_rest): (&f32, &f32)| if at_rest > 0.0 { 1.0 / mass } else { 0.0 };
    of_nodes.iter().zip(at_rest).map(inverse).collect()
}

impl<P: Pack> LaneBatch<P, SideBySide<P>> {
    /// Solves bending: on the background grid if the mesh fills it, else at the mesh's hinges. Then reads the nodes for
    /// [`solve_stretch_on_background`](Self::solve_stretch_on_background).
    pub(super) fn solve_bending_with_background(&mut self) {
        let is_whole = self.fabric.background().is_some_and(|grid| grid.transfer.is_whole);
        if !is_whole {
            self.solve_dihedral_both_ways();
        }
        self.read_nodes();
        if let Some(grid) = &mut self.background
            && is_whole
        {
            grid.solve_bending();
        }
    }

    /// Solves stretch and shear on the background grid; then a sweep over the mesh's links, which corrects what chains
    /// overshoot as the sweep of a grid does, tethers and contacts.
    pub(super) fn solve_stretch_on_background(&mut self) {
        if let Some(grid) = &mut self.background {
            grid.solve_stretch();
        }
        self.place_particles();
        self.sweep_mesh();
        self.solve_tethers();
        self.solve_contacts();
    }

    /// Finds the nodes' positions from the particles.
    fn read_nodes(&mut self) {
        let (Some(grid), Some(background)) = (&mut self.background, self.fabric.background())
        else {
            return;
        };
        grid.set_clock(self.clock);
        let GridTransfer { nodes, particles, means, heights, .. } = &background.transfer;
        let grid = match grid {
            BackgroundGrid::SideBySide(grid) => grid,
            BackgroundGrid::Single(grid) => {
                grid.take_particles(self.positions.packs());
                return grid.project(&background.transfer);
            }
        };
        let positions = grid.positions.packs_mut();
        positions.fill(splat3(Vec3::ZERO));
        P::run(Interpolate { rows: nodes, from: self.positions.packs(), to: positions });
        // What the grid does not resolve.
        let rest = &mut self.stretch_shift;
        for _ in 0..PROJECTION_STEPS {
            rest.clone_from(self.positions.packs_mut());
            P::run(AddInterpolated { rows: particles, sign: -1.0, from: positions, to: rest });
            P::run(AddHeights { heights, sign: -1.0, nodes: positions, to: rest });
            P::run(AddInterpolated { rows: means, sign: 1.0, from: rest, to: positions });
        }
    }

    /// Interpolates the positions of the free particles from the nodes.
    fn place_particles(&mut self) {
        let (Some(grid), Some(background)) = (&mut self.background, self.fabric.background())
        else {
            return;
        };
        let rows = &background.transfer.particles;
        let to = self.positions.packs_mut();
        match grid {
            BackgroundGrid::SideBySide(grid) => {
                let nodes = grid.positions.packs_mut();
                P::run(Interpolate { rows, from: nodes, to });
                let heights = &background.transfer.heights;
                P::run(AddHeights { heights, sign: 1.0, nodes, to });
            }
            BackgroundGrid::Single(grid) => grid.place_particles(rows, to),
        }
    }
}

/// Overwrites the vector of each row that has terms by the interpolated one.
struct Interpolate<'a, P: Pack> {
    rows: &'a Interpolation,
    from: &'a [Pack3<P>],
    to: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Interpolate<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { rows, from, to } = self;
        for (row, to) in rows.rows().zip(to) {
            if row.is_empty() {
                continue;
            }
            let mut sum = V3::<L>::splat(token, 0.0);
            for term in row {
                let from = V3::load(token, &from[term.from as usize]);
                sum = sum.plus_scaled(from, L::splat(token, term.weight));
            }
            sum.store(to);
        }
    }
}

/// Adds the interpolated vector of each row, or subtracts it.
struct AddInterpolated<'a, P: Pack> {
    rows: &'a Interpolation,
    sign: f32,
    from: &'a [Pack3<P>],
    to: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for AddInterpolated<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { rows, sign, from, to } = self;
        for (row, to) in rows.rows().zip(to) {
            let mut sum: V3<L> = V3::load(token, to);
            for term in row {
                let from = V3::load(token, &from[term.from as usize]);
                sum = sum.plus_scaled(from, L::splat(token, sign * term.weight));
            }
            sum.store(to);
        }
    }
}

/// Raises particles by their heights above the surface between the nodes, or lowers them.
struct AddHeights<'a, P: Pack> {
    heights: &'a [Height],
    sign: f32,
    nodes: &'a [Pack3<P>],
    to: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for AddHeights<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { heights, sign, nodes, to } = self;
        let least = L::splat(token, LEAST_LENGTH * LEAST_LENGTH);
        for Height { particle, nodes: [a, b, c, d], along: [x, y], height } in heights {
            let along: V3<L> =
                V3::load(token, &nodes[*b as usize]) - V3::load(token, &nodes[*a as usize]);
            let across: V3<L> =
                V3::load(token, &nodes[*d as usize]) - V3::load(token, &nodes[*c as usize]);
            let normal = along.cross(across);
            let length = normal.dot(normal).max(least).sqrt();
            let factor = L::splat(token, sign * height) / length;
            let to = &mut to[*particle as usize];
            V3::<L>::load(token, to)
                .plus_scaled(along, L::splat(token, sign * x))
                .plus_scaled(across, L::splat(token, sign * y))
                .plus_scaled(normal, factor)
                .store(to);
        }
    }
}
