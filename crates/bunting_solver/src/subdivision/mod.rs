//! The drawn surface: a smooth subdivision of the simulated one, through all its particles.

mod grid;
mod mesh;
mod stencils;
mod surface;
#[cfg(test)]
mod tests;

use glam::{Vec3, Vec3A};

use crate::fabric::Grid;
pub use grid::GridPlanes;
use grid::GridScheme;
use mesh::Points;
pub use stencils::Stencils;

/// A smooth surface through the particles of a fabric, with vertices of its own: every edge is halved several
/// times. Grids are subdivided by the four-point scheme along rows and columns (Dyn, Levin and Gregory 1987), other
/// meshes by the modified butterfly scheme (Zorin, Schröder and Sweldens 1996).
///
/// Both pass through the particles exactly, reproduce planes, and on grids parabolas. The border follows from the
/// particles of the border alone; corners at which it turns by more than 30° at rest stay sharp.
///
/// ```
/// use bunting_solver::{FabricBuilder, Grid, Subdivision, SubdivisionBuffers};
///
/// let grid = Grid::new(9, 9, 1.0, 1.0);
/// let fabric = FabricBuilder::grid(grid).build()?;
/// let smooth = Subdivision::of_grid(&grid, 1);
/// // Twice as many cells along each side.
/// let [mut drawn, mut normals] = [vec![[0.0; 3]; 17 * 17], vec![[0.0; 3]; 17 * 17]];
/// let mut buffers = SubdivisionBuffers::default();
/// smooth.evaluate(fabric.rest_positions(), &mut buffers, &mut drawn, &mut normals);
/// # assert_eq!(smooth.attributes().rows().len(), 17 * 17);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Subdivision {
    scheme: Scheme,
    attributes: Stencils,
    kept: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

#[derive(Clone, Debug)]
enum Scheme {
    Grid(GridScheme),
    Mesh {
        points: Stencils,
        triangles: Vec<[u32; 3]>,
        /// The point of each drawn vertex: at a seam several vertices have one point.
        point_of_vertex: Vec<u32>,
    },
}

/// Buffers of [`Subdivision::evaluate`], which are kept from cloth to cloth.
#[derive(Clone, Debug, Default)]
pub struct SubdivisionBuffers {
    grid: GridPlanes,
    /// Vectors of four lanes, which are loaded at once.
    particles: Vec<Vec3A>,
    points: Vec<Vec3A>,
    normals: Vec<Vec3A>,
}

impl Subdivision {
    /// Halves the edges of a grid `steps` times.
    #[must_use]
    pub fn of_grid(grid: &Grid, steps: u32) -> Self {
        let scheme = GridScheme::new(grid.columns, grid.rows, steps);
        Self {
            attributes: scheme.bilinear(),
            kept: scheme.kept(),
            triangles: scheme.triangles(),
            scheme: Scheme::Grid(scheme),
        }
    }

    /// Halves the edges of a mesh `steps` times, given the positions of its particles or places at rest, m, which of these each vertex
    /// is, and three vertices a triangle.
    ///
    /// # Panics
    ///
    /// If there is no such vertex, particle or place.
    #[must_use]
    pub fn of_mesh(rest: &[Vec3], particle_of: &[u32], indices: &[u32], steps: u32) -> Self {
        Self::halved(rest, particle_of, indices, steps, Points::new)
    }

    /// The same by any scheme, given how the points of triangles are made.
    fn halved(
        rest: &[Vec3],
        particle_of: &[u32],
        indices: &[u32],
        steps: u32,
        of_scheme: fn(&[Vec3], Vec<[u32; 3]>) -> Points,
    ) -> Self {
        let corners = indices.as_chunks::<3>().0;
        let particle = |&vertex: &u32| particle_of[vertex as usize];
        let mut points =
            of_scheme(rest, corners.iter().map(|it| it.each_ref().map(particle)).collect());
        // Attributes are subdivided like positions, so that a texture keeps its place. At a seam they have a border.
        let of_vertices =
            particle_of.iter().map(|&particle| rest[particle as usize]).collect::<Vec<_>>();
        let mut vertices = of_scheme(&of_vertices, corners.to_vec());
        (0..steps).for_each(|_| {
            points.subdivide();
            vertices.subdivide();
        });
        let mut point_of_vertex = particle_of.to_vec();
        point_of_vertex.resize(vertices.stencils.rows().len(), 0);
        let both = vertices.triangles.as_flattened().iter().zip(points.triangles.as_flattened());
        both.for_each(|(&vertex, &point)| point_of_vertex[vertex as usize] = point);
        Self {
            attributes: vertices.stencils,
            kept: (0..particle_of.len() as u32).collect(),
            triangles: vertices.triangles,
            scheme: Scheme::Mesh {
                points: points.stencils,
                triangles: points.triangles,
                point_of_vertex,
            },
        }
    }

    /// Triangles of the drawn vertices.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Weights of the mesh's vertices at each drawn vertex, for texture coordinates and other attributes.
    #[must_use]
    pub fn attributes(&self) -> &Stencils {
        &self.attributes
    }

    /// The drawn vertex at each vertex of the mesh.
    #[must_use]
    pub fn kept(&self) -> &[u32] {
        &self.kept
    }

    /// Writes positions (m) and unit normals of the drawn vertices, from positions of the particles. The normals are
    /// those of the drawn surface; on grids they are means over a cell.
    ///
    /// # Panics
    ///
    /// If the slices have other numbers of vertices than the surface.
    pub fn evaluate(
        &self,
        positions: &[Vec3],
        buffers: &mut SubdivisionBuffers,
        drawn: &mut [[f32; 3]],
        normals: &mut [[f32; 3]],
    ) {
        let expected = self.attributes.rows().len();
        assert!(drawn.len() == expected && normals.len() == expected, "{expected} vertices");
        match &self.scheme {
            Scheme::Grid(grid) => grid.evaluate(positions, &mut buffers.grid, drawn, normals),
            Scheme::Mesh { points, triangles, point_of_vertex } => {
                buffers.particles.clear();
                buffers.particles.extend(positions.iter().map(|&at| Vec3A::from(at)));
                points.apply(&buffers.particles, &mut buffers.points);
                add_normals(&buffers.points, triangles, &mut buffers.normals);
                for (vertex, &point) in point_of_vertex.iter().enumerate() {
                    drawn[vertex] = buffers.points[point as usize].to_array();
                    normals[vertex] = buffers.normals[point as usize].to_array();
                }
            }
        }
    }
}

/// Writes the unit normals of points: the means of their triangles' normals, weighted by area.
fn add_normals(points: &[Vec3A], triangles: &[[u32; 3]], normals: &mut Vec<Vec3A>) {
    normals.clear();
    normals.resize(points.len(), Vec3A::ZERO);
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| points[corner as usize]);
        let normal = (b - a).cross(c - a);
        corners.iter().for_each(|&corner| normals[corner as usize] += normal);
    }
    normals.iter_mut().for_each(|normal| *normal = normal.normalize_or_zero());
}
