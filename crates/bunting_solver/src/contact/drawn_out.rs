//! Contacts that would tear cloth: a particle passes through a shape that would draw it too far from its pins.
//!
//! A banner that is driven against a post, or a pin within a shape, leaves the other particles no place on this side of the
//! surface. Cloth that cannot tear would be drawn out without limit, and be thrown to and fro by its links and the shape.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;

/// Greatest distance from its nearest pin, in lengths of the tether between them, to which a shape moves a particle.
/// Smaller: fast shapes that draw cloth out pass through it. Larger: caught cloth is stretched that far.
const DRAWN_OUT: f32 = 3.0;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Whether a particle would be drawn out too far at a position, m.
    pub(super) fn is_drawn_out(&self, cloth: usize, particle: u32, at: Vec3) -> bool {
        let tethers = self.fabric_of(cloth).fabric.tethers();
        let Ok(index) = tethers.binary_search_by_key(&particle, |tether| tether.particle) else {
            return false;
        };
        let (pack, lane) = self.layout.locate(tethers[index].pin as usize, cloth);
        let pin = lane3(&self.positions.packs()[pack], lane);
        let stretch = self.parameters.tether_stretch[0].lanes()[cloth];
        let most = DRAWN_OUT * stretch * tethers[index].length;
        at.distance_squared(pin) > most * most
    }
}
