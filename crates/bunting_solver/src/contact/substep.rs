//! A collider and a cloth in a substep, and what the collider pushes.

use core::cell::RefCell;

use glam::{Affine3A, Mat3, Vec3};
use parry3d::math::Pose;

use crate::contact::closed_form::ClosedForm;
use crate::contact::collider::Collider;
use crate::contact::ground::RISE_SPEED;
use crate::contact::obstacle::Obstacle;
use crate::contact::reach::Reach;
use crate::contact::surface::{Projection, Surface};
use crate::contact::sweep::{Corner, solve_triangles};
use crate::contact::touch::Touch;
use crate::contact::triangles::TriangleCells;
use crate::fabric::FabricMaterial;
use crate::step::Drive;
use crate::step::clock::Clock;
use crate::step::frame::FrameStep;

/// The push of a collider to a particle.
pub(super) struct Push {
    pub particle: u32,
    /// Position of the particle before the push, m, in the cloth's frame.
    pub before: Vec3,
    /// New position of the particle, m, in the collider's frame.
    pub to: Vec3,
    pub touch: Touch,
}

impl Push {
    /// Adds a push of triangles that has moved the particle on. The normal stays that of the surface nearest to the particle.
    pub fn append(&mut self, next: Self) {
        self.to = next.to;
        self.touch.sticks |= next.touch.sticks;
    }
}

/// A collider and a cloth in a substep.
pub(super) struct Contact<'a> {
    collider: &'a Collider,
    /// Thickness of the cloth, m.
    thickness: f32,
    /// Area density of the cloth, kg/m².
    density: f32,
    surface: Surface<'a>,
    reach: Reach,
    /// The collider's poses at the beginning and at the end of the substep, each in the cloth's frame as it
    /// was then.
    old_pose: Pose,
    pub pose: Pose,
    /// Motion of the cloth's frame in the substep.
    frame: FrameStep,
    /// Whether the collider rests in the cloth's frame, which rests, too.
    is_still: bool,
    /// The substep, counted from one.
    substep: u32,
}

impl<'a> Contact<'a> {
    pub fn new(
        material: &FabricMaterial,
        drive: &Drive,
        collider: &'a Collider,
        clock: &Clock,
    ) -> Self {
        let Clock { settings, begun, .. } = *clock;
        // `integrate` has counted this substep already.
        let index = begun - 1;
        let pose_after =
            |substeps: u32| collider.pose_at(substeps as f32 / settings.substeps as f32);
        let (old_pose, pose) = (pose_after(index), pose_after(begun));
        let frame = drive.motion.substep(index, settings.substeps);
        let clearance = collider.clearance(material.thickness);
        Self {
            collider,
            thickness: material.thickness,
            density: material.area_density,
            surface: Surface {
                shape: &*collider.shape.0,
                closed_form: ClosedForm::of(&*collider.shape.0),
                ground: collider.shape.as_heightfield(),
                cells: None,
                rise: RISE_SPEED * clock.step,
                carries: false,
                clearance,
                friction: (material.surface_friction * collider.friction).sqrt(),
            },
            reach: Reach::new(collider, [&old_pose, &pose], &frame, clearance),
            old_pose,
            pose,
            frame,
            is_still: collider.from == collider.to && !frame.moves,
            substep: begun,
        }
    }

    /// The shape's closed form, if it has one.
    pub fn closed_form(&self) -> Option<&ClosedForm<'a>> {
        self.surface.closed_form.as_ref()
    }

    /// Changes of coordinates from the cloth's frame into the collider's, at the start and at the end of the substep.
    pub fn to_collider(&self) -> &[Affine3A; 2] {
        self.reach.to_collider()
    }

    /// Change of coordinates from the collider's frame into the cloth's at the end of the substep.
    pub fn to_cloth(&self) -> Affine3A {
        Affine3A::from_rotation_translation(self.pose.rotation, self.pose.translation)
    }

    /// From a point in the collider's frame to its [motion](Self::surface_motion) in the substep.
    pub fn to_motion(&self) -> Affine3A {
        if self.is_still {
            return Affine3A::from_mat3_translation(Mat3::ZERO, Vec3::ZERO);
        }
        let image = |vector: Vec3| self.surface_motion(vector) - self.surface_motion(Vec3::ZERO);
        let axes = Mat3::from_cols(image(Vec3::X), image(Vec3::Y), image(Vec3::Z));
        Affine3A::from_mat3_translation(axes, self.surface_motion(Vec3::ZERO))
    }

    /// The substep, counted from one.
    pub fn substep(&self) -> u32 {
        self.substep
    }

    /// Least distance of particles from the shape, m.
    pub fn clearance(&self) -> f32 {
        self.surface.clearance
    }

    /// Coulomb friction coefficient.
    pub fn friction(&self) -> f32 {
        self.surface.friction
    }

    /// The contact of a shape that carries along what it hits, or does not.
    pub fn carrying(mut self, carries: bool) -> Self {
        self.surface.carries = carries;
        self
    }

    /// The contact of a shape whose triangles near the cloth are known.
    pub fn among(mut self, cells: Option<&'a mut TriangleCells>) -> Self {
        self.surface.cells = cells.map(RefCell::new);
        self
    }

    /// Way of the collider's origin in the substep, in the cloth's frame, m.
    pub fn way(&self) -> f32 {
        self.surface_motion(Vec3::ZERO).length()
    }

    /// The contact with a clearance that is larger by some distance, m.
    pub fn widened(mut self, by: f32) -> Self {
        self.surface.clearance += by;
        self
    }

    /// Whether a point of the cloth's frame, m, is within the shape at the end of the substep.
    pub fn contains(&self, at: Vec3) -> bool {
        self.surface.contains(self.pose.inverse_transform_point(at))
    }

    /// Normal of the surface, in the cloth's frame, near a point at the end of the substep, m; none beyond the clearance.
    pub fn normal_at(&self, at: Vec3) -> Option<Vec3> {
        let normal = self.surface.normal_at(self.pose.inverse_transform_point(at))?;
        Some(self.pose.transform_vector(normal))
    }

    /// Both ends of a particle's path between two points in the cloth's frame, in the collider's frame, m, so that the
    /// path is relative to the surface; the first end is taken before the cloth's frame moved.
    pub fn path(&self, start: Vec3, end: Vec3) -> (Vec3, Vec3) {
        let from = self.old_pose.inverse_transform_point(self.frame.to_old(start));
        (from, self.pose.inverse_transform_point(end))
    }

    /// Projects a particle that moves between two points in the cloth's frame, m.
    pub fn project(&self, start: Vec3, end: Vec3) -> Option<Projection> {
        let (from, to) = self.reach.path(start, end)?;
        self.surface.project(from, to)
    }

    /// Projects triangles, given as indices of corners.
    pub fn solve_triangles(&self, triangles: &[[u32; 3]], corners: &mut [Corner]) {
        let obstacle = Obstacle::new(self.collider, self.thickness);
        solve_triangles(&obstacle, self.surface.friction, triangles, corners);
    }

    /// Position of a particle after a push, m, in the cloth's frame.
    pub fn end(&self, push: &Push) -> Vec3 {
        self.pose.transform_point(push.to)
    }

    /// Impulse on the collider, N·s, in its frame, by a particle of an inertia, m², that gains a velocity, m/s, in the cloth's frame.
    pub fn impulse(&self, inertia: f32, gained: Vec3) -> Vec3 {
        self.pose.rotation.inverse() * -(self.density * inertia * gained)
    }

    /// Motion of a point of the collider in the substep, m, in the cloth's present frame.
    pub fn surface_motion(&self, point: Vec3) -> Vec3 {
        if self.is_still {
            return Vec3::ZERO;
        }
        let before = self.frame.to_new(self.old_pose.transform_point(point));
        self.pose.transform_point(point) - before
    }
}
