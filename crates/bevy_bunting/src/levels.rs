//! Cutting fabrics: one for each level of a cloth, shared by all cloths cut alike.

use std::collections::HashMap;
use std::sync::{Arc, Weak};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_tasks::{AsyncComputeTaskPool, Task, futures::check_ready};
use bunting_solver::{
    ClothSnapshot, Fabric, FabricBuilder, FabricError, FabricMaterial, LevelTransfer,
};

use crate::attachment::Attachment;
use crate::error::ClothError;
use crate::lod::LodSet;
use crate::mesh::ClothMesh;
use crate::part::{Blend, RigidPart, SimulatedPart, check_weights};
#[cfg(feature = "render")]
use crate::render::LevelMesh;

/// Vertices from which a cloth is cut beside the main thread, where there are threads: it takes
/// some ticks then.
const LARGE: usize = 8192;

/// The fabrics of one cloth, the finest first, and how state moves between neighbours.
#[derive(Debug)]
pub(crate) struct ClothLevels {
    levels: Vec<Level>,
    transfers: Vec<LevelTransfer>,
    /// What is not simulated.
    rigid: RigidPart,
    /// Number of levels that were asked for.
    asked: usize,
    /// Why there are fewer.
    lack: Option<Lack>,
}

#[derive(Debug)]
struct Level {
    fabric: Arc<Fabric>,
    /// The vertices of the cloth's mesh that it simulates, ascending.
    vertices: Vec<u32>,
    /// Particles that are not shown where they are.
    blends: Vec<Blend>,
    /// What it is drawn with.
    #[cfg(feature = "render")]
    mesh: LevelMesh,
}

impl Level {
    #[cfg_attr(not(feature = "render"), expect(unused_variables, reason = "drawn only"))]
    fn new(
        fabric: Arc<Fabric>,
        vertices: Vec<u32>,
        builder: &FabricBuilder,
        rigid: &RigidPart,
    ) -> Self {
        Self {
            blends: Blend::all(rigid, &vertices, &fabric),
            #[cfg(feature = "render")]
            mesh: LevelMesh::new(&vertices, builder.indices(), rigid),
            fabric,
            vertices,
        }
    }
}

/// Why a level cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lack {
    /// The grid cannot be halved, or the mesh has nothing to leave out.
    Particles,
    /// Nothing would hold it.
    Pins,
}

impl ClothLevels {
    /// The fabric of a level. Levels that could not be cut have that of the coarsest that could.
    pub fn fabric(&self, level: usize) -> &Arc<Fabric> {
        &self.level(level).fabric
    }

    /// Number of levels that were asked for.
    pub fn count(&self) -> usize {
        self.asked
    }

    /// What a level is drawn with.
    #[cfg(feature = "render")]
    pub fn mesh(&self, level: usize) -> &LevelMesh {
        &self.level(level).mesh
    }

    /// What is not simulated.
    #[cfg(feature = "render")]
    pub fn rigid(&self) -> &RigidPart {
        &self.rigid
    }

    /// The particle that a vertex of the cloth's mesh is at a level.
    pub fn particle(&self, level: usize, vertex: u32) -> Option<usize> {
        let level = self.level(level);
        let at = level.vertices.binary_search(&vertex).ok()?;
        Some(level.fabric.particle_of_vertex()[at] as usize)
    }

    /// Moves particles of a level from where they are simulated to where they are shown.
    pub fn blend(&self, level: usize, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let blends = &self.level(level).blends;
        blends.iter().for_each(|blend| blend.apply(positions, normals));
    }

    fn level(&self, level: usize) -> &Level {
        &self.levels[level.min(self.levels.len() - 1)]
    }

    /// What a cloth of this mesh is to be told about levels that could not be cut.
    pub fn lack(&self, entity: Entity, mesh: &ClothMesh) -> Option<ClothError> {
        let (built, asked) = (self.levels.len(), self.asked);
        Some(match (self.lack?, mesh.as_grid()) {
            (Lack::Pins, _) => ClothError::NoVertices { entity, level: built },
            (Lack::Particles, Some(grid)) => ClothError::NotNested {
                entity,
                columns: grid.columns,
                rows: grid.rows,
                halvings: asked - 1,
            },
            (Lack::Particles, None) => ClothError::TooFewLevels { entity, built, asked },
        })
    }

    /// The state at one level, moved to another, for a cloth of a material under a gravity along
    /// the axes of its frame, m/s².
    pub fn transfer(
        &self,
        mut snapshot: ClothSnapshot,
        (from, to): (usize, usize),
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        // Most of a crowd has not been seen yet.
        if snapshot.is_at_rest(self.fabric(from)) {
            return ClothSnapshot::at_rest(self.fabric(to));
        }
        let coarser = self.between(from, to);
        if !coarser.is_empty() {
            return LevelTransfer::restrict_through(coarser, &snapshot, material, gravity);
        }
        for transfer in self.between(to, from).iter().rev() {
            snapshot = transfer.prolong(&snapshot, material, gravity);
        }
        snapshot
    }

    /// For each particle of a level the one that it is at a finer level.
    pub fn shared(&self, fine: usize, coarse: usize) -> Vec<u32> {
        let mut particles = (0..self.fabric(coarse).particle_count() as u32).collect::<Vec<_>>();
        for transfer in self.between(fine, coarse).iter().rev() {
            particles.iter_mut().for_each(|at| *at = transfer.shared()[*at as usize]);
        }
        particles
    }

    /// A state that has only the positions and velocities of a finer level's particles, made sound.
    pub fn calm(
        &self,
        snapshot: ClothSnapshot,
        level: usize,
        material: &FabricMaterial,
    ) -> ClothSnapshot {
        match self.between(0, level).last() {
            Some(transfer) if !snapshot.is_at_rest(self.fabric(level)) => {
                transfer.settle(snapshot, material)
            }
            _ => snapshot,
        }
    }

    /// Values at the particles of a level, spread over its triangles to those of a finer level.
    pub fn spread(&self, mut values: Vec<Vec3>, from: usize, to: usize) -> Vec<Vec3> {
        for transfer in self.between(to, from).iter().rev() {
            values = transfer.spread(&values).collect();
        }
        values
    }

    /// Unit vectors at the particles of a level, carried to those of another.
    pub fn carry(&self, vectors: &[Vec3], from: usize, to: usize) -> Vec<Vec3> {
        let mut vectors = vectors.to_vec();
        for transfer in self.between(from, to) {
            vectors = transfer.pick(&vectors).collect();
        }
        if to < from {
            vectors = self.spread(vectors, from, to);
            vectors.iter_mut().for_each(|vector| *vector = vector.normalize_or_zero());
        }
        vectors
    }

    /// What lies between a level and a coarser one.
    fn between(&self, fine: usize, coarse: usize) -> &[LevelTransfer] {
        let end = coarse.min(self.transfers.len());
        &self.transfers[fine.min(end)..end]
    }

    /// Cuts as many levels as are asked for, or as can be.
    fn cut(mesh: &ClothMesh, attached: &[u32], asked: usize) -> Result<Self, FabricError> {
        let part = SimulatedPart::of(mesh, attached)?;
        let fabric = part.builder.clone().build().map_err(|error| part.renumber(error))?;
        let SimulatedPart { mut builder, vertices, rigid, .. } = part;
        let held = fabric.has_pins();
        let finest = Level::new(Arc::new(fabric), vertices, &builder, &rigid);
        let (levels, transfers) = (vec![finest], Vec::new());
        let mut cut = Self { levels, transfers, rigid, asked, lack: None };
        while cut.levels.len() < asked {
            let finer = cut.level(usize::MAX);
            let next = builder.coarser().and_then(|coarser| {
                let fabric = Arc::new(coarser.builder.clone().build().ok()?);
                let transfer =
                    LevelTransfer::nested(&finer.fabric, &fabric, &coarser.vertices).ok()?;
                Some((coarser, fabric, transfer))
            });
            let Some((coarser, fabric, transfer)) = next else {
                cut.lack = Some(Lack::Particles);
                break;
            };
            if held && !fabric.has_pins() {
                cut.lack = Some(Lack::Pins);
                break;
            }
            let of_finest = |&vertex: &u32| finer.vertices[vertex as usize];
            let vertices = coarser.vertices.iter().map(of_finest).collect();
            builder = coarser.builder;
            cut.levels.push(Level::new(fabric, vertices, &builder, &cut.rigid));
            cut.transfers.push(transfer);
        }
        Ok(cut)
    }
}

/// Puts pinned particles where they belong, to the last bit.
pub(crate) fn hold_pins(snapshot: &mut ClothSnapshot, fabric: &Fabric) {
    for (particle, position) in snapshot.positions.iter_mut().enumerate() {
        if fabric.is_pinned(particle) {
            *position = fabric.rest_positions()[particle];
        }
    }
}

/// All fabrics in use, by content: what is cut alike is cut once.
#[derive(Resource, Debug, Default)]
pub(crate) struct FabricLibrary {
    cut: HashMap<Vec<u32>, Weak<ClothLevels>>,
    /// What is being cut beside the main thread.
    cutting: HashMap<Vec<u32>, Task<Result<ClothLevels, FabricError>>>,
    /// Whether a cloth waits for its fabrics, or for others than it has.
    pub awaited: bool,
}

impl FabricLibrary {
    /// The fabrics of a cloth, cut now or before; none while they are being cut: ask again.
    ///
    /// # Errors
    ///
    /// The mesh, the attachment's vertices or the levels are bad.
    pub fn levels(
        &mut self,
        entity: Entity,
        mesh: &ClothMesh,
        attachment: Option<&Attachment>,
        lods: &LodSet,
    ) -> Result<Option<Arc<ClothLevels>>, ClothError> {
        lods.validate(entity)?;
        let pinned = attachment.map(|attachment| attachment.vertices.choose(&mesh.uvs()));
        check_weights(mesh).map_err(|source| ClothError::Weights { entity, source })?;
        let held = |pinned: &Vec<u32>| !pinned.is_empty() || mesh.weights().contains(&0.0);
        if !pinned.as_ref().is_none_or(held) {
            return Err(ClothError::NoVertices { entity, level: 0 });
        }
        let key = key(mesh, pinned.as_deref(), lods);
        if let Some(levels) = self.cut.get(&key).and_then(Weak::upgrade) {
            return Ok(Some(levels));
        }
        let asked = lods.levels();
        let attached = pinned.unwrap_or_default();
        let cut = match (self.cutting.get_mut(&key), AsyncComputeTaskPool::try_get()) {
            (Some(task), _) => check_ready(task),
            (None, Some(pool)) if mesh.vertex_count() >= LARGE => {
                let mesh = mesh.clone();
                let task = pool.spawn(async move { ClothLevels::cut(&mesh, &attached, asked) });
                self.cutting.insert(key.clone(), task);
                None
            }
            _ => Some(ClothLevels::cut(mesh, &attached, asked)),
        };
        let Some(cut) = cut else { return Ok(None) };
        self.cutting.remove(&key);
        let levels = Arc::new(cut.map_err(|source| ClothError::Mesh { entity, source })?);
        self.cut.retain(|_, levels| levels.strong_count() > 0);
        self.cut.insert(key, Arc::downgrade(&levels));
        Ok(Some(levels))
    }
}

/// Everything that a fabric depends on, bit for bit; each list after its length.
fn key(mesh: &ClothMesh, pinned: Option<&[u32]>, lods: &LodSet) -> Vec<u32> {
    let mut key = vec![lods.levels() as u32];
    match mesh {
        ClothMesh::Grid { columns, rows, width, height } => {
            key.extend([0, *columns, *rows, width.to_bits(), height.to_bits()]);
        }
        ClothMesh::Triangles { positions, indices, uv, weights } => {
            let lengths = [positions.len(), indices.len(), uv.len(), weights.len()];
            key.push(1);
            key.extend(lengths.map(|length| length as u32));
            key.extend(positions.iter().flat_map(|position| position.to_array()).map(f32::to_bits));
            key.extend(indices);
            key.extend(uv.iter().flat_map(|uv| uv.to_array()).map(f32::to_bits));
            key.extend(weights.iter().map(|weight| weight.to_bits()));
        }
    }
    key.extend(pinned.unwrap_or_default());
    key
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::ClothEdge;

    const FLAG: ClothMesh = ClothMesh::grid(9, 5, 1.5, 1.0);

    fn levels(
        library: &mut FabricLibrary,
        edge: ClothEdge,
        lods: LodSet,
    ) -> Result<Arc<ClothLevels>, ClothError> {
        let attachment = Attachment::in_place(edge);
        let levels = library.levels(Entity::PLACEHOLDER, &FLAG, Some(&attachment), &lods);
        levels.map(|levels| levels.expect("small cloths are cut at once"))
    }

    #[test]
    fn alike_is_cut_once() {
        let mut library = FabricLibrary::default();
        let one = levels(&mut library, ClothEdge::Left, LodSet::default()).expect("a flag");
        let same = levels(&mut library, ClothEdge::Left, LodSet::default()).expect("a flag");
        let other = levels(&mut library, ClothEdge::Right, LodSet::default()).expect("a flag");
        assert!(Arc::ptr_eq(&one, &same));
        assert!(!Arc::ptr_eq(&one, &other));
    }

    #[test]
    fn every_level_keeps_its_pins() {
        let mut library = FabricLibrary::default();
        let levels =
            levels(&mut library, ClothEdge::Right, LodSet::new([5.0, 10.0])).expect("a flag");
        let pins = |level: usize| {
            let fabric = levels.fabric(level);
            (0..fabric.particle_count())
                .filter(|&particle| fabric.is_pinned(particle))
                .collect::<Vec<_>>()
        };
        assert_eq!(pins(0), [8, 17, 26, 35, 44]);
        assert_eq!(pins(1), [4, 9, 14]);
        assert_eq!(pins(2), [2, 5]);
    }

    #[test]
    fn levels_that_cannot_be_cut_are_told_of_and_repeat_the_coarsest() {
        let lods = LodSet::new([1.0, 2.0, 3.0]);
        let levels = levels(&mut FabricLibrary::default(), ClothEdge::Left, lods).expect("a flag");
        assert!(matches!(
            levels.lack(Entity::PLACEHOLDER, &FLAG),
            Some(ClothError::NotNested { columns: 9, rows: 5, halvings: 3, .. })
        ));
        assert_eq!(levels.count(), 4);
        assert!(Arc::ptr_eq(levels.fabric(2), levels.fabric(3)));
        let state = ClothSnapshot::at_rest(levels.fabric(3));
        let moved = levels.transfer(state.clone(), (3, 2), &FabricMaterial::SILK, Vec3::ZERO);
        assert_eq!(moved, state);
        assert_eq!(levels.spread(state.positions, 3, 0).len(), 45);
    }

    /// The flag as plain triangles.
    fn triangles() -> ClothMesh {
        let flag = FLAG.builder().build().expect("a flag");
        let indices = flag.triangles().as_flattened().to_vec();
        ClothMesh::triangles(flag.rest_positions().to_vec(), indices, FLAG.uvs())
    }

    #[test]
    fn any_mesh_has_levels_that_keep_what_is_attached() {
        let mesh = triangles();
        let attachment = Attachment::in_place(ClothEdge::Left);
        let lods = LodSet::new([5.0, 10.0, 20.0]);
        let levels = FabricLibrary::default()
            .levels(Entity::PLACEHOLDER, &mesh, Some(&attachment), &lods)
            .expect("a cloth")
            .expect("at once");
        let fabric = levels.fabric(1);
        assert!(fabric.particle_count() < 45);
        let pinned = (0..fabric.particle_count()).filter(|&particle| fabric.is_pinned(particle));
        assert_eq!(pinned.count(), 5);
        let lack = levels.lack(Entity::PLACEHOLDER, &mesh);
        assert!(matches!(lack, Some(ClothError::TooFewLevels { asked: 4, .. })), "{lack:?}");
    }
}
