//! The contacts of layers in a substep: with one another, then with colliders, which press them together again.

use crate::contact::itself::contacts::{LayerContacts, Layers};
use crate::contact::itself::particles::Particles;
use crate::contact::itself::rules::Rules;

/// Number of times that layers and then their contacts with colliders are solved. One: layers that are pressed on a
/// floor come to lie in one plane, and pass through one another by rounding.
const ROUNDS: usize = 2;

/// The lanes of the cloths whose layers touch.
pub(in crate::contact) trait Lanes {
    /// Copies velocities of particles that are near others out of the lanes.
    fn read_velocities(&mut self, particles: &mut Particles);

    /// Copies what contacts have changed back into the lanes.
    fn write(&mut self, particles: &Particles);

    /// Solves the contacts with colliders, and notes what they have changed. Returns whether any has pushed a particle.
    fn touch_colliders(&mut self, particles: &mut Particles) -> bool;
}

impl<R: Rules> Layers<'_, R> {
    /// Keeps layers apart and away from colliders, in some number of sweeps over all contacts in a round, and returns those that still pass
    /// through one another. Positions and masses of all particles have been gathered before.
    pub fn solve(&self, contacts: &mut LayerContacts, lanes: &mut impl Lanes, sweeps: usize) {
        contacts.begin(self);
        contacts.untangle(self.mesh, self.step);
        for _ in 0..ROUNDS {
            if contacts.meet() {
                lanes.read_velocities(&mut contacts.particles);
                contacts.stop_tangled();
                contacts.separate(self, sweeps);
                lanes.write(&contacts.particles);
                contacts.particles.touched.fill(false);
            }
            if !lanes.touch_colliders(&mut contacts.particles) {
                break;
            }
            contacts.renew(self);
        }
        if let Some(mut zones) = contacts.return_zones(self) {
            lanes.read_velocities(&mut contacts.particles);
            zones.stop(&mut contacts.particles);
            lanes.write(&contacts.particles);
        }
    }
}
