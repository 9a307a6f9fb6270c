//! The contacts of layers in a substep: with one another, then with colliders, which press them together again.

use crate::contact::itself::contacts::LayerContacts;
use crate::contact::itself::mesh::ContactMesh;
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

/// How layers are kept apart in a substep.
pub(in crate::contact) struct Rounds<'a, R> {
    pub mesh: &'a ContactMesh,
    pub rules: &'a R,
    /// Greatest distance that any layers keep, m.
    pub thickness: f32,
    /// Length of the substep, s.
    pub step: f32,
    /// Number of sweeps over all contacts in a round.
    pub sweeps: usize,
}

impl<R: Rules> Rounds<'_, R> {
    /// Keeps layers apart and away from colliders, and returns those that still pass through one another. Positions and
    /// masses of all particles have been gathered before.
    pub fn solve(&self, layers: &mut LayerContacts, lanes: &mut impl Lanes) {
        let Self { mesh, rules, thickness, step, sweeps } = *self;
        let mut meet = layers.find(mesh, thickness, rules);
        layers.untangle(mesh, step);
        layers.gather(step, rules);
        for _ in 0..ROUNDS {
            if meet {
                lanes.read_velocities(&mut layers.particles);
                layers.separate(sweeps);
                lanes.write(&layers.particles);
                layers.particles.touched.fill(false);
            }
            if !lanes.touch_colliders(&mut layers.particles) {
                break;
            }
            if layers.are_outdated(mesh, thickness) {
                meet = layers.find(mesh, thickness, rules);
                layers.gather(step, rules);
            }
        }
        if meet && let Some(mut zones) = layers.return_zones(mesh, thickness, rules) {
            lanes.read_velocities(&mut layers.particles);
            zones.stop(&mut layers.particles);
            lanes.write(&layers.particles);
        }
    }
}
