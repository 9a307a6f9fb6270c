//! Contacts: particles keep their clearance from colliders, and slide along them with friction.

use glam::Vec3;
use parry3d::math::Pose;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::constants::LEAST_CLEARANCE;
use crate::contact::collider::Collider;
use crate::contact::ground::RISE_SPEED;
use crate::contact::surface::{Projection, Surface};
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};
use crate::step::clock::Clock;
use crate::step::frame::FrameStep;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Projects every contact candidate once.
    pub fn solve_contacts(&mut self) {
        for cloth in 0..self.lanes.len() {
            // The lane's state is taken out, so that the particles of the batch can be written.
            let touches = |state: &mut LaneState| !state.colliders.is_empty();
            if let Some(mut state) = self.lanes[cloth].take_if(touches) {
                for (collider, candidates) in state.colliders.iter().zip(&state.contacts) {
                    let contact = Contact::new(&state, collider, &self.clock);
                    for &particle in candidates {
                        state.external_moment +=
                            self.solve_contact(cloth, particle as usize, &contact);
                    }
                }
                self.lanes[cloth] = Some(state);
            }
        }
    }

    /// Projects one particle. Returns the moment of the correction about the pole, m⁴.
    fn solve_contact(&mut self, cloth: usize, particle: usize, contact: &Contact) -> f32 {
        let (pack, lane) = self.layout.locate(particle, cloth);
        let effective_step = self.parameters.step.lanes()[lane];
        let position = &mut self.positions.packs_mut()[pack];
        let start = lane3(&self.scratch[pack], lane);
        let before = lane3(position, lane);
        let Some(Projection { to, normal }) = contact.project(start, before) else { return 0.0 };
        let after = contact.pose.transform_point(to);
        let normal = contact.pose.rotation * normal;
        set_lane3(position, lane, after);

        // A surface pushes a particle but does not throw it off: the velocity away from the surface that the
        // contact gave to it is removed.
        let of_surface = (after - contact.surface_point_before(to)) / self.clock.step;
        let predicted = start + lane3(&self.displacement[pack], lane);
        let velocity = lane3(&self.velocity[pack], lane);
        let given = (after - before) / effective_step;
        let leaving = velocity + (after - predicted) / effective_step - of_surface;
        let thrown = leaving.dot(normal).min(given.dot(normal)).max(0.0) * normal;
        set_lane3(&mut self.velocity[pack], lane, velocity - thrown);

        // An impact must not be extrapolated, so the velocities of the last substeps change by the same
        // amount. A steady pressure is extrapolated, since it continues.
        let arrived = lane3(&self.older_velocity[pack], lane);
        let approach = (of_surface - arrived).dot(normal);
        let impact = approach.min((given - thrown).dot(normal)).max(0.0) * normal;
        for past in [&mut self.older_velocity[pack], &mut self.oldest_velocity[pack]] {
            set_lane3(past, lane, lane3(past, lane) + impact);
        }
        self.fabric_of(cloth).pole.map_or(0.0, |pole| {
            let inertia = self.masses.inertia[pack].lanes()[lane];
            let moment = |at: Vec3| pole.moment(inertia, at, at - predicted);
            moment(after) - moment(before)
        })
    }
}

/// A collider and a cloth in a substep.
struct Contact<'a> {
    surface: Surface<'a>,
    /// The collider's poses at the beginning and at the end of the substep, each in the cloth's frame as it
    /// was then.
    old_pose: Pose,
    pose: Pose,
    /// Motion of the cloth's frame in the substep.
    frame: FrameStep,
}

impl<'a> Contact<'a> {
    fn new(cloth: &LaneState, collider: &'a Collider, clock: &Clock) -> Self {
        let Clock { settings, begun, .. } = *clock;
        // `integrate` has counted this substep already.
        let index = begun - 1;
        let pose_after =
            |substeps: u32| collider.pose_at(substeps as f32 / settings.substeps as f32);
        Self {
            surface: Surface {
                shape: &*collider.shape.0,
                ground: collider.shape.as_heightfield(),
                rise: RISE_SPEED * clock.step,
                clearance: (cloth.material.thickness + collider.margin).max(LEAST_CLEARANCE),
                friction: (cloth.material.surface_friction * collider.friction).sqrt(),
            },
            old_pose: pose_after(index),
            pose: pose_after(begun),
            frame: cloth.drive.motion.substep(index, settings.substeps),
        }
    }

    /// Projects a particle that moves between two points in the cloth's frame, m. Both ends of its path are
    /// transformed to the collider's frame, so that the path is relative to the surface; the first end is
    /// taken before the cloth's frame moved.
    fn project(&self, start: Vec3, end: Vec3) -> Option<Projection> {
        let from = self.old_pose.inverse_transform_point(self.frame.to_old(start));
        let to = self.pose.inverse_transform_point(end);
        self.surface.project(from, to)
    }

    /// Position of a point of the collider at the beginning of the substep, in the cloth's present frame, m.
    fn surface_point_before(&self, point: Vec3) -> Vec3 {
        self.frame.to_new(self.old_pose.transform_point(point))
    }
}
