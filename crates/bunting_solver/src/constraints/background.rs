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
use crate::constraints::interpolate::{AddInterpolated, Interpolate, Remainder};
use crate::fabric::{Fabric, GridTransfer, Height};
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
        if let Some(BackgroundGrid::SideBySide(grid)) = &mut self.background
            && is_whole
        {
            grid.solve_bending_before_stretch();
        }
    }

    /// Solves stretch and shear on the background grid, then tethers and contacts. Between them is a sweep over the links
    /// of a mesh that is curved or does not fill its grid: such links are longer than the grid's where particles are
    /// raised above nodes, or extrapolated from them. On other meshes a sweep stretches single links by up to 80 % in
    /// wind, and takes a part of the load from the grid.
    pub(super) fn solve_stretch_on_background(&mut self) {
        if let Some(BackgroundGrid::SideBySide(grid)) = &mut self.background {
            grid.solve_stretch_of_grid();
        }
        self.place_particles();
        if self.fabric.background().is_some_and(|grid| !grid.transfer.is_whole) {
            self.sweep_mesh();
        }
        self.solve_tethers();
        self.sum_reactions();
        self.solve_contacts();
    }

    /// Finds the nodes' positions from the particles.
    fn read_nodes(&mut self) {
        let (Some(BackgroundGrid::SideBySide(grid)), Some(background)) =
            (&mut self.background, self.fabric.background())
        else {
            return;
        };
        grid.clock = self.clock;
        let GridTransfer { nodes, particles, means, heights, .. } = &background.transfer;
        let positions = grid.positions.packs_mut();
        P::run(Interpolate { rows: nodes, from: self.positions.packs(), to: positions });
        // What the grid does not resolve.
        let rest = &mut self.stretch_shift;
        rest.resize(self.positions.packs().len(), splat3(Vec3::ZERO));
        for _ in 0..PROJECTION_STEPS {
            let (rows, of) = (particles, self.positions.packs());
            P::run(Remainder { rows, from: positions, of, to: rest });
            P::run(AddHeights { heights, sign: -1.0, nodes: positions, to: rest });
            P::run(AddInterpolated { rows: means, from: rest, to: positions });
        }
    }

    /// Interpolates the positions of the free particles from the nodes.
    fn place_particles(&mut self) {
        let (Some(BackgroundGrid::SideBySide(grid)), Some(background)) =
            (&mut self.background, self.fabric.background())
        else {
            return;
        };
        let GridTransfer { particles: rows, heights, .. } = &background.transfer;
        let to = self.positions.packs_mut();
        let nodes = grid.positions.packs_mut();
        P::run(Interpolate { rows, from: nodes, to });
        P::run(AddHeights { heights, sign: 1.0, nodes, to });
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
