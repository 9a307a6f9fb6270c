//! Attachments: chosen vertices of a cloth stay on another entity.

use std::collections::HashSet;
use std::sync::Arc;

use bevy_ecs::entity::EntityMapper;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::components::Transform;
use bunting_solver::MeshPoint;

use crate::cloth::mesh::ClothMesh;
use crate::motion::anchor_hold::{AnchorHold, infinite_force};
use crate::motion::attached_vertices::AttachedVertices;
use crate::motion::held_group::HeldGroup;

/// Default of [`Attachment::teleport_speed`], m/s: no vehicle changes its velocity by as much between two
/// frames. Smaller: hard manoeuvres count as teleports and do not swing the cloth. Larger: jumps whip it.
pub(crate) const TELEPORT_SPEED: f32 = 25.0;

/// Holds chosen vertices of a cloth on a target that may move.
///
/// The cloth's frame is the target's pose times [`offset`](Self::offset). The held vertices keep their
/// positions in the [`ClothMesh`](crate::ClothMesh), seen from that frame. The cloth's own [`Transform`] is
/// overwritten with the frame, whether the cloth is a child of its target or not.
///
/// A change of target, offset or held vertices does not whip the cloth: the cloth moves rigidly with its
/// frame, and newly held vertices move to their places within one and a half seconds. A cloth more than 2 m away
/// is first put in place, as by a teleport.
///
/// The target may move in any schedule, by physics or by animation; in `PostUpdate`, before `TransformSystems::Propagate`, else
/// it counts as moved a frame later. What moves while no time passes, as while `Time<Virtual>` is paused, is teleported. The
/// target's scale scales the offset's translation. The cloth grows with the target, if its scale changes by one factor in all
/// directions, from the size that it has when it is attached.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_transform::prelude::*;
///
/// let mut world = World::new();
/// let pole = world.spawn(Transform::default()).id();
/// let held = Attachment::new(pole, ClothEdge::Left);
/// world.spawn((ClothMesh::grid(33, 23, 1.5, 1.0), held));
/// ```
#[derive(Component, Clone, Debug, Reflect)]
#[type_path = "bevy_bunting"]
#[component(map_entities = map_target)]
#[reflect(Component, Debug, Clone)]
pub struct Attachment {
    /// Entity that the vertices stay on. [`Entity::PLACEHOLDER`] and the cloth itself hold the vertices on
    /// the cloth's own [`Transform`].
    #[reflect(default = "placeholder")]
    pub target: Entity,
    /// The vertices that are held.
    pub vertices: AttachedVertices,
    /// Pose of the cloth's frame relative to the target. The scale is baked into the cloth when it is attached.
    #[reflect(default)]
    pub offset: Transform,
    /// Fate of the cloth when the target is despawned.
    #[reflect(default)]
    pub on_lost: TargetLost,
    /// Change of the target's velocity between two frames or ticks, in m/s, above which the target was
    /// teleported: the cloth then moves with it rigidly, without being accelerated. At 60 frames a second, 25
    /// m/s is a departure of 0.4 m from the extrapolated motion. Where the next change has the same velocity, the target
    /// is not teleported but fast: the cloth gets its velocity (up to 100 m/s) and flies on with it. A turn counts by the change of velocity of a
    /// point 1 m away, and any turn of more than 90° is a teleport.
    #[reflect(default = "teleport_speed")]
    pub teleport_speed: f32,
    /// Further vertices, held on further entities: the other mast of a banner, the other shoulder of a cape.
    #[reflect(default)]
    pub anchors: Vec<Anchor>,
    /// Whether the first of the held vertices is brought to the target, see [`Attachment::at`]. In the tick in which the mesh is
    /// known this becomes false, and [`offset`](Self::offset) what brings it there.
    #[reflect(default)]
    pub brings_first: bool,
}

/// Vertices of a cloth that are held on an entity besides the [`Attachment`]'s own: its pose times the offset, times the
/// vertices' positions in the [`ClothMesh`](crate::ClothMesh).
///
/// They move relative to the cloth's frame, which is that of the attachment's target, evenly in the substeps of a tick.
/// A vertex that is held more than once is held by the attachment, or else by the first anchor that names it.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_transform::prelude::*;
///
/// let mut world = World::new();
/// let mast = world.spawn(Transform::from_xyz(2.0, 0.0, 0.0)).id();
/// // The right edge of a banner, 2 m from its origin, is on another mast.
/// let offset = Transform::from_xyz(-2.0, 0.0, 0.0);
/// let anchor = Anchor::new(mast, ClothEdge::Right).with_offset(offset);
/// world.spawn(Attachment::in_place(ClothEdge::Left).with_anchor(anchor));
/// ```
#[derive(Clone, Debug, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, Clone)]
pub struct Anchor {
    /// Entity that the vertices stay on.
    pub target: Entity,
    /// The vertices that are held.
    pub vertices: AttachedVertices,
    /// Pose of the vertices' frame relative to the target; the scale is ignored. The target's scale scales the translation, and
    /// the vertices are as far from one another as the cloth's size has them.
    #[reflect(default)]
    pub offset: Transform,
    /// How the vertices are held: exactly, by springs or on a rail.
    #[reflect(default)]
    pub hold: AnchorHold,
    /// Force of the cloth on the anchor, N, as the mean over a tick, at which the anchor lets go: it is removed from the
    /// [`Attachment`], and [`ClothAnchorBroke`](crate::ClothAnchorBroke) is triggered on the cloth. Infinite by default.
    #[reflect(default = "infinite_force")]
    pub break_force: f32,
    /// Fate of the cloth when the anchor's target is despawned; none: that of the [`Attachment`].
    #[reflect(default)]
    pub on_lost: Option<TargetLost>,
    /// Whether the first of the held vertices is brought to the target, see [`Anchor::at`]. In the tick in which the mesh is known
    /// this becomes false, and [`offset`](Self::offset) what brings it there.
    #[reflect(default)]
    pub brings_first: bool,
}

impl Anchor {
    /// Holds vertices on a target, in the target's own frame.
    #[must_use]
    pub fn new(target: Entity, vertices: impl Into<AttachedVertices>) -> Self {
        Self {
            target,
            vertices: vertices.into(),
            offset: Transform::IDENTITY,
            hold: AnchorHold::Rigid,
            break_force: f32::INFINITY,
            on_lost: None,
            brings_first: false,
        }
    }

    /// Holds vertices on a target, of which the first is at the target, or at [`offset`](Self::offset) from it, wherever the mesh
    /// has it. The others keep their places relative to it.
    ///
    /// ```
    /// use bevy_bunting::prelude::*;
    /// use bevy_ecs::prelude::*;
    ///
    /// # let mut world = World::new();
    /// # let pegs = [(); 2].map(|()| world.spawn(bevy_transform::components::Transform::default()).id());
    /// // Each corner of a sheet hangs on a peg.
    /// let [left, right] = pegs;
    /// let second = Anchor::at(right, ClothCorner::TopRight);
    /// let held = Attachment::at(left, ClothCorner::TopLeft).with_anchor(second);
    /// // Or by index.
    /// let third = Anchor::at(right, 12_u32);
    /// # assert!(held.brings_first && third.brings_first);
    /// ```
    #[must_use]
    pub fn at(target: Entity, vertices: impl Into<AttachedVertices>) -> Self {
        Self { brings_first: true, ..Self::new(target, vertices) }
    }

    /// The anchor with a fate of its own when its target is despawned.
    #[must_use]
    pub fn when_lost(mut self, outcome: TargetLost) -> Self {
        self.on_lost = Some(outcome);
        self
    }

    /// The anchor with springs of a stiffness (N/m), all of them together.
    #[must_use]
    pub fn with_stiffness(mut self, stiffness: f32) -> Self {
        self.hold = AnchorHold::Spring { stiffness, max_force: f32::INFINITY };
        self
    }

    /// The anchor with another [`hold`](Self::hold).
    #[must_use]
    pub fn with_hold(mut self, hold: AnchorHold) -> Self {
        self.hold = hold;
        self
    }

    /// The anchor that lets go at a force, N.
    #[must_use]
    pub fn breaking_at(mut self, force: f32) -> Self {
        self.break_force = force;
        self
    }

    /// Whether all numbers can be used.
    pub(crate) fn is_valid(&self) -> bool {
        self.hold.is_valid() && self.break_force >= 0.0
    }

    /// The anchor with another [`offset`](Self::offset).
    #[must_use]
    pub fn with_offset(mut self, offset: Transform) -> Self {
        self.offset = offset;
        self
    }
}

/// Target of an attachment in a file that names none.
fn placeholder() -> Entity {
    Entity::PLACEHOLDER
}

/// Greatest change of velocity of an attachment in a file that names none, m/s.
fn teleport_speed() -> f32 {
    TELEPORT_SPEED
}

/// Maps the targets when a scene is loaded. The placeholder is no entity of a scene and stays.
fn map_target<M: EntityMapper>(attachment: &mut Attachment, mapper: &mut M) {
    let anchors = attachment.anchors.iter_mut().map(|anchor| &mut anchor.target);
    for target in anchors.chain([&mut attachment.target]) {
        if *target != Entity::PLACEHOLDER {
            *target = mapper.get_mapped(*target);
        }
    }
}

impl Attachment {
    /// Holds vertices on a target, in the target's own frame.
    #[must_use]
    pub fn new(target: Entity, vertices: impl Into<AttachedVertices>) -> Self {
        Self {
            target,
            vertices: vertices.into(),
            offset: Transform::IDENTITY,
            on_lost: TargetLost::default(),
            teleport_speed: TELEPORT_SPEED,
            anchors: Vec::new(),
            brings_first: false,
        }
    }

    /// Holds vertices on a target, of which the first is at the target, or at [`offset`](Self::offset) from it, wherever the mesh
    /// has it: the cloth is moved so. On the cloth's own [`Transform`] it is as [`in_place`](Self::in_place).
    #[must_use]
    pub fn at(target: Entity, vertices: impl Into<AttachedVertices>) -> Self {
        Self { brings_first: true, ..Self::new(target, vertices) }
    }

    /// Holds vertices on the cloth's own [`Transform`].
    #[must_use]
    pub fn in_place(vertices: impl Into<AttachedVertices>) -> Self {
        Self::new(Entity::PLACEHOLDER, vertices)
    }

    /// The attachment with another [`offset`](Self::offset).
    #[must_use]
    pub fn with_offset(mut self, offset: Transform) -> Self {
        self.offset = offset;
        self
    }

    /// The attachment with a further [`Anchor`].
    #[must_use]
    pub fn with_anchor(mut self, anchor: Anchor) -> Self {
        self.anchors.push(anchor);
        self
    }

    /// What is held on each target: by the attachment, then by each anchor. A vertex or a point occurs once.
    pub(crate) fn groups(&self, mesh: &ClothMesh) -> Vec<HeldGroup> {
        let (mut taken, mut taken_points) = (HashSet::new(), HashSet::new());
        let anchored = self.anchors.iter().map(|anchor| &anchor.vertices);
        let mut of_group = |chosen: &AttachedVertices| {
            let mut vertices = chosen.choose(mesh);
            vertices.retain(|&vertex| taken.insert(vertex));
            let bits = |point: &MeshPoint| (point.vertices, point.weights.map(f32::to_bits));
            let points = chosen.points().filter(|point| taken_points.insert(bits(point)));
            HeldGroup { vertices, points: points.collect() }
        };
        core::iter::once(&self.vertices).chain(anchored).map(&mut of_group).collect()
    }

    /// What is pinned on each target, in the order of [`groups`](Self::groups).
    pub(crate) fn pinned_groups(&self, mesh: &ClothMesh) -> Vec<HeldGroup> {
        let mut groups = self.groups(mesh);
        for (group, anchor) in groups[1..].iter_mut().zip(&self.anchors) {
            if !anchor.hold.is_rigid() {
                group.clear();
            }
        }
        groups
    }

    /// What each anchor holds by springs or on a rail.
    pub(crate) fn sprung_groups(&self, mesh: &ClothMesh) -> Vec<HeldGroup> {
        let mut groups = self.groups(mesh).split_off(1);
        for (group, anchor) in groups.iter_mut().zip(&self.anchors) {
            if anchor.hold.is_rigid() || !anchor.hold.is_valid() {
                group.clear();
            }
        }
        groups
    }

    /// The rail of each anchor; none for one without a rail.
    pub(crate) fn rails(&self) -> Vec<Option<Arc<[Vec3]>>> {
        let rail = |anchor: &Anchor| match &anchor.hold {
            AnchorHold::Rail { points, .. } => Some(Arc::from(points.as_slice())),
            _ => None,
        };
        self.anchors.iter().map(rail).collect()
    }

    /// Whether vertices are to be brought to a target.
    pub(crate) fn brings_any(&self) -> bool {
        self.brings_first || self.anchors.iter().any(|anchor| anchor.brings_first)
    }

    /// The fate of the cloth when the target of an anchor is despawned.
    pub(crate) fn outcome_of(&self, anchor: &Anchor) -> TargetLost {
        anchor.on_lost.unwrap_or(self.on_lost)
    }

    /// Lets go the vertices on lost targets. Those of anchors that stand stay held; without the attachment's own target the
    /// cloth's frame is its own transform. Returns whether the attachment still does anything.
    pub(crate) fn release(&mut self, lost: &[Entity]) -> bool {
        let is_lost = |target: Entity| lost.contains(&target);
        if is_lost(self.target) {
            self.brings_first = false;
            self.target = Entity::PLACEHOLDER;
            self.vertices = AttachedVertices::List(Vec::new());
            self.offset = Transform::IDENTITY;
        }
        self.anchors.retain(|anchor| !is_lost(anchor.target));
        !self.anchors.is_empty()
            || self.target != Entity::PLACEHOLDER
            || self.vertices != AttachedVertices::List(Vec::new())
    }

    /// The target of the attachment of `cloth`, unless it is the cloth itself.
    pub(crate) fn target_other_than(&self, cloth: Entity) -> Option<Entity> {
        (self.target != Entity::PLACEHOLDER && self.target != cloth).then_some(self.target)
    }
}

/// Fate of a cloth whose target is despawned.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let pole = world.spawn_empty().id();
/// // If the pole is despawned, the flag falls.
/// let held = Attachment { on_lost: TargetLost::Release, ..Attachment::new(pole, ClothEdge::Left) };
/// # world.spawn(held);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum TargetLost {
    /// The cloth is paused: it gets [`ClothPaused`](crate::ClothPaused). If that component is removed,
    /// the cloth hangs from the last pose of its target.
    #[default]
    Freeze,
    /// The vertices on that target are let go, and the cloth goes on, held by all others or by none: an [`Anchor`] of a lost target is removed; an
    /// [`Attachment`] that has lost its own target holds no vertices on the cloth's own transform, and is removed when no
    /// anchor is left.
    Release,
}
