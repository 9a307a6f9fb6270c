//! Features that come nearer than the thickness are moved apart, in sweeps over all their contacts.

use glam::Vec3;

use crate::contact::itself::contact::Contact;
use crate::contact::itself::near::Kind;
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::rules::{Keep, Rules};
use crate::contact::itself::untangle::Tangles;

/// Speed at which features that are too near at the start of a substep move apart, m/s. Smaller: layers stay pressed
/// together for long. Larger: links beside them are stretched.
const RECOVERY: f32 = 0.5;

/// Part of the distance at rest that features keep which are nearer than the thickness at rest. Larger: such features
/// are pushed by rounding errors.
const REST_PART: f32 = 0.8;

/// Distance from which on features are no contact, as a multiple of what they keep: other contacts move particles by about
/// the thickness.
pub(in crate::contact) const FAR: f32 = 2.0;

/// The contacts of layers in a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Contacts {
    contacts: Vec<Contact>,
    /// For each contact, the [`travel`](Particles::travel) of its particles, m, up to which its features stay farther apart
    /// than they must.
    reach: Vec<f32>,
}

impl Contacts {
    pub fn clear(&mut self) {
        self.contacts.clear();
    }

    /// Moves all features apart that are too near, and stops their approach, in at most so many sweeps over all contacts.
    pub fn separate(&mut self, particles: &mut Particles, sweeps: usize) {
        let Self { contacts, reach } = self;
        reach.clear();
        reach.resize(contacts.len(), 0.0);
        contacts.iter_mut().for_each(|contact| contact.fresh = 0.0);
        particles.forget_travel();
        for _ in 0..sweeps {
            let mut any = false;
            for (contact, reach) in contacts.iter_mut().zip(reach.iter_mut()) {
                // The four particles have not travelled farther than four times the farthest one.
                if 4.0 * particles.farthest >= *reach {
                    any |= contact.project(particles, reach);
                }
            }
            if !any {
                break;
            }
        }
        for _ in 0..sweeps {
            let mut any = false;
            for contact in contacts.iter_mut().filter(|contact| contact.depth > 0.0) {
                any |= contact.stop(particles);
            }
            if !any {
                break;
            }
        }
    }

    /// The contacts of features that are as near as they may be, given what counts as such, m.
    pub fn touching(&self, particles: &Particles, within: f32) -> impl Iterator<Item = &Contact> {
        self.contacts.iter().filter(move |contact| contact.is_touching(particles, within))
    }

    /// Particles of features that are still much nearer than they must be.
    pub fn pressed_particles(&self, particles: &Particles) -> impl Iterator<Item = usize> {
        let pressed = self.contacts.iter().filter(|contact| contact.is_pressed(particles));
        pressed.flat_map(Contact::particles)
    }
}

/// The distances of contacts.
pub(in crate::contact) struct Spacing<'a, R> {
    pub rules: &'a R,
    /// Length of the substep, s.
    pub step: f32,
    /// Features that pass through one another at the start of the substep.
    pub tangles: &'a Tangles,
}

impl<R: Rules> Spacing<'_, R> {
    /// Gathers the contacts of pairs.
    pub fn gather(&self, pairs: &Pairs, particles: &Particles, into: &mut Contacts) {
        into.contacts.clear();
        let triangles = pairs.particles_triangles.iter().map(|&it| (it, Kind::ParticleTriangle));
        let edges = pairs.edges_edges.iter().map(|&it| (it, Kind::EdgeEdge));
        let all = triangles.chain(edges);
        into.contacts.extend(all.filter_map(|(pair, kind)| self.contact(pair, kind, particles)));
    }

    /// The contact of two features; none if they stay apart.
    fn contact(&self, pair: [u32; 4], kind: Kind, particles: &Particles) -> Option<Contact> {
        // Tangled features must pass through others to come apart.
        if self.tangles.contain_any(&pair) {
            return None;
        }
        let of = |positions: &[Vec3]| pair.map(|particle| positions[particle as usize]);
        let (start, end) = (of(&particles.start), of(&particles.end));
        let passed = kind.passed(start, end);
        let Keep { distance, friction, rest } = self.rules.keep(pair);
        let near = kind.near(end, passed).filter(|near| near.gap < FAR * distance)?;
        let is_near_at_rest = |rest: &[Vec3; 4]| kind.are_within(rest, distance / REST_PART);
        let at_rest = rest
            .filter(is_near_at_rest)
            .map_or(f32::INFINITY, |rest| REST_PART * kind.distance(rest));
        let distance = distance.min(at_rest).min(kind.distance(start) + RECOVERY * self.step);
        Some(Contact {
            particles: pair,
            kind,
            distance,
            friction,
            passed,
            normal: near.normal,
            factors: near.factors,
            is_facing: true,
            fresh: 0.0,
            depth: 0.0,
            stopped: 0.0,
            impact: 0.0,
        })
    }
}
