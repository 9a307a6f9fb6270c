//! Access to a cloth's particles within a substep, for forces and constraints of the user.

use core::ops::{Deref, DerefMut};

use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_math::{Isometry3d, Vec3};
use bunting_solver::ParticlesMut;

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::lod::rest_timer::RestTimer;
use crate::motion::growth::SizedFrame;
use crate::motion::pose::PoseHistory;

/// The particles of cloths in a substep: a system parameter for systems in
/// [`ClothSubstepSystems::UserForces`](crate::ClothSubstepSystems::UserForces) and
/// [`ClothSubstepSystems::UserConstraints`](crate::ClothSubstepSystems::UserConstraints).
///
/// ```
/// # use bevy_app::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::Vec3;
/// use bevy_bunting::prelude::*;
/// use bevy_bunting::{ClothParticles, ClothSubstep, ClothSubstepSystems};
///
/// /// A lift of 2 m/s² on each particle below the plane y = 0 of the world.
/// fn lift(mut particles: ClothParticles, cloths: Query<Entity, With<ClothMesh>>) {
///     for entity in &cloths {
///         let Some(mut cloth) = particles.get_mut(entity) else { continue };
///         for particle in 0..cloth.count() {
///             if cloth.to_world(cloth.position(particle)).y < 0.0 {
///                 let acceleration = cloth.direction_to_local(2.0 * Vec3::Y);
///                 cloth.add_acceleration(particle, acceleration);
///             }
///         }
///     }
/// }
///
/// # let mut app = App::new();
/// # app.add_plugins(ClothPlugins::default());
/// app.add_systems(ClothSubstep, lift.in_set(ClothSubstepSystems::UserForces));
/// ```
///
/// Several such systems access the same particles, and must be ordered against one another.
///
/// Without a system with this parameter, cloths are solved batch by batch, each in the processor's cache;
/// with one, each phase of a substep passes over all batches.
#[derive(SystemParam)]
pub struct ClothParticles<'w, 's> {
    batches: ResMut<'w, ClothBatches>,
    cloths: Query<'w, 's, (&'static ClothInstance, &'static PoseHistory, &'static mut RestTimer)>,
}

impl ClothParticles<'_, '_> {
    /// The particles of a cloth in the current substep.
    ///
    /// None if the cloth does not take part in this substep: cloths at coarse levels have fewer substeps in a
    /// tick than cloths at fine levels, and take part in only some of them. Also none if the cloth is paused,
    /// asleep or invalid, and outside of the sets from [`Integrate`](crate::ClothSubstepSystems::Integrate)
    /// to [`UpdateVelocities`](crate::ClothSubstepSystems::UpdateVelocities).
    pub fn get_mut(&mut self, cloth: Entity) -> Option<SubstepParticles<'_>> {
        let (instance, history, rest_timer) = self.cloths.get_mut(cloth).ok()?;
        let (particles, fraction) = self.batches.particles_mut(instance.lane()?)?;
        let frame = frame_at(history, fraction);
        let frame = SizedFrame { pose: frame, size: instance.growth.end() };
        Some(SubstepParticles { particles, frame, rest_timer })
    }
}

/// Frame of a cloth at a fraction of the tick: as in the solver, it turns at a constant rate about a fixed
/// axis while its origin moves along a straight line.
fn frame_at(history: &PoseHistory, fraction: f32) -> Isometry3d {
    let (start, end) = (history.start(), history.end());
    if start == end {
        return end;
    }
    let translation = start.translation.lerp(end.translation, fraction);
    Isometry3d::new(translation, start.rotation.slerp(end.rotation, fraction).normalize())
}

/// The particles of one cloth in a substep, with the methods of [`ParticlesMut`]. They read positions (m),
/// velocities (m/s) and inverse masses (1/kg), and write accelerations (m/s²), impulses and corrections of
/// positions. Coordinates are those of the cloth's frame in this substep; velocities are relative to the
/// world, along the axes of the frame.
///
/// Of cloth that has [grown](Self::scale) all lengths are in units of the frame, and masses are those of the fabric: a force on it
/// is divided by the third power of the scale. [`to_world`](Self::to_world), [`direction_to_local`](Self::direction_to_local) and
/// their opposites do so with points, velocities and accelerations.
///
/// Particles are numbered as in [`ClothState::fabric`](crate::ClothState::fabric). A cloth does not fall asleep
/// in a tick in which its particles are written.
#[derive(Debug)]
pub struct SubstepParticles<'a> {
    particles: ParticlesMut<'a>,
    frame: SizedFrame,
    rest_timer: Mut<'a, RestTimer>,
}

impl SubstepParticles<'_> {
    /// Pose of the cloth's frame in the world (m) at the end of this substep.
    #[must_use]
    pub fn frame(&self) -> Isometry3d {
        self.frame.pose
    }

    /// Metres in a unit of positions, see [`ClothState::scale`](crate::ClothState::scale).
    #[must_use]
    pub fn scale(&self) -> f32 {
        self.frame.size
    }

    /// Transforms a point (m) from the cloth's frame to the world.
    #[must_use]
    pub fn to_world(&self, point: Vec3) -> Vec3 {
        self.frame.to_world(point)
    }

    /// Transforms a point (m) from the world to the cloth's frame.
    #[must_use]
    pub fn to_local(&self, point: Vec3) -> Vec3 {
        self.frame.to_local(point)
    }

    /// Transforms a direction, such as a velocity, from the cloth's frame to the world.
    #[must_use]
    pub fn direction_to_world(&self, direction: Vec3) -> Vec3 {
        self.frame.pose.rotation * (self.frame.size * direction)
    }

    /// Transforms a direction, such as an acceleration, from the world to the cloth's frame.
    #[must_use]
    pub fn direction_to_local(&self, direction: Vec3) -> Vec3 {
        self.frame.pose.rotation.inverse() * direction / self.frame.size
    }
}

impl<'a> Deref for SubstepParticles<'a> {
    type Target = ParticlesMut<'a>;

    fn deref(&self) -> &ParticlesMut<'a> {
        &self.particles
    }
}

impl<'a> DerefMut for SubstepParticles<'a> {
    fn deref_mut(&mut self) -> &mut ParticlesMut<'a> {
        self.rest_timer.ticks = 0;
        &mut self.particles
    }
}
