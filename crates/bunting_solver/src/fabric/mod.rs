//! A cloth at rest: what every cloth cut from the same piece shares, and nothing that moves.
//!
//! A [`Fabric`] holds geometry only. Masses are areas (the mass of a particle is its area times
//! the material's density) and stiffnesses are weights of the material's moduli, so cloths of
//! different [`FabricMaterial`]s share one fabric and ride in one batch.

mod bending;
mod builder;
mod colour;
mod error;
mod grid;
mod hinges;
mod links;
mod material;
mod patches;
mod strands;
mod tethers;
mod topology;
mod twist;
mod weld;
mod yarns;

use glam::{Vec2, Vec3};

pub(crate) use patches::Patch;
pub(crate) use strands::{ABREAST, Cell, PolishLink, Strand, StrandLink, Strands, Thread};
pub(crate) use tethers::Pin;
pub(crate) use twist::{Ribbon, RibbonProfile};

pub use bending::{BendLine, BendProfile};
pub use builder::{Coarser, FabricBuilder};
pub use colour::Colours;
pub use error::FabricError;
pub use grid::Grid;
pub(crate) use hinges::angle as hinge_angle;
pub use hinges::{Hinge, HingeClass};
pub use links::{Link, LinkClass, LinkFamily};
pub use material::FabricMaterial;
pub use tethers::Tether;
pub use yarns::Yarn;

/// A piece of cloth at rest, cut with its pins. Immutable; share it in an `Arc`.
#[derive(Clone, Debug)]
pub struct Fabric {
    rest: Vec<Vec3>,
    uv: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    triangle_areas: Vec<f32>,
    patches: Vec<Patch>,
    columns_of_cells: Option<usize>,
    particle_of_vertex: Vec<u32>,
    areas: Vec<f32>,
    inverse_areas: Vec<f32>,
    border: Vec<bool>,
    links: Vec<Link>,
    link_classes: Vec<LinkClass>,
    link_colours: Colours,
    yarns: Vec<Yarn>,
    yarn_colours: Colours,
    strands: Strands,
    hinges: Vec<Hinge>,
    hinge_classes: Vec<HingeClass>,
    hinge_colours: Colours,
    bend_lines: Vec<BendLine>,
    bend_profiles: Vec<BendProfile>,
    ribbons: Vec<Ribbon>,
    ribbon_profiles: Vec<RibbonProfile>,
    pins: Vec<Pin>,
    tethers: Vec<Tether>,
    far_tethers: Vec<Tether>,
    reach: f32,
    tautness: f32,
    grid: Option<Grid>,
}

impl Fabric {
    /// Positions at rest in the cloth's frame, m, one a particle.
    #[must_use]
    pub fn rest_positions(&self) -> &[Vec3] {
        &self.rest
    }

    /// Texture coordinates, one a particle: u runs along the warp, v along the weft.
    #[must_use]
    pub fn uvs(&self) -> &[Vec2] {
        &self.uv
    }

    /// Triangles as particle indices, counter-clockwise seen from the front.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Areas of the triangles at rest, m².
    #[must_use]
    pub fn triangle_areas(&self) -> &[f32] {
        &self.triangle_areas
    }

    pub(crate) fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// Particles in a row of a grid whose patches are its cells, row by row.
    pub(crate) fn columns_of_cells(&self) -> Option<usize> {
        self.columns_of_cells
    }

    /// The particle that each vertex of the source mesh was welded into.
    #[must_use]
    pub fn particle_of_vertex(&self) -> &[u32] {
        &self.particle_of_vertex
    }

    /// Number of particles.
    #[must_use]
    pub fn particle_count(&self) -> usize {
        self.rest.len()
    }

    /// Area that each particle carries, m²: a third of each triangle that it borders (thesis, 5.1.3).
    /// Times the material's density it is the particle's mass, pinned or not.
    #[must_use]
    pub fn particle_areas(&self) -> &[f32] {
        &self.areas
    }

    /// One over the area of each particle, 1/m²; zero where it is pinned, as if infinitely heavy
    /// (thesis, 5.1.4).
    #[must_use]
    pub fn inverse_areas(&self) -> &[f32] {
        &self.inverse_areas
    }

    /// Whether a particle is pinned to the cloth's frame.
    #[must_use]
    pub fn is_pinned(&self, particle: usize) -> bool {
        self.inverse_areas[particle] == 0.0
    }

    /// Whether any particle is pinned.
    #[must_use]
    pub fn has_pins(&self) -> bool {
        !self.pins.is_empty()
    }

    /// Whether each particle lies on the border of the mesh.
    #[must_use]
    pub fn border(&self) -> &[bool] {
        &self.border
    }

    /// Distance constraints, colour by colour.
    #[must_use]
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// How many of the links are warp or weft: these come first.
    #[must_use]
    pub fn stretch_link_count(&self) -> usize {
        self.links.partition_point(|link| link.family != LinkFamily::Bias)
    }

    /// Stiffness classes that links refer to.
    #[must_use]
    pub fn link_classes(&self) -> &[LinkClass] {
        &self.link_classes
    }

    /// Runs of links that share no particle.
    #[must_use]
    pub fn link_colours(&self) -> &Colours {
        &self.link_colours
    }

    /// The same links in straight paths, colour by colour.
    #[must_use]
    pub fn yarns(&self) -> &[Yarn] {
        &self.yarns
    }

    pub(crate) fn strands(&self) -> &Strands {
        &self.strands
    }

    /// Whether its bias carries shear alone, as that of a grid does whose diagonals count as bias.
    pub(crate) fn squares_cells(&self) -> bool {
        !self.strands.cells.is_empty()
    }

    /// Runs of yarns that share no particle.
    #[must_use]
    pub fn yarn_colours(&self) -> &Colours {
        &self.yarn_colours
    }

    /// Bending constraints, colour by colour.
    #[must_use]
    pub fn hinges(&self) -> &[Hinge] {
        &self.hinges
    }

    /// Stiffness classes that hinges refer to.
    #[must_use]
    pub fn hinge_classes(&self) -> &[HingeClass] {
        &self.hinge_classes
    }

    /// Runs of hinges that share no particle.
    #[must_use]
    pub fn hinge_colours(&self) -> &Colours {
        &self.hinge_colours
    }

    /// Rows and columns along which a grid bends; none for other meshes, which bend at their
    /// [`hinges`](Self::hinges).
    #[must_use]
    pub fn bend_lines(&self) -> &[BendLine] {
        &self.bend_lines
    }

    /// Kinds of line that bend lines refer to.
    #[must_use]
    pub fn bend_profiles(&self) -> &[BendProfile] {
        &self.bend_profiles
    }

    /// Ribbons of cells along which a grid twists.
    pub(crate) fn ribbons(&self) -> &[Ribbon] {
        &self.ribbons
    }

    pub(crate) fn ribbon_profiles(&self) -> &[RibbonProfile] {
        &self.ribbon_profiles
    }

    /// How far each particle may be from the nearest pin.
    #[must_use]
    pub fn tethers(&self) -> &[Tether] {
        &self.tethers
    }

    /// What keeps free particles within reach of the pin that is farthest from them at rest, of those that lie
    /// further from it than any lies from its nearest.
    #[must_use]
    pub fn far_tethers(&self) -> &[Tether] {
        &self.far_tethers
    }

    /// Greatest distance of any particle from its nearest pin, m.
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// √L/l with L the [`reach`](Self::reach) and l the length of the shortest link of warp and weft, m^−½:
    /// what gravity makes of it is how fast the topmost links of a hanging cloth vibrate.
    #[must_use]
    pub fn tautness(&self) -> f32 {
        self.tautness
    }

    pub(crate) fn pins(&self) -> &[Pin] {
        &self.pins
    }

    /// How far each particle is from a pin at rest, along the cloth, m.
    pub(crate) fn distances_from(&self, pin: Pin) -> Vec<f32> {
        let edges = self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        tethers::distances(&self.rest, edges, pin, self.grid.is_some())
    }

    /// The grid that the fabric was made from, if it was.
    #[must_use]
    pub fn grid(&self) -> Option<&Grid> {
        self.grid.as_ref()
    }

    /// Area of the whole fabric, m².
    #[must_use]
    pub fn area(&self) -> f32 {
        self.areas.iter().sum()
    }
}
