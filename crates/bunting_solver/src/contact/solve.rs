//! Contacts: particles and triangles keep their clearance from colliders, and slide along them with friction.

use glam::Vec3;
use parry3d::math::Pose;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::constants::LEAST_CLEARANCE;
use crate::contact::candidates::Candidates;
use crate::contact::collider::Collider;
use crate::contact::ground::RISE_SPEED;
use crate::contact::obstacle::Obstacle;
use crate::contact::pressing::Pressing;
use crate::contact::reach::Reach;
use crate::contact::reaction::ReactionSum;
use crate::contact::surface::{Projection, Surface};
use crate::contact::sweep::{Corner, solve_triangles};
use crate::contact::touch::Touch;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};
use crate::step::clock::Clock;
use crate::step::frame::FrameStep;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Projects every candidate of contacts with colliders once (particles, then triangles), and keeps layers of each
    /// cloth apart that has contacts with itself.
    pub fn solve_contacts(&mut self) {
        for cloth in 0..self.lanes.len() {
            // The lane's state is taken out, so that the particles of the batch can be written.
            let touches = |state: &mut LaneState| {
                (!state.colliders.is_empty() || state.self_contacts.is_some()) && !state.is_grouped
            };
            if let Some(mut state) = self.lanes[cloth].take_if(touches) {
                match state.self_contacts.take() {
                    Some(mut contacts) => {
                        self.solve_layers(cloth, &mut state, &mut contacts);
                        state.self_contacts = Some(contacts);
                    }
                    None => self.solve_colliders(cloth, &mut state),
                }
                self.lanes[cloth] = Some(state);
            }
        }
    }

    /// Projects every candidate of a cloth's contacts with colliders once.
    pub(in crate::contact) fn solve_colliders(&mut self, cloth: usize, state: &mut LaneState) {
        let mut reactions = core::mem::take(&mut state.reactions);
        let mut sums = reactions.iter_mut();
        for (collider, candidates) in state.colliders.iter().zip(&state.contacts) {
            let reaction = sums.next().filter(|_| collider.reports_as.is_some());
            let mut outcome = Outcome { moment: 0.0, pressing: state.pressing, reaction };
            self.solve_candidates(cloth, state, (collider, candidates), &mut outcome);
            state.external_moment += outcome.moment;
            state.pressing = outcome.pressing;
        }
        state.reactions = reactions;
    }

    /// Projects everything that may touch one collider.
    fn solve_candidates(
        &mut self,
        cloth: usize,
        state: &LaneState,
        (collider, candidates): (&Collider, &Candidates),
        outcome: &mut Outcome,
    ) {
        if let Some(reaction) = &mut outcome.reaction {
            reaction.begin_substep();
        }
        if candidates.is_empty() {
            return;
        }
        let contact = Contact::new(state, collider, &self.clock);
        let mut pushes = Vec::new();
        for &particle in &candidates.particles {
            pushes.extend(self.solve_contact(cloth, particle, &contact));
        }
        if !candidates.triangles.is_empty() {
            self.solve_triangle_contacts(cloth, candidates, &contact, &mut pushes);
        }
        self.take_back_tearing(cloth, &contact, &mut pushes);
        for push in &pushes {
            self.change_velocity(cloth, &contact, push, outcome);
        }
    }

    /// Projects one particle, and returns the push if there is one.
    fn solve_contact(&mut self, cloth: usize, particle: u32, contact: &Contact) -> Option<Push> {
        let (pack, lane) = self.layout.locate(particle as usize, cloth);
        let start = lane3(&self.scratch[pack], lane);
        let before = lane3(&self.positions.packs()[pack], lane);
        let Projection { to, normal, sticks } = contact.project(start, before)?;
        let after = contact.pose.transform_point(to);
        set_lane3(&mut self.positions.packs_mut()[pack], lane, after);
        Some(Push { particle, before, to, touch: Touch { normal, at: to, sticks } })
    }

    /// Projects triangles, and adds what pushes their corners to the pushes of particles, which are in ascending order.
    fn solve_triangle_contacts(
        &mut self,
        cloth: usize,
        candidates: &Candidates,
        contact: &Contact,
        pushes: &mut Vec<Push>,
    ) {
        let corner_of = |&particle: &u32| {
            let (start, end) = (self.start_of(cloth, particle), self.position_of(cloth, particle));
            let (from, to) = contact.path(start, end);
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            let inverse_mass = self.masses.inverse[pack].lanes()[lane];
            Corner::new(inverse_mass, from, to)
        };
        let mut corners: Vec<Corner> = candidates.corners.iter().map(corner_of).collect();
        contact.solve_triangles(&candidates.triangles, &mut corners);
        let of_particles = pushes.len();
        for (&particle, corner) in candidates.corners.iter().zip(&corners) {
            let Some(touch) = corner.touch else { continue };
            let after = contact.pose.transform_point(corner.to);
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            let position = &mut self.positions.packs_mut()[pack];
            let before = lane3(position, lane);
            set_lane3(position, lane, after);
            let push = Push { particle, before, to: corner.to, touch };
            match pushes[..of_particles].binary_search_by_key(&particle, |push| push.particle) {
                Ok(known) => pushes[known].append(push),
                Err(_) => pushes.push(push),
            }
        }
    }

    /// Changes the velocity of a particle that a collider has pushed. What the particle and its triangles were pushed
    /// counts as one push: a particle that is put down on the surface and is then raised by a triangle would be left with
    /// a velocity, though it does not move.
    fn change_velocity(
        &mut self,
        cloth: usize,
        contact: &Contact,
        push: &Push,
        outcome: &mut Outcome,
    ) {
        let (pack, lane) = self.layout.locate(push.particle as usize, cloth);
        let effective_step = self.parameters.step.lanes()[lane];
        let start = lane3(&self.scratch[pack], lane);
        let (before, after) = (push.before, contact.end(push));
        let Touch { at, sticks, .. } = push.touch;
        let normal = contact.pose.rotation * push.touch.normal;

        // A surface pushes a particle but does not throw it off: the velocity away from the surface that the
        // contact gave to it is removed. A particle that sticks has the velocity of the surface.
        let of_surface = contact.surface_motion(at) / self.clock.step;
        let predicted = start + lane3(&self.displacement[pack], lane);
        let velocity = lane3(&self.velocity[pack], lane);
        let given = (after - before) / effective_step;
        let leaving = velocity + (after - predicted) / effective_step - of_surface;
        let thrown = if sticks {
            leaving
        } else {
            leaving.dot(normal).min(given.dot(normal)).max(0.0) * normal
        };
        set_lane3(&mut self.velocity[pack], lane, velocity - thrown);

        // An impact must not be extrapolated, so the velocities of the last substeps change by the same
        // amount. A steady pressure is extrapolated, since it continues.
        let approach = of_surface - lane3(&self.older_velocity[pack], lane);
        let impact = if sticks {
            approach
        } else {
            approach.dot(normal).min((given - thrown).dot(normal)).max(0.0) * normal
        };
        for past in [&mut self.older_velocity[pack], &mut self.oldest_velocity[pack]] {
            let changed = lane3(past, lane) + impact;
            set_lane3(past, lane, changed);
        }
        let inertia = self.masses.inertia[pack].lanes()[lane];
        if let Some(pole) = self.pole_of(cloth) {
            outcome.moment += pole.gained(inertia, predicted, [before, after]);
        }
        let steady = given - thrown - impact;
        outcome.pressing.add(steady / effective_step);
        if let Some(reaction) = &mut outcome.reaction {
            // A steady force acts for the whole substep, of which the formula takes β; an impact changes the velocity
            // once.
            let steady = steady * (self.clock.step / effective_step);
            let gained = contact.density * inertia * (steady + impact);
            let on_collider = contact.pose.rotation.inverse() * -gained;
            reaction.add(push.particle as usize, at, on_collider);
        }
    }
}

/// The effects of a substep's contacts with one collider besides those on particles.
struct Outcome<'a> {
    /// Moment of the corrections about the pole, m⁴.
    moment: f32,
    /// How hard this collider and those before it press the cloth in this tick.
    pressing: Pressing,
    /// Reactions of the collider, if it reports them.
    reaction: Option<&'a mut ReactionSum>,
}

/// The push of a collider to a particle.
pub(super) struct Push {
    pub particle: u32,
    /// Position of the particle before the push, m, in the cloth's frame.
    pub before: Vec3,
    /// New position of the particle, m, in the collider's frame.
    pub to: Vec3,
    touch: Touch,
}

impl Push {
    /// Adds a push of triangles that has moved the particle on. The normal stays that of the surface nearest to the particle.
    fn append(&mut self, next: Self) {
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
    pose: Pose,
    /// Motion of the cloth's frame in the substep.
    frame: FrameStep,
}

impl<'a> Contact<'a> {
    pub fn new(cloth: &LaneState, collider: &'a Collider, clock: &Clock) -> Self {
        let Clock { settings, begun, .. } = *clock;
        // `integrate` has counted this substep already.
        let index = begun - 1;
        let pose_after =
            |substeps: u32| collider.pose_at(substeps as f32 / settings.substeps as f32);
        let (old_pose, pose) = (pose_after(index), pose_after(begun));
        let frame = cloth.drive.motion.substep(index, settings.substeps);
        let clearance = (cloth.material.thickness + collider.margin).max(LEAST_CLEARANCE);
        Self {
            collider,
            thickness: cloth.material.thickness,
            density: cloth.material.area_density,
            surface: Surface {
                shape: &*collider.shape.0,
                ground: collider.shape.as_heightfield(),
                rise: RISE_SPEED * clock.step,
                clearance,
                friction: (cloth.material.surface_friction * collider.friction).sqrt(),
            },
            reach: Reach::new(collider, [&old_pose, &pose], &frame, clearance),
            old_pose,
            pose,
            frame,
        }
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
    fn path(&self, start: Vec3, end: Vec3) -> (Vec3, Vec3) {
        let from = self.old_pose.inverse_transform_point(self.frame.to_old(start));
        (from, self.pose.inverse_transform_point(end))
    }

    /// Projects a particle that moves between two points in the cloth's frame, m.
    fn project(&self, start: Vec3, end: Vec3) -> Option<Projection> {
        if self.reach.is_missed(start, end) {
            return None;
        }
        let (from, to) = self.path(start, end);
        self.surface.project(from, to)
    }

    /// Projects triangles, given as indices of corners.
    fn solve_triangles(&self, triangles: &[[u32; 3]], corners: &mut [Corner]) {
        let obstacle = Obstacle::new(self.collider, self.thickness);
        solve_triangles(&obstacle, self.surface.friction, triangles, corners);
    }

    /// Position of a particle after a push, m, in the cloth's frame.
    pub fn end(&self, push: &Push) -> Vec3 {
        self.pose.transform_point(push.to)
    }

    /// Motion of a point of the collider in the substep, m, in the cloth's present frame.
    pub fn surface_motion(&self, point: Vec3) -> Vec3 {
        let before = self.frame.to_new(self.old_pose.transform_point(point));
        self.pose.transform_point(point) - before
    }
}
