//! From triangles to a fabric.

mod coarser;
mod rest_normals;
mod slivers;
mod validate;

use std::collections::BTreeMap;
use std::collections::BTreeSet;

use glam::{Vec2, Vec3};

use super::links::{self, Sheet};
use super::{
    Fabric, FabricError, Grid, bending, hinges, patches, strands::Strands, tethers, topology,
    twist, weld, yarns,
};

pub use coarser::Coarser;

/// Default distance at which vertices are one particle, as a part of the mesh's extent: the
/// rounding of 32-bit positions.
const WELD_FRACTION: f32 = 1e-6;

/// A triangle's area below this part of its longest edge squared is none.
const LEAST_ASPECT: f32 = 1e-6;

/// Collects a mesh and its pins, checks them, and cuts a [`Fabric`].
///
/// ```
/// use bunting_solver::{FabricBuilder, Grid};
///
/// let flag = FabricBuilder::grid(Grid::new(33, 23, 1.5, 1.0))
///     .pin_where(|_position, uv| uv.x == 0.0)
///     .build()?;
/// assert_eq!(flag.particle_count(), 33 * 23);
/// # Ok::<(), bunting_solver::FabricError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FabricBuilder {
    positions: Vec<Vec3>,
    indices: Vec<u32>,
    uv: Vec<Vec2>,
    pinned: BTreeSet<u32>,
    weld_distance: Option<f32>,
    tethered: bool,
    grid: Option<Grid>,
}

impl FabricBuilder {
    /// A mesh of triangles: positions in metres, three indices a triangle, counter-clockwise seen
    /// from the front.
    #[must_use]
    pub fn new(positions: Vec<Vec3>, indices: Vec<u32>) -> Self {
        Self {
            positions,
            indices,
            uv: Vec::new(),
            pinned: BTreeSet::new(),
            weld_distance: None,
            tethered: true,
            grid: None,
        }
    }

    /// A rectangular grid. Shear links run along both diagonals of each cell.
    #[must_use]
    pub fn grid(grid: Grid) -> Self {
        if grid.validate().is_err() {
            // Reported by `build`.
            return Self { grid: Some(grid), ..Self::new(Vec::new(), Vec::new()) };
        }
        Self {
            uv: grid.uvs(),
            grid: Some(grid),
            // A grid has no seams.
            weld_distance: Some(0.0),
            ..Self::new(grid.positions(), grid.triangles(false).into_iter().flatten().collect())
        }
    }

    /// Texture coordinates, one a vertex: warp runs along u. Without them the warp of each triangle
    /// runs along its first edge, which does not matter to a material of equal warp and weft.
    #[must_use]
    pub fn uv(mut self, uv: Vec<Vec2>) -> Self {
        self.uv = uv;
        self
    }

    /// Pins vertices to the cloth's frame.
    #[must_use]
    pub fn pin(mut self, vertices: impl IntoIterator<Item = u32>) -> Self {
        self.pinned.extend(vertices);
        self
    }

    /// Pins the vertices for which a predicate on position (m) and texture coordinate holds.
    #[must_use]
    pub fn pin_where(mut self, predicate: impl Fn(Vec3, Vec2) -> bool) -> Self {
        let uv = |vertex: usize| self.uv.get(vertex).copied().unwrap_or_default();
        let chosen = (0..self.positions.len())
            .filter(|&vertex| predicate(self.positions[vertex], uv(vertex)));
        self.pinned.extend(chosen.map(|vertex| vertex as u32));
        self
    }

    /// Distance in metres at which vertices are merged into one particle.
    #[must_use]
    pub fn weld_distance(mut self, distance: f32) -> Self {
        self.weld_distance = Some(distance);
        self
    }

    /// Whether free particles are tethered to their pins, as they are by default. Tethers catch what
    /// overshoots in violent motion; without them a step costs a little less.
    #[must_use]
    pub fn tethered(mut self, tethered: bool) -> Self {
        self.tethered = tethered;
        self
    }

    /// Cuts the fabric.
    ///
    /// # Errors
    ///
    /// A [`FabricError`] says what is wrong with the mesh, and where.
    pub fn build(self) -> Result<Fabric, FabricError> {
        self.validate()?;
        let welded =
            weld::weld(&self.positions, self.weld_distance.unwrap_or_else(|| self.default_weld()));
        let vertices = &welded.vertex_of_particle;
        let rest: Vec<Vec3> =
            vertices.iter().map(|&vertex| self.positions[vertex as usize]).collect();
        let uv: Vec<Vec2> = vertices
            .iter()
            .map(|&vertex| self.uv.get(vertex as usize).copied().unwrap_or_default())
            .collect();
        let particle = |vertex: u32| welded.particle_of_vertex[vertex as usize];
        let triangles: Vec<[u32; 3]> = self
            .indices
            .chunks_exact(3)
            .map(|corners| [0, 1, 2].map(|corner| particle(corners[corner])))
            .collect();

        let triangle_areas = triangles
            .iter()
            .enumerate()
            .map(|(index, &triangle)| {
                triangle_area(&rest, triangle).ok_or(FabricError::ZeroArea { triangle: index })
            })
            .collect::<Result<Vec<f32>, FabricError>>()?;
        let mut areas = vec![0.0; rest.len()];
        for (triangle, area) in triangles.iter().zip(&triangle_areas) {
            for &corner in triangle {
                areas[corner as usize] += area / 3.0;
            }
        }
        if let Some(loose) = areas.iter().position(|&area| area == 0.0) {
            return Err(FabricError::LooseVertex { vertex: vertices[loose] as usize });
        }
        let mut pinned = vec![false; rest.len()];
        for &vertex in &self.pinned {
            pinned[particle(vertex) as usize] = true;
        }
        let inverse_areas: Vec<f32> = areas
            .iter()
            .zip(&pinned)
            .map(|(area, &pinned)| if pinned { 0.0 } else { 1.0 / area })
            .collect();

        let edges = topology::edges(&triangles).map_err(|[a, b]| FabricError::NonManifoldEdge {
            a: vertices[a as usize],
            b: vertices[b as usize],
        })?;
        let mut border = vec![false; rest.len()];
        for edge in edges.iter().filter(|edge| edge.other_opposite.is_none()) {
            for end in edge.ends {
                border[end as usize] = true;
            }
        }

        let sheet = Sheet { rest: &rest, uv: &uv };
        let mut geometry = BTreeMap::new();
        match &self.grid {
            // Both diagonals of a cell: each way of cutting it counts half.
            Some(grid) => {
                for flipped in [false, true] {
                    for triangle in grid.triangles(flipped) {
                        sheet.add_links(&mut geometry, triangle, 0.5);
                    }
                }
            }
            None => {
                for &triangle in &triangles {
                    sheet.add_links(&mut geometry, triangle, 1.0);
                }
            }
        }
        let (links, link_classes, link_colours) =
            links::finish(&rest, &pinned, geometry.into_values());
        let (yarns, yarn_colours) = yarns::yarns(&rest, &links);
        let pins = tethers::pins(&edges, &pinned);
        let flat = self.grid.is_some();
        let tethers = tethers::tethers(&rest, &edges, &pins, flat);
        let reach = tethers.iter().map(|tether| tether.length).fold(0.0, f32::max);
        let (tethers, far_tethers) = if self.tethered {
            let far = tethers::far_tethers(&rest, &edges, &pins, &tethers, reach, flat);
            (tethers, far)
        } else {
            (Vec::new(), Vec::new())
        };
        let (bend_lines, bend_profiles) =
            self.grid.map(|grid| bending::lines(&grid, &inverse_areas)).unwrap_or_default();
        let (ribbons, ribbon_profiles) =
            self.grid.map(|grid| twist::ribbons(&grid, &inverse_areas)).unwrap_or_default();
        let mut strands = Strands::new(&yarns, &yarn_colours, &links);
        if let Some(grid) = &self.grid {
            strands.set_cells(grid.cells().map(|(corners, _)| corners));
        }
        let (hinges, hinge_classes, hinge_colours) = hinges::hinges(&rest, &edges, &pinned);

        let patches = patches::patches(&triangles, &triangle_areas);
        let cells = self.grid.filter(|grid| patches::are_cells(&patches, grid));
        let tautness = reach.sqrt() / links::shortest(&links);
        Ok(Fabric {
            rest,
            uv,
            patches,
            columns_of_cells: cells.map(|grid| grid.columns as usize),
            triangles,
            triangle_areas,
            particle_of_vertex: welded.particle_of_vertex,
            areas,
            inverse_areas,
            border,
            links,
            link_classes,
            link_colours,
            yarns,
            yarn_colours,
            strands,
            hinges,
            hinge_classes,
            hinge_colours,
            bend_lines,
            bend_profiles,
            ribbons,
            ribbon_profiles,
            pins,
            reach,
            tautness,
            tethers,
            far_tethers,
            grid: self.grid,
        })
    }

    fn default_weld(&self) -> f32 {
        let first = self.positions[0];
        let (low, high) =
            self.positions.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
        WELD_FRACTION * (high - low).max_element()
    }
}

fn triangle_area(rest: &[Vec3], triangle: [u32; 3]) -> Option<f32> {
    let [a, b, c] = triangle.map(|corner| rest[corner as usize]);
    let longest =
        (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let area = 0.5 * (b - a).cross(c - a).length();
    (area > LEAST_ASPECT * longest).then_some(area)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::{FabricMaterial, LinkFamily};

    const QUAD: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];

    fn error(positions: &[Vec3], indices: &[u32]) -> FabricError {
        FabricBuilder::new(positions.to_vec(), indices.to_vec()).build().expect_err("a bad mesh")
    }

    #[test]
    fn bad_meshes_say_where() {
        assert_eq!(error(&QUAD, &[]), FabricError::Empty);
        assert_eq!(error(&QUAD, &[0, 1, 2, 3]), FabricError::IndexCount { count: 4 });
        assert_eq!(
            error(&QUAD, &[0, 1, 2, 1, 9, 2]),
            FabricError::IndexOutOfRange { triangle: 1, vertex: 9, vertices: 4 }
        );
        let mut infinite = QUAD;
        infinite[2].y = f32::INFINITY;
        assert_eq!(error(&infinite, &[0, 1, 2]), FabricError::NotFinite { vertex: 2 });
        assert_eq!(error(&QUAD, &[0, 1, 2, 1, 1, 3]), FabricError::ZeroArea { triangle: 1 });
        assert_eq!(error(&QUAD, &[0, 1, 2]), FabricError::LooseVertex { vertex: 3 });
        let fan = [QUAD[0], QUAD[1], QUAD[2], QUAD[3], Vec3::Z];
        assert_eq!(
            error(&fan, &[1, 2, 0, 1, 2, 3, 1, 2, 4]),
            FabricError::NonManifoldEdge { a: 1, b: 2 }
        );
        let pinned = FabricBuilder::new(QUAD.to_vec(), vec![0, 1, 2, 1, 3, 2]).pin([4]).build();
        assert_eq!(
            pinned.expect_err("a bad pin"),
            FabricError::PinOutOfRange { vertex: 4, vertices: 4 }
        );
        let grid = FabricBuilder::grid(Grid::new(1, 5, 1.0, 1.0)).build();
        assert!(matches!(grid, Err(FabricError::Grid { columns: 1, .. })));
    }

    #[test]
    fn mass_is_a_third_of_each_bordering_triangle() {
        let fabric = FabricBuilder::grid(Grid::new(5, 4, 2.0, 1.5)).build().expect("a good fabric");
        assert!((fabric.area() - 3.0).abs() < 1e-5);
        // A row carries half of the cells above and below it.
        let row: f32 = fabric.particle_areas()[5..10].iter().sum();
        assert!((row - 1.0).abs() < 1e-5, "{row}");
    }

    #[test]
    fn a_seam_is_welded() {
        let seam = [QUAD[0], QUAD[1], QUAD[2], QUAD[1], QUAD[3], QUAD[2] + Vec3::X * 1e-8];
        let fabric = FabricBuilder::new(seam.to_vec(), vec![0, 1, 2, 3, 4, 5])
            .build()
            .expect("a good fabric");
        assert_eq!(fabric.particle_count(), 4);
        assert_eq!(fabric.particle_of_vertex(), &[0, 1, 2, 1, 3, 2]);
        assert_eq!(fabric.hinges().len(), 1);
    }

    #[test]
    fn all_pinned_is_allowed_and_has_nothing_to_solve() {
        let fabric = FabricBuilder::grid(Grid::new(3, 3, 1.0, 1.0))
            .pin(0..9)
            .build()
            .expect("a good fabric");
        assert!(fabric.links().is_empty() && fabric.hinges().is_empty());
    }

    #[test]
    fn grid_links_have_the_textbook_stiffness() {
        let grid = Grid::new(4, 5, 0.9, 2.0);
        let (dx, dy) = (0.3, 0.5);
        let fabric = FabricBuilder::grid(grid).build().expect("a good fabric");
        let material = FabricMaterial {
            warp_stiffness: 900.0,
            weft_stiffness: 700.0,
            shear_stiffness: 40.0,
            ..FabricMaterial::DENIM
        };
        let [c11, c22, g] = material.lattice_moduli();
        for link in fabric.links() {
            let [a, b] = link.particles;
            let on_border = |count: u32, at: u32| at == 0 || at == count - 1;
            let (width, height) = (grid.columns, grid.rows);
            let expected = match link.family {
                LinkFamily::Warp => {
                    (c11 - g * dx * dx / (dy * dy)) * dy / dx
                        * if on_border(height, a / width) { 0.5 } else { 1.0 }
                }
                LinkFamily::Weft => {
                    (c22 - g * dy * dy / (dx * dx)) * dx / dy
                        * if on_border(width, a % width) { 0.5 } else { 1.0 }
                }
                LinkFamily::Bias => g * (dx * dx + dy * dy) / (2.0 * dx * dy),
            };
            let stiffness = fabric.link_classes()[link.class as usize].stiffness(&material);
            assert!((stiffness / expected - 1.0).abs() < 2e-3, "{a}–{b}: {stiffness} {expected}");
        }
        assert!(fabric.link_classes().len() <= 6, "{:?}", fabric.link_classes());
    }

    #[test]
    fn colours_share_no_particle() {
        let fabric = FabricBuilder::grid(Grid::new(9, 6, 1.0, 1.0)).build().expect("a good fabric");
        let lists = [
            (
                fabric.link_colours(),
                fabric.links().iter().map(|link| link.particles.to_vec()).collect::<Vec<_>>(),
            ),
            (
                fabric.hinge_colours(),
                fabric.hinges().iter().map(|hinge| hinge.particles.to_vec()).collect(),
            ),
        ];
        for (colours, constraints) in lists {
            let covered: usize = colours.ranges().iter().map(ExactSizeIterator::len).sum();
            assert_eq!(covered, constraints.len());
            for range in colours.ranges() {
                let mut particles: Vec<u32> = constraints[range.clone()].concat();
                let all = particles.len();
                particles.sort_unstable();
                particles.dedup();
                assert_eq!(particles.len(), all);
            }
        }
    }
}
