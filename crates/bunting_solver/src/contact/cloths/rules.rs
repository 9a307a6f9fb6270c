//! Which cloths of a group are kept apart.

use glam::Vec3;

use crate::contact::cloths::member::Member;
use crate::contact::itself::rules::{Keep, Rules};

/// The rules of a group.
pub(super) struct OfGroup<'a> {
    pub members: &'a [Member],
    /// Index of each patch's cloth.
    pub of_patch: &'a [u32],
    /// Index of each particle's cloth.
    pub of_particle: &'a [u32],
    /// See [`Rules::sewn`].
    pub sewn: &'a [[u32; 2]],
}

impl OfGroup<'_> {
    /// Greatest distance that any two layers keep, m.
    pub fn greatest_thickness(&self) -> f32 {
        let all = self
            .members
            .iter()
            .map(|member| member.settings.thickness.max(member.own_thickness.unwrap_or(0.0)));
        all.fold(0.0, f32::max)
    }
}

impl Rules for OfGroup<'_> {
    #[inline(always)]
    fn compare(&self, patches: [usize; 2]) -> bool {
        let [one, other] = patches.map(|patch| self.of_patch[patch]);
        let [first, second] = [one, other].map(|member| &self.members[member as usize]);
        first.is_finite
            && second.is_finite
            && if one == other {
                first.own_thickness.is_some() && first.moves
            } else {
                (first.moves || second.moves) && first.settings.touches(&second.settings)
            }
    }

    fn keep(&self, particles: [u32; 4]) -> Keep {
        let [one, other] =
            [particles[0], particles[3]].map(|at| self.of_particle[at as usize] as usize);
        let [first, second] = [one, other].map(|member| &self.members[member]);
        if one != other {
            return Keep {
                distance: 0.5 * (first.settings.thickness + second.settings.thickness),
                friction: (first.friction * second.friction).sqrt(),
                rest: None,
            };
        }
        let rest: &[Vec3] = first.fabric.rest_positions();
        Keep {
            distance: first.own_thickness.unwrap_or(first.settings.thickness),
            friction: first.friction,
            rest: Some(particles.map(|at| rest[at as usize - first.range.start])),
        }
    }

    fn sewn(&self) -> &[[u32; 2]] {
        self.sewn
    }
}
