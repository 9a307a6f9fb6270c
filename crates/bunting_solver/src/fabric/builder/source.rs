//! The mesh that a fabric is built from, its pins and its options.

use std::collections::BTreeSet;

use glam::{Quat, Vec2, Vec3};

use super::mesh_point::MeshPoint;
use crate::fabric::grid::Grid;
use crate::fabric::regions::MaterialRegion;
use crate::fabric::weld::{Weld, default_distance, weld};

/// Collects a mesh and its pins, checks them, and builds a [`Fabric`](crate::Fabric) from them.
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
    pub(super) positions: Vec<Vec3>,
    pub(super) indices: Vec<u32>,
    /// Texture coordinates, one for each vertex or none.
    pub(super) uv: Vec<Vec2>,
    pub(super) pinned: BTreeSet<u32>,
    /// Points with particles, and whether these are pinned.
    pub(super) points: Vec<(MeshPoint, bool)>,
    /// Welding distance, m; by default a fraction of the mesh's extent.
    pub(super) weld_distance: Option<f32>,
    /// For each vertex a number that it shares with those that are merged with it; without it vertices are merged by
    /// their distance.
    pub(super) merged: Option<Vec<u32>>,
    /// Whether vertices were pinned by a predicate before there were texture coordinates.
    pub(super) pinned_before_uv: bool,
    pub(super) tethered: bool,
    /// The grid that the mesh was made from.
    pub(super) grid: Option<Grid>,
    /// Where the material differs.
    pub(super) regions: Vec<MaterialRegion>,
}

impl FabricBuilder {
    /// A mesh of triangles: positions in metres, three vertex indices per triangle, counter-clockwise seen from the
    /// front.
    #[must_use]
    pub fn new(positions: Vec<Vec3>, indices: Vec<u32>) -> Self {
        Self {
            positions,
            indices,
            uv: Vec::new(),
            pinned: BTreeSet::new(),
            points: Vec::new(),
            weld_distance: None,
            merged: None,
            pinned_before_uv: false,
            tethered: true,
            grid: None,
            regions: Vec::new(),
        }
    }

    /// A rectangular grid, with links along both diagonals of each cell.
    #[must_use]
    pub fn grid(grid: Grid) -> Self {
        if grid.validate().is_err() {
            // `build` reports the invalid grid.
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

    /// Turns all positions about the origin, and then moves them, m. A grid stays a grid, and so do its coarser levels.
    ///
    /// ```
    /// use bunting_solver::{FabricBuilder, Grid};
    /// use glam::{Quat, Vec3};
    ///
    /// // A towel that lies flat on the ground.
    /// let lie = Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2);
    /// let towel = FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0)).placed(lie, Vec3::ZERO);
    /// assert!(towel.positions().iter().all(|at| at.y.abs() < 1e-6));
    /// ```
    #[must_use]
    pub fn placed(mut self, rotation: Quat, translation: Vec3) -> Self {
        self.positions.iter_mut().for_each(|at| *at = rotation * *at + translation);
        self
    }

    /// Sets texture coordinates, one for each vertex: the warp runs along u. Without them the warp of each
    /// triangle runs along its first edge, which does not matter if warp and weft are equally stiff.
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

    /// Pins the vertices for which a predicate on position (m) and texture coordinate holds; the latter is zero for
    /// meshes without. Set texture coordinates before: [`build`](Self::build) refuses to guess which were meant.
    #[must_use]
    pub fn pin_where(mut self, predicate: impl Fn(Vec3, Vec2) -> bool) -> Self {
        self.pinned_before_uv |= self.uv.is_empty();
        let uv = |vertex: usize| self.uv.get(vertex).copied().unwrap_or_default();
        let chosen = (0..self.positions.len())
            .filter(|&vertex| predicate(self.positions[vertex], uv(vertex)));
        self.pinned.extend(chosen.map(|vertex| vertex as u32));
        self
    }

    /// Adds regions in which the material differs: hems, battens, patches.
    #[must_use]
    pub fn regions(mut self, regions: impl IntoIterator<Item = MaterialRegion>) -> Self {
        self.regions.extend(regions);
        self
    }

    /// Sets the distance in metres at which vertices are merged into one particle; zero merges none. The
    /// default is a millionth of the mesh's extent. After [`repair`](Self::repair) it has no effect.
    #[must_use]
    pub fn weld_distance(mut self, distance: f32) -> Self {
        self.weld_distance = Some(distance);
        self
    }

    /// Merges vertices that have the same number, whatever their distance: one number for each vertex. An empty list
    /// merges vertices by their distance, as without it.
    #[must_use]
    pub fn merge(mut self, numbers: Vec<u32>) -> Self {
        self.merged = (!numbers.is_empty()).then_some(numbers);
        self
    }

    /// Sets whether free particles are tethered to their pins, as they are by default. A tether bounds the
    /// distance from a pin along the cloth, which stops overshoot in violent motion; without tethers a step
    /// costs a little less.
    #[must_use]
    pub fn tethered(mut self, tethered: bool) -> Self {
        self.tethered = tethered;
        self
    }

    /// Positions of the vertices, m.
    #[must_use]
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Texture coordinates of the vertices; empty without.
    #[must_use]
    pub fn uvs(&self) -> &[Vec2] {
        &self.uv
    }

    /// Three vertices per triangle.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// For each vertex a number that it shares with those that are merged with it; empty where vertices are merged by
    /// their distance.
    #[must_use]
    pub fn merged(&self) -> &[u32] {
        self.merged.as_deref().unwrap_or_default()
    }

    /// Number of particles that the vertices are merged into.
    #[must_use]
    pub fn particle_count(&self) -> usize {
        self.weld().vertex_of_particle.len()
    }

    /// Distance in metres at which vertices are merged.
    pub(super) fn effective_weld_distance(&self) -> f32 {
        self.weld_distance.unwrap_or_else(|| default_distance(&self.positions))
    }

    /// The grid whose vertices are the particles; none of a grid with points between its vertices.
    pub(super) fn own_grid(&self) -> Option<Grid> {
        self.grid.filter(|_| self.points.is_empty())
    }

    /// Merges vertices into particles.
    pub(super) fn weld(&self) -> Weld {
        match &self.merged {
            Some(merged) => Weld::by_number(merged),
            None => weld(&self.positions, self.effective_weld_distance()),
        }
    }
}
