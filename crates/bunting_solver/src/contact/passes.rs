//! Contacts with colliders after each pass over the lines of a cloth.
//!
//! Lines pull a cloth into what it lies on. If contacts pushed it out again at the end of a substep alone, its links would be strained by
//! (β h)² p/l there, with p the acceleration by which the shape presses. Therefore particles are moved out of colliders after each pass,
//! and what is left of the solve knows where they may be.
//!
//! The last contacts of a substep begin with where particles would be without these pushes, so that each particle has one push in a
//! substep: friction is that of the whole push, and velocities change once.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::candidates::{Candidates, Pushed};
use crate::contact::substep::Contact;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Moves particles out of colliders after a pass over lines.
    pub fn solve_contacts_of_pass(&mut self) {
        if !self.lanes.iter().flatten().any(LaneState::is_near_colliders) {
            return;
        }
        // This call copies the positions back from the constraints' arrays.
        self.positions.packs_mut();
        self.press_sets();
        let is_alone = |candidates: &Candidates| {
            !candidates.is_in_lanes && !candidates.wait_for_end && !candidates.touching.is_empty()
        };
        let touches = |state: &mut LaneState| state.contacts.iter().any(is_alone);
        for cloth in 0..self.lanes.len() {
            // The lane's state is taken out, so that the particles of the batch can be written.
            let Some(mut state) = self.lanes[cloth].take_if(touches) else { continue };
            let mut contacts = core::mem::take(&mut state.contacts);
            for (collider, candidates) in state.colliders.iter().zip(&mut contacts) {
                if !is_alone(candidates) {
                    continue;
                }
                self.take_back_pushed(cloth, &mut candidates.pushed);
                let Candidates { touching, pushed, cells, .. } = candidates;
                let contact = Contact::new(&state.material, &state.drive, collider, &self.clock)
                    .among(cells.as_mut());
                touching.retain(|&particle| {
                    let push = self.solve_contact(cloth, particle, &contact);
                    pushed.extend(
                        push.iter().map(|push| (particle, contact.end(push) - push.before)),
                    );
                    push.is_some()
                });
            }
            state.contacts = contacts;
            self.lanes[cloth] = Some(state);
        }
    }

    /// Moves particles back to where they would be without the pushes of passes, as far as these are not in lanes.
    pub(super) fn take_back_all_pushed(&mut self) {
        for cloth in 0..self.lanes.len() {
            let has_pushed = |state: &mut LaneState| {
                state.contacts.iter().any(|candidates| !candidates.pushed.is_empty())
            };
            let Some(mut state) = self.lanes[cloth].take_if(has_pushed) else { continue };
            for candidates in &mut state.contacts {
                self.take_back_pushed(cloth, &mut candidates.pushed);
            }
            self.lanes[cloth] = Some(state);
        }
    }

    fn take_back_pushed(&mut self, cloth: usize, pushed: &mut Pushed) {
        for (particle, by) in pushed.drain(..) {
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            let position = &mut self.positions.packs_mut()[pack];
            let without = lane3(position, lane) - by;
            set_lane3(position, lane, without);
        }
    }
}
