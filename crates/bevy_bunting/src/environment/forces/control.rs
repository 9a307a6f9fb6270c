//! Positions and velocities of single particles, set between ticks.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Isometry3d, Vec3};
use bunting_solver::{ClothSnapshot, Fabric};

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::lod::rest_timer::RestTimer;
use crate::motion::growth::SizedFrame;
use crate::motion::pose::PoseHistory;

/// Reason why particles cannot be moved. The cloth is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ControlError {
    /// The entity is no cloth, or the cloth is not simulated: it is new, invalid, or simulated in advance.
    #[error("cloth {entity} is not simulated")]
    NotSimulated {
        /// The entity.
        entity: Entity,
    },
    /// A substep is going on: use [`ClothParticles`](crate::ClothParticles) there.
    #[error("cloth {entity} is in a substep: use ClothParticles there")]
    InSubstep {
        /// The cloth.
        entity: Entity,
    },
    /// There is no such particle at the cloth's level of detail.
    #[error("cloth {entity} has no particle {particle}: it has {count}")]
    NoParticle {
        /// The cloth.
        entity: Entity,
        /// Index of the particle.
        particle: usize,
        /// Number of particles at the present level.
        count: usize,
    },
    /// A position or velocity is not finite.
    #[error("the position or velocity of particle {particle} of cloth {entity} is not finite")]
    NotFinite {
        /// The cloth.
        entity: Entity,
        /// Index of the particle.
        particle: usize,
    },
}

/// Control over the positions and velocities of particles between ticks: a system parameter for systems in any schedule but
/// [`ClothSubstep`](crate::ClothSubstep). The integrator goes on without a jolt: a particle that is moved keeps its
/// velocity, and a velocity that is given is not extrapolated. Constraints act on the result in the next tick.
///
/// ```
/// # use bevy_app::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::Vec3;
/// use bevy_bunting::prelude::*;
///
/// /// Kicks the middle of each cloth upwards.
/// fn kick(mut control: ClothControl, cloths: Query<Entity, With<ClothMesh>>) {
///     for entity in &cloths {
///         let kicked = control.edit(entity, |cloth| {
///             let up = cloth.direction_to_local(3.0 * Vec3::Y);
///             cloth.add_velocity(cloth.count() / 2, up)
///         });
///         if let Err(error) = kicked {
///             println!("{error}");
///         }
///     }
/// }
/// # let mut app = App::new();
/// # app.add_plugins(ClothPlugins::default()).add_systems(Update, kick);
/// ```
#[derive(SystemParam)]
pub struct ClothControl<'w, 's> {
    batches: ResMut<'w, ClothBatches>,
    cloths:
        Query<'w, 's, (&'static mut ClothInstance, &'static PoseHistory, &'static mut RestTimer)>,
}

impl ClothControl<'_, '_> {
    /// Changes particles of a cloth, and wakes it if it sleeps at rest. If `edit` returns an error, nothing is changed.
    ///
    /// # Errors
    ///
    /// The cloth is not simulated or in a substep, or `edit` returns an error.
    pub fn edit<R>(
        &mut self,
        entity: Entity,
        edit: impl FnOnce(&mut ControlledCloth) -> Result<R, ControlError>,
    ) -> Result<R, ControlError> {
        let not_simulated = ControlError::NotSimulated { entity };
        let (mut instance, history, mut timer) =
            self.cloths.get_mut(entity).map_err(|_| not_simulated)?;
        if instance.lane().is_some_and(|lane| self.batches.particles_mut(lane).is_some()) {
            return Err(ControlError::InSubstep { entity });
        }
        let fabric = instance.fabric().cloned().ok_or(not_simulated)?;
        let state = instance.state(&self.batches).ok_or(not_simulated)?;
        let mut cloth = ControlledCloth {
            entity,
            fabric,
            state,
            frame: SizedFrame { pose: history.end(), size: instance.growth.end() },
        };
        let result = edit(&mut cloth)?;
        instance.set_state(cloth.state, &mut self.batches);
        timer.restart();
        Ok(result)
    }
}

/// The particles of one cloth between ticks. Positions are in the cloth's frame, whose units are longer or shorter than metres
/// where the cloth has [grown](Self::scale); velocities are relative to the world, along
/// the axes of the frame. Particles are numbered as in [`ClothState::fabric`](crate::ClothState::fabric). Pinned particles
/// cannot be moved: values given to them are ignored.
#[derive(Debug)]
pub struct ControlledCloth {
    entity: Entity,
    fabric: Arc<Fabric>,
    state: ClothSnapshot,
    frame: SizedFrame,
}

impl ControlledCloth {
    /// Number of particles.
    #[must_use]
    pub fn count(&self) -> usize {
        self.fabric.particle_count()
    }

    /// The fabric at the cloth's present level.
    #[must_use]
    pub fn fabric(&self) -> &Fabric {
        &self.fabric
    }

    /// Pose of the cloth's frame in the world (m) at the end of the last tick.
    #[must_use]
    pub fn frame(&self) -> Isometry3d {
        self.frame.pose
    }

    /// Metres in a unit of positions, see [`ClothState::scale`](crate::ClothState::scale).
    #[must_use]
    pub fn scale(&self) -> f32 {
        self.frame.size
    }

    /// Transforms a point from the cloth's frame to the world, m.
    #[must_use]
    pub fn to_world(&self, point: Vec3) -> Vec3 {
        self.frame.to_world(point)
    }

    /// Transforms a point (m) from the world to the cloth's frame.
    #[must_use]
    pub fn to_local(&self, point: Vec3) -> Vec3 {
        self.frame.to_local(point)
    }

    /// Rotates a direction, such as a velocity, from the world to the cloth's frame.
    #[must_use]
    pub fn direction_to_local(&self, direction: Vec3) -> Vec3 {
        self.frame.pose.rotation.inverse() * direction
    }

    /// Position of a particle, m.
    ///
    /// # Errors
    ///
    /// There is no such particle.
    pub fn position(&self, particle: usize) -> Result<Vec3, ControlError> {
        self.check(particle, Vec3::ZERO)?;
        Ok(self.state.positions[particle])
    }

    /// Velocity of a particle relative to the world, m/s.
    ///
    /// # Errors
    ///
    /// There is no such particle.
    pub fn velocity(&self, particle: usize) -> Result<Vec3, ControlError> {
        self.check(particle, Vec3::ZERO)?;
        Ok(self.frame.size * self.state.velocities[particle])
    }

    /// Moves a particle to a position, m. It keeps its velocity.
    ///
    /// # Errors
    ///
    /// There is no such particle, or the position is not finite.
    pub fn set_position(&mut self, particle: usize, position: Vec3) -> Result<(), ControlError> {
        self.check(particle, position)?;
        if !self.fabric.is_pinned(particle) {
            self.state.positions[particle] = position;
        }
        Ok(())
    }

    /// Moves a particle by a displacement, m. It keeps its velocity.
    ///
    /// # Errors
    ///
    /// There is no such particle, or the position is not finite.
    pub fn move_by(&mut self, particle: usize, displacement: Vec3) -> Result<(), ControlError> {
        let position = self.position(particle)? + displacement;
        self.set_position(particle, position)
    }

    /// Sets the velocity of a particle relative to the world, m/s.
    ///
    /// # Errors
    ///
    /// There is no such particle, or the velocity is not finite.
    pub fn set_velocity(&mut self, particle: usize, velocity: Vec3) -> Result<(), ControlError> {
        let change = velocity - self.velocity(particle)?;
        self.add_velocity(particle, change)
    }

    /// Changes the velocity of a particle by an impulse, m/s.
    ///
    /// # Errors
    ///
    /// There is no such particle, or the velocity is not finite.
    pub fn add_velocity(&mut self, particle: usize, change: Vec3) -> Result<(), ControlError> {
        self.check(particle, self.velocity(particle)? + change)?;
        if !self.fabric.is_pinned(particle) {
            self.state.add_velocity(particle, change / self.frame.size);
        }
        Ok(())
    }

    fn check(&self, particle: usize, value: Vec3) -> Result<(), ControlError> {
        let (entity, count) = (self.entity, self.count());
        if particle >= count {
            Err(ControlError::NoParticle { entity, particle, count })
        } else if !value.is_finite() {
            Err(ControlError::NotFinite { entity, particle })
        } else {
            Ok(())
        }
    }
}
