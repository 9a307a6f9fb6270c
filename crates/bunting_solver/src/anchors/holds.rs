//! The holds of a cloth in a tick.

use glam::Vec3;

use crate::anchors::hold::Hold;

/// The holds of a cloth, and what they do to it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Holds {
    /// In the order of their particles, each of which is held once.
    pub list: Vec<Hold>,
    /// The place of each hold in the order in which the holds were given.
    order: Vec<usize>,
    /// Each hold in the substep under way; none if its particle is pinned.
    pub now: Vec<Option<Held>>,
    /// Impulse of each on that which holds, N·s, along the axes at the end of the tick.
    pub impulses: Vec<Vec3>,
}

/// A held particle in a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held {
    /// Where it would be without the hold, m.
    pub predicted: Vec3,
    /// Where the hold alone brings it, m.
    pub drawn: Vec3,
    /// Its inertia with the hold's, in units of the density, m².
    pub inertia: f32,
    /// What the hold has done to it at the end of the substep, in units of the density, m³.
    pub given: Vec3,
}

impl Holds {
    /// Replaces the holds. Of those of one particle the first one holds.
    pub fn set(&mut self, holds: Vec<Hold>) {
        self.order = (0..holds.len()).collect();
        self.order.sort_by_key(|&index| (holds[index].particle, index));
        self.order.dedup_by_key(|index| holds[*index].particle);
        self.list = self.order.iter().map(|&index| holds[index].clone()).collect();
        self.impulses.clear();
        self.impulses.resize(holds.len(), Vec3::ZERO);
    }

    /// Forgets all impulses: a tick begins.
    pub fn begin_tick(&mut self) {
        self.impulses.fill(Vec3::ZERO);
    }

    /// The particles that are held, and what the holds have done to them in this substep, in units of the density, m³.
    pub fn given(&self) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let held = self.list.iter().zip(&self.now);
        held.filter_map(|(hold, now)| Some((hold.particle, now.as_ref()?.given)))
    }

    /// Notes what a hold of the list has done to its particle in this substep, in units of the density (m³), and adds the
    /// impulse on that which holds.
    pub fn note(&mut self, hold: usize, given: Vec3, impulse: Vec3) {
        if let Some(held) = &mut self.now[hold] {
            held.given = given;
        }
        self.impulses[self.order[hold]] += impulse;
    }
}
