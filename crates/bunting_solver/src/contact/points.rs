//! Where a cloth touches something: computed for those who ask, from what the last substep left.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::contact::cloths::group::ClothGroup;
use crate::contact::substep::Contact;
use crate::simd::lane::Pack;

/// Distance beyond the clearance, or the distance of layers, up to which cloth touches, m: other contacts and rounding lift it.
const TOUCHING: f32 = 1e-4;

/// What a cloth touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Touched {
    /// A collider.
    Collider,
    /// The cloth itself.
    Itself,
    /// Another cloth.
    Cloth,
}

/// A point at which a cloth touches something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// What the cloth touches.
    pub what: Touched,
    /// A point of the cloth, m.
    pub at: Vec3,
    /// Unit normal: away from the collider, or from the other layer.
    pub normal: Vec3,
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// The particles of a cloth that touch colliders, and the contacts of the cloth with itself.
    pub fn contact_points(&self, cloth: usize) -> Vec<ContactPoint> {
        let mut points = Vec::new();
        let Some(state) = self.lanes[cloth].as_ref().filter(|_| self.clock.begun > 0) else {
            return points;
        };
        let mut positions = Vec::new();
        self.copy_positions(cloth, &mut positions);
        for (collider, candidates) in state.colliders.iter().zip(&state.contacts) {
            let contact = Contact::new(&state.material, &state.drive, collider, &self.clock)
                .widened(TOUCHING);
            let particles = candidates.particles.iter().chain(&candidates.corners);
            let mut particles: Vec<u32> = particles.copied().collect();
            particles.sort_unstable();
            particles.dedup();
            points.extend(particles.iter().filter_map(|&particle| {
                let at = positions[particle as usize];
                let normal = contact.normal_at(at)?;
                Some(ContactPoint { what: Touched::Collider, at, normal })
            }));
        }
        if let Some(own) = &state.self_contacts {
            let touching = own.layers.touching(TOUCHING);
            points.extend(touching.map(|(_, at, normal)| ContactPoint {
                what: Touched::Itself,
                at,
                normal,
            }));
        }
        points
    }
}

impl ClothGroup {
    /// The contacts of a member, given its index, with itself and with the others, in the world.
    #[must_use]
    pub fn contact_points(&self, member: usize) -> Vec<ContactPoint> {
        let mut points = Vec::new();
        for (particles, at, normal) in self.layers().touching(TOUCHING) {
            let of = [particles[0], particles[3]].map(|particle| self.member_of(particle));
            let what = if of[0] == of[1] { Touched::Itself } else { Touched::Cloth };
            let normal = if of[0] == member { normal } else { -normal };
            if of.contains(&member) {
                points.push(ContactPoint { what, at: self.origin() + at, normal });
            }
        }
        points
    }
}
