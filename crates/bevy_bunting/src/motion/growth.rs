//! Growth: a cloth that becomes larger or smaller while it is simulated, as much in each direction.
//!
//! Its fabrics stay as they are. All lengths that the solver and [`ClothState`](crate::ClothState) know are in units of the
//! cloth's frame, which are s metres long where the cloth is s times as large as its fabrics. A cloth of area density σ,
//! stretch stiffness k and bending stiffness B then has the kinetic energy s⁴ ½ σ u̇², the energy of stretch s² ½ k ε² and that of
//! bending ½ B κ², each per area of the fabric. Divided by s⁴, this is cloth of the fabric's size with k/s² and B/s⁴, under
//! accelerations and velocities of 1/s, in air that is s times as dense. A force is s³ times as large as in that cloth, a torque s⁴.
//!
//! Loads by which substeps are chosen are turned into m/s²; only the solver's threshold of cloth that is flung is one of the units.
//!
//! Growth itself moves nothing: particles stay where they are in the frame, and keep their velocities in the world.

use core::ops::RangeInclusive;

use bevy_math::{Affine3A, Isometry3d, Vec3};
use bunting_solver::{ClothSnapshot, Drive, FabricMaterial, FrameMotion, Pressure};
use parry3d::bounding_volume::Aabb;

use crate::motion::inertia::ClothInertia;

/// Part of the largest of three scales by which they may differ and count as one. Smaller: rounding in turned hierarchies counts
/// as a change of shape. Larger: cloth visibly has another shape than what it lies on.
const EVEN: f32 = 1e-3;

/// Part of itself by which a size may be another without a change. Smaller: rounding grows cloth. Larger: growth has steps.
const STEP: f32 = 1.0 / 8192.0;

/// Sizes that a cloth may have, in units of the size with which it was made. Wider: stiffnesses overflow.
const SIZES: RangeInclusive<f32> = 0.01..=100.0;

/// How many times as large as its fabrics a cloth is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Growth {
    /// At the start and at the end of the tick.
    span: [f32; 2],
    /// Scale of what the cloth follows with which it would be as large as its fabrics; none before these are sought.
    reference: Option<Vec3>,
    /// Whether a scale that the cloth cannot have was reported.
    is_reported: bool,
}

impl Default for Growth {
    fn default() -> Self {
        Self { span: [1.0; 2], reference: None, is_reported: false }
    }
}

impl Growth {
    /// The size at the start of the tick.
    pub fn start(&self) -> f32 {
        self.span[0]
    }

    /// The size at the end of the tick: metres in a unit of the cloth's frame.
    pub fn end(&self) -> f32 {
        self.span[1]
    }

    /// The size where what the cloth follows has a scale; none if it is another in different directions, mirrored, or out of
    /// range.
    pub fn size_with(&self, scale: Vec3) -> Option<f32> {
        let Some(reference) = self.reference else { return Some(self.end()) };
        if scale == reference {
            return Some(1.0);
        }
        let sizes = scale / reference;
        let (least, greatest) = (sizes.min_element(), sizes.max_element());
        // False where a number is NaN.
        let is_good = greatest - least <= EVEN * greatest && SIZES.contains(&least);
        if !is_good || !SIZES.contains(&greatest) {
            return None;
        }
        let size = sizes.element_sum() / 3.0;
        let is_near = |known: f32| (size - known).abs() < STEP * known;
        let known = [1.0, self.end()].into_iter().find(|&known| is_near(known));
        Some(known.unwrap_or(size))
    }

    /// The size that is shown where what the cloth follows has a scale now.
    pub fn present(&self, scale: Vec3) -> f32 {
        self.size_with(scale).unwrap_or(self.end())
    }

    /// The cloth keeps its size while what it follows has a scale: it follows something else.
    pub fn keep_with(&mut self, scale: Vec3) {
        self.reference = Some(scale / self.end());
    }

    /// The cloth is made anew, with a scale of what it follows.
    pub fn restart(&mut self, scale: Vec3) {
        *self = Self { reference: Some(scale), ..Self::default() };
    }

    /// Whether the scale with which the cloth has its fabrics' size is known.
    pub fn is_known(&self) -> bool {
        self.reference.is_some()
    }

    /// Gives the cloth the size that it has with a scale. Whether one that it cannot have is to be reported; it keeps its size.
    pub fn follow(&mut self, scale: Vec3) -> bool {
        let size = self.size_with(scale);
        self.span[1] = size.unwrap_or(self.end());
        let was_reported = core::mem::replace(&mut self.is_reported, size.is_none());
        size.is_none() && !was_reported
    }

    /// Ends the tick.
    pub fn settle(&mut self) {
        self.span[0] = self.span[1];
    }

    /// Changes a state at the start of the tick so that it keeps its velocities in the world.
    pub fn keep_velocities(&self, state: &mut ClothSnapshot) {
        state.scale_velocities(self.start() / self.end());
    }

    /// The material of cloth of the fabrics' size that moves like the cloth.
    pub fn material(&self, material: &FabricMaterial) -> FabricMaterial {
        let size = self.end();
        if size == 1.0 {
            return *material;
        }
        let squared = size * size;
        FabricMaterial {
            warp_stiffness: material.warp_stiffness / squared,
            weft_stiffness: material.weft_stiffness / squared,
            shear_stiffness: material.shear_stiffness / squared,
            bend_stiffness: material.bend_stiffness / (squared * squared),
            thickness: material.thickness / size,
            ..*material
        }
    }

    /// Air inside the cloth: a pressure p moves cloth of an area density σ by p/σ, whatever its size.
    pub fn pressure(&self, air: Pressure) -> Pressure {
        let size = self.end();
        match air {
            Pressure::Constant { pressure } => Pressure::Constant { pressure: pressure / size },
            Pressure::Sealed { pressure, ambient } => {
                Pressure::Sealed { pressure: pressure / size, ambient: ambient / size }
            }
            // It follows from the speed and the density of the air.
            air => air,
        }
    }

    /// What acts on the cloth (in m), in its units.
    pub fn drive(&self, drive: Drive) -> Drive {
        let size = self.end();
        if size == 1.0 {
            return drive;
        }
        Drive {
            motion: self.motion(drive.motion),
            gravity: drive.gravity / size,
            wind: drive.wind / size,
            air_density: drive.air_density * size,
        }
    }

    /// A motion of the frame (in m), in the cloth's units.
    pub fn motion(&self, motion: FrameMotion) -> FrameMotion {
        FrameMotion { translation: motion.translation / self.end(), ..motion }
    }

    /// Inertia with its limits (in m) in the cloth's units.
    pub fn inertia(&self, inertia: ClothInertia) -> ClothInertia {
        ClothInertia {
            max_speed: inertia.max_speed / self.end(),
            max_acceleration: inertia.max_acceleration / self.end(),
            ..inertia
        }
    }

    /// A place in the frame (m) at the start and at the end of the tick, in the cloth's units.
    pub fn places(&self, [start, end]: [Vec3; 2]) -> [Vec3; 2] {
        [start / self.start(), end / self.end()]
    }

    /// Factor of a force or an impulse in the cloth's units.
    pub fn force(&self) -> f32 {
        self.end() * self.end() * self.end()
    }

    /// Factor of a torque or an angular impulse in the cloth's units.
    pub fn torque(&self) -> f32 {
        self.force() * self.end()
    }

    /// A box in the frame at the start of the tick, in units of the cloth, in m.
    pub fn bounds(&self, bounds: &Aabb) -> Aabb {
        Aabb::new(bounds.mins * self.start(), bounds.maxs * self.start())
    }

    /// Matrices to the frame (m) at the start and at the end of the tick, in the cloth's units.
    pub fn matrices(&self, mut matrices: [Vec<Affine3A>; 2]) -> [Vec<Affine3A>; 2] {
        for (matrices, size) in matrices.iter_mut().zip(self.span) {
            shrink(matrices, size);
        }
        matrices
    }
}

/// Matrices to a frame (m), in the units of a cloth of a size.
pub(crate) fn shrink(matrices: &mut [Affine3A], size: f32) {
    if size != 1.0 {
        let by = Affine3A::from_scale(Vec3::splat(size.recip()));
        matrices.iter_mut().for_each(|matrix| *matrix = by * *matrix);
    }
}

/// A frame whose units are metres times the size of a cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SizedFrame {
    pub pose: Isometry3d,
    pub size: f32,
}

impl SizedFrame {
    /// A point of the frame in the world, m.
    pub fn to_world(self, point: Vec3) -> Vec3 {
        self.pose * (self.size * point)
    }

    /// A point in the world (m) in the frame.
    pub fn to_local(self, point: Vec3) -> Vec3 {
        self.pose.rotation.inverse() * (point - Vec3::from(self.pose.translation)) / self.size
    }
}
