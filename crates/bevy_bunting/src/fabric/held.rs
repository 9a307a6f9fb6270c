//! The particles that groups of vertices and points hold.

use std::collections::{HashMap, HashSet};

use bunting_solver::MeshPoint;

use crate::fabric::levels::ClothLevels;
use crate::motion::held_group::HeldGroup;

/// Part of a free particle's vertices that must be held if it is to be, too. Less: what is held spreads into the cloth. More:
/// rounding lets go of particles between held vertices.
const NEARLY_ALL: f32 = 0.99;

/// Weight of a vertex from which on a particle is at it. Less: the particle at a point beside it is held with it.
const AT_VERTEX: f32 = 0.9999;

/// A particle that groups hold.
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
    /// The particles of a level that groups hold, ascending: those at vertices or nearest to them, those on edges and triangles
    /// between them, and those at points. A vertex of several groups is the first one's. The level has pinned particles between
    /// pinned vertices of one group and others, too: they are held in part.
    pub fn held(&self, level: usize, groups: &[HeldGroup]) -> Vec<HeldParticle> {
        let fabric = self.fabric(level);
        let beside = self.particles_beside_vertices(level);
        let at_point = |point| self.particle_of_point(level, point);
        let level = self.level(level);
        let mut group_of: HashMap<u32, usize> = HashMap::new();
        for (group, held) in groups.iter().enumerate() {
            for place in held.vertices.iter().filter_map(|&vertex| level.place(vertex)) {
                group_of.entry(place).or_insert(group);
            }
        }
        let mut held: Vec<HeldParticle> = Vec::new();
        if groups.iter().all(HeldGroup::is_empty) {
            return held;
        }
        let all = 0..fabric.particle_count();
        for particle in all.filter(|particle| !beside.contains(particle)) {
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
        for (group, of) in groups.iter().enumerate() {
            let at_vertices = of.vertices.iter().filter_map(|&vertex| level.particle(vertex));
            let at_points = of.points.iter().filter_map(at_point);
            let unknown =
                at_vertices.chain(at_points).filter(|it| is_known.binary_search(it).is_err());
            held.extend(
                unknown.map(|particle| HeldParticle { particle, shares: vec![(group, 1.0)] }),
            );
        }
        // Of vertices that share a particle the first one holds it: the sort is stable.
        held.sort_by_key(|it| it.particle);
        held.dedup_by_key(|it| it.particle);
        held
    }

    /// The particle of a level at a point; none if the fabrics do not know it.
    pub fn particle_of_point(&self, level: usize, point: &MeshPoint) -> Option<usize> {
        let at = self.points.iter().position(|known| known == point)?;
        Some(self.fabric(level).particle_of_point()[at] as usize)
    }

    /// The particles of a level at points, but for those that are at vertices, too.
    fn particles_beside_vertices(&self, level: usize) -> HashSet<usize> {
        let particles = self.fabric(level).particle_of_point().iter().map(|at| *at as usize);
        let is_at_vertex =
            |particle: &usize| self.corners(level, *particle).any(|(_, weight)| weight > AT_VERTEX);
        particles.filter(|particle| !is_at_vertex(particle)).collect()
    }
}
