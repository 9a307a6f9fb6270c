//! A cloth at rest: the immutable part that all cloths of one mesh share.
//!
//! A [`Fabric`] holds geometry only. Masses are areas (a particle's mass is its area times the material's area
//! density and the factors of regions), and the stiffness of a constraint is a modulus of the material times a coefficient of the
//! constraint, so that cloths of different [`FabricMaterial`]s share one fabric and one batch.
//!
//! From a mesh to a fabric, a file a step: [`FabricBuilder`] checks the mesh and merges its seams
//! (`builder/`, `weld`); `mesh` finds areas, edges and pins. A grid is its own result: `links` joins particles along warp, weft and
//! diagonals, and `yarns` cuts the links into straight paths. On any other mesh `remesh/` lays nodes along warp and weft, `net/` finds the
//! lines between them, `of_nodes` makes particles of the nodes, and `carried` lets the mesh follow. Of both, `chains` arranges the lines
//! for solving, `bending` and `twist` resist bending, `tethers` bounds the distances from the pins, and `patches` pairs triangles for
//! sums over them. Where the material differs from place to place, `regions/` finds factors on masses and stiffnesses before all that.

mod bending;
mod builder;
mod carried;
mod chains;
mod clamp;
mod classes;
mod colour;
mod directions;
mod edge_sums;
mod error;
#[expect(clippy::module_inception, reason = "the file of the type that gives the folder its name")]
mod fabric;
mod faces;
mod farthest;
mod grid;
mod hinges;
mod interpolation;
mod links;
mod links_at;
mod material;
mod mesh;
mod net;
mod normals;
mod of_nodes;
mod patches;
mod pin;
mod pin_distances;
mod pin_paths;
mod regions;
mod remesh;
mod rest_bends;
mod rest_paths;
mod shared_topology;
mod strip;
mod tethers;
mod topology;
mod twist;
mod weld;
mod yarns;

pub(crate) use bending::{BendLine, BendProfile};
pub(crate) use chains::{CHAINS_PER_PAIR, Cell, Chain, ChainLink, ChainPair, Chains, SweepLink};
#[cfg(test)]
pub(crate) use hinges::angle as hinge_angle;
pub(crate) use patches::Patch;
pub(crate) use pin_distances::DistancesFromPin;
pub(crate) use rest_bends::RestBends;
pub(crate) use strip::{StripLink, StripRow};
pub(crate) use tethers::Tether;
pub(crate) use topology::ascending;
pub(crate) use twist::{Ribbon, RibbonProfile};
pub(crate) use yarns::Yarn;

pub use builder::{CoarserMesh, FabricBuilder, MeshPoint, MeshRepair, Resampled, Resolution};
pub use carried::Carried;
pub use error::FabricError;
pub use fabric::Fabric;
pub use grid::Grid;
pub use links::{Link, LinkFamily};
pub use material::FabricMaterial;
pub use regions::{MaterialRegion, RegionError, RegionShape};
