//! Stretch, shear and bending of a mesh on its background grid.
//!
//! The nodes are integrated as the particles are (`step/nodes.rs`), and take over whatever else acts on the particles:
//! contacts and forces of users. Where nothing does, particles only follow (`step/follow.rs`). The grid is solved as any
//! other grid, and the particles follow: x = P X, where P interpolates between nodes. A node takes over what its displacement moves: X ← X + R (x − P X) with
//! R = (Pᵀ m)⁻¹ Pᵀ m, which is Galerkin's method with lumped masses. What the grid does not resolve is taken off.
//!
//! Nodes without a past are read from the particles alone. They begin at X = B x, with B the weights in triangles, which
//! keeps straight rows straight, and take steps of R towards the orthogonal projection. In each substep that would move
//! them by an error whose size does not depend on the substep's length, of modes that P hardly shows.

use glam::Vec3;

use crate::batch::lane_batch::{BackgroundGrid, LaneBatch};
use crate::batch::layout::Positions;
use crate::batch::side_by_side::SideBySide;
use crate::batch::snapshot::ClothSnapshot;
use crate::constants::LEAST_LENGTH;
use crate::constraints::interpolate::{AddInterpolated, Interpolate, Remainder};
use crate::fabric::{Background, Fabric, GridTransfer, Height};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::registers::Pack1;
use crate::simd::vec3::{Pack3, V3, lane3, set_lane3, splat3};

/// Steps towards the orthogonal projection for nodes that are read from the particles alone. Fewer: rows of nodes zigzag.
const READING_STEPS: usize = 2;

/// The inverse mass of each node, 1/m², from those of the particles, which include added masses; zero where the node is
/// pinned.
pub(crate) fn node_inverse_masses(fabric: &Fabric, of_particles: &[f32]) -> Vec<f32> {
    let Some(Background { fabric: grid, transfer, .. }) = fabric.background() else {
        return Vec::new();
    };
    let mass = |&inverse: &f32| if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
    let masses: Vec<f32> = of_particles.iter().map(mass).collect();
    let moved = transfer.node_masses(&masses);
    let inverse = |((mass, area), at_rest): ((&f32, &f32), &f32)| area / mass * at_rest;
    moved.iter().zip(&transfer.moved_areas).zip(grid.inverse_areas()).map(inverse).collect()
}

/// The state of the nodes of a mesh without a past.
pub(crate) fn nodes_of(fabric: &Fabric, positions: &[Vec3], velocities: &[Vec3]) -> ClothSnapshot {
    let Some(Background { transfer, .. }) = fabric.background() else {
        return ClothSnapshot::default();
    };
    let flat = GridTransfer { heights: Vec::new(), ..transfer.clone() };
    ClothSnapshot::new(interpolated(transfer, positions), interpolated(&flat, velocities))
}

/// The vectors of nodes, interpolated from those of particles.
fn interpolated(transfer: &GridTransfer, of_particles: &[Vec3]) -> Vec<Vec3> {
    let particles: Vec<Pack3<Pack1>> = of_particles.iter().copied().map(splat3).collect();
    let mut nodes = vec![splat3(Vec3::ZERO); transfer.nodes.len()];
    Pack1::run(Interpolate { rows: &transfer.nodes, from: &particles, to: &mut nodes });
    let mut unresolved = Vec::new();
    for _ in 0..READING_STEPS {
        project(transfer, &particles, &mut unresolved, &mut nodes, |_| {});
        join(&transfer.joined, &mut nodes);
    }
    nodes.iter().map(|node| lane3(node, 0)).collect()
}

/// Moves the nodes of each pair to the middle between them.
fn join(pairs: &[[u32; 2]], nodes: &mut [Pack3<Pack1>]) {
    for pair in pairs {
        let [first, second] = pair.map(|node| lane3(&nodes[node as usize], 0));
        let middle = splat3(first.midpoint(second));
        pair.iter().for_each(|&node| nodes[node as usize] = middle);
    }
}

/// Moves nodes by R (x − P X), one step towards the places at which the particles are interpolated from them best.
/// `leave_out` may change what is left of x.
fn project<P: Pack>(
    GridTransfer { particles: rows, means, heights, .. }: &GridTransfer,
    particles: &[Pack3<P>],
    unresolved: &mut Vec<Pack3<P>>,
    nodes: &mut [Pack3<P>],
    leave_out: impl Fn(&mut [Pack3<P>]),
) {
    unresolved.resize(particles.len(), splat3(Vec3::ZERO));
    P::run(Remainder { rows, from: nodes, of: particles, to: unresolved });
    P::run(AddHeights { heights, sign: -1.0, nodes, to: unresolved });
    leave_out(unresolved);
    P::run(AddInterpolated { rows: means, from: unresolved, to: nodes });
}

impl<P: Pack> LaneBatch<P, SideBySide<P>> {
    /// Moves the nodes, and solves bending.
    pub(super) fn solve_bending_on_background(&mut self) {
        self.move_nodes();
        if let Some(BackgroundGrid::SideBySide(grid)) = &mut self.background {
            grid.solve_bending_before_stretch();
        }
    }

    /// Solves stretch and shear on the background grid, then contacts.
    pub(super) fn solve_stretch_on_background(&mut self) {
        if let Some(BackgroundGrid::SideBySide(grid)) = &mut self.background {
            grid.solve_stretch_of_grid();
            grid.join_ends();
        }
        self.place_particles();
        self.sum_reactions();
        self.solve_guides();
        self.solve_contacts();
    }

    /// Moves the nodes as the particles have moved since the last substep, but for those that particles follow.
    fn move_nodes(&mut self) {
        if !self.integrates_particles() {
            return;
        }
        let (Some(BackgroundGrid::SideBySide(grid)), Some(background)) =
            (&mut self.background, self.fabric.background())
        else {
            return;
        };
        let (transfer, particles) = (&background.transfer, self.positions.packs());
        let nodes = grid.positions.packs_mut();
        P::run(Interpolate { rows: &transfer.held, from: particles, to: nodes });
        project(transfer, particles, &mut self.stretch_shift, nodes, |unresolved| {
            for (cloth, state) in self.lanes.iter().enumerate() {
                if state.as_ref().is_some_and(|state| state.follows_nodes) {
                    unresolved.iter_mut().for_each(|pack| set_lane3(pack, cloth, Vec3::ZERO));
                }
            }
        });
        self.draw_nodes();
    }

    /// Interpolates the positions of the free particles from the nodes, and their velocities at the end of a tick if all
    /// follow them.
    fn place_particles(&mut self) {
        let integrates = self.integrates_particles();
        let (Some(BackgroundGrid::SideBySide(grid)), Some(background)) =
            (&mut self.background, self.fabric.background())
        else {
            return;
        };
        let GridTransfer { particles: rows, heights, .. } = &background.transfer;
        grid.update_node_velocities(&mut self.lanes);
        let to = self.positions.packs_mut();
        let nodes = grid.positions.packs_mut();
        P::run(Interpolate { rows, from: nodes, to });
        P::run(AddHeights { heights, sign: 1.0, nodes, to });
        if !integrates && self.clock.begun == self.clock.settings.substeps {
            P::run(Interpolate { rows, from: &grid.velocity, to: &mut self.velocity });
        }
    }
}

/// Raises particles by their heights above the surface between the nodes, or lowers them.
pub(crate) struct AddHeights<'a, P: Pack> {
    pub heights: &'a [Height],
    pub sign: f32,
    pub nodes: &'a [Pack3<P>],
    pub to: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for AddHeights<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { heights, sign, nodes, to } = self;
        let sign = L::splat(token, sign);
        for Height { particle, nodes: [a, b, c, d], along: [x, y], height } in heights {
            let nodes: [V3<L>; 4] = [
                V3::load(token, &nodes[*a as usize]),
                V3::load(token, &nodes[*b as usize]),
                V3::load(token, &nodes[*c as usize]),
                V3::load(token, &nodes[*d as usize]),
            ];
            let at = [L::splat(token, *x), L::splat(token, *y), L::splat(token, *height)];
            let to = &mut to[*particle as usize];
            raised(token, V3::load(token, to), nodes, sign, at).store(to);
        }
    }
}

/// A place that is raised by a [`Height`] above four nodes, or lowered, given the coordinates along both tangents and along the
/// normal.
#[inline(always)]
pub(crate) fn raised<L: Lane>(
    token: L::Token,
    from: V3<L>,
    [a, b, c, d]: [V3<L>; 4],
    sign: L,
    [x, y, height]: [L; 3],
) -> V3<L> {
    let least = L::splat(token, LEAST_LENGTH * LEAST_LENGTH);
    let (along, across) = (b - a, d - c);
    let normal = along.cross(across);
    let length = normal.dot(normal).max(least).sqrt();
    from.plus_scaled(along, sign * x)
        .plus_scaled(across, sign * y)
        .plus_scaled(normal, sign * height / length)
}
