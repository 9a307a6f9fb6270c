//! The fabric: a mesh at rest, and everything computed from it before a cloth moves.

use glam::{Vec2, Vec3};

use super::background::BackgroundMesh;
use super::background_fabric::Background;
use super::bending::{BendLine, BendProfile, Bending};
use super::chains::Chains;
use super::colour::Colours;
use super::grid::Grid;
use super::hinges::{Hinge, HingeClass, Hinges};
use super::laid_yarns::LaidYarns;
use super::links::{Link, LinkClass, Links, Probe};
use super::material::FabricMaterial;
use super::mesh::{RestMesh, Surface};
use super::patches::{self, Patch};
use super::pin_paths::PinPaths;
use super::quads::Net;
use super::rest_bends::RestBends;
use super::strip::{self, StripRow};
use super::tethers::{Pin, Tether, Tethers};
use super::twist::{Ribbon, RibbonProfile, Twist};
use super::yarns::{Yarn, Yarns};
use crate::constants::FREE_LENGTH;

/// A piece of cloth at rest, with its pins. It is immutable; all cloths made of it share it in an `Arc`.
///
/// A [`FabricBuilder`](crate::FabricBuilder) builds it. Vertices of the source mesh at the same position are
/// one particle, see [`particle_of_vertex`](Self::particle_of_vertex); everything else is indexed by
/// particle.
#[derive(Clone, Debug)]
pub struct Fabric {
    pub(super) grid: Option<Grid>,
    pub(super) mesh: RestMesh,
    pub(super) patches: Vec<Patch>,
    pub(super) patch_grid_columns: Option<usize>,
    pub(super) links: Links,
    pub(super) yarns: Yarns,
    pub(super) chains: Chains,
    pub(super) laid_yarns: LaidYarns,
    pub(super) strips: Vec<Vec<StripRow>>,
    pub(super) hinges: Hinges,
    pub(super) bending: Bending,
    pub(super) twist: Twist,
    pub(super) rest_bends: Option<RestBends>,
    pub(super) tethers: Tethers,
    pub(super) pin_paths: PinPaths,
    pub(super) covered: Vec<f32>,
    pub(super) tautness: f32,
    pub(super) shortest: f32,
    pub(super) probes: Vec<Probe>,
    pub(super) topology: Option<u64>,
    pub(super) background: Option<Background>,
}

/// [`Fabric::tautness`] of a fabric with this [`reach`](Fabric::reach) and shortest link, m. Without pins it counts as a few links long.
pub(super) fn tautness(reach: f32, shortest: f32) -> f32 {
    if reach > 0.0 { reach } else { FREE_LENGTH * shortest }.sqrt() / shortest
}

impl Fabric {
    /// The constraints of a mesh, or of the grid that the mesh was made from.
    pub(super) fn new(
        mut mesh: RestMesh,
        surface: &Surface,
        grid: Option<Grid>,
        tethered: bool,
    ) -> Self {
        let background = match &grid {
            Some(_) => None,
            None => BackgroundMesh::of(&mesh, surface)
                .and_then(|grid| Background::of(grid, tethered))
                .or_else(|| Some(Background::of_net(Net::of(&mesh, surface)?, tethered))),
        };
        let net = background.as_ref().filter(|it| it.nodes_are_particles);
        if let Some(Background { fabric: net, .. }) = net {
            mesh.set_areas(net.mesh.areas.clone());
        }
        let mut patches = patches::patches(&mesh.triangles, &surface.triangle_areas);
        let cells = grid.filter(|grid| patches::are_cells(&patches, grid));
        if let Some(grid) = &cells {
            mesh.set_areas(grid.particle_areas());
            patches::quarter(&mut patches, grid);
        }
        let links = Links::of(&mesh, grid.as_ref(), None, &surface.corner_uv, false);
        // Only a grid is solved along its own links.
        let (yarns, laid_yarns) = match (&grid, &background) {
            (Some(_), _) => (Yarns::of(&mesh.positions, &links.list), LaidYarns::default()),
            (None, Some(_)) => Default::default(),
            (None, None) => (Yarns::default(), LaidYarns::of(&mesh, surface)),
        };
        let chains = Chains::of(&yarns.list, &yarns.colours, &links.list, grid.as_ref(), false);
        let strips =
            grid.map(|grid| strip::strips(&grid, &links.list, &chains)).unwrap_or_default();
        let hinges = Hinges::of(&mesh, &surface.edges);
        let bending = grid
            .map(|grid| Bending::of(&grid, &mesh.inverse_areas, false, None))
            .unwrap_or_default();
        let twist =
            grid.map(|grid| Twist::of(&grid, &mesh.inverse_areas, None)).unwrap_or_default();
        let tethers = Tethers::of(&mesh, &surface.edges, grid.is_some(), tethered);
        // A load runs along the straight lines of a background grid, not along the edges of the mesh, which zigzag.
        let (reach, shortest) = match (&grid, &background) {
            (_, Some(Background { fabric, .. })) => (fabric.reach(), fabric.links.shortest()),
            (Some(_), None) => (tethers.reach, links.shortest()),
            (None, None) => (tethers.reach, laid_yarns.least_spacing),
        };
        let mut fabric = Self {
            patch_grid_columns: cells.map(|grid| grid.columns as usize),
            tautness: tautness(reach, shortest),
            shortest,
            probes: links.probes(),
            grid,
            mesh,
            patches,
            links,
            yarns,
            chains,
            laid_yarns,
            strips,
            hinges,
            bending,
            twist,
            rest_bends: None,
            tethers,
            pin_paths: PinPaths::default(),
            covered: Vec::new(),
            topology: None,
            background,
        };
        fabric.topology = fabric.hash_topology();
        fabric
    }

    /// Positions at rest in the cloth's frame, m, one per particle.
    #[must_use]
    pub fn rest_positions(&self) -> &[Vec3] {
        &self.mesh.positions
    }

    /// Texture coordinates, one per particle: u runs along the warp, v along the weft.
    #[must_use]
    pub fn uvs(&self) -> &[Vec2] {
        &self.mesh.uv
    }

    /// Triangles as particle indices, counter-clockwise seen from the front.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.mesh.triangles
    }

    /// The particle that each vertex of the source mesh was merged into.
    #[must_use]
    pub fn particle_of_vertex(&self) -> &[u32] {
        &self.mesh.particle_of_vertex
    }

    /// Number of particles.
    #[must_use]
    pub fn particle_count(&self) -> usize {
        self.mesh.positions.len()
    }

    /// Area of each particle, m²: a quarter of each cell that it borders on a grid, elsewhere a third of each
    /// triangle (thesis, 5.1.3). Multiplied by the material's area density it is the mass of the particle, pinned
    /// or not.
    #[must_use]
    pub fn particle_areas(&self) -> &[f32] {
        &self.mesh.areas
    }

    /// Area of the whole fabric, m².
    #[must_use]
    pub fn area(&self) -> f32 {
        self.mesh.areas.iter().sum()
    }

    /// Whether a particle is pinned to the cloth's frame.
    #[must_use]
    pub fn is_pinned(&self, particle: usize) -> bool {
        self.mesh.inverse_areas[particle] == 0.0
    }

    /// Whether any particle is pinned.
    #[must_use]
    pub fn has_pins(&self) -> bool {
        !self.tethers.pins.is_empty()
    }

    /// Unit normals at the particles for given positions (m, one for each particle), on the front side: the
    /// area-weighted mean of the normals of each particle's triangles. Zero if these have no area.
    #[must_use]
    pub fn normals(&self, positions: &[Vec3]) -> Vec<Vec3> {
        self.mesh.normals_at(positions)
    }

    /// Distance constraints: warp first, then weft, then diagonals. Links between two pinned particles are left out.
    #[must_use]
    pub fn links(&self) -> &[Link] {
        &self.links.list
    }

    /// Stiffness in N/m of one of this fabric's [`links`](Self::links) for a material, if diagonals resist
    /// stretch as well as shear: on triangle meshes, and in the Gauss–Seidel scheme.
    #[must_use]
    pub fn link_stiffness(&self, link: &Link, material: &FabricMaterial) -> f32 {
        self.links.classes[link.class as usize].stiffness(material)
    }

    /// Number of hinges: edges at which the Gauss–Seidel scheme, and any scheme on a triangle mesh, resists
    /// bending.
    #[must_use]
    pub fn hinge_count(&self) -> usize {
        self.hinges.list.len()
    }

    /// The grid that the fabric was made from; none for other meshes.
    #[must_use]
    pub fn grid(&self) -> Option<&Grid> {
        self.grid.as_ref()
    }

    /// Greatest number of particles of a row or a column of a grid, or of a line along which a net bends.
    pub(crate) fn longest_line(&self) -> usize {
        let of_lines = self.bending.lines.iter().map(|line| line.particles.len()).max();
        let of_grid = self.grid.map_or(0, |grid| grid.columns.max(grid.rows) as usize);
        of_grid.max(of_lines.unwrap_or(0))
    }

    /// One over the area of each particle, 1/m²; zero if it is pinned, as if it had infinite mass (thesis,
    /// 5.1.4).
    pub(crate) fn inverse_areas(&self) -> &[f32] {
        &self.mesh.inverse_areas
    }

    /// The triangles in pairs, see `patches.rs`.
    pub(crate) fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// Number of particles in a row if the patches are the cells of a grid, row by row; otherwise none.
    pub(crate) fn patch_grid_columns(&self) -> Option<usize> {
        self.patch_grid_columns
    }

    /// Table of stiffnesses that links refer to.
    pub(crate) fn link_classes(&self) -> &[LinkClass] {
        &self.links.classes
    }

    /// The yarns, colour by colour.
    pub(crate) fn yarns(&self) -> &[Yarn] {
        &self.yarns.list
    }

    /// Ranges of yarns that share no particle.
    pub(crate) fn yarn_colours(&self) -> &Colours {
        &self.yarns.colours
    }

    /// The chains of the yarns, for cloths side by side.
    pub(crate) fn chains(&self) -> &Chains {
        &self.chains
    }

    /// Yarns laid across the triangles of a mesh; none of grids, and of meshes with a background grid.
    pub(crate) fn laid_yarns(&self) -> &LaidYarns {
        &self.laid_yarns
    }

    /// Whether diagonals resist shear alone (`constraints/shear.rs`): on grids with diagonals of the family
    /// [`Diagonal`](crate::LinkFamily::Diagonal).
    pub(crate) fn has_shear_cells(&self) -> bool {
        !self.chains.cells.is_empty()
    }

    /// Whether corrections of particles are summed by themselves (`constraints/corrections.rs`): on grids without such
    /// cells, and on meshes without a background grid.
    pub(crate) fn sums_corrections(&self) -> bool {
        self.background.is_none() && !self.has_shear_cells()
    }

    /// Strips of a narrow grid, each row by row; none of other fabrics.
    pub(crate) fn strips(&self) -> &[Vec<StripRow>] {
        &self.strips
    }

    /// Bending constraints of the Gauss–Seidel scheme and of triangle meshes, colour by colour.
    pub(crate) fn hinges(&self) -> &[Hinge] {
        &self.hinges.list
    }

    /// Table of stiffnesses that hinges refer to.
    pub(crate) fn hinge_classes(&self) -> &[HingeClass] {
        &self.hinges.classes
    }

    /// Rows and columns along which a grid bends; none for other meshes, which bend at their hinges.
    pub(crate) fn bend_lines(&self) -> &[BendLine] {
        &self.bending.lines
    }

    /// Table of profiles that bend lines refer to.
    pub(crate) fn bend_profiles(&self) -> &[BendProfile] {
        &self.bending.profiles
    }

    /// Ribbons of cells along which a grid twists; none for other meshes.
    pub(crate) fn ribbons(&self) -> &[Ribbon] {
        &self.twist.ribbons
    }

    /// Table of profiles that ribbons refer to.
    pub(crate) fn ribbon_profiles(&self) -> &[RibbonProfile] {
        &self.twist.profiles
    }

    /// The background grid or the net that solves stretch, shear and bending in place of the mesh's own links; none of grids,
    /// and of meshes that are solved by laid yarns.
    pub(crate) fn background(&self) -> Option<&Background> {
        self.background.as_ref()
    }

    /// A material along the directions in which stretch is solved.
    pub(crate) fn material_of_stretch(&self, material: &FabricMaterial) -> FabricMaterial {
        self.background.as_ref().map_or(*material, |grid| material.turned(grid.warp_cos2))
    }

    /// The second differences of a background grid that is curved at rest.
    pub(crate) fn rest_bends(&self) -> Option<&RestBends> {
        self.rest_bends.as_ref()
    }

    /// The pinned particles.
    pub(crate) fn pins(&self) -> &[Pin] {
        &self.tethers.pins
    }

    /// Whether all pins of a cloth with its particles at these positions (m) are where they are at rest.
    pub(crate) fn are_pins_at_rest(&self, positions: &[Vec3]) -> bool {
        let is_at_rest = |particle: usize| positions[particle] == self.rest_positions()[particle];
        self.pins().iter().all(|pin| is_at_rest(pin.particle as usize))
    }

    /// Tether of each free particle to its nearest pin.
    pub(crate) fn tethers(&self) -> &[Tether] {
        &self.tethers.near
    }

    /// Tethers to the farthest pins, of particles that lie farther from them than [`reach`](Self::reach) at
    /// rest.
    pub(crate) fn far_tethers(&self) -> &[Tether] {
        &self.tethers.far
    }

    /// Greatest distance of any particle from its nearest pin, with the slack of its tether, m; zero without pins.
    pub(crate) fn reach(&self) -> f32 {
        self.tethers.reach
    }

    /// Tautness √L/l, m^−½, with L the [`reach`](Self::reach) and l the length of the shortest link of warp
    /// and weft, both of the background grid if there is one. The topmost links of a cloth of length L that
    /// hangs under gravity g vibrate at 2 √g times this value, rad/s.
    pub(crate) fn tautness(&self) -> f32 {
        self.tautness
    }

    /// Length of the shortest link of warp and weft, m.
    pub(crate) fn shortest_link(&self) -> f32 {
        self.shortest
    }

    /// Some links of warp and weft, spread over the cloth.
    pub(crate) fn probes(&self) -> &[Probe] {
        &self.probes
    }
}
