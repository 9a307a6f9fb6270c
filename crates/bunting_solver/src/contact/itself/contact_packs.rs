//! Contacts in lanes: eight in a pack, none of which has a particle in common with another, so that all are solved at once as if one after
//! the other.

use crate::contact::itself::touching::Touching;
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;
use crate::simd::vec3::Pack3;

/// Number of packs that take contacts at a time. Fewer: more packs are left with free lanes. More: as many bits for each particle.
const OPEN: usize = u32::BITS as usize;

/// Eight contacts.
#[derive(Clone, Debug)]
pub(in crate::contact) struct ContactPack {
    /// Indices of the contacts' particles. Lanes without a contact are those before the first contact, and have its particles: what they
    /// write is overwritten.
    pub particles: [[u32; Pack8::WIDTH]; 4],
    /// First lane with a contact.
    first: usize,
    /// Distance that features keep, m; in lanes without a contact so small that it does nothing.
    pub distance: Pack8,
    /// Coulomb friction coefficient.
    pub friction: Pack8,
    /// See [`Touching::passed`].
    pub passed: Pack8,
    /// Inverse masses of the particles, 1/m².
    pub inverse_masses: [Pack8; 4],
    /// Unit normal and factors of the particles when the features faced each other last.
    pub normal: Pack3<Pack8>,
    pub factors: [Pack8; 4],
    /// Whether the features faced each other when that was last asked: 1, else 0.
    pub faces: Pack8,
    /// Sum of the depths by which features were moved apart, m.
    pub depth: Pack8,
    /// How much of this is counted in [`stopped`](Self::stopped), m.
    counted: Pack8,
    /// Sum of the approaches that were stopped, m/s.
    pub stopped: Pack8,
    /// What of this was an impact, m/s.
    pub impact: Pack8,
}

impl ContactPack {
    fn new(first: &Touching) -> Self {
        let zero = Pack8::splat(0.0);
        Self {
            particles: first.particles.map(|particle| [particle; Pack8::WIDTH]),
            first: Pack8::WIDTH,
            distance: Pack8::splat(f32::NEG_INFINITY),
            friction: zero,
            passed: zero,
            inverse_masses: [zero; 4],
            normal: [zero; 3],
            factors: [zero; 4],
            faces: zero,
            depth: zero,
            counted: zero,
            stopped: zero,
            impact: zero,
        }
    }

    fn add(&mut self, contact: &Touching) {
        self.first -= 1;
        let lane = self.first;
        for (of_lanes, particle) in self.particles.iter_mut().zip(contact.particles) {
            of_lanes[lane] = particle;
        }
        self.distance.lanes_mut()[lane] = contact.distance;
        self.friction.lanes_mut()[lane] = contact.friction;
        self.passed.lanes_mut()[lane] = contact.passed;
    }

    /// Reads the inverse masses of all particles, 1/m².
    pub fn read_masses(&mut self, inverse_masses: &[f32]) {
        for (into, particles) in self.inverse_masses.iter_mut().zip(&self.particles) {
            for (into, &particle) in into.lanes_mut().iter_mut().zip(particles) {
                *into = inverse_masses[particle as usize];
            }
        }
    }

    /// Counts what has moved features apart since the last call as approaches that were stopped, given the rate at which it becomes
    /// velocities, 1/s.
    pub fn count_pushes(&mut self, rate: f32) {
        let depths = self.depth.lanes().iter().zip(self.counted.lanes());
        for (stopped, (depth, counted)) in self.stopped.lanes_mut().iter_mut().zip(depths) {
            *stopped += (depth - counted) * rate;
        }
        self.counted = self.depth;
    }

    /// First lane with a contact.
    pub fn first(&self) -> usize {
        self.first
    }

    /// The particles of a lane.
    pub fn particles_of(&self, lane: usize) -> [u32; 4] {
        self.particles.map(|of_lanes| of_lanes[lane])
    }
}

/// Puts contacts into packs.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Packing {
    /// For each particle, the open packs in which it is, one a bit.
    taken: Vec<u32>,
    /// Index of each open pack.
    open: [Option<usize>; OPEN],
}

impl Packing {
    /// Puts contacts between some number of particles into packs.
    pub fn pack(&mut self, contacts: &[Touching], particles: usize, packs: &mut Vec<ContactPack>) {
        packs.clear();
        self.taken.resize(particles, 0);
        let stride = contacts.len().div_ceil(Pack8::WIDTH);
        let order = (0..stride).flat_map(|at| (0..Pack8::WIDTH).map(move |run| run * stride + at));
        for contact in order.filter_map(|at| contacts.get(at)) {
            let taken =
                contact.particles.iter().fold(0, |bits, &at| bits | self.taken[at as usize]);
            let slot = match (!taken).trailing_zeros() as usize {
                OPEN => {
                    self.close(0, packs);
                    0
                }
                slot => slot,
            };
            let index = *self.open[slot].get_or_insert_with(|| {
                packs.push(ContactPack::new(contact));
                packs.len() - 1
            });
            packs[index].add(contact);
            if packs[index].first == 0 {
                self.close(slot, packs);
            } else {
                contact.particles.iter().for_each(|&at| self.taken[at as usize] |= 1 << slot);
            }
        }
        (0..OPEN).for_each(|slot| self.close(slot, packs));
    }

    /// Closes an open pack.
    fn close(&mut self, slot: usize, packs: &[ContactPack]) {
        if let Some(index) = self.open[slot].take() {
            for &particle in packs[index].particles.iter().flatten() {
                self.taken[particle as usize] &= !(1 << slot);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_contact_is_in_one_pack_and_no_particle_twice_in_a_pack() {
        const PARTICLES: u32 = 90;
        let contacts: Vec<Touching> = (0..500_u32)
            .map(|at| {
                let first = at * at % PARTICLES;
                let particles = [0, 7, 31, 40].map(|by| (first + by) % PARTICLES);
                Touching { particles, distance: 1.0 + at as f32, friction: 0.0, passed: 0.0 }
            })
            .collect();
        let (mut packing, mut packs) = (Packing::default(), Vec::new());
        // A second time, the scratch arrays must be clean.
        for _ in 0..2 {
            packing.pack(&contacts, PARTICLES as usize, &mut packs);
            let mut distances = Vec::new();
            for pack in &packs {
                let lanes = pack.first()..Pack8::WIDTH;
                let mut all: Vec<u32> =
                    lanes.clone().flat_map(|it| pack.particles_of(it)).collect();
                let count = all.len();
                all.sort_unstable();
                all.dedup();
                assert_eq!(all.len(), count);
                distances.extend(lanes.map(|lane| pack.distance.lanes()[lane]));
            }
            distances.sort_by(f32::total_cmp);
            assert!(distances.iter().copied().eq(contacts.iter().map(|it| it.distance)));
        }
        assert!(packs.len() < 2 * contacts.len() / Pack8::WIDTH, "{} packs", packs.len());
    }
}
