//! The fabric: a mesh at rest, and everything computed from it before a cloth moves.

use glam::{Vec2, Vec3};

use super::bending::{BendLine, BendProfile, Bending};
use super::chains::Chains;
use super::colour::Colours;
use super::grid::Grid;
use super::hinges::{Hinge, HingeClass, Hinges};
use super::links::{Link, LinkClass, LinkFamily, Links, Probe};
use super::links_at::KnownLinksAt;
use super::material::FabricMaterial;
use super::mesh::{RestMesh, Surface};
use super::patches::{self, Patch};
use super::pin::Pin;
use super::pin_distances::PinDistances;
use super::regions::{Extremes, Variation};
use super::rest_bends::RestBends;
use super::strip::{self, StripRow};
use super::tethers::{Tether, Tethers};
use super::twist::{Ribbon, RibbonProfile, Twist};
use super::yarns::{Yarn, Yarns};
use crate::constants::FREE_LENGTH;

/// A piece of cloth at rest, with its pins. It is immutable; all cloths made of it share it in an `Arc`.
///
/// A [`FabricBuilder`](crate::FabricBuilder) builds it. The particles of a grid are its vertices, those of any other mesh lie on lines
/// along warp and weft, see [`particle_of_vertex`](Self::particle_of_vertex); everything is indexed by particle.
#[derive(Clone, Debug)]
pub struct Fabric {
    pub(super) grid: Option<Grid>,
    pub(super) mesh: RestMesh,
    /// The particle at each point.
    pub(super) particle_of_point: Vec<u32>,
    pub(super) patches: Vec<Patch>,
    pub(super) patch_grid_columns: Option<usize>,
    pub(super) links: Links,
    pub(super) links_at: KnownLinksAt,
    pub(super) yarns: Yarns,
    pub(super) chains: Chains,
    pub(super) strips: Vec<Vec<StripRow>>,
    pub(super) hinges: Hinges,
    pub(super) bending: Bending,
    pub(super) twist: Twist,
    pub(super) rest_bends: Option<RestBends>,
    pub(super) tethers: Tethers,
    pub(super) pin_distances: PinDistances,
    pub(super) tautness: f32,
    pub(super) shortest: f32,
    pub(super) probes: Vec<Probe>,
    pub(super) topology: Option<u64>,
    /// cos² of the angle between the rows of a grid and the warp.
    pub(super) warp_cos2: f32,
    /// m².
    pub(super) area: f32,
    pub(super) extremes: Extremes,
}

/// [`Fabric::tautness`] of a fabric with this [`reach`](Fabric::reach) and shortest link, m. Without pins it counts as a few links long.
pub(super) fn tautness(reach: f32, shortest: f32) -> f32 {
    if reach > 0.0 { reach } else { FREE_LENGTH * shortest }.sqrt() / shortest
}

impl Fabric {
    /// The constraints of a grid whose rows have an angle to the warp, given its cos², and how its material varies.
    pub(super) fn of_grid(
        mut mesh: RestMesh,
        surface: &Surface,
        grid: Grid,
        warp_cos2: f32,
        variation: &Variation,
        tethered: bool,
    ) -> Self {
        let mut patches = patches::patches(&mesh.triangles, &surface.triangle_areas);
        let cells = Some(grid).filter(|grid| patches::are_cells(&patches, grid));
        if let Some(grid) = &cells {
            mesh.set_areas(grid.particle_areas());
            patches::quarter(&mut patches, grid);
        }
        let area = mesh.areas.iter().sum();
        variation.weigh(&mut mesh);
        let links = Links::of(&mesh, &grid, warp_cos2, variation);
        let yarns = Yarns::of(&mesh.positions, &links.list);
        let mut chains = Chains::of(&yarns.list, &yarns.colours, &links.list);
        chains.find_cells(grid.cells().map(|(corners, _)| corners));
        let tethers = Tethers::of(&mesh, &surface.edges, true, tethered);
        let (reach, shortest) = (tethers.reach, links.shortest());
        let mut fabric = Self {
            patch_grid_columns: cells.map(|grid| grid.columns as usize),
            tautness: tautness(reach, shortest),
            shortest,
            probes: links.probes(),
            strips: strip::strips(&grid, &links.list, &chains),
            hinges: Hinges::of(&mesh, &surface.edges, variation),
            bending: Bending::of(&grid, &mesh.inverse_areas, variation),
            twist: Twist::of(&grid, &mesh.inverse_areas, variation),
            rest_bends: None,
            grid: Some(grid),
            extremes: variation.extremes(&mesh),
            mesh,
            particle_of_point: Vec::new(),
            patches,
            links,
            links_at: Default::default(),
            yarns,
            chains,
            tethers,
            pin_distances: PinDistances::default(),
            topology: None,
            warp_cos2,
            area,
        };
        fabric.topology = fabric.hash_topology();
        fabric
    }

    /// Sets the particle at each vertex of the mesh that it was made from, given the place of each vertex and the particle there.
    pub(super) fn set_vertices(&mut self, place_of_vertex: &[u32], particles: &[u32]) {
        let of_places = place_of_vertex.iter().map(|&place| particles[place as usize]);
        self.mesh.particle_of_vertex = of_places.collect();
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

    /// The particle at each vertex of the source mesh; of a mesh that is no grid the nearest one, of a pinned vertex the nearest
    /// pinned one.
    #[must_use]
    pub fn particle_of_vertex(&self) -> &[u32] {
        &self.mesh.particle_of_vertex
    }

    /// The particle at each point of [`FabricBuilder::pin_points`](crate::FabricBuilder::pin_points) and
    /// [`free_points`](crate::FabricBuilder::free_points), in the order in which they were given. A point at a vertex is that vertex,
    /// and of points that lie closer together than a fiftieth of a cell the first one has a particle.
    #[must_use]
    pub fn particle_of_point(&self) -> &[u32] {
        &self.particle_of_point
    }

    /// Number of particles.
    #[must_use]
    pub fn particle_count(&self) -> usize {
        self.mesh.positions.len()
    }

    /// Area of each particle, m²: a quarter of each cell that it borders on a grid, elsewhere a third of each
    /// triangle (thesis, 5.1.3); times the factors on density of the [regions](crate::FabricBuilder::regions) that it lies in.
    /// Multiplied by the material's area density it is the mass of the particle, pinned or not.
    #[must_use]
    pub fn particle_areas(&self) -> &[f32] {
        &self.mesh.areas
    }

    /// Area of the whole fabric, m².
    #[must_use]
    pub fn area(&self) -> f32 {
        self.area
    }

    /// Sum of the [`particle_areas`](Self::particle_areas), m²: the mass of the whole cloth over the material's area density. It is the
    /// [`area`](Self::area) of a cloth without [regions](crate::FabricBuilder::regions).
    #[must_use]
    pub fn mass_area(&self) -> f32 {
        self.mesh.areas.iter().sum()
    }

    /// The least and the greatest factors on the material.
    pub(crate) fn extremes(&self) -> &Extremes {
        &self.extremes
    }

    /// Factor on the stretch stiffness of a material at one of this fabric's [`links`](Self::links), by the
    /// [regions](crate::FabricBuilder::regions) that it lies in: 1 without.
    #[must_use]
    pub fn stretch_factor(&self, link: &Link) -> f32 {
        self.links.classes[link.class as usize].factor
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

    /// A material along the rows and columns of a grid.
    pub(crate) fn material_along_rows(&self, material: &FabricMaterial) -> FabricMaterial {
        material.turned(self.warp_cos2)
    }

    /// The second differences at rest of a net, which is curved there; none of a grid.
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

    /// The links at a particle, diagonals among them.
    pub(crate) fn links_at(&self, particle: u32) -> impl Iterator<Item = &Link> {
        let indices = self.links_at.of(particle, &self.links.list, self.particle_count());
        indices.iter().map(|&index| &self.links.list[index as usize])
    }

    /// Tether of each free particle to its nearest pin.
    pub(crate) fn tethers(&self) -> &[Tether] {
        &self.tethers.near
    }

    /// Tether of a particle to its nearest pin, if it has one.
    pub(crate) fn tether_of(&self, particle: u32) -> Option<&Tether> {
        let index = self.tethers().binary_search_by_key(&particle, |it| it.particle).ok()?;
        Some(&self.tethers()[index])
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
    /// and weft. The topmost links of a cloth of length L that
    /// hangs under gravity g vibrate at 2 √g times this value, rad/s.
    pub(crate) fn tautness(&self) -> f32 {
        self.tautness
    }

    /// Length of the shortest link of warp and weft, m.
    pub(crate) fn shortest_link(&self) -> f32 {
        self.shortest
    }

    /// Length of the diagonals at rest, m, the mean of a net's.
    pub(crate) fn diagonal(&self) -> f32 {
        if let Some(grid) = self.grid() {
            return grid.diagonal();
        }
        let diagonals = self.links().iter().filter(|it| it.family == LinkFamily::Diagonal);
        let (count, sum) =
            diagonals.fold((0.0, 0.0), |(count, sum), it| (count + 1.0, sum + it.rest_length));
        sum / f32::max(count, 1.0)
    }

    /// Some links of warp and weft, spread over the cloth.
    pub(crate) fn probes(&self) -> &[Probe] {
        &self.probes
    }
}
