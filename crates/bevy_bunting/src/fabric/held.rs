//! The particles that groups of vertices hold.

use std::collections::HashMap;

use crate::fabric::levels::ClothLevels;

/// Part of a free particle's vertices that must be held if it is to be, too. Less: what is held spreads into the cloth. More:
/// rounding lets go of particles between held vertices.
const NEARLY_ALL: f32 = 0.99;

/// A particle that groups of vertices hold.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HeldParticle {
    pub particle: usize,
    /// The groups, with their parts of the vertices around the particle.
    pub shares: Vec<(usize, f32)>,
}

impl HeldParticle {
    /// The group with the greatest part, of equal ones the first.
    pub fn group(&self) -> usize {
        let greater =
            |one: (usize, f32), other: (usize, f32)| if other.1 > one.1 { other } else { one };
        self.shares.iter().copied().reduce(greater).map_or(0, |share| share.0)
    }

    /// Adds a part of a group.
    fn add(&mut self, group: usize, part: f32) {
        match self.shares.iter_mut().find(|share| share.0 == group) {
            Some(share) => share.1 += part,
            None => self.shares.push((group, part)),
        }
    }

    fn sum(&self) -> f32 {
        self.shares.iter().map(|share| share.1).sum()
    }
}

impl ClothLevels {
    /// The particles of a level that groups of vertices hold, ascending: those at these vertices or nearest to them, and those on
    /// edges and triangles between them. A vertex of several groups is the first one's. The level has pinned particles between
    /// pinned vertices of one group and others, too: they are held in part.
    pub fn held(&self, level: usize, groups: &[Vec<u32>]) -> Vec<HeldParticle> {
        let fabric = self.fabric(level);
        let level = self.level(level);
        let mut group_of: HashMap<u32, usize> = HashMap::new();
        for (group, vertices) in groups.iter().enumerate() {
            for place in vertices.iter().filter_map(|&vertex| level.place(vertex)) {
                group_of.entry(place).or_insert(group);
            }
        }
        let mut held: Vec<HeldParticle> = Vec::new();
        if group_of.is_empty() {
            return held;
        }
        for particle in 0..fabric.particle_count() {
            let mut found = HeldParticle { particle, shares: Vec::new() };
            for (vertex, weight) in level.corners(particle) {
                let place = level.place(vertex);
                if let Some(&group) = place.and_then(|place| group_of.get(&place)) {
                    found.add(group, weight);
                }
            }
            let is_held = match fabric.is_pinned(particle) {
                true => !found.shares.is_empty(),
                false => found.sum() > NEARLY_ALL,
            };
            if is_held {
                held.push(found);
            }
        }
        let is_known: Vec<usize> = held.iter().map(|it| it.particle).collect();
        for (group, &vertex) in
            groups.iter().enumerate().flat_map(|(group, of)| of.iter().map(move |it| (group, it)))
        {
            let Some(particle) = level.particle(vertex) else { continue };
            if is_known.binary_search(&particle).is_err() {
                held.push(HeldParticle { particle, shares: vec![(group, 1.0)] });
            }
        }
        // Of vertices that share a particle the first one holds it: the sort is stable.
        held.sort_by_key(|it| it.particle);
        held.dedup_by_key(|it| it.particle);
        held
    }
}
