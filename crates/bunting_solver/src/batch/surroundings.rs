//! What acts on the cloths of a batch from outside, and what they touch.

use std::sync::Arc;

use glam::Vec3;
use parry3d::bounding_volume::Aabb;

use crate::anchors::hold::Hold;
use crate::anchors::pin_groups::PinGroups;
use crate::anchors::pin_reports::{PinReaction, PinReports};
use crate::batch::cloth_batch::{ClothBatch, Lanes, with_batch};
use crate::batch::error::BatchError;
use crate::contact::collider::Collider;
use crate::contact::itself::settings::SelfCollision;
use crate::contact::points::ContactPoint;
use crate::contact::reaction::ContactReaction;
use crate::pressure::Pressure;
use crate::seams::plan::Seams;
use crate::seams::state::LaneSeams;
use crate::seams::stitch::Lacing;
use crate::step::{Drive, Guide, MovingPin};

impl ClothBatch {
    /// Sets the frame motion, gravity and air that act on a lane from the next tick on. The frame's motion is
    /// repeated in every tick until it is set again. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// A number is not finite, the air's density is negative, or there is no such lane. The lane then keeps
    /// its former drive.
    pub fn drive(&mut self, lane: usize, drive: Drive) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        drive.validate().map_err(|name| BatchError::Drive { name })?;
        with_batch!(&mut self.0, batch => {
            if let Some(cloth) = &mut batch.lanes[lane] {
                cloth.drive = drive;
            }
        });
        Ok(())
    }

    /// Moves pins of a lane's cloth within its frame in the next tick, in each substep by the same way; later they stay
    /// where they are. Constraints see them as held, and the air as moving. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// There is no such lane, a particle is not pinned, or a position is not finite. The pins then stay where they are.
    pub fn move_pins(&mut self, lane: usize, pins: Vec<MovingPin>) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        with_batch!(&mut self.0, batch => batch.set_pin_motion(lane, pins))
    }

    /// Sets the guides of a lane's cloth in the next tick, one for each particle; without any, the cloth is free. Later
    /// guides stay where they are at the end of that tick. Pinned particles have no limits. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// There is no such lane, the number of guides is neither zero nor that of the particles, or a number is not finite or
    /// is negative where it cannot be. The lane keeps its guides.
    pub fn set_guides(&mut self, lane: usize, guides: Vec<Guide>) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        with_batch!(&mut self.0, batch => batch.set_guides(lane, guides))
    }

    /// Sets the wind at each particle of a lane's cloth, from the next tick on: its velocity less that of the
    /// [`Drive`], m/s, along the frame's axes at the end of the tick. Without any, the wind is the same at all particles. An
    /// empty lane stays empty.
    ///
    /// # Errors
    ///
    /// There is no such lane, the number of winds is neither zero nor that of the particles, or a number is not finite. The
    /// lane keeps its winds.
    pub fn set_local_wind(&mut self, lane: usize, winds: Vec<Vec3>) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        with_batch!(&mut self.0, batch => batch.set_local_wind(lane, winds))
    }

    /// Gives a lane's cloth air inside from the next substep on, or takes it away; at first there is none. An empty lane stays
    /// empty. The first call for a lane finds the border of its fabric.
    ///
    /// # Errors
    ///
    /// There is no such lane, a number is not finite or is negative where it cannot be, or the air of a cloth with holes
    /// of more than a twentieth of its area would be sealed. The lane keeps its air.
    pub fn set_pressure(&mut self, lane: usize, air: Option<Pressure>) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        with_batch!(&mut self.0, batch => batch.set_pressure(lane, air))
    }

    /// Pressure of the air inside a lane's cloth in the last substep, Pa above the surrounding air's; none without air, or
    /// before the first substep. It is less than was asked for where the substeps do not resolve that.
    #[must_use]
    pub fn pressure(&self, lane: usize) -> Option<f32> {
        with_batch!(&self.0, batch => batch.lanes[lane].as_ref())?.pressure_inside()
    }

    /// Reports what a lane's cloth does to its pins from the next tick on, or ceases to; at first it does not. `pivots` are
    /// for each group the points about which torque is taken, at the start and at the end of the next tick, each in the
    /// frame at that time, m. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// There is no such lane.
    pub fn report_pins(
        &mut self,
        lane: usize,
        groups: Option<(&Arc<PinGroups>, Vec<[Vec3; 2]>)>,
    ) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        with_batch!(&mut self.0, batch => {
            if let Some(cloth) = &mut batch.lanes[lane] {
                cloth.pin_reports = groups.map(|(groups, pivots)| match cloth.pin_reports.take() {
                    Some(mut reports) if Arc::ptr_eq(&reports.groups, groups) => {
                        reports.pivots = pivots;
                        reports
                    }
                    _ => {
                        let known = core::mem::take(&mut cloth.pin_velocities);
                        Box::new(PinReports::new(Arc::clone(groups), pivots, known))
                    }
                });
            }
        });
        Ok(())
    }

    /// Velocities of a lane's pins at the end of the last tick, m/s, from which their inertia in the next one follows; empty
    /// unless their [reactions are asked for](Self::report_pins).
    #[must_use]
    pub fn pin_velocities(&self, lane: usize) -> &[Vec3] {
        let cloth = with_batch!(&self.0, batch => batch.lanes[lane].as_ref());
        cloth.map_or(&[], |cloth| match &cloth.pin_reports {
            Some(reports) => reports.velocities(),
            None => &cloth.pin_velocities,
        })
    }

    /// Sets the [velocities of the pins](Self::pin_velocities) of a cloth that goes on in another lane, before their
    /// reactions are asked for. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// There is no such lane.
    pub fn set_pin_velocities(
        &mut self,
        lane: usize,
        velocities: Vec<Vec3>,
    ) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        with_batch!(&mut self.0, batch => {
            if let Some(cloth) = &mut batch.lanes[lane] {
                cloth.pin_velocities = velocities;
            }
        });
        Ok(())
    }

    /// What a lane's cloth did to each group of its pins in the last tick; empty unless that
    /// [is asked for](Self::report_pins).
    #[must_use]
    pub fn pin_reactions(&self, lane: usize) -> &[PinReaction] {
        let cloth = with_batch!(&self.0, batch => batch.lanes[lane].as_ref());
        cloth.and_then(|cloth| cloth.pin_reports.as_ref()).map_or(&[], |reports| &reports.sums)
    }

    /// Holds free particles of a lane's cloth by springs or on rails, from the next tick on. Their motion is repeated in
    /// every tick until they are set again. Of several holds of one particle the first one holds. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// There is no such lane or particle, or a number is not finite or is negative. The lane keeps its former holds.
    pub fn hold(&mut self, lane: usize, holds: Vec<Hold>) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        let count = self.fabric().particle_count();
        let is_bad = |hold: &&Hold| hold.particle as usize >= count || !hold.is_valid();
        if let Some(&Hold { particle, .. }) = holds.iter().find(is_bad) {
            return Err(BatchError::Hold { particle });
        }
        with_batch!(&mut self.0, batch => {
            if let Some(cloth) = &mut batch.lanes[lane] {
                // Particles that are no longer held get their own masses back.
                cloth.added_mass = None;
                cloth.holds = (!holds.is_empty()).then(|| {
                    let mut list = cloth.holds.take().unwrap_or_default();
                    list.set(holds);
                    list
                });
            }
        });
        Ok(())
    }

    /// Impulse of a lane's cloth in the last tick on that which holds each particle, N·s, along the axes of the cloth's
    /// frame at the end of the tick, in the order in which the holds were given.
    #[must_use]
    pub fn hold_impulses(&self, lane: usize) -> &[Vec3] {
        let cloth = with_batch!(&self.0, batch => batch.lanes[lane].as_ref());
        cloth.and_then(|cloth| cloth.holds.as_ref()).map_or(&[], |holds| &holds.impulses)
    }

    /// Sews a lane's cloth together from the next tick on, as far as lacings say, until they are set again. Without lacings all stitches
    /// are open. An empty lane stays empty.
    ///
    /// The two sides of a closed stitch have one place at the end of each substep, before contacts. Momentum and angular momentum stay
    /// as they are. A cloth without pins falls, turns and hangs as one cloth of all its pieces.
    ///
    /// # Errors
    ///
    /// There is no such lane, the seams are those of a fabric with another number of particles, or a length or a time is not finite or
    /// is negative. The lane keeps its former seams.
    pub fn sew(
        &mut self,
        lane: usize,
        seams: &Arc<Seams>,
        lacings: Vec<Lacing>,
    ) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        if seams.of_fabric != self.fabric().particle_count() {
            return Err(BatchError::Fabric);
        }
        if let Some(lacing) = lacings.iter().position(|lacing| !lacing.is_valid()) {
            return Err(BatchError::Lacing { lacing });
        }
        with_batch!(&mut self.0, batch => {
            batch.resume_relaxation_of_seams(lane);
            if let Some(cloth) = &mut batch.lanes[lane] {
                match &mut cloth.seams {
                    Some(known) if Arc::ptr_eq(&known.seams, seams) => known.lacings = lacings,
                    known => *known = Some(Box::new(LaneSeams::new(Arc::clone(seams), lacings))),
                }
            }
        });
        Ok(())
    }

    /// Opens all seams of a lane's cloth.
    ///
    /// # Errors
    ///
    /// There is no such lane.
    pub fn unsew(&mut self, lane: usize) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        with_batch!(&mut self.0, batch => {
            batch.resume_relaxation_of_seams(lane);
            if let Some(cloth) = &mut batch.lanes[lane] {
                cloth.seams = None;
            }
        });
        Ok(())
    }

    /// Sets the shapes that a lane's cloth cannot enter, from the next tick on. An empty lane stays empty.
    ///
    /// # Errors
    ///
    /// There is no such lane, or a number of a collider is not finite. Such a collider is left out.
    pub fn set_colliders(
        &mut self,
        lane: usize,
        colliders: impl IntoIterator<Item = Collider>,
    ) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        let mut refused = None;
        with_batch!(&mut self.0, batch => {
            if let Some(cloth) = &mut batch.lanes[lane] {
                cloth.colliders.clear();
                for (index, collider) in colliders.into_iter().enumerate() {
                    if collider.is_finite() {
                        cloth.colliders.push(collider);
                    } else {
                        refused.get_or_insert(index);
                    }
                }
            }
        });
        refused.map_or(Ok(()), |index| Err(BatchError::Collider { index }))
    }

    /// Keeps a lane's cloth from passing through itself from the next substep on, or lets it; at first it does. An empty
    /// lane stays empty. The first call for a lane computes the features of its fabric that may touch, which takes
    /// longer than a tick.
    ///
    /// # Errors
    ///
    /// There is no such lane, or the thickness is not finite and greater than zero. The lane keeps its settings.
    pub fn set_self_collision(
        &mut self,
        lane: usize,
        settings: Option<SelfCollision>,
    ) -> Result<(), BatchError> {
        self.check_lane(lane)?;
        if settings.is_some_and(|settings| !settings.is_valid()) {
            return Err(BatchError::SelfCollision);
        }
        with_batch!(&mut self.0, batch => batch.set_self_collision(lane, settings));
        Ok(())
    }

    /// For each lane, the box around all positions that its cloth's particles reach in a tick of `tick` seconds under
    /// the present [`Drive`], as far as they touch nothing, with the cloth's thickness; in m, relative to the cloth's
    /// frame at the start of the tick. None for a lane without a cloth. By this box a host finds the colliders that a
    /// cloth may touch.
    #[must_use]
    pub fn swept_bounds(&self, tick: f32) -> Vec<Option<Aabb>> {
        with_batch!(&self.0, batch => batch.swept_bounds(tick))
    }

    /// The colliders that a lane's cloth could touch in the last tick.
    pub fn near_colliders(&self, lane: usize) -> impl Iterator<Item = &Collider> {
        let cloth = with_batch!(&self.0, batch => batch.lanes[lane].as_ref());
        let near = cloth.into_iter().flat_map(|cloth| cloth.colliders.iter().zip(&cloth.contacts));
        near.filter(|(_, candidates)| !candidates.is_empty()).map(|(collider, _)| collider)
    }

    /// The particles of a lane's cloth that touch colliders at the end of the last tick, and where the cloth touched itself in
    /// its last substep, in the cloth's frame. They are computed by this call. Those of a cloth with itself and with others
    /// are known to the [`ClothGroup`](crate::ClothGroup) that solved them.
    #[must_use]
    pub fn contact_points(&self, lane: usize) -> Vec<ContactPoint> {
        with_batch!(&self.0, batch => batch.contact_points(lane))
    }

    /// Load of the colliders that pressed a lane's cloth in the last tick, for [`Loads::contacts`](crate::Loads::contacts):
    /// κ p l/L, with p the acceleration by which they steadily pressed its particles where they pressed most (the mean over
    /// contacts, weighted by squares), l the length of the shortest link and L the cloth's length (`step/loads.rs`), or that of colliders that
    /// come near, if it is larger, m/s²; zero for an empty lane.
    #[must_use]
    pub fn contact_load(&self, lane: usize) -> f32 {
        with_batch!(&self.0, batch => {
            batch.lanes[lane].as_ref().map_or(0.0, |state| batch.contact_load(lane, state))
        })
    }

    /// Load of the pins of a lane's cloth, for [`Loads::tension`](crate::Loads::tension), as of the last tick, see
    /// [`Loads::of_pins`](crate::Loads::of_pins), or of the [pressure](Self::set_pressure) inside it, if that is greater, m/s²; zero for an
    /// empty lane.
    #[must_use]
    pub fn tension_load(&self, lane: usize) -> f32 {
        with_batch!(&self.0, batch => {
            batch.lanes[lane].as_ref().map_or(0.0, |state| batch.tension_load(lane, state))
        })
    }

    /// What a lane's cloth did in the last tick to each collider that [`reports_as`](Collider::reports_as) a number, in
    /// the order of the colliders.
    pub fn reactions(&self, lane: usize) -> impl Iterator<Item = ContactReaction> {
        let cloth = with_batch!(&self.0, batch => batch.lanes[lane].as_ref());
        let areas = self.fabric().particle_areas();
        let sums = cloth.into_iter().flat_map(|cloth| cloth.colliders.iter().zip(&cloth.reactions));
        sums.filter_map(|(collider, sum)| {
            Some(sum.total(collider.reports_as?, collider.to.1, areas))
        })
    }
}
