//! Which features are kept apart, how far, and with which friction.

use glam::Vec3;

/// How two features are kept apart.
pub(in crate::contact) struct Keep {
    /// Distance, m.
    pub distance: f32,
    /// Coulomb friction coefficient.
    pub friction: f32,
    /// Positions of the particles at rest, m, if they are of one cloth: features that are nearer at rest may be.
    pub rest: Option<[Vec3; 4]>,
}

/// Which features are kept apart, and how.
pub(in crate::contact) trait Rules {
    /// Whether features of two patches are kept apart.
    fn compare(&self, patches: [usize; 2]) -> bool;

    /// How the features of a contact are kept apart, given its particles.
    fn keep(&self, particles: [u32; 4]) -> Keep;

    /// Particles that seams join, in both orders, ascending. Features with such particles touch each other as neighbours do.
    fn sewn(&self) -> &[[u32; 2]];
}

/// The rules of a cloth by itself.
pub(in crate::contact) struct OfOneCloth<'a> {
    /// Distance of layers, m.
    pub thickness: f32,
    /// Coulomb friction coefficient.
    pub friction: f32,
    /// Positions at rest, m.
    pub rest: &'a [Vec3],
    /// See [`Rules::sewn`].
    pub sewn: &'a [[u32; 2]],
}

impl Rules for OfOneCloth<'_> {
    #[inline(always)]
    fn compare(&self, _patches: [usize; 2]) -> bool {
        true
    }

    #[inline(always)]
    fn keep(&self, particles: [u32; 4]) -> Keep {
        Keep {
            distance: self.thickness,
            friction: self.friction,
            rest: Some(particles.map(|particle| self.rest[particle as usize])),
        }
    }

    fn sewn(&self) -> &[[u32; 2]] {
        self.sewn
    }
}
