//! Substeps by need, as the plugin chooses them for each cloth.

use bunting_solver::{
    ClothBatch, Drive, Effort, Fabric, FabricMaterial, FrameMotion, Loads, StepLimits, StepSettings,
};
use glam::Vec3;

/// Chooses the substeps of one cloth tick by tick, from its frame's motion in the tick and from air, motion, tension and
/// contacts in the tick before.
#[derive(Clone, Debug, Default)]
pub struct Need {
    limits: StepLimits,
    effort: Effort,
    loads: Loads,
    /// Motion of the frame in the tick before.
    frame: FrameMotion,
    /// Numbers of ticks and of substeps so far, and most substeps in a tick.
    spent: [u32; 3],
}

impl Need {
    /// Within these limits.
    #[must_use]
    pub fn within(limits: StepLimits) -> Self {
        Self { limits, ..Self::default() }
    }

    /// The same for a cloth that begins with its particles at these positions, m.
    #[must_use]
    pub fn beginning_at(
        self,
        fabric: &Fabric,
        material: &FabricMaterial,
        positions: &[Vec3],
    ) -> Self {
        let tension = Loads::of_pins(fabric, material, positions);
        Self { loads: Loads { tension, ..self.loads }, ..self }
    }

    /// Settings for a tick of `tick` seconds.
    pub fn settings(&mut self, fabric: &Fabric, drive: &Drive, tick: f32) -> StepSettings {
        self.loads.frame = Loads::of_frame(&self.frame, &drive.motion, fabric, tick);
        let class = self.effort.update(&self.loads, tick);
        let acceleration = class.acceleration(drive.gravity.length());
        let settings = self.limits.of_fabric(fabric, tick, acceleration);
        let [ticks, sum, most] = &mut self.spent;
        *ticks += 1;
        *sum += settings.substeps;
        *most = settings.substeps.max(*most);
        settings
    }

    /// Notes what acted on the cloth in a batch's first lane in that tick, and how its positions (m) have changed.
    pub fn note(
        &mut self,
        batch: &ClothBatch,
        material: &FabricMaterial,
        drive: &Drive,
        [before, after]: [&[Vec3]; 2],
        tick: f32,
    ) {
        self.frame = drive.motion;
        self.loads.air = Loads::of_air(batch.fabric(), drive, material, tick);
        self.loads.motion = Loads::of_motion(batch.fabric(), before, after, tick);
        self.loads.tension = batch.tension_load(0);
        self.loads.contacts = batch.contact_load(0);
    }

    /// Mean number of substeps in a tick.
    #[must_use]
    pub fn mean_substeps(&self) -> f64 {
        f64::from(self.spent[1]) / f64::from(self.spent[0].max(1))
    }

    /// Most substeps in a tick.
    #[must_use]
    pub fn most_substeps(&self) -> u32 {
        self.spent[2]
    }
}
