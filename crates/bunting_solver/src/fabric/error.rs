//! Errors of meshes, grids and materials.

use super::regions::RegionError;

/// Reason why a fabric cannot be built, with the location of the defect.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FabricError {
    /// The mesh has no triangles.
    #[error("the mesh has no triangles: give it at least one")]
    Empty,
    /// The indices do not come in threes.
    #[error("{count} indices do not make whole triangles: give three per triangle")]
    IndexCount {
        /// Number of indices given.
        count: usize,
    },
    /// An index points past the last vertex.
    #[error("triangle {triangle} uses vertex {vertex}, but there are {vertices} vertices")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The index that is out of range.
        vertex: u32,
        /// Number of vertices given.
        vertices: usize,
    },
    /// A pin points past the last vertex.
    #[error("vertex {vertex} cannot be pinned: there are {vertices} vertices")]
    PinOutOfRange {
        /// The index that is out of range.
        vertex: u32,
        /// Number of vertices given.
        vertices: usize,
    },
    /// A position is infinite or not a number.
    #[error("the position of vertex {vertex} is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A texture coordinate is infinite or not a number.
    #[error("the texture coordinate of vertex {vertex} is not finite")]
    UvNotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// The distance at which vertices are merged is negative, infinite or not a number.
    #[error("vertices cannot be merged at a distance of {distance} m")]
    WeldDistance {
        /// The distance, m.
        distance: f32,
    },
    /// There must be one number per vertex to merge vertices by.
    #[error("{numbers} numbers for {vertices} vertices to merge: give one per vertex, or none")]
    MergeCount {
        /// Number of numbers given.
        numbers: usize,
        /// Number of vertices given.
        vertices: usize,
    },
    /// There must be one texture coordinate per vertex.
    #[error("{uvs} texture coordinates for {vertices} vertices: give one per vertex, or none")]
    UvCount {
        /// Number of texture coordinates given.
        uvs: usize,
        /// Number of vertices given.
        vertices: usize,
    },
    /// A triangle has no area, and so neither mass nor normal.
    #[error("triangle {triangle} has no area: remove it, or move its corners apart")]
    ZeroArea {
        /// The triangle.
        triangle: usize,
    },
    /// A vertex has no triangle, and so no mass.
    #[error("vertex {vertex} belongs to no triangle: remove it")]
    LooseVertex {
        /// The vertex.
        vertex: usize,
    },
    /// More than two triangles share an edge.
    #[error("more than two triangles share the edge from vertex {a} to {b}: split the mesh there")]
    NonManifoldEdge {
        /// One end of the edge.
        a: u32,
        /// The other end.
        b: u32,
    },
    /// A piece of the mesh is one-sided, as a Möbius strip is: its triangles have no consistent winding.
    #[error(
        "the triangles around the edge from vertex {a} to {b} have no consistent winding, as on a Möbius strip: cut the mesh open there"
    )]
    OneSided {
        /// One end of an edge whose triangles disagree.
        a: u32,
        /// The other end.
        b: u32,
    },
    /// The size of cells is no positive number, or so small that there would be too many particles.
    #[error(
        "cells of {size} m would make {particles} particles: give a size that makes at least 1 and at most {most}"
    )]
    CellSize {
        /// The size, m.
        size: f32,
        /// About how many particles there would be.
        particles: f32,
        /// Greatest number of particles.
        most: u32,
    },
    /// The surface around a vertex can't be divided into cells.
    #[error(
        "the surface around vertex {vertex} cannot be divided into cells of {size} m: give smaller ones, or repair the mesh there"
    )]
    Cells {
        /// The vertex.
        vertex: u32,
        /// Size of the cells, m.
        size: f32,
    },
    /// Vertices were pinned by a predicate on texture coordinates before there were any.
    #[error(
        "vertices were pinned by a predicate before the texture coordinates were set: set them first"
    )]
    PinnedBeforeUv,
    /// A point is to lie between vertices of which one is past the last.
    #[error("a point on vertex {vertex} cannot be held: there are {vertices} vertices")]
    PointOutOfRange {
        /// The index that is out of range.
        vertex: u32,
        /// Number of vertices given.
        vertices: usize,
    },
    /// A point is to lie between vertices that are not the corners of one triangle.
    #[error(
        "a point between vertices {vertices:?} cannot be held: no triangle has these corners; name those of the triangle that it lies on"
    )]
    PointOffMesh {
        /// The vertices.
        vertices: [u32; 3],
    },
    /// The weights of a point are no barycentric coordinates of a place on its triangle.
    #[error(
        "a point between vertices {vertices:?} cannot have the weights {weights:?}: give three from 0 to 1 with the sum 1"
    )]
    PointWeights {
        /// The corners of its triangle.
        vertices: [u32; 3],
        /// Their weights.
        weights: [f32; 3],
    },
    /// Points were chosen before the mesh was repaired, which numbers its vertices anew.
    #[error("points were chosen before the mesh was repaired: repair it first")]
    PointsBeforeRepair,
    /// A region of the material cannot be used.
    #[error("material region {region} cannot be used: {source}")]
    Region {
        /// Index of the region.
        region: usize,
        /// What is wrong with it.
        source: RegionError,
    },
    /// A grid needs at least two particles and a positive length along both sides.
    #[error(
        "a grid of {columns} × {rows} particles over {width} m × {height} m is not a cloth: give at least 2 × 2 and a positive size"
    )]
    Grid {
        /// Particles in a row.
        columns: u32,
        /// Particles in a column.
        rows: u32,
        /// Extent along a row, m.
        width: f32,
        /// Extent along a column, m.
        height: f32,
    },
    /// A value of the material cannot be simulated.
    #[error("the material's {name} cannot be {value}")]
    Material {
        /// The field's name.
        name: &'static str,
        /// Value of the field.
        value: f32,
    },
}
