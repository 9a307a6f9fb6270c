//! Fabrics of nets: the lines between the nodes that a surface is resampled to.

use super::chains::Chains;
use super::fabric::{Fabric, tautness};
use super::hinges::Hinges;
use super::net::Net;
use super::patches;
use super::pin_distances::PinDistances;
use super::tethers::Tethers;
use super::twist::Twist;

impl Fabric {
    /// A fabric whose particles are the nodes of a net.
    pub(super) fn of_nodes(net: Net, tethered: bool) -> Self {
        let Net { mesh, edges, links, yarns, corners, bending, rest_bends, area, variation } = net;
        let mut chains = Chains::of(&yarns.list, &yarns.colours, &links.list);
        chains.find_cells(corners.into_iter());
        chains.measure_diagonals(&mesh.positions);
        chains.sweep_diagonals();
        let tethers = Tethers::of(&mesh, &edges, false, tethered);
        let (reach, shortest) = (tethers.reach, links.shortest());
        Self {
            bending,
            twist: Twist::default(),
            rest_bends: Some(rest_bends),
            hinges: Hinges::of(&mesh, &edges, &variation),
            pin_distances: PinDistances::default(),
            tautness: tautness(reach, shortest),
            shortest,
            probes: links.probes(),
            patches: patches::patches(&mesh.triangles, &mesh.triangle_areas()),
            patch_grid_columns: None,
            strips: Vec::new(),
            topology: None,
            warp_cos2: 1.0,
            area,
            grid: None,
            tethers,
            extremes: variation.extremes(&mesh),
            mesh,
            particle_of_point: Vec::new(),
            links,
            links_at: Default::default(),
            yarns,
            chains,
        }
    }

    /// Whether its particles are the nodes of a net.
    pub(crate) fn is_net(&self) -> bool {
        self.grid.is_none()
    }
}
