//! Detailed meshes that a cloth carries.

use std::sync::Arc;

use bevy_asset::{AssetEvent, AssetId, Assets, Handle, RenderAssetUsages};
use bevy_camera::primitives::Aabb;
use bevy_camera::visibility::{InheritedVisibility, NoAutoAabb, Visibility};
use bevy_ecs::prelude::*;
use bevy_math::{Vec3, Vec3A};
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};
use bevy_reflect::Reflect;
use bunting_solver::{Subdivision, SubdivisionBuffers};

use crate::background::Background;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::display::surface::ClothSurface;
use crate::fabric::levels::ClothLevels;
use crate::render::binding::{Binding, SurfaceVertices};
use crate::render::level_meshes::LevelMeshes;
use crate::render::mesh_content::{changed_meshes, content_of};
use crate::render::source_mesh::SourceMesh;
use crate::render::tangents::TangentSums;

/// Number of halvings of the finest level's edges in the surface that carries meshes.
const HALVINGS: u32 = 1;

/// Makes a cloth carry the entity's `Mesh3d`: a detailed mesh with hems, eyelets, fringe, thickness or lining, which is
/// bound to the smooth surface of the finest level at rest. Positions, normals and tangents follow; what is not on the
/// surface keeps its distance from it. Levels of the simulation do not show in it.
///
/// The mesh lies around the [`ClothMesh`](crate::ClothMesh), in the same frame: make the entity a child of the cloth
/// without a transform of its own. The mesh that is shown is a copy; other entities with the same asset stay as they
/// are. It is drawn as it is until another thread has bound it. The cloth itself is drawn only if it has a material.
///
/// A cloth that names itself is drawn by its own detailed mesh alone. A detailed mesh of one surface needs none of this: as a
/// [`ClothFromMesh`](crate::ClothFromMesh) it is simulated as finely as its [`ClothResolution`](crate::ClothResolution) says.
///
/// # Errors
///
/// A [`ClothFailed`] event tells that the mesh is kept in the render world only. It is then shown as it is.
///
/// ```
/// use bevy_bunting::ClothDeformer;
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_mesh::Mesh3d;
///
/// fn spawn(mut commands: Commands, fringe: Mesh3d) {
///     let carpet = commands.spawn(ClothMesh::grid(33, 33, 1.5, 1.0)).id();
///     commands.spawn((fringe, ClothDeformer { cloth: carpet }, ChildOf(carpet)));
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Debug, PartialEq, Clone)]
pub struct ClothDeformer {
    /// The cloth.
    #[entities]
    pub cloth: Entity,
}

/// A mesh bound to a cloth.
#[derive(Component, Debug)]
pub struct Carried {
    cloth: Entity,
    /// Levels of the cloth; none if it is gone.
    levels: Option<Arc<ClothLevels>>,
    /// The given mesh, as it is at rest.
    given: Handle<Mesh>,
    /// What the given mesh contained when it was bound, see [`content_of`].
    content: u64,
    /// The mesh that is shown: a copy or, if the mesh cannot be carried, the given one.
    shown: Handle<Mesh>,
    state: CarriedState,
}

impl Carried {
    /// Levels of the cloth; none if it is gone.
    pub fn levels(&self) -> Option<&ClothLevels> {
        self.levels.as_deref()
    }

    /// The mesh that is shown.
    pub fn shown(&self) -> &Handle<Mesh> {
        &self.shown
    }

    /// Whether the mesh is bound to these levels, or is being bound.
    fn has_binding(&self, levels: &Arc<ClothLevels>) -> bool {
        let is_of = self.levels.as_ref().is_some_and(|of| Arc::ptr_eq(of, levels));
        is_of && !matches!(self.state, CarriedState::Refused)
    }

    /// Whether this is the mesh that is shown.
    pub fn shows(&self, mesh: AssetId<Mesh>) -> bool {
        self.shown.id() == mesh
    }

    /// Takes up the binding that another thread has made. Returns whether it has.
    fn finish(&mut self) -> bool {
        if let CarriedState::Awaited(work) = &self.state
            && work.is_done()
            && let CarriedState::Awaited(work) =
                core::mem::replace(&mut self.state, CarriedState::Refused)
            && let Some(bound) = work.take()
        {
            self.state = CarriedState::Bound(Box::new(bound));
            return true;
        }
        false
    }

    /// Greatest distance of a vertex from the surface, m; zero until it is known.
    pub fn reach(&self) -> f32 {
        if let CarriedState::Bound(bound) = &self.state { bound.binding.reach } else { 0.0 }
    }
}

#[derive(Debug)]
enum CarriedState {
    Awaited(Background<Option<Bound>>),
    Bound(Box<Bound>),
    Refused,
}

#[derive(Debug)]
struct Bound {
    subdivision: Subdivision,
    binding: Binding,
    /// Positions of the finest level's particles when the mesh was last written, m.
    written: Vec<Vec3>,
}

type Unbound = (
    Entity,
    &'static ClothDeformer,
    &'static Mesh3d,
    Option<&'static mut Carried>,
    Option<&'static SourceMesh>,
);

/// Begins to bind meshes that are new, changed or have another cloth. Those whose cloth is gone stay as they are, and forget
/// it.
pub fn bind_meshes(
    mut deformers: Query<Unbound>,
    cloths: Query<&ClothInstance>,
    written: Query<&LevelMeshes>,
    mut events: MessageReader<AssetEvent<Mesh>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut commands: Commands,
) {
    let changed = changed_meshes(&mut events, &written);
    for (entity, deformer, shown, mut carried, source) in &mut deformers {
        let levels = cloths.get(deformer.cloth).ok().and_then(|cloth| cloth.levels.as_ref());
        let Some(levels) = levels else {
            if let Some(carried) = carried.as_mut().filter(|carried| carried.levels.is_some()) {
                (carried.levels, carried.state) = (None, CarriedState::Refused);
            }
            continue;
        };
        let known = carried.as_deref().filter(|carried| carried.shows(shown.id()));
        let is_same = known.is_some();
        if known.is_none() && source.is_some_and(|source| !source.shows(shown.id())) {
            // Another mesh of which a cloth is to be made.
            continue;
        }
        let given = known.map_or(&shown.0, |carried| &carried.given).clone();
        let is_known = known.is_some_and(|carried| {
            let of_levels = carried.levels.as_ref();
            carried.cloth == deformer.cloth
                && of_levels.is_some_and(|of| Arc::ptr_eq(of, levels))
                && !(changed.contains(&given.id())
                    && meshes.get(&given).is_some_and(|mesh| content_of(mesh) != carried.content))
        });
        if is_known {
            continue;
        }
        let Some(mesh) = meshes.get(&given) else { continue };
        let content = content_of(mesh);
        let bound = |shown: Handle<Mesh>, state: CarriedState| Carried {
            cloth: deformer.cloth,
            levels: Some(Arc::clone(levels)),
            given: given.clone(),
            content,
            shown,
            state,
        };
        let Some(rest) = at_rest(mesh) else {
            if let Some(carried) = carried.as_mut().filter(|carried| carried.has_binding(levels)) {
                // The last good mesh is carried further on.
                if is_same {
                    carried.content = content;
                }
                commands.entity(entity).insert(Mesh3d(carried.shown.clone()));
            } else {
                commands.entity(entity).insert(bound(shown.0.clone(), CarriedState::Refused));
            }
            ClothFailed::report(&mut commands, entity, ClothError::MeshUnreadable { entity });
            continue;
        };
        let copy = mesh.clone();
        let of = Arc::clone(levels);
        let work = Background::begin(move || bind(&of, &rest));
        let copy = meshes.add(copy);
        let carried = bound(copy.clone(), CarriedState::Awaited(work));
        let mut entity_commands = commands.entity(entity);
        entity_commands.insert((carried, Mesh3d(copy), NoAutoAabb)).insert_if_new(Aabb::default());
        if deformer.cloth == entity {
            entity_commands.insert_if_new((ClothSurface::default(), Visibility::default()));
        }
    }
}

/// Positions and normals of a mesh; none if they cannot be read. Where it has no normals they are zero.
fn at_rest(mesh: &Mesh) -> Option<SurfaceVertices> {
    if !mesh.asset_usage.contains(RenderAssetUsages::MAIN_WORLD) {
        return None;
    }
    let read = |attribute| match mesh.try_attribute(attribute) {
        Ok(VertexAttributeValues::Float32x3(values)) => Some(values.clone()),
        _ => None,
    };
    let positions = read(Mesh::ATTRIBUTE_POSITION)?;
    let normals = read(Mesh::ATTRIBUTE_NORMAL).unwrap_or_else(|| vec![[0.0; 3]; positions.len()]);
    Some(SurfaceVertices { positions, normals })
}

/// Binds a mesh to the finest level at rest.
fn bind(levels: &ClothLevels, mesh: &SurfaceVertices) -> Option<Bound> {
    let (fabric, rigid) = (levels.fabric(0), levels.rigid());
    let indices = fabric.triangles().as_flattened();
    let subdivision = match fabric.grid() {
        Some(grid) => Subdivision::of_grid(grid, HALVINGS),
        None => {
            let particles: Vec<u32> = (0..fabric.particle_count() as u32).collect();
            Subdivision::of_mesh(fabric.rest_positions(), &particles, indices, HALVINGS)
        }
    };
    let mut surface = SurfaceVertices::default();
    let buffers = &mut SubdivisionBuffers::default();
    evaluate(&subdivision, fabric.rest_positions(), buffers, &mut surface);
    let binding = Binding::new(&surface, &subdivision, &rigid.corners(), mesh).ok()?;
    Some(Bound { subdivision, binding, written: Vec::new() })
}

fn evaluate(
    subdivision: &Subdivision,
    positions: &[Vec3],
    buffers: &mut SubdivisionBuffers,
    surface: &mut SurfaceVertices,
) {
    let count = subdivision.attributes().rows().len();
    surface.positions.resize(count, [0.0; 3]);
    surface.normals.resize(count, [0.0; 3]);
    subdivision.evaluate(positions, buffers, &mut surface.positions, &mut surface.normals);
}

/// Buffers that are kept from frame to frame.
#[derive(Debug, Default)]
pub struct CarryBuffers {
    subdivision: SubdivisionBuffers,
    surface: SurfaceVertices,
    tangents: TangentSums,
}

type CarriedMesh = (Entity, &'static Mesh3d, &'static InheritedVisibility, &'static mut Carried);

/// Writes carried meshes of cloths that have moved, and the bounds of those that other entities have.
pub fn carry_meshes(
    mut carried: Query<CarriedMesh>,
    cloths: Query<&ClothSurface, With<ClothInstance>>,
    mut bounds: Query<&mut Aabb>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut buffers: Local<CarryBuffers>,
) {
    for (entity, shown, visibility, mut carried) in &mut carried {
        if carried.bypass_change_detection().finish() {
            // Its bounds follow.
            carried.set_changed();
        }
        let carried = carried.bypass_change_detection();
        let Carried { levels: Some(levels), state: CarriedState::Bound(bound), .. } = carried
        else {
            continue;
        };
        let Ok(surface) = cloths.get(carried.cloth) else { continue };
        let fits = surface.positions.len() == levels.fabric(surface.level()).particle_count();
        if !fits || shown.0 != carried.shown {
            continue;
        }
        if let Ok([of_cloth, mut bounds]) = bounds.get_many_mut([carried.cloth, entity]) {
            let half_extents = of_cloth.half_extents + Vec3A::splat(bound.binding.reach);
            bounds.set_if_neq(Aabb { center: of_cloth.center, half_extents });
        }
        if !visibility.get() {
            continue;
        }
        let finest = levels.interpolate(surface.positions.clone(), surface.level(), 0);
        if bound.written == finest {
            continue;
        }
        let Some(mut mesh) = meshes.get_mut(shown.id()) else { continue };
        let CarryBuffers { subdivision, surface: vertices, tangents } = &mut *buffers;
        evaluate(&bound.subdivision, &finest, subdivision, vertices);
        write(&mut mesh, &bound.binding, vertices);
        tangents.write_tangents(&mut mesh);
        bound.written = finest;
    }
}

fn write(mesh: &mut Mesh, binding: &Binding, surface: &SurfaceVertices) {
    let (mut positions, mut normals) = (None, None);
    for (attribute, values) in mesh.attributes_mut() {
        let VertexAttributeValues::Float32x3(values) = values else { continue };
        if attribute.id == Mesh::ATTRIBUTE_POSITION.id {
            positions = Some(values);
        } else if attribute.id == Mesh::ATTRIBUTE_NORMAL.id {
            normals = Some(values);
        }
    }
    let Some(positions) = positions.filter(|it| it.len() == binding.vertex_count()) else { return };
    binding.carry(surface, positions, normals.map(Vec::as_mut_slice));
}
