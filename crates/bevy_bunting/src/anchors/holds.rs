//! The springs and rails that hold a cloth.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::fabric::known_level::KnownLevel;
use crate::fabric::levels::ClothLevels;
use crate::motion::held_group::HeldGroup;

/// A cloth that is held by springs or rails, of anchors or of grabs.
#[derive(Component, Debug, Default)]
pub(crate) struct ClothHolds {
    /// The levels and the level of the particles.
    of: Option<KnownLevel>,
    /// The anchor, the particle and its place at rest (m) of each hold of an anchor.
    pub anchored: Vec<(usize, u32, Vec3)>,
    /// Number of particles of each anchor.
    pub counts: Vec<usize>,
    /// Rails of anchors, shared with the solver; none for springs.
    pub rails: Vec<Option<Arc<[Vec3]>>>,
    /// That which holds, in the order of the holds given to the solver.
    pub owners: Vec<Owner>,
}

/// That which holds a particle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Owner {
    /// An anchor of the cloth's attachment.
    Anchor { index: usize, particle: u32 },
    /// An entity with a [`ClothGrab`](crate::ClothGrab).
    Grab(Entity),
}

impl ClothHolds {
    /// Whether the holds are those of a level.
    pub fn fits(&self, levels: &Arc<ClothLevels>, level: usize) -> bool {
        self.of.as_ref().is_some_and(|of| of.is(levels, level))
    }

    /// Finds the particles of a level, given what each anchor holds by springs or on a rail, and the rails.
    /// A level without any of an anchor's vertices is held where it is nearest to the first one.
    pub fn find(
        &mut self,
        levels: &Arc<ClothLevels>,
        level: usize,
        groups: &[HeldGroup],
        rails: Vec<Option<Arc<[Vec3]>>>,
    ) {
        self.of = Some(KnownLevel::new(levels, level));
        self.rails = rails;
        self.anchored.clear();
        self.counts.clear();
        let rest = levels.fabric(level).rest_positions();
        let held = levels.held(level, groups);
        for (anchor, group) in groups.iter().enumerate() {
            let of_group = held.iter().filter(|it| it.group() == anchor);
            let mut particles: Vec<usize> = of_group.map(|it| it.particle).collect();
            if particles.is_empty() {
                particles.extend(
                    group.vertices.first().and_then(|&vertex| nearest(levels, level, vertex)),
                );
            }
            self.counts.push(particles.len());
            let holds = particles.into_iter().map(|at| (anchor, at as u32, rest[at]));
            self.anchored.extend(holds);
        }
    }
}

/// The particle of a level that is at rest nearest to a vertex of the finest one.
fn nearest(levels: &ClothLevels, level: usize, vertex: u32) -> Option<usize> {
    let at = levels.vertex_position(0, vertex, levels.fabric(0).rest_positions())?;
    let rest = levels.fabric(level).rest_positions();
    let distance = |particle: usize| rest[particle].distance_squared(at);
    (0..rest.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
}
