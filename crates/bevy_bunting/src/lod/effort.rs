//! The effort of each cloth: its substeps follow from the loads that act on it now.

use bevy_ecs::prelude::*;
use bunting_solver::{
    Effort, EffortCause, EffortClass, FrameMotion, LaneSurface, Loads, StepSettings,
};

use crate::cloth::instance::ClothInstance;
use crate::motion::inertia::ClothInertia;
use crate::motion::pose::PoseHistory;

/// The substeps of a cloth, and the reason for them; read only.
///
/// A cloth takes more substeps than its weight needs while strong wind, an acceleration of its frame, its own motion, pins that
/// draw it out or colliders that it is pulled against need them, within [`ClothSettings::steps`](crate::ClothSettings::steps). It gets
/// more at once, and fewer after half a second. It may take more than it needs, to share a batch with cloths that need
/// more, see [`ClothSettings::share_batches`](crate::ClothSettings::share_batches).
#[derive(Component, Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct ClothEffort {
    effort: Effort,
    loads: Loads,
    /// Motion of the frame in the last tick.
    motion: FrameMotion,
    /// Acceleration of the cloth's own in the last tick, m/s².
    acceleration: f32,
    /// What the cloth feels of its frame's acceleration.
    inertia: ClothInertia,
    /// Those that it needs by itself.
    pub(crate) needed: StepSettings,
    /// Those that it takes.
    pub(crate) settings: StepSettings,
}

impl ClothEffort {
    /// Substeps and passes of the cloth in a tick, as of the last tick in which it was simulated.
    #[must_use]
    pub fn settings(&self) -> StepSettings {
        self.settings
    }

    /// Substeps and passes that the cloth needs by itself; it takes at least as many.
    #[must_use]
    pub fn needed(&self) -> StepSettings {
        self.needed
    }

    /// The reason for the number of substeps that the cloth needs.
    #[must_use]
    pub fn cause(&self) -> EffortCause {
        self.effort.cause()
    }

    /// The class of effort.
    #[must_use]
    pub fn class(&self) -> EffortClass {
        self.effort.class()
    }

    /// Accelerations from which the class follows.
    #[must_use]
    pub fn loads(&self) -> Loads {
        self.loads
    }

    /// Chooses the class for a tick of `tick` seconds, from the frame's motion in this tick and from air and motion in
    /// the last. Returns whether the class has changed.
    pub(crate) fn update(
        &mut self,
        instance: &ClothInstance,
        frame: &PoseHistory,
        tick: f32,
    ) -> bool {
        // A cloth that begins drawn out must not wait for a tick that has shown it.
        if let (true, Some(fabric), Some(begun)) =
            (self.loads == Loads::default(), instance.fabric(), instance.snapshot())
        {
            let material = instance.acting_material();
            let tension = Loads::of_pins(fabric, &material, &begun.positions);
            self.loads.tension = instance.growth.end() * tension;
        }
        let of_frame = if frame.rests() && self.motion.is_none() {
            0.0
        } else {
            let Some(fabric) = instance.fabric() else { return false };
            let growth = &instance.growth;
            let [before, now] = [self.motion, frame.motion()].map(|motion| growth.motion(motion));
            growth.end() * growth.inertia(self.inertia).load(&before, &now, fabric, tick)
        };
        self.loads.frame = of_frame + self.acceleration;
        let before = self.effort.class();
        self.effort.update(&self.loads, tick) != before
    }

    /// Motion of the frame in the last tick.
    pub(crate) fn motion(&self) -> FrameMotion {
        self.motion
    }

    /// Notes the motion of the frame in this tick, the accelerations by air and of the cloth's own, m/s², and what the
    /// cloth feels of the frame's acceleration.
    pub(crate) fn note_drive(
        &mut self,
        motion: FrameMotion,
        air: f32,
        acceleration: f32,
        inertia: ClothInertia,
    ) {
        self.inertia = inertia;
        self.acceleration = acceleration;
        self.motion = motion;
        self.loads.air = air;
    }

    /// Notes the loads of turning links, of pins and of colliders in this tick, of a cloth whose units are `size` metres long.
    pub(crate) fn note_tick(&mut self, surface: &LaneSurface, size: f32) {
        self.loads.motion = size * surface.motion;
        self.loads.tension = size * surface.tension;
        self.loads.contacts = size * surface.contacts;
    }
}
