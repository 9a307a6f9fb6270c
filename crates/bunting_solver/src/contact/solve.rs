//! Contacts: particles and triangles keep their clearance from colliders, and slide along them with friction.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::candidates::Candidates;
use crate::contact::pressing::Pressing;
use crate::contact::reaction::ReactionSum;
use crate::contact::substep::{Contact, Push};
use crate::contact::surface::Projection;
use crate::contact::sweep::Corner;
use crate::contact::touch::Touch;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Projects every candidate of contacts with colliders once (particles, then triangles), and keeps layers of each
    /// cloth apart that has contacts with itself.
    pub fn solve_contacts(&mut self) {
        self.take_back_all_pushed();
        self.solve_sets();
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
                    None => self.solve_colliders_where(cloth, &mut state, |it| !it.is_in_lanes),
                }
                self.lanes[cloth] = Some(state);
            }
        }
    }

    /// Projects every candidate of a cloth's contacts with colliders once.
    pub(in crate::contact) fn solve_colliders(&mut self, cloth: usize, state: &mut LaneState) {
        self.solve_colliders_where(cloth, state, |_| true);
    }

    /// Projects every candidate of a cloth's contacts with some colliders once.
    fn solve_colliders_where(
        &mut self,
        cloth: usize,
        state: &mut LaneState,
        is_solved: impl Fn(&Candidates) -> bool,
    ) {
        let mut contacts = core::mem::take(&mut state.contacts);
        for (collider, candidates) in contacts.iter_mut().enumerate() {
            if !is_solved(candidates) {
                continue;
            }
            self.solve_collider(
                cloth,
                state,
                (collider, candidates),
                |batch, contact, particles| {
                    let pushes = particles
                        .iter()
                        .map(|&particle| batch.solve_contact(cloth, particle, contact));
                    pushes.flatten().collect()
                },
            );
        }
        state.contacts = contacts;
    }

    /// Projects everything that may touch a collider, given its index and a function that projects particles.
    pub(super) fn solve_collider(
        &mut self,
        cloth: usize,
        state: &mut LaneState,
        (index, candidates): (usize, &mut Candidates),
        project: impl FnOnce(&mut Self, &Contact, &[u32]) -> Vec<Push>,
    ) {
        // A host may have taken it away since the tick began.
        let Some(collider) = state.colliders.get(index) else { return };
        let is_held = state.is_held(&self.fabric_of(cloth).fabric);
        let reaction = ReactionSum::begin_substep(&mut state.reactions, index, collider);
        if candidates.is_empty() {
            return;
        }
        let mut outcome = Outcome { moment: 0.0, pressing: state.pressing, reaction };
        let mut cells = candidates.cells.take();
        let contact = Contact::new(&state.material, &state.drive, collider, &self.clock)
            .carrying(candidates.carries)
            .among(cells.as_mut());
        let mut pushes = project(self, &contact, &candidates.particles);
        if !candidates.is_in_lanes {
            candidates.touching.clear();
            candidates.touching.extend(pushes.iter().map(|push| push.particle));
        }
        if !candidates.triangles.is_empty() {
            self.solve_triangle_contacts(cloth, candidates, &contact, &mut pushes);
        }
        if is_held {
            self.take_back_straining(cloth, &contact, &mut pushes);
        }
        for push in &pushes {
            self.change_velocity(cloth, &contact, push, &mut outcome);
        }
        state.external_moment += outcome.moment;
        state.pressing = outcome.pressing;
        candidates.cells = cells;
    }

    /// Projects one particle, and returns the push if there is one.
    pub(super) fn solve_contact(
        &mut self,
        cloth: usize,
        particle: u32,
        contact: &Contact,
    ) -> Option<Push> {
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
        outcome.pressing.add(steady.length() / effective_step);
        if let Some(reaction) = &mut outcome.reaction {
            // A steady force acts for the whole substep, of which the formula takes β; an impact changes the velocity
            // once.
            let steady = steady * (self.clock.step / effective_step);
            let on_collider = contact.impulse(inertia, steady + impact);
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
