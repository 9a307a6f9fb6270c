//! Areas and inverse masses of a batch's particles.

use crate::simd::lane::Pack;

/// Areas and inverse masses of all particles. Masses are in units of the area density, so that a particle
/// without added mass has the mass of its area, in m².
#[derive(Clone, Debug)]
pub(crate) struct Masses<P: Pack, C> {
    /// Area of each particle, m².
    pub areas: Vec<C>,
    /// One over the area, 1/m²; zero if pinned.
    pub inverse_areas: Vec<C>,
    /// Inverse mass of each cloth's particles, with added mass, 1/m²; zero if pinned.
    pub inverse: Vec<P>,
    /// One over the inverse mass, m²; zero if pinned.
    pub inertia: Vec<P>,
    /// Effective length of the substep that the inverse masses of fabrics are for, s; zero for those without added
    /// mass.
    pub substep: f32,
}

impl<P: Pack, C> Masses<P, C> {
    /// Masses without added mass, given areas and inverse areas, and the number of packs of a batch. The inverse masses
    /// in lanes are zero until a substep begins.
    pub fn new(areas: Vec<C>, inverse_areas: Vec<C>, packs: usize) -> Self {
        let zero = vec![P::splat(0.0); packs];
        Self { areas, inverse_areas, inverse: zero.clone(), inertia: zero, substep: 0.0 }
    }
}
