//! A surface of many triangles, with an inside if it is closed.

use glam::Vec3;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::query::PointQuery;
use parry3d::shape::{
    ConvexPolyhedron, HeightField, Shape, TriMesh, TriMeshFlags, Triangle, TypedShape,
};

use super::block::Nearest;
use crate::contact::{ground, polyhedron};

#[derive(Clone, Copy)]
pub(super) enum TriangleSurface<'a> {
    Mesh(&'a TriMesh),
    Polyhedron(&'a ConvexPolyhedron),
    /// Ground, which is inside below.
    Field(&'a HeightField),
}

impl<'a> TriangleSurface<'a> {
    /// The surface of a shape, if it consists of triangles.
    pub fn of(shape: &'a dyn Shape) -> Option<Self> {
        match shape.as_typed_shape() {
            TypedShape::TriMesh(mesh) => Some(Self::Mesh(mesh)),
            TypedShape::ConvexPolyhedron(polyhedron) => Some(Self::Polyhedron(polyhedron)),
            TypedShape::HeightField(field) => Some(Self::Field(field)),
            _ => None,
        }
    }

    /// Whether the surface has an inside.
    pub fn is_closed(self) -> bool {
        match self {
            Self::Mesh(mesh) => is_closed(mesh),
            Self::Polyhedron(_) | Self::Field(_) => true,
        }
    }

    /// About the width of a triangle, m: as if all triangles together were as large as the box around them.
    pub fn width_of_triangle(self) -> f32 {
        let (around, count) = match self {
            Self::Mesh(mesh) => (mesh.local_aabb(), mesh.indices().len()),
            Self::Polyhedron(polyhedron) => (polyhedron.local_aabb(), polyhedron.faces().len()),
            Self::Field(field) => (field.local_aabb(), 2 * field.nrows() * field.ncols()),
        };
        let Vec3 { x, y, z } = around.extents();
        let area = 2.0 * (x * y + y * z + z * x);
        (area / count.max(1) as f32).sqrt()
    }

    /// Adds the triangles whose boxes meet a box to `found`, with their indices. Those of ground face upwards.
    pub fn near(self, around: &Aabb, found: &mut Vec<(u32, Triangle)>) {
        match self {
            Self::Mesh(mesh) => {
                let near = mesh.bvh().intersect_aabb(around);
                found.extend(near.map(|index| (index, mesh.triangle(index))));
            }
            Self::Polyhedron(polyhedron) => {
                let all = (0..).zip(polyhedron::triangles(polyhedron));
                found.extend(all.filter(|(_, triangle)| triangle.local_aabb().intersects(around)));
            }
            Self::Field(field) => {
                field.map_elements_in_local_aabb(around, &mut |index, triangle| {
                    let Triangle { a, b, c } = *triangle;
                    let is_upright = triangle.scaled_normal().y > 0.0;
                    let upright = if is_upright { *triangle } else { Triangle::new(a, c, b) };
                    found.push((index, upright));
                });
            }
        }
    }

    /// Whether a point is inside, by a search in the whole surface.
    pub fn contains(self, at: Vec3) -> bool {
        match self {
            Self::Mesh(mesh) => is_closed(mesh) && mesh.contains_local_point(at),
            Self::Polyhedron(polyhedron) => {
                polyhedron::nearest(polyhedron, at).is_some_and(|(distance, _)| distance < 0.0)
            }
            Self::Field(field) => ground::depth(field, at).is_some_and(|depth| depth > 0.0),
        }
    }

    /// Whether a point is inside, given what of the surface is nearest to it: by the pseudo-normals of a closed mesh (Bærentzen and Aanæs 2005).
    pub fn is_inside(self, at: Vec3, nearest: &Nearest) -> bool {
        let Nearest { index, triangle, coordinates, away } = nearest;
        let Self::Mesh(mesh) = self else { return self.contains(at) };
        let Some(normals) = mesh.pseudo_normals().filter(|_| is_closed(mesh)) else {
            return false;
        };
        let corner = coordinates.iter().position(|part| *part == 1.0);
        let opposite = coordinates.iter().position(|part| *part == 0.0);
        let normal = match (corner, opposite) {
            (Some(corner), _) => {
                let vertex = mesh.indices()[*index as usize][corner];
                normals.vertices_pseudo_normal[vertex as usize]
            }
            // The first edge is opposite to the third corner.
            (_, Some(opposite)) => normals.edges_pseudo_normal[*index as usize][(opposite + 1) % 3],
            _ => triangle.scaled_normal(),
        };
        away.dot(normal) <= 0.0
    }
}

/// Whether a mesh has an inside.
fn is_closed(mesh: &TriMesh) -> bool {
    mesh.flags().contains(TriMeshFlags::ORIENTED)
}
