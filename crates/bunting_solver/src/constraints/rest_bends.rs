//! The second differences at rest of a net, turned with the cloth.
//!
//! Before bending is solved, the frame of each node is found from its neighbours at their predicted positions. The second
//! differences at rest (`fabric/rest_bends.rs`), which are constant in this frame, are then constant vectors of the systems'
//! right-hand sides.

use crate::batch::layout::{Layout, Order, Particles, Positions};
use crate::constants::LEAST_LENGTH;
use crate::fabric::Fabric;
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3, splat3};

/// The second differences at rest of the nodes of a batch of nets.
#[derive(Clone, Debug)]
pub(crate) struct RestBendPacks<P: Pack, Y: Layout<P>> {
    frames: Vec<NodeFrame<Y::Constant>>,
    /// Second differences along rows, and along columns, m.
    turned: [Y::Positions; 2],
}

/// What the frame of each node of a pack is found from, and what is constant in it.
#[derive(Clone, Copy, Debug)]
struct NodeFrame<C> {
    /// Index of the first node in row-major order.
    at: u32,
    /// Indices of its neighbours before and after it in its row, above and below it.
    neighbours: [u32; 4],
    /// Positive in lanes whose node has a neighbour above it, and below it.
    has_in_column: [C; 2],
    /// Positive in lanes whose node has neighbours before and after it in its row.
    has_in_row: [C; 2],
    /// As `RestBends::of_nodes`, m.
    at_rest: [[C; 3]; 2],
}

impl<P: Pack, Y: Layout<P>> RestBendPacks<P, Y> {
    /// Those of a fabric; none of a grid.
    pub fn of(fabric: &Fabric, layout: &Y) -> Option<Self> {
        let rest = fabric.rest_bends()?;
        let mut nodes_of_packs = vec![Vec::new(); layout.pack_count()];
        for node in 0..fabric.particle_count() {
            nodes_of_packs[layout.locate(node, 0).0].push(node);
        }
        let frame = |(pack, nodes): (usize, &Vec<usize>)| {
            let constant = |of_node: &dyn Fn(usize) -> f32| {
                Y::Constant::of(|lane| nodes.get(lane).map_or(0.0, |&node| of_node(node)))
            };
            let has = |side: usize| move |node: usize| rest.has_neighbour(node, side);
            let masks =
                |sides: [usize; 2]| sides.map(|side| constant(&|node| f32::from(has(side)(node))));
            NodeFrame {
                at: layout.index_of_pack(pack),
                neighbours: layout.neighbours_of_pack(pack, nodes, rest),
                has_in_row: masks([0, 1]),
                has_in_column: masks([2, 3]),
                at_rest: [0, 1].map(|kind| {
                    [0, 1, 2].map(|axis| constant(&|node| rest.of_nodes[node][kind][axis]))
                }),
            }
        };
        let zero = || layout.positions(vec![splat3(glam::Vec3::ZERO); layout.pack_count()]);
        Some(Self {
            frames: nodes_of_packs.iter().enumerate().map(frame).collect(),
            turned: [zero(), zero()],
        })
    }

    /// The second differences along rows or columns as the positions of particles.
    pub fn of_lines<'a>(
        &'a mut self,
        are_rows: bool,
        order: Order,
        masses: &'a [P],
        linked: &'a [P],
    ) -> <Y::Positions as Positions<P>>::Particles<'a> {
        let [rows, columns] = &mut self.turned;
        if are_rows { rows } else { columns }.particles(order, masses, linked)
    }

    /// Turns them with the nodes, in row-major order.
    pub fn turn(&mut self, nodes: <Y::Positions as Positions<P>>::Particles<'_>) {
        let turned = self.turned.each_mut().map(|vectors| vectors.overwritten());
        P::run(TurnRestBends { frames: &self.frames, turned, nodes });
    }
}

struct TurnRestBends<'a, P: Pack, S: Particles<P>> {
    frames: &'a [NodeFrame<S::Constant>],
    turned: [&'a mut [Pack3<P>]; 2],
    nodes: S,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for TurnRestBends<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let zero = L::splat(token, 0.0);
        let [rows, columns] = self.turned;
        for (frame, (row, column)) in self.frames.iter().zip(rows.iter_mut().zip(columns)) {
            let at: V3<L> = self.nodes.position(token, frame.at);
            let [before, after, above, below] = frame.neighbours;
            let [has_before, has_after] = &frame.has_in_row;
            let before = self.nodes.position(token, before);
            let before: V3<L> = before.or_where_not(zero.lt(has_before.load(token)), at);
            let after = self.nodes.position(token, after);
            let after: V3<L> = after.or_where_not(zero.lt(has_after.load(token)), at);
            let [has_above, has_below] = &frame.has_in_column;
            let above = self.nodes.position(token, above);
            let above: V3<L> = above.or_where_not(zero.lt(has_above.load(token)), at);
            let below = self.nodes.position(token, below);
            let below: V3<L> = below.or_where_not(zero.lt(has_below.load(token)), at);
            let across = below - above;
            let along = after - before;
            let normal = unit(token, along.cross(across));
            let tangent = unit(token, along);
            let product = normal.cross(tangent);
            let [of_row, of_column] = &frame.at_rest;
            let axes = [normal, tangent, product];
            along_axes(token, axes, of_row).store(row);
            along_axes(token, axes, of_column).store(column);
        }
    }
}

/// The vector with these parts along axes.
#[inline(always)]
fn along_axes<L: Lane, C: Constant<L::Pack>>(
    token: L::Token,
    [normal, tangent, product]: [V3<L>; 3],
    [first, second, third]: &[C; 3],
) -> V3<L> {
    (normal * first.load(token))
        .plus_scaled(tangent, second.load(token))
        .plus_scaled(product, third.load(token))
}

/// The unit vector along a vector.
#[inline(always)]
fn unit<L: Lane>(token: L::Token, vector: V3<L>) -> V3<L> {
    let least = L::splat(token, LEAST_LENGTH * LEAST_LENGTH);
    vector * (L::splat(token, 1.0) / vector.dot(vector).max(least).sqrt())
}
