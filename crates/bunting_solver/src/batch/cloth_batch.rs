//! The public interface of a batch, for every width and layout.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::error::BatchError;
use crate::batch::exchange::Entering;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_count::LaneCount;
use crate::batch::mixed::Mixed;
use crate::batch::particles_mut::ParticlesMut;
use crate::batch::single_cloth::SingleCloth;
use crate::batch::single_net::SingleNet;
use crate::batch::snapshot::ClothSnapshot;
use crate::batch::surfaces::LaneSurface;
use crate::constants::GRAVITY;
use crate::fabric::{Fabric, FabricMaterial};
use crate::simd::registers::{Pack1, Pack8, Pack16};
use crate::step::bdf::IntegratorHistory;
use crate::step::limits::StepLimits;
use crate::step::{Scheme, StepSettings};

/// The state of up to [`LaneCount`] cloths of one [`Fabric`], or of fabrics of one topology, stepped together.
///
/// Each cloth has a lane, numbered from 0. The bits of its state depend on its own history only. If there is
/// no lane with a given number, methods that change a lane return [`BatchError::NoLane`], and methods that
/// read one panic.
///
/// ```
/// use std::sync::Arc;
/// use bunting_solver::{
///     ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, LaneCount, StepLimits,
/// };
/// use glam::Vec3;
///
/// let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
/// let fabric = Arc::new(grid.pin_where(|_, uv| uv.x == 0.0).build()?);
/// // Two flags side by side, each in a wind and of a material of its own.
/// let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
/// let at_rest = ClothSnapshot::at_rest(&fabric);
/// let calm = batch.insert(&at_rest, FabricMaterial::FLAG_POLYESTER)?;
/// let windy = batch.insert(&at_rest, FabricMaterial::SILK)?;
/// batch.drive(windy, Drive { wind: Vec3::new(6.0, 0.0, 1.0), ..Drive::default() })?;
/// batch.step(1.0 / 60.0, StepLimits::default());
///
/// // The silk goes on in a batch of its own, with the same bits.
/// let state = batch.snapshot(windy);
/// batch.remove(windy)?;
/// let mut alone = ClothBatch::new(fabric, LaneCount::One);
/// alone.insert(&state, FabricMaterial::SILK)?;
/// # assert!(batch.is_occupied(calm) && !batch.is_occupied(windy));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ClothBatch(pub(super) Lanes);

/// A batch of one width and layout.
#[derive(Clone, Debug)]
pub(super) enum Lanes {
    /// One cloth across all lanes of a vector.
    Single(Box<LaneBatch<Pack8, SingleCloth<Pack8>>>),
    /// One net across all lanes of a vector.
    SingleNet(Box<LaneBatch<Pack8, SingleNet>>),
    One(Box<LaneBatch<Pack1>>),
    Eight(Box<LaneBatch<Pack8>>),
    Sixteen(Box<LaneBatch<Pack16>>),
    Mixed(Box<LaneBatch<Pack8, Mixed<Pack8>>>),
}

/// Evaluates an expression with the batch of any width and layout.
macro_rules! with_batch {
    ($lanes:expr, $batch:ident => $body:expr) => {
        match $lanes {
            Lanes::Single($batch) => $body,
            Lanes::SingleNet($batch) => $body,
            Lanes::One($batch) => $body,
            Lanes::Eight($batch) => $body,
            Lanes::Sixteen($batch) => $body,
            Lanes::Mixed($batch) => $body,
        }
    };
}

pub(super) use with_batch;

impl ClothBatch {
    /// An empty batch of the given width, or of the [widest](LaneCount::widest) that this machine has.
    #[must_use]
    pub fn new(fabric: Arc<Fabric>, lanes: LaneCount) -> Self {
        Self(match lanes.min(LaneCount::widest()) {
            LaneCount::One => Lanes::of_one_cloth(fabric),
            LaneCount::Eight => Lanes::Eight(Box::new(LaneBatch::side_by_side(fabric))),
            LaneCount::Sixteen => Lanes::Sixteen(Box::new(LaneBatch::side_by_side(fabric))),
        })
    }

    /// An empty batch of [`LaneCount::Eight`] for cloths of different fabrics, which all have the topology of this
    /// one, for [`Scheme::Yarns`]. A cloth has the same bits as among cloths of its own fabric, and the batch takes
    /// longer than one of a single fabric. None where the fabric has no [`topology`](Fabric::topology).
    #[must_use]
    pub fn mixed(fabric: &Arc<Fabric>) -> Option<Self> {
        Some(Self(Lanes::Mixed(Box::new(LaneBatch::mixed(fabric)?))))
    }

    /// Whether cloths of different fabrics can be put into the batch.
    #[must_use]
    pub fn is_mixed(&self) -> bool {
        matches!(self.0, Lanes::Mixed(_))
    }

    /// The fabric that all cloths of the batch are cut from, or whose topology they have where the batch is
    /// [`mixed`](Self::mixed).
    #[must_use]
    pub fn fabric(&self) -> &Arc<Fabric> {
        with_batch!(&self.0, batch => &batch.fabric)
    }

    /// Number of lanes.
    #[must_use]
    pub fn lane_count(&self) -> usize {
        with_batch!(&self.0, batch => batch.lanes.len())
    }

    /// Lanes that hold a cloth.
    pub fn occupied(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.lane_count()).filter(|&lane| self.is_occupied(lane))
    }

    /// Whether a lane holds a cloth.
    #[must_use]
    pub fn is_occupied(&self, lane: usize) -> bool {
        with_batch!(&self.0, batch => batch.lanes.get(lane).is_some_and(Option::is_some))
    }

    /// Whether no lane is free.
    #[must_use]
    pub fn is_full(&self) -> bool {
        with_batch!(&self.0, batch => batch.lanes.iter().all(Option::is_some))
    }

    /// Whether no lane holds a cloth.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        with_batch!(&self.0, batch => batch.lanes.iter().all(Option::is_none))
    }

    /// Restarts the integrator of a lane: its next substep is of first order.
    pub(crate) fn restart_integrator(&mut self, lane: usize) {
        with_batch!(&mut self.0, batch => {
            if let Some(cloth) = &mut batch.lanes[lane] {
                cloth.history = IntegratorHistory::default();
            }
        });
    }

    /// Puts a cloth into the first free lane and returns the lane.
    ///
    /// # Errors
    ///
    /// No lane is free, the material is invalid, or the state is not finite or of another fabric. The batch
    /// is then unchanged.
    pub fn insert(
        &mut self,
        snapshot: &ClothSnapshot,
        material: FabricMaterial,
    ) -> Result<usize, BatchError> {
        let lanes = self.lane_count();
        let lane =
            (0..lanes).find(|&lane| !self.is_occupied(lane)).ok_or(BatchError::Full { lanes })?;
        self.replace(lane, snapshot, material)?;
        Ok(lane)
    }

    /// Puts a cloth into a lane, in place of any cloth that it holds.
    ///
    /// # Errors
    ///
    /// The material is invalid, the state is not finite or of another fabric, or there is no such lane. The
    /// batch is then unchanged.
    pub fn replace(
        &mut self,
        lane: usize,
        snapshot: &ClothSnapshot,
        material: FabricMaterial,
    ) -> Result<(), BatchError> {
        let fabric = &Arc::clone(self.fabric());
        self.exchange(&[], &[Entering { lane, fabric, snapshot, material }])
    }

    /// Removes cloths from lanes, and inserts others in place of any cloths that their lanes hold. Exchanging
    /// several cloths takes hardly longer than exchanging one.
    ///
    /// # Errors
    ///
    /// A material is bad, a state is not finite or of another fabric, a fabric is not one of the batch's, or there is
    /// no such lane. The batch is then as it was.
    pub fn exchange(&mut self, leave: &[usize], come: &[Entering]) -> Result<(), BatchError> {
        for &lane in leave {
            self.check_lane(lane)?;
        }
        for Entering { lane, fabric, snapshot, material } in come {
            self.check_lane(*lane)?;
            let may_enter = Arc::ptr_eq(fabric, self.fabric())
                || (self.is_mixed() && fabric.has_topology_of(self.fabric()));
            if !may_enter {
                return Err(BatchError::Fabric);
            }
            material.validate()?;
            self.check(snapshot)?;
        }
        with_batch!(&mut self.0, batch => batch.exchange(leave, come));
        Ok(())
    }

    /// Removes the cloth from a lane.
    ///
    /// # Errors
    ///
    /// There is no such lane.
    pub fn remove(&mut self, lane: usize) -> Result<(), BatchError> {
        self.exchange(&[lane], &[])
    }

    /// Overwrites the state of a lane. If the state has no integrator's history, the next substep is of first
    /// order.
    ///
    /// # Errors
    ///
    /// The state is not finite or of another fabric, or there is no such lane. The lane is then unchanged.
    pub fn restore(&mut self, lane: usize, snapshot: &ClothSnapshot) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        self.check(snapshot)?;
        with_batch!(&mut self.0, batch => batch.restore(&[(lane, snapshot)]));
        Ok(())
    }

    pub(super) fn check_lane(&self, lane: usize) -> Result<(), BatchError> {
        let lanes = self.lane_count();
        if lane < lanes { Ok(()) } else { Err(BatchError::NoLane { lane, lanes }) }
    }

    /// Panics if there is no such lane: a single cloth would otherwise answer for every lane.
    #[track_caller]
    fn expect_lane(&self, lane: usize) {
        let lanes = self.lane_count();
        assert!(lane < lanes, "there is no lane {lane}: there are {lanes}");
    }

    fn check(&self, snapshot: &ClothSnapshot) -> Result<(), BatchError> {
        let expected = self.fabric().particle_count();
        if !snapshot.is_of(expected) {
            let lists = [&snapshot.positions, &snapshot.velocities].map(Vec::len);
            let given = lists.into_iter().find(|&given| given != expected);
            return Err(BatchError::ParticleCount { given: given.unwrap_or_default(), expected });
        }
        if snapshot.is_finite() { Ok(()) } else { Err(BatchError::NotFinite) }
    }

    /// Changes the material of a lane from the next tick on. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// The material cannot be simulated, or there is no such lane. The lane keeps its material.
    pub fn set_material(
        &mut self,
        lane: usize,
        material: FabricMaterial,
    ) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        material.validate()?;
        with_batch!(&mut self.0, batch => {
            if let Some(cloth) = &mut batch.lanes[lane] {
                cloth.material = material;
            }
        });
        Ok(())
    }

    /// Begins a tick of `tick` seconds: sets the length of its substeps, and finds the particles that may touch
    /// each collider. In a tick without length nothing moves.
    ///
    /// # Panics
    ///
    /// When the batch is [`mixed`](Self::mixed) and the scheme is not [`Scheme::Yarns`].
    pub fn begin_tick(&mut self, tick: f32, settings: StepSettings) {
        self.lay_out_for(settings.scheme);
        assert!(!self.is_mixed() || settings.scheme == Scheme::Yarns, "a mixed batch has yarns");
        with_batch!(&mut self.0, batch => batch.begin_tick(tick, settings));
    }

    /// Begins a substep: carries the state into the moved frame, applies air, gravity and damping, and
    /// predicts positions.
    pub fn integrate(&mut self) {
        with_batch!(&mut self.0, batch => batch.integrate());
    }

    /// Projects the predicted positions onto the constraints, contacts included.
    pub fn solve_constraints(&mut self) {
        with_batch!(&mut self.0, batch => batch.solve_constraints());
    }

    /// The first part of [`solve_constraints`](Self::solve_constraints) in the scheme of yarns: bending. It
    /// is public for measurements of its time.
    #[doc(hidden)]
    pub fn solve_all_bending(&mut self) {
        with_batch!(&mut self.0, batch => batch.solve_all_bending());
    }

    /// The second part of [`solve_constraints`](Self::solve_constraints): all other constraints.
    #[doc(hidden)]
    pub fn solve_all_but_bending(&mut self) {
        with_batch!(&mut self.0, batch => batch.solve_all_but_bending());
    }

    /// The particles of a lane during a substep, for forces and constraints of the caller: between
    /// [`integrate`](Self::integrate) and [`update_velocities`](Self::update_velocities). None if the lane is
    /// empty, and outside a substep.
    pub fn particles_mut(&mut self, lane: usize) -> Option<ParticlesMut<'_>> {
        with_batch!(&mut self.0, batch => ParticlesMut::new(&mut **batch, lane))
    }

    /// Ends a substep: computes velocities from the corrected positions.
    pub fn update_velocities(&mut self) {
        with_batch!(&mut self.0, batch => batch.update_velocities());
    }

    /// Recomputes all normals from the positions.
    pub fn compute_normals(&mut self) {
        with_batch!(&mut self.0, batch => batch.compute_normals());
    }

    /// Runs one whole tick of `tick` seconds: all substeps, then the normals. Their number is chosen within the limits
    /// for the batch's fabric under standard gravity; settings are limits that leave no choice. Where gravity is stronger, see
    /// [`StepLimits::of_fabric`].
    pub fn step(&mut self, tick: f32, limits: impl Into<StepLimits>) {
        let settings = limits.into().of_fabric(self.fabric(), tick, GRAVITY);
        self.begin_tick(tick, settings);
        for _ in 0..settings.substeps {
            self.integrate();
            self.solve_constraints();
            self.update_velocities();
        }
        self.compute_normals();
    }

    /// Positions of a lane's particles in the cloth's frame, m.
    pub fn copy_positions(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.expect_lane(lane);
        with_batch!(&self.0, batch => batch.copy_positions(lane, into));
    }

    /// Velocities of a lane's particles relative to the world, along the frame's axes, m/s.
    pub fn copy_velocities(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.expect_lane(lane);
        with_batch!(&self.0, batch => batch.copy_velocities(lane, into));
    }

    /// Unit normals of a lane's particles, as of the last
    /// [`compute_normals`](Self::compute_normals).
    pub fn copy_normals(&self, lane: usize, into: &mut Vec<Vec3>) {
        self.expect_lane(lane);
        with_batch!(&self.0, batch => batch.copy_normals(lane, into));
    }

    /// Positions and normals of all cloths at once, each cloth's into the element of its lane: much faster
    /// than lane by lane. The elements of empty lanes keep their values.
    ///
    /// # Panics
    ///
    /// If `into` has fewer elements than the batch has lanes.
    pub fn copy_surfaces(&self, into: &mut [LaneSurface]) {
        with_batch!(&self.0, batch => batch.copy_surfaces(into));
    }

    /// The state of a lane, with the integrator's history.
    #[must_use]
    pub fn snapshot(&self, lane: usize) -> ClothSnapshot {
        self.expect_lane(lane);
        with_batch!(&self.0, batch => batch.snapshot(lane))
    }

    /// The state of a lane, without the integrator's history.
    #[must_use]
    pub fn snapshot_without_history(&self, lane: usize) -> ClothSnapshot {
        self.expect_lane(lane);
        with_batch!(&self.0, batch => batch.snapshot_without_history(lane))
    }

    /// Positions and velocities of some of a lane's particles, in the given order: the state of a coarser
    /// fabric with these particles.
    #[must_use]
    pub fn snapshot_of(&self, lane: usize, particles: &[u32]) -> ClothSnapshot {
        self.expect_lane(lane);
        with_batch!(&self.0, batch => batch.snapshot_of(lane, particles))
    }

    /// Whether every number of a lane's state is finite.
    #[must_use]
    pub fn is_finite(&self, lane: usize) -> bool {
        self.expect_lane(lane);
        with_batch!(&self.0, batch => batch.is_finite(lane))
    }
}
