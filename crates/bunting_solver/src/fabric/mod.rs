//! A cloth at rest: the immutable part that all cloths of one mesh share.
//!
//! A [`Fabric`] holds geometry only. Masses are areas (a particle's mass is its area times the material's area
//! density), and the stiffness of a constraint is a modulus of the material times a coefficient of the
//! constraint, so that cloths of different [`FabricMaterial`]s share one fabric and one batch.
//!
//! From a mesh to a fabric, a file a step: [`FabricBuilder`] checks the mesh and merges its seams
//! (`builder/`, `weld`); `mesh` finds areas, edges and pins; `links` joins particles along warp, weft and
//! diagonals; `yarns` cuts the links into straight paths and `chains` arranges these for solving; `bending` and
//! `twist` (grids) or `hinges` (other meshes) resist bending; `background` lays a grid under meshes that are
//! flat at rest or textured like their shape, and `quads` finds lines in others, with
//! nodes of `remesh` where their vertices are uneven; `builder/resampled` makes particles of such nodes, and `carried` lets the mesh
//! follow them; `tethers` bounds the distances from the pins;
//! `patches` pairs triangles for sums over them.

mod background;
mod background_fabric;
mod bending;
mod builder;
mod carried;
mod cell_sizes;
mod chains;
mod clamp;
mod classes;
mod colour;
mod covered;
mod curved_links;
mod edge_sums;
mod error;
#[expect(clippy::module_inception, reason = "the file of the type that gives the folder its name")]
mod fabric;
mod farthest;
mod grid;
mod hinges;
mod laid_yarns;
mod links;
mod material;
mod mesh;
mod normals;
mod patches;
mod pin_paths;
mod quads;
mod remesh;
mod rest_bends;
mod rest_paths;
mod shared_topology;
mod stretch_solver;
mod strip;
mod tethers;
mod topology;
mod twist;
mod weld;
mod yarns;

pub(crate) use background::{GridTransfer, Height, Interpolation, RowGroup, Term};
pub(crate) use background_fabric::Background;
pub(crate) use bending::{BendLine, BendProfile};
pub(crate) use chains::{CHAINS_PER_PAIR, Cell, Chain, ChainLink, ChainPair, Chains, SweepLink};
pub(crate) use hinges::{Hinge, angle as hinge_angle};
pub(crate) use laid_yarns::{BAND, Coupling, LaidLink, LaidYarn, LaidYarns, Node, YARNS_AT_ONCE};
pub(crate) use patches::Patch;
pub(crate) use pin_paths::DistancesFromPin;
pub(crate) use rest_bends::RestBends;
pub(crate) use strip::{StripLink, StripRow};
pub(crate) use tethers::Tether;
pub(crate) use topology::ascending;
pub(crate) use twist::{Ribbon, RibbonProfile};
pub(crate) use yarns::Yarn;

pub use builder::{CoarserMesh, FabricBuilder, MeshRepair, Resampled, Resolution};
pub use carried::Carried;
pub use error::FabricError;
pub use fabric::Fabric;
pub use grid::Grid;
pub use links::{Link, LinkFamily};
pub use material::FabricMaterial;
pub use stretch_solver::StretchSolver;
