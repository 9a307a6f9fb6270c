//! The fabrics that solve a mesh in its place: background grids, and nets of quads.

use std::sync::Arc;

use super::background::{BackgroundMesh, GridTransfer, lies_in_plane};
use super::bending::Bending;
use super::chains::Chains;
use super::fabric::{Fabric, tautness};
use super::hinges::Hinges;
use super::laid_yarns::LaidYarns;
use super::links::Links;
use super::patches;
use super::pin_paths::PinPaths;
use super::quads::Net;
use super::rest_bends::RestBends;
use super::tethers::Tethers;
use super::topology;
use super::twist::Twist;
use super::yarns::Yarns;

/// The grid that solves stretch, shear and bending of a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Background {
    /// The grid, whose particles are called nodes.
    pub fabric: Arc<Fabric>,
    /// How it reads the mesh's particles and moves them.
    pub transfer: GridTransfer,
    /// cos² of the angle between its rows and the warp.
    pub warp_cos2: f32,
    /// Number of nodes around which there is cloth.
    pub node_count: usize,
    /// Whether each node is the particle of its number.
    pub nodes_are_particles: bool,
    /// Whether it is a net that lies in no plane.
    pub is_curved_net: bool,
}

impl Background {
    /// The grid of a mesh; none if three of its triangles share an edge.
    pub(super) fn of(mesh: BackgroundMesh, tethered: bool) -> Option<Self> {
        let warp_cos2 = mesh.warp_cos2;
        let (fabric, transfer) = Fabric::of_background(mesh, tethered)?;
        let node_count = fabric.mesh.areas.iter().filter(|area| **area > 0.0).count();
        Some(Self {
            fabric: Arc::new(fabric),
            transfer,
            warp_cos2,
            node_count,
            nodes_are_particles: false,
            is_curved_net: false,
        })
    }

    /// The net of a mesh of quads.
    pub(super) fn of_net(net: Net, tethered: bool) -> Self {
        let nodes_are_particles = net.nodes_are_particles;
        let is_curved_net = !lies_in_plane(&net.mesh);
        let (fabric, transfer) = Fabric::of_net(net, tethered);
        Self {
            node_count: fabric.particle_count(),
            fabric: Arc::new(fabric),
            transfer,
            warp_cos2: 1.0,
            nodes_are_particles,
            is_curved_net,
        }
    }
}

impl Fabric {
    /// A fabric whose particles are the nodes of a net.
    pub(super) fn of_nodes(net: Net, tethered: bool) -> Self {
        let edges = net.edges.clone();
        let (mut fabric, _) = Self::of_net(net, tethered);
        fabric.hinges = Hinges::of(&fabric.mesh, &edges);
        let (reach, shortest) = (fabric.reach(), fabric.links.shortest());
        fabric.tautness = tautness(reach, shortest);
        fabric.shortest = shortest;
        fabric.probes = fabric.links.probes();
        fabric
    }

    /// The constraints of a net, whose nodes have no hinges.
    fn of_net(net: Net, tethered: bool) -> (Self, GridTransfer) {
        let Net { mesh, edges, links, yarns, corners, bending, rest_bends, transfer, .. } = net;
        let mut chains = Chains::of(&yarns.list, &yarns.colours, &links.list, None, false);
        chains.find_cells(corners.into_iter());
        chains.measure_diagonals(&mesh.positions);
        chains.sweep_diagonals();
        let fabric = Self {
            bending,
            twist: Twist::default(),
            rest_bends: Some(rest_bends),
            hinges: Hinges::of(&mesh, &[]),
            tethers: Tethers::of(&mesh, &edges, false, tethered),
            pin_paths: PinPaths::default(),
            // Its lines end inside the cloth, too, and give their load to others by shear.
            covered: vec![1.0; mesh.positions.len()],
            tautness: 0.0,
            shortest: 0.0,
            probes: Vec::new(),
            patches: patches::patches(&mesh.triangles, &mesh.triangle_areas()),
            patch_grid_columns: None,
            background: None,
            laid_yarns: LaidYarns::default(),
            strips: Vec::new(),
            topology: None,
            grid: None,
            mesh,
            links,
            yarns,
            chains,
        };
        (fabric, transfer)
    }

    /// The constraints of a background grid, whose nodes have no hinges; none if three of its triangles share an edge.
    fn of_background(background: BackgroundMesh, tethered: bool) -> Option<(Self, GridTransfer)> {
        let BackgroundMesh { grid, mut mesh, coverage, transfer, is_flat, .. } = background;
        let BackgroundMesh { is_cut, sizes, warps, are_alike, .. } = background;
        let edges = topology::edges(&mesh.triangles).ok()?;
        let is_closed = !transfer.joined.is_empty();
        let links = match &warps {
            Some(warps) => Links::of_cells_with_warps(&mesh, &grid, &coverage, warps, is_closed),
            None => Links::of(&mesh, Some(&grid), Some(&coverage), &[], is_closed),
        };
        // In the chart all lines are straight.
        let yarns = Yarns::of(&grid.positions(), &links.list);
        let sizes = sizes.as_ref();
        let mut chains =
            Chains::of(&yarns.list, &yarns.colours, &links.list, Some(&grid), is_closed);
        if !are_alike {
            chains.measure_diagonals(&mesh.positions);
        }
        mesh.triangles = grid.triangles(false);
        let inverse_areas = &mesh.inverse_areas;
        let fabric = Self {
            bending: Bending::of(&grid, inverse_areas, is_closed, sizes),
            twist: Twist::of(&grid, inverse_areas, sizes),
            rest_bends: (!is_flat).then(|| RestBends::of(&grid, &mesh, is_closed)),
            hinges: Hinges::of(&mesh, &[]),
            tethers: Tethers::of(&mesh, &edges, is_flat && !is_cut, tethered),
            pin_paths: PinPaths::default(),
            covered: sizes
                .filter(|_| is_cut)
                .map_or(Vec::new(), |sizes| sizes.parts_of_particles(&grid)),
            tautness: 0.0,
            shortest: 0.0,
            probes: Vec::new(),
            patches: patches::cells(&mesh.triangles, &grid, sizes),
            patch_grid_columns: Some(grid.columns as usize),
            background: None,
            laid_yarns: LaidYarns::default(),
            strips: Vec::new(),
            topology: None,
            grid: Some(grid),
            mesh,
            links,
            yarns,
            chains,
        };
        Some((fabric, transfer))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::fabric::Grid;
    use crate::fabric::mesh::RestMesh;
    use crate::fabric::weld::weld;

    #[test]
    fn nodes_with_three_triangles_at_an_edge_are_no_fabric() {
        let grid = Grid::new(8, 8, 1.0, 1.0);
        let positions = grid.positions();
        let uv = vec![Vec2::ZERO; positions.len()];
        let indices = grid.triangles(false).into_flattened();
        let mesh = RestMesh::new(&positions, &uv, &indices, [], weld(&positions, 0.0));
        let (mesh, surface) = mesh.expect("a good mesh");
        let background = || BackgroundMesh::of(&mesh, &surface).expect("a flat mesh has a grid");
        assert!(Background::of(background(), true).is_some());
        let mut bad = background();
        let [a, b, _] = bad.mesh.triangles[0];
        bad.mesh.triangles.extend([[a, b, 62], [a, b, 63]]);
        assert!(Background::of(bad, true).is_none());
    }
}
