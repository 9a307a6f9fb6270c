//! The fabrics in use, shared by cloths of equal content.

use std::collections::HashMap;
use std::sync::{Arc, Weak};

use bevy_ecs::prelude::*;
use bunting_solver::{FabricError, MaterialRegion};

use crate::background::Background;
use crate::cloth::error::ClothError;
use crate::cloth::mesh::ClothMesh;
use crate::cloth::regions::{add_key, check_regions};
use crate::cloth::resolution::ClothResolution;
use crate::cloth::weights::check_weights;
use crate::fabric::attached::Attached;
use crate::fabric::awaited::AwaitedLevels;
use crate::fabric::content_key::ContentKey;
use crate::fabric::cut::cut_levels;
use crate::fabric::levels::ClothLevels;
use crate::fabric::refusal::refusal;
use crate::lod::lod_set::{LodChoice, LodSet};

/// Number of vertices, as by [`work`], from which levels are built on another thread, where there are threads: building takes
/// longer than a tick then. Fewer: cloths appear some ticks late without need.
const ASYNC_VERTICES: usize = 8192;

/// The same number for levels that may be late: building takes longer than the cloths of a tick may. Fewer: a single flag of 33 × 33
/// appears some ticks late without need.
const ASYNC_VERTICES_LATE: usize = 2048;

/// Number of vertices, over all different cloths, whose fabrics are expected to be built in a tick: a flag of
/// 33 × 33 with its levels takes some milliseconds. Larger: ticks wait for other threads. Smaller: many new
/// cloths appear late without need.
const VERTICES_PER_TICK: usize = 1024;

/// Number of a grid's vertices whose fabric takes as long as that of one particle of another mesh.
const DEARER: f32 = 3.0;

/// Number of particles of a mesh that is no grid by default.
const PARTICLES: f32 = 1000.0;

/// Number of particles of which no fabric is built.
const MOST_PARTICLES: f32 = 1e6;

/// Number of ticks by which levels may be late where they depend on the machine anyway, after they are due and after the last ones were
/// taken. Fewer: ticks wait for other threads on a busy machine. More: cloths appear late where threads have no time for them at all.
const MOST_LATE: u64 = 256;

/// The levels of all cloths in use, by content.
#[derive(Resource, Debug, Default)]
pub(crate) struct FabricLibrary {
    cut: HashMap<ContentKey, Weak<ClothLevels>>,
    /// Levels that are being built and are expected in a later tick.
    cutting: HashMap<ContentKey, Cutting>,
    /// Number of ticks so far.
    tick: u64,
    /// Tick in which levels that were built in the background were last taken.
    taken: u64,
    /// Number of vertices whose levels are expected in this tick or later.
    expected: usize,
    /// Whether a cloth waits for its levels, or for levels that replace its present ones.
    pub awaited: bool,
    /// Whether levels are built now, however long that takes.
    pub at_once: bool,
    /// Whether levels of cloths whose choice of levels is automatic may be taken later than they are due, so that no
    /// tick waits for another thread.
    pub may_be_late: bool,
}

/// Levels that are being built in the background. They are taken in a tick that follows from the numbers of vertices, or
/// later where they are not built yet and may be late.
#[derive(Debug)]
struct Cutting {
    /// Tick in which the levels are taken.
    due: u64,
    levels: Background<Result<ClothLevels, FabricError>>,
}

impl Cutting {
    /// Whether the levels are taken in a tick, given that in which others were last taken.
    fn is_ready(&self, tick: u64, taken: u64, may_be_late: bool) -> bool {
        let latest = self.due.max(taken) + MOST_LATE;
        let waits = may_be_late && !self.levels.is_done() && tick < latest;
        tick >= self.due && !waits
    }
}

/// Result of a request for a cloth's levels.
pub(crate) enum Found {
    Levels(Arc<ClothLevels>),
    /// The levels are being built: ask again in a later tick.
    Awaited(AwaitedLevels),
}

impl FabricLibrary {
    /// Begins a tick, in which no cloth waits yet. If none waited in the last tick, all levels that are being
    /// built are abandoned.
    pub fn begin_tick(&mut self) {
        if !self.awaited {
            self.cutting.clear();
            self.expected = 0;
        }
        self.awaited = false;
        self.tick += 1;
        self.expected = self.expected.saturating_sub(VERTICES_PER_TICK);
    }

    /// Whether levels are expected in a later tick. Most are not due yet, so that no key is hashed.
    pub fn is_cutting(&self, awaited: &AwaitedLevels, lods: &LodSet) -> bool {
        self.tick < awaited.due || self.is_cutting_key(&awaited.key, lods)
    }

    /// Whether the levels with this key are being built, and expected in a later tick.
    fn is_cutting_key(&self, key: &ContentKey, lods: &LodSet) -> bool {
        let may_be_late = self.may_be_late(lods);
        let is_ready = |cutting: &Cutting| cutting.is_ready(self.tick, self.taken, may_be_late);
        self.cutting.get(key).is_some_and(|cutting| !is_ready(cutting))
    }

    /// Whether the levels of a cloth may be taken later than they are due.
    fn may_be_late(&self, lods: &LodSet) -> bool {
        self.may_be_late && matches!(lods.choice, LodChoice::Automatic { .. })
    }

    /// Forgets levels that no cloth has any more. Returns whether there were any.
    pub fn forget_unused(&mut self) -> bool {
        let before = self.cut.len();
        self.cut.retain(|_, levels| levels.strong_count() > 0);
        self.cut.len() < before
    }

    /// The levels that cloths have.
    pub fn living(&self) -> impl Iterator<Item = Arc<ClothLevels>> + '_ {
        self.cut.values().filter_map(Weak::upgrade)
    }

    /// Number of ticks until all levels that are being built are ready.
    pub fn ticks_to_cut(&self) -> u64 {
        let left = |cutting: &Cutting| cutting.due.saturating_sub(self.tick);
        self.cutting.values().map(left).max().unwrap_or(0)
    }

    /// Returns the levels of a cloth with a valid [`LodSet`], given what an attachment holds, if there is one, and where its material
    /// differs: built now or before. While another thread builds them it returns what the cloth
    /// waits for: ask again in a later tick.
    ///
    /// # Errors
    ///
    /// The mesh, its weights, its regions or the attachment's vertices are invalid.
    pub fn levels(
        &mut self,
        entity: Entity,
        mesh: &ClothMesh,
        attached: Option<Option<Attached>>,
        lods: &LodSet,
        (resolution, regions): (ClothResolution, &[MaterialRegion]),
    ) -> Result<Found, ClothError> {
        check_weights(mesh.weights(), mesh.vertex_count())
            .map_err(|source| ClothError::Weights { entity, source })?;
        check_regions(entity, regions, mesh)?;
        let is_rigid = || mesh.weights().contains(&0.0);
        if matches!(attached, Some(None)) && !is_rigid() {
            return Err(ClothError::NoVertices { entity });
        }
        let attached = attached.flatten().unwrap_or_default();
        let key = content_key(mesh, &attached, lods.levels(), (resolution, regions));
        if let Some(levels) = self.cut.get(&key).and_then(Weak::upgrade) {
            return Ok(Found::Levels(levels));
        }
        let Some(cut) = self.cut_or_wait(&key, mesh, (attached, resolution, regions), lods) else {
            let due = self.cutting[&key].due;
            return Ok(Found::Awaited(AwaitedLevels { key, due }));
        };
        let levels = Arc::new(cut.map_err(|source| refusal(entity, mesh, source))?);
        self.cut.insert(key, Arc::downgrade(&levels));
        Ok(Found::Levels(levels))
    }

    /// Builds levels now, or takes them in the tick in which they are due; none before.
    fn cut_or_wait(
        &mut self,
        key: &ContentKey,
        mesh: &ClothMesh,
        (attached, resolution, regions): (Attached, ClothResolution, &[MaterialRegion]),
        lods: &LodSet,
    ) -> Option<Result<ClothLevels, FabricError>> {
        if !self.at_once && self.is_cutting_key(key, lods) {
            return None;
        }
        let asked = lods.levels();
        if let Some(cutting) = self.cutting.remove(key) {
            self.taken = self.tick;
            return Some(cutting.levels.take());
        }
        if self.at_once {
            return Some(cut_levels(mesh, &attached, asked, resolution, regions));
        }
        let vertices = work(mesh, &attached, resolution);
        let fits = self.expected == 0 || self.expected + vertices <= VERTICES_PER_TICK;
        // Small cloths are built at once and do not wait for large ones.
        let may_be_late = self.may_be_late(lods);
        let least = if may_be_late { ASYNC_VERTICES_LATE } else { ASYNC_VERTICES };
        let is_large = vertices >= least;
        let expected = if is_large { vertices } else { self.expected + vertices };
        if !is_large {
            self.expected = expected;
        }
        if fits && !is_large {
            return Some(cut_levels(mesh, &attached, asked, resolution, regions));
        }
        let due = self.tick + expected.div_ceil(VERTICES_PER_TICK) as u64;
        let (mesh, regions) = (mesh.clone(), regions.to_vec());
        let cut = move || cut_levels(&mesh, &attached, asked, resolution, &regions);
        let levels = Background::begin(cut);
        self.cutting.insert(key.clone(), Cutting { due, levels });
        None
    }
}

/// Number of a grid's vertices whose levels take about as long as those of a mesh.
fn work(mesh: &ClothMesh, attached: &Attached, resolution: ClothResolution) -> usize {
    let ClothMesh::Triangles { positions, indices, .. } = mesh else {
        let dearer = if attached.points.is_empty() { 1.0 } else { DEARER };
        return (dearer * mesh.vertex_count() as f32) as usize;
    };
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| positions.get(corner as usize).copied());
        let area = a.zip(b).zip(c).map(|((a, b), c)| 0.5 * (b - a).cross(c - a).length());
        area.unwrap_or_default()
    };
    let particles = match resolution {
        ClothResolution::Auto => PARTICLES,
        ClothResolution::Particles(count) => count as f32,
        ClothResolution::CellSize(size) => {
            indices.as_chunks::<3>().0.iter().map(area).sum::<f32>() / (size * size)
        }
    };
    // More are refused at once.
    let particles = if particles < MOST_PARTICLES { particles } else { 0.0 };
    (DEARER * particles.max(positions.len() as f32)) as usize
}

fn content_key(
    mesh: &ClothMesh,
    attached: &Attached,
    levels: usize,
    (resolution, regions): (ClothResolution, &[MaterialRegion]),
) -> ContentKey {
    let mut key = vec![levels as u32];
    key.extend(resolution.key());
    add_key(regions, &mut key);
    match mesh {
        ClothMesh::Grid { columns, rows, width, height } => {
            key.extend([0, *columns, *rows, width.to_bits(), height.to_bits()]);
        }
        ClothMesh::Sheet { columns, rows, width, depth } => {
            key.extend([2, *columns, *rows, width.to_bits(), depth.to_bits()]);
        }
        ClothMesh::Triangles { positions, indices, uv, weights, merged } => {
            let lengths = [positions.len(), indices.len(), uv.len(), weights.len(), merged.len()];
            key.push(1);
            key.extend(lengths.map(|length| length as u32));
            key.extend(positions.iter().flat_map(|position| position.to_array()).map(f32::to_bits));
            key.extend(indices);
            key.extend(uv.iter().flat_map(|uv| uv.to_array()).map(f32::to_bits));
            key.extend(weights.iter().map(|weight| weight.to_bits()));
            key.extend(merged);
        }
    }
    attached.add_key(&mut key);
    key.into()
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use bevy_math::Vec3;
    use bevy_tasks::{AsyncComputeTaskPool, TaskPoolBuilder};
    use bunting_solver::{ClothSnapshot, FabricMaterial};

    use super::*;
    use crate::fabric::levels::FewerLevels;
    use crate::motion::attached_vertices::ClothEdge;
    use crate::motion::attachment::Attachment;

    fn at_once(found: Found) -> Arc<ClothLevels> {
        match found {
            Found::Levels(levels) => levels,
            Found::Awaited(_) => panic!("small cloths are cut at once"),
        }
    }

    const FLAG: ClothMesh = ClothMesh::grid(9, 5, 1.5, 1.0);

    fn levels(
        library: &mut FabricLibrary,
        edge: ClothEdge,
        lods: LodSet,
    ) -> Result<Arc<ClothLevels>, ClothError> {
        let attachment = Attachment::in_place(edge);
        library
            .levels(
                Entity::PLACEHOLDER,
                &FLAG,
                Some(Attached::of(&attachment, &FLAG)),
                &lods,
                (ClothResolution::Auto, &[]),
            )
            .map(at_once)
    }

    #[test]
    fn late_levels_are_not_waited_for_where_they_may_be_late() {
        let pool =
            AsyncComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(1).build());
        let hog = |_| {
            let (go, busy) = mpsc::channel::<()>();
            (go, pool.spawn(async move { busy.recv() }))
        };
        let hogs: Vec<_> = (0..pool.thread_num()).map(hog).collect();
        let mut library = FabricLibrary { may_be_late: true, ..FabricLibrary::default() };
        let mut is_there = |width: f32| {
            let mesh = ClothMesh::grid(33, 33, width, 1.0);
            let found = library.levels(
                Entity::PLACEHOLDER,
                &mesh,
                None,
                &LodSet::automatic(1),
                (ClothResolution::Auto, &[]),
            );
            library.awaited = true;
            library.begin_tick();
            matches!(found, Ok(Found::Levels(_)))
        };
        assert!(is_there(1.0), "the first is cut at once");
        assert!((0..8).all(|_| !is_there(1.1)), "no thread has had time for it");
        hogs.iter().for_each(|(go, _)| go.send(()).expect("it waits"));
        assert!((0..2 * MOST_LATE).any(|_| is_there(1.1)));
    }

    #[test]
    fn levels_that_may_be_late_are_not_built_in_a_tick_if_that_takes_long() {
        AsyncComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(1).build());
        let is_there = |may_be_late: bool, lods: LodSet| {
            let mut library = FabricLibrary { may_be_late, ..FabricLibrary::default() };
            let mesh = ClothMesh::grid(65, 65, 1.0, 1.0);
            let resolution = (ClothResolution::Auto, &[][..]);
            let found = library.levels(Entity::PLACEHOLDER, &mesh, None, &lods, resolution);
            matches!(found, Ok(Found::Levels(_)))
        };
        assert!(!is_there(true, LodSet::automatic(2)));
        assert!(is_there(false, LodSet::automatic(2)), "costs are fixed");
        assert!(is_there(true, LodSet::default()), "levels are not chosen");
    }

    #[test]
    fn equal_cloths_share_their_levels() {
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
    fn levels_that_cannot_be_cut_are_reported_and_repeat_the_coarsest() {
        let lods = LodSet::new([1.0, 2.0, 3.0]);
        let levels = levels(&mut FabricLibrary::default(), ClothEdge::Left, lods).expect("a flag");
        let told = || levels.tell_fewer(Entity::PLACEHOLDER, FLAG.as_grid());
        let grid = Some(FewerLevels::Grid {
            entity: Entity::PLACEHOLDER,
            columns: 9,
            rows: 5,
            halvings: 3,
        });
        assert_eq!([told(), told()], [grid, None], "once for all cloths of the mesh");
        assert!(levels.has_fewer());
        assert_eq!(levels.count(), 4);
        assert!(Arc::ptr_eq(levels.fabric(2), levels.fabric(3)));
        let state = ClothSnapshot::at_rest(levels.fabric(3));
        let moved = levels.transfer(state.clone(), (3, 2), &FabricMaterial::SILK, Vec3::ZERO);
        assert_eq!(moved, state);
        assert_eq!(levels.interpolate(state.positions, 3, 0).len(), 45);
    }

    /// The flag as a mesh of triangles.
    fn triangles() -> ClothMesh {
        let flag = FLAG.builder().build().expect("a flag");
        let indices = flag.triangles().as_flattened().to_vec();
        ClothMesh::triangles(flag.rest_positions().to_vec(), indices, FLAG.uvs())
    }

    #[test]
    fn levels_of_a_mesh_keep_its_attached_vertices() {
        let mesh = triangles();
        let attachment = Attachment::in_place(ClothEdge::Left);
        let lods = LodSet::new([5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0, 640.0]);
        let levels = FabricLibrary::default()
            .levels(
                Entity::PLACEHOLDER,
                &mesh,
                Some(Attached::of(&attachment, &mesh)),
                &lods,
                (ClothResolution::Auto, &[]),
            )
            .map(at_once)
            .expect("a cloth");
        for level in 0..9 {
            let fabric = levels.fabric(level);
            for vertex in (0..45).step_by(9) {
                let particle = levels.particle(level, vertex).expect("a particle");
                assert!(fabric.is_pinned(particle), "{vertex} at level {level}");
            }
        }
        assert!(levels.fabric(1).particle_count() < levels.fabric(0).particle_count() / 2);
        let told = levels.tell_fewer(Entity::PLACEHOLDER, mesh.as_grid());
        assert!(matches!(told, Some(FewerLevels::Triangles { asked: 9, .. })), "{told:?}");
    }
}
