//! A group of cloths that may touch one another.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::ClothBatch;
use crate::contact::cloths::member::{GroupMember, Member};
use crate::contact::cloths::rules::OfGroup;
use crate::contact::itself::contacts::{LayerContacts, Layers};
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::place::Pose;
use crate::contact::itself::rounds::Lanes;

/// Number of sweeps over all contacts. Fewer: cloth that lies on cloth trembles and does not fall asleep. More: costs more.
const SWEEPS: usize = 8;

/// Access to the lanes of a group's cloths.
pub trait GroupLanes {
    /// The batch of a member, given its index, and its lane, which must hold a cloth.
    fn lane(&mut self, member: usize) -> (&mut ClothBatch, usize);
}

/// A group of cloths of any fabrics, materials, batches and frames, which do not pass through one another.
///
/// In each substep, [`begin_substep`](Self::begin_substep) comes before [`ClothBatch::integrate`] of all batches, and
/// [`solve`](Self::solve) after [`ClothBatch::solve_constraints`]. Contacts of the cloths with colliders and with
/// themselves are solved there, too. A cloth whose batch does not take part in a substep is held in it.
///
/// ```
/// use std::sync::Arc;
/// use bunting_solver::{
///     ClothBatch, ClothGroup, ClothSnapshot, FabricBuilder, FabricMaterial, FrameMotion, Grid, GroupLanes,
///     GroupMember, LaneCount, StepSettings,
/// };
/// use glam::{Quat, Vec3};
///
/// // Two flags, each alone in a batch.
/// struct Flags([ClothBatch; 2]);
///
/// impl GroupLanes for Flags {
///     fn lane(&mut self, member: usize) -> (&mut ClothBatch, usize) {
///         (&mut self.0[member], 0)
///     }
/// }
///
/// let grid = FabricBuilder::grid(Grid::new(9, 9, 0.5, 0.5));
/// let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build()?);
/// let flag = || {
///     let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
///     batch.insert(&ClothSnapshot::at_rest(&fabric), FabricMaterial::SILK).map(|_| batch)
/// };
/// let mut flags = Flags([flag()?, flag()?]);
/// // One hangs 2 cm behind the other.
/// let members = [0.0, 0.02].map(|behind| GroupMember {
///     thickness: 5e-3,
///     memberships: 1,
///     filters: 1,
///     start: (behind * Vec3::NEG_Z, Quat::IDENTITY),
///     motion: FrameMotion::NONE,
///     carrier: Vec3::ZERO,
/// });
///
/// let mut group = ClothGroup::default();
/// let settings = StepSettings::default();
/// flags.0.iter_mut().for_each(|flag| flag.begin_tick(1.0 / 60.0, settings));
/// group.set_members(&members, &mut flags);
/// for _ in 0..settings.substeps {
///     group.begin_substep(&mut flags);
///     flags.0.iter_mut().for_each(ClothBatch::integrate);
///     flags.0.iter_mut().for_each(ClothBatch::solve_constraints);
///     group.solve(&mut flags);
///     flags.0.iter_mut().for_each(ClothBatch::update_velocities);
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ClothGroup {
    members: Vec<Member>,
    /// The features of each member, and of all.
    meshes: Vec<Arc<ContactMesh>>,
    mesh: ContactMesh,
    /// Index of each patch's member, and of each particle's.
    of_patch: Vec<u32>,
    of_particle: Vec<u32>,
    layers: LayerContacts,
    /// Origin of the group's frame in the world, m.
    origin: Vec3,
}

impl ClothGroup {
    /// Sets the members, in a tick after [`ClothBatch::begin_tick`] of their batches. Members whose numbers are not valid
    /// touch nothing. The first call for cloths of certain fabrics computes their features, which takes longer than a
    /// tick.
    pub fn set_members(&mut self, members: &[GroupMember], lanes: &mut impl GroupLanes) {
        self.members.clear();
        self.layers.begin_tick();
        let mut meshes = Vec::with_capacity(members.len());
        let mut first = 0;
        for (index, &settings) in members.iter().enumerate() {
            let (batch, lane) = lanes.lane(index);
            let shape = batch.lane_shape(lane);
            let count = shape.fabric.particle_count();
            self.members.push(Member {
                settings,
                range: first..first + count,
                own_thickness: None,
                friction: 0.0,
                sewn: Vec::new(),
                fabric: shape.fabric,
                moves: false,
                is_finite: settings.is_valid(),
                pose: Pose::default(),
            });
            meshes.push(shape.mesh);
            first += count;
        }
        self.origin = members.iter().find(|it| it.is_valid()).map_or(Vec3::ZERO, |it| it.start.0);
        let same = |(one, other): (&Arc<ContactMesh>, &Arc<ContactMesh>)| Arc::ptr_eq(one, other);
        if meshes.len() != self.meshes.len() || !meshes.iter().zip(&self.meshes).all(same) {
            self.join(meshes);
        }
    }

    /// Joins the features of all members.
    fn join(&mut self, meshes: Vec<Arc<ContactMesh>>) {
        let counts = || self.members.iter().map(|member| member.range.len());
        self.mesh = ContactMesh::joined(
            meshes.iter().zip(counts()).map(|(mesh, count)| (&**mesh, count as u32)),
        );
        let repeated = |counts: &mut dyn Iterator<Item = usize>| {
            let each = counts.enumerate();
            each.flat_map(|(member, count)| core::iter::repeat_n(member as u32, count)).collect()
        };
        self.of_patch = repeated(&mut meshes.iter().map(|mesh| mesh.patches.len()));
        self.of_particle = repeated(&mut counts());
        self.layers.particles.resize(self.of_particle.len());
        self.meshes = meshes;
    }

    /// The layers of all members.
    pub(in crate::contact) fn layers(&self) -> &LayerContacts {
        &self.layers
    }

    /// Index of a particle's member.
    pub(in crate::contact) fn member_of(&self, particle: u32) -> usize {
        self.of_particle[particle as usize] as usize
    }

    /// Origin of the group's frame in the world, m.
    pub(in crate::contact) fn origin(&self) -> Vec3 {
        self.origin
    }

    /// Begins a substep: leaves the contacts of the members to the group, and notes where they are.
    pub fn begin_substep(&mut self, lanes: &mut impl GroupLanes) {
        for (index, member) in self.members.iter_mut().enumerate() {
            let (batch, lane) = lanes.lane(index);
            let start = &mut self.layers.particles.start[member.range.clone()];
            batch.begin_grouped(lane, member, self.origin, start);
        }
    }

    /// Keeps the members apart, and each from its colliders.
    pub fn solve(&mut self, lanes: &mut impl GroupLanes) {
        let [mut step, mut rate] = [0.0_f32; 2];
        for (index, member) in self.members.iter_mut().enumerate() {
            let (batch, lane) = lanes.lane(index);
            let [of_member, rate_of_member] =
                batch.read_grouped(lane, member, self.origin, &mut self.layers.particles);
            step = step.max(of_member);
            rate = rate.max(rate_of_member);
        }
        let Self { members, mesh, of_patch, of_particle, layers, .. } = self;
        let sewn: Vec<[u32; 2]> = members.iter().flat_map(Member::sewn_of_group).collect();
        let rules = OfGroup { members, of_patch, of_particle, sewn: &sewn };
        let thickness = rules.greatest_thickness();
        layers.particles.touched.fill(false);
        let how = Layers { mesh, rules: &rules, thickness, step, rate };
        how.solve(layers, &mut LanesOfGroup { members, lanes }, SWEEPS);
        let unrelaxed: Vec<usize> = layers.unrelaxed_particles(thickness).collect();
        for (index, member) in members.iter().enumerate() {
            let (batch, lane) = lanes.lane(index);
            let range = &member.range;
            let own = unrelaxed.iter().filter(|at| range.contains(at));
            batch.end_grouped(lane, own.map(|at| at - range.start));
        }
    }
}

/// The lanes of a group's members.
struct LanesOfGroup<'a, G> {
    members: &'a [Member],
    lanes: &'a mut G,
}

impl<G: GroupLanes> Lanes for LanesOfGroup<'_, G> {
    fn read_velocities(&mut self, particles: &mut Particles) {
        for (index, member) in self.members.iter().enumerate() {
            let (batch, lane) = self.lanes.lane(index);
            batch.read_velocities(lane, member, particles);
        }
    }

    fn write(&mut self, particles: &Particles) {
        for (index, member) in self.members.iter().enumerate() {
            let (batch, lane) = self.lanes.lane(index);
            batch.write_grouped(lane, member, particles);
        }
    }

    fn touch_colliders(&mut self, particles: &mut Particles) -> bool {
        let mut has_pushed = false;
        for (index, member) in self.members.iter().enumerate() {
            let (batch, lane) = self.lanes.lane(index);
            has_pushed |= batch.touch_colliders(lane, member, particles);
        }
        has_pushed
    }
}
