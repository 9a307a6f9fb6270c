//! How hard colliders press a cloth, by which its effort is chosen: see [`Loads::of_contacts`].

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::Layout;
use crate::simd::lane::Pack;
use crate::step::effort::Loads;

/// The sum, over a cloth's contacts in a tick, of the squares of the accelerations by steady pushes, m²/s⁴.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pressing(f32);

impl Pressing {
    /// Adds the acceleration of a particle by the steady part of a push, m/s².
    pub fn add(&mut self, acceleration: Vec3) {
        self.0 += acceleration.length_squared();
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Load of the colliders that pressed a cloth in this tick, m/s².
    pub fn contact_load(&self, cloth: usize, state: &LaneState) -> f32 {
        let counted = self.fabric.particle_count() as f32 * self.clock.begun as f32;
        let pressing = (state.pressing.0 / counted.max(1.0)).sqrt();
        Loads::of_contacts(&self.fabric_of(cloth).fabric, pressing)
    }
}
