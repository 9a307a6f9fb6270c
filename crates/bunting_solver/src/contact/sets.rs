//! Contacts in lanes: sets of colliders of one kind, one in each lane.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::contact::collider_packs::{ColliderPacks, LaneTouch, Member};
use crate::contact::reaction::ReactionSum;
use crate::contact::substep::{Contact, Push};
use crate::contact::touch::Touch;
use crate::contact::triangles::TriangleCells;
use crate::contact::velocity_packs::ChangeVelocities;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Moves particles out of the colliders of all sets after a pass over lines.
    pub(super) fn press_sets(&mut self) {
        let mut sets = core::mem::take(&mut self.collider_packs);
        let mut entering = Vec::new();
        for set in &mut sets {
            set.solved = P::splat(1.0);
            self.fill_set(set);
            set.press(&self.scratch, self.positions.packs_mut(), &mut entering);
            for index in entering.drain(..) {
                self.press_entering(set, index);
            }
        }
        self.collider_packs = sets;
    }

    /// Solves the contacts of all sets at the end of a substep. Those of cloths that have contacts with themselves or with other cloths are
    /// solved together with these, after the pushes of passes are taken back here.
    pub(super) fn solve_sets(&mut self) {
        let mut sets = core::mem::take(&mut self.collider_packs);
        let mut entering = Vec::new();
        for set in &mut sets {
            set.solved = P::splat(0.0);
            for member in &set.members {
                let alone = |state| f32::from(!Self::has_other_contacts(state));
                let is_solved = self.lanes[member.cloth].as_ref().map_or(0.0, alone);
                set.solved.lanes_mut()[Y::lanes(member.cloth)].fill(is_solved);
            }
            self.fill_set(set);
            set.press(&self.scratch, self.positions.packs_mut(), &mut entering);
            let mut changed = P::splat(0.0);
            for at in 0..set.members.len() {
                let member = set.members[at];
                if self.changes_in_lanes(set, member) {
                    changed.lanes_mut()[Y::lanes(member.cloth)].fill(1.0);
                } else {
                    self.solve_member(set, member);
                }
            }
            self.change_velocities(set, changed);
            set.forget_pushes();
        }
        self.collider_packs = sets;
    }

    fn has_other_contacts(state: &LaneState) -> bool {
        state.self_contacts.is_some() || state.is_grouped
    }

    /// Writes the colliders of a set as they are in this substep.
    fn fill_set(&self, set: &mut ColliderPacks<P>) {
        for at in 0..set.members.len() {
            let member = set.members[at];
            if let Some(contact) = self.contact_of(member) {
                set.fill(&Y::lanes(member.cloth), &contact);
            }
        }
    }

    /// Takes out a collider's triangles near its cloth, so that the contact can ask for them.
    fn take_cells(&mut self, member: Member) -> Option<TriangleCells> {
        self.lanes[member.cloth].as_mut()?.contacts.get_mut(member.collider)?.cells.take()
    }

    fn put_cells(&mut self, member: Member, cells: Option<TriangleCells>) {
        let state = self.lanes[member.cloth].as_mut();
        if let Some(of_collider) = state.and_then(|it| it.contacts.get_mut(member.collider)) {
            of_collider.cells = cells;
        }
    }

    fn contact_of(&self, member: Member) -> Option<Contact<'_>> {
        let state = self.lanes[member.cloth].as_ref()?;
        let collider = state.colliders.get(member.collider)?;
        Some(Contact::new(&state.material, &state.drive, collider, &self.clock))
    }

    /// Moves particles of a pack, given its index in the set, that enter their colliders.
    fn press_entering(&mut self, set: &mut ColliderPacks<P>, index: usize) {
        let pack = set.near[index].pack as usize;
        for at in 0..set.members.len() {
            let member = set.members[at];
            for lane in Y::lanes(member.cloth) {
                if set.near[index].touch(lane) != LaneTouch::Enters {
                    continue;
                }
                let mut cells = self.take_cells(member);
                if let Some(contact) = self.contact_of(member) {
                    let contact = contact.among(cells.as_mut());
                    let start = lane3(&self.scratch[pack], lane);
                    let before = lane3(&self.positions.packs()[pack], lane);
                    if let Some(projection) = contact.project(start, before) {
                        let after = contact.pose.transform_point(projection.to);
                        set_lane3(&mut self.positions.packs_mut()[pack], lane, after);
                        set_lane3(&mut set.near[index].pushed, lane, after - before);
                    }
                }
                self.put_cells(member, cells);
            }
        }
    }

    /// Whether all that is left of a cloth's contacts with a collider is to change velocities in lanes: no particle enters, and no link may be
    /// strained too far.
    fn changes_in_lanes(&self, set: &ColliderPacks<P>, member: Member) -> bool {
        let Some(state) = &self.lanes[member.cloth] else { return false };
        let lanes = Y::lanes(member.cloth);
        // A host may have taken the collider away since the tick began.
        if member.collider >= state.colliders.len()
            || Self::has_other_contacts(state)
            || set.enters(lanes.clone())
        {
            return false;
        }
        let cannot_strain = |contact: Contact| {
            self.cannot_strain(member.cloth, &contact, set.longest_push(lanes.clone()))
        };
        !state.is_held(&self.fabric_of(member.cloth).fabric)
            || self.contact_of(member).is_some_and(cannot_strain)
    }

    /// Changes the velocities of particles that slide, in some lanes of a set.
    fn change_velocities(&mut self, set: &mut ColliderPacks<P>, changed: P) {
        P::run(ChangeVelocities {
            set,
            changed,
            step: self.clock.step,
            effective_step: &self.parameters.step,
            start: &self.scratch,
            displacement: &self.displacement,
            position: self.positions.packs(),
            velocities: [&mut self.velocity, &mut self.older_velocity, &mut self.oldest_velocity],
        });
        for &Member { cloth, collider } in &set.members {
            if changed.lanes()[Y::lanes(cloth).start] == 0.0 {
                continue;
            }
            if let Some(mut state) = self.lanes[cloth].take() {
                self.note_pushes(set, &mut state, Member { cloth, collider });
                self.lanes[cloth] = Some(state);
            }
        }
    }

    /// Notes the effects of pushes along a collider besides those on particles.
    fn note_pushes(&self, set: &ColliderPacks<P>, state: &mut LaneState, member: Member) {
        let Member { cloth, collider: index } = member;
        let pole = self.pole_of(cloth);
        let collider = &state.colliders[index];
        let reaction = ReactionSum::begin_substep(&mut state.reactions, index, collider);
        let contact = || Contact::new(&state.material, &state.drive, collider, &self.clock);
        let mut reaction = reaction.map(|reaction| (reaction, contact()));
        for &particle in &state.contacts[index].particles {
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            let near = set.of_pack(pack);
            if near.touch(lane) != LaneTouch::Slides {
                continue;
            }
            state.pressing.add(near.steady.lanes()[lane]);
            if pole.is_none() && reaction.is_none() {
                continue;
            }
            let after = lane3(&self.positions.packs()[pack], lane);
            let inertia = self.masses.inertia[pack].lanes()[lane];
            if let Some(pole) = &pole {
                let before = after - lane3(&near.pushed, lane);
                let way = lane3(&self.displacement[pack], lane);
                let predicted = lane3(&self.scratch[pack], lane) + way;
                state.external_moment += pole.gained(inertia, predicted, [before, after]);
            }
            if let Some((reaction, contact)) = &mut reaction {
                let at = contact.pose.inverse_transform_point(after);
                let on_collider = contact.impulse(inertia, lane3(&near.gained, lane));
                reaction.add(particle as usize, at, on_collider);
            }
        }
    }

    /// Solves what is left of a cloth's contacts with a collider after its particles have been pressed.
    fn solve_member(&mut self, set: &ColliderPacks<P>, member: Member) {
        let Member { cloth, collider } = member;
        let Some(mut state) = self.lanes[cloth].take_if(|state| !Self::has_other_contacts(state))
        else {
            return;
        };
        let Some(candidates) = state.contacts.get_mut(collider) else {
            self.lanes[cloth] = Some(state);
            return;
        };
        let mut candidates = core::mem::take(candidates);
        let candidates_of = (collider, &mut candidates);
        self.solve_collider(cloth, &mut state, candidates_of, |batch, contact, particles| {
            let mut pushes = Vec::new();
            for &particle in particles {
                let (pack, lane) = batch.layout.locate(particle as usize, cloth);
                let near = set.of_pack(pack);
                match near.touch(lane) {
                    LaneTouch::None => {}
                    LaneTouch::Slides => {
                        let after = lane3(&batch.positions.packs()[pack], lane);
                        let to = contact.pose.inverse_transform_point(after);
                        let normal = lane3(&near.normal, lane);
                        let before = after - lane3(&near.pushed, lane);
                        let touch = Touch { normal, at: to, sticks: false };
                        pushes.push(Push { particle, before, to, touch });
                    }
                    LaneTouch::Enters => {
                        pushes.extend(batch.solve_contact(cloth, particle, contact));
                    }
                }
            }
            pushes
        });
        state.contacts[collider] = candidates;
        self.lanes[cloth] = Some(state);
    }
}
