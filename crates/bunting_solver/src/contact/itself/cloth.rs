//! A cloth that may touch itself.

use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::swept::Swept;

/// A cloth that may touch itself.
#[derive(Clone, Copy)]
pub(super) struct Cloth<'a> {
    pub mesh: &'a ContactMesh,
    pub particles: &'a Particles,
    /// Distance of layers, m.
    pub thickness: f32,
}

impl Cloth<'_> {
    /// Boxes around the paths of some particles.
    pub fn swept(&self, particles: &[u32]) -> Swept {
        let Particles { start, end, .. } = self.particles;
        let mut swept = Swept::EMPTY;
        for &particle in particles {
            swept.add(start[particle as usize], end[particle as usize]);
        }
        swept
    }
}
