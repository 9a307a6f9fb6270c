//! Features that come nearer than the thickness are moved apart: C = n·Σ wᵢ xᵢ − d ≥ 0, with Coulomb friction.
//!
//! A contact has four particles with factors wᵢ: one and the negative barycentric coordinates of a particle over a
//! triangle, or those of the closest points of two edges. A feature that has passed through another in the substep
//! returns to the side on which it began.

use glam::Vec3;

use crate::constants::LEAST_LENGTH;
use crate::contact::itself::closest::{edges, over};
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::particles::{Particles, relative};
use crate::contact::itself::rules::{Keep, Rules};
use crate::contact::itself::untangle::Tangles;

/// Speed at which features that are too near at the start of a substep move apart, m/s. Smaller: layers stay pressed
/// together for long. Larger: links beside them are stretched.
const RECOVERY: f32 = 0.5;

/// Part of the distance at rest that features keep which are nearer than the thickness at rest. Larger: such features
/// are pushed by rounding errors.
const REST_PART: f32 = 0.8;

/// Part of their distance below which features are pressed together. Larger: layers at rest tremble. Smaller: they pass
/// through one another by under-relaxation.
const PRESSED: f32 = 0.5;

/// Two features that touch, or may touch in later sweeps.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct Contact {
    particles: [u32; 4],
    kind: Kind,
    /// Distance that the features keep, m.
    distance: f32,
    /// Coulomb friction coefficient.
    friction: f32,
    /// Sign of the height, or of the volume, at the start of the substep, if the features have passed through one
    /// another since; else zero.
    passed: f32,
    /// Unit normal and factors when the contact was last solved.
    normal: Vec3,
    factors: [f32; 4],
    /// Sum of the depths by which the features were moved apart, m.
    depth: f32,
    /// The [`travel`](Particles::travel) of the four particles, m, up to which the features stay farther apart than they
    /// must.
    reach: f32,
    /// Sum of the approaches that were stopped, m/s.
    stopped: f32,
    /// What of this was an impact, m/s.
    impact: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    ParticleTriangle,
    EdgeEdge,
}

/// Two features that are too near.
struct Near {
    /// Unit normal, to the side of the positive factors.
    normal: Vec3,
    factors: [f32; 4],
    /// Signed distance, m.
    gap: f32,
}

/// The distances of contacts.
pub(in crate::contact) struct Spacing<'a, R> {
    pub rules: &'a R,
    /// Number of times that all contacts are solved, one after the other.
    pub sweeps: usize,
    /// Length of the substep, s.
    pub step: f32,
    /// Features that pass through one another at the start of the substep.
    pub tangles: &'a Tangles,
}

impl<R: Rules> Spacing<'_, R> {
    /// Moves all features apart that are too near, and stops their approach.
    pub fn separate(&self, pairs: &Pairs, particles: &mut Particles, contacts: &mut Vec<Contact>) {
        contacts.clear();
        let triangles = pairs.particles_triangles.iter().map(|&it| (it, Kind::ParticleTriangle));
        let edges = pairs.edges_edges.iter().map(|&it| (it, Kind::EdgeEdge));
        for (pair, kind) in triangles.chain(edges) {
            if let Some(contact) = self.contact(pair, kind, particles) {
                contacts.push(contact);
            }
        }
        particles.travel.clear();
        particles.travel.resize(particles.end.len(), 0.0);
        for _ in 0..self.sweeps {
            for contact in contacts.iter_mut() {
                contact.project(particles);
            }
        }
        for _ in 0..self.sweeps {
            for contact in contacts.iter_mut().filter(|contact| contact.depth > 0.0) {
                contact.stop(particles);
            }
        }
    }

    /// The contact of two features; none if they stay apart.
    fn contact(&self, pair: [u32; 4], kind: Kind, particles: &Particles) -> Option<Contact> {
        // Tangled features must pass through others to come apart.
        if self.tangles.contain_any(&pair) {
            return None;
        }
        let of = |positions: &[Vec3]| pair.map(|particle| positions[particle as usize]);
        let (start, end) = (of(&particles.start), of(&particles.end));
        let passed = match kind {
            Kind::ParticleTriangle => passed_triangle(start, end),
            Kind::EdgeEdge => passed_edge(start, end),
        };
        let Keep { distance: thickness, friction, rest } = self.rules.keep(pair);
        let mut contact = Contact {
            particles: pair,
            kind,
            distance: thickness,
            friction,
            passed,
            normal: Vec3::ZERO,
            factors: [0.0; 4],
            depth: 0.0,
            reach: 0.0,
            stopped: 0.0,
            impact: 0.0,
        };
        // Other contacts move particles by about the thickness.
        contact.near(particles).filter(|near| near.gap < 2.0 * thickness)?;
        let distance = match kind {
            Kind::ParticleTriangle => height_or_far,
            Kind::EdgeEdge => distance_of_edges,
        };
        let at_rest = rest.map_or(f32::INFINITY, |rest| REST_PART * distance(rest));
        contact.distance = thickness.min(at_rest).min(distance(start) + RECOVERY * self.step);
        Some(contact)
    }
}

impl Contact {
    /// The features, where they face each other.
    fn near(&self, particles: &Particles) -> Option<Near> {
        let at = self.particles.map(|particle| particles.end[particle as usize]);
        match self.kind {
            Kind::ParticleTriangle => over_triangle(at, self.passed),
            Kind::EdgeEdge => between_edges(at, self.passed),
        }
    }

    /// The particles of both features.
    pub fn particles(&self) -> impl Iterator<Item = usize> + use<> {
        self.particles.into_iter().map(|particle| particle as usize)
    }

    /// Whether the features are still much nearer than they must be.
    pub fn is_pressed(&self, particles: &Particles) -> bool {
        self.near(particles).is_some_and(|near| near.gap < PRESSED * self.distance)
    }

    /// Moves the features apart.
    fn project(&mut self, particles: &mut Particles) {
        let travel: f32 = self.particles.iter().map(|&at| particles.travel[at as usize]).sum();
        if travel < self.reach {
            return;
        }
        let Some(Near { normal, factors, gap }) = self.near(particles) else { return };
        let depth = (self.distance - gap).max(-self.depth);
        if depth == 0.0 {
            self.reach = travel + (gap - self.distance);
            return;
        }
        self.reach = 0.0;
        let inverse = self.inverse_mass(particles, factors);
        if inverse <= 0.0 {
            return;
        }
        let slide = relative(&particles.end, self.particles, factors)
            - relative(&particles.start, self.particles, factors);
        let slide = slide - normal * slide.dot(normal);
        let held = (self.friction * depth.max(0.0) / slide.length().max(LEAST_LENGTH)).min(1.0);
        let by = (normal * depth - slide * held) / inverse;
        for (&particle, factor) in self.particles.iter().zip(factors) {
            let particle = particle as usize;
            let factor = particles.inverse_mass[particle] * factor;
            let by = by * factor;
            particles.end[particle] += by;
            particles.travel[particle] += by.length();
            particles.touched[particle] |= factor != 0.0;
        }
        (self.normal, self.factors) = (normal, factors);
        self.depth += depth;
    }

    /// Stops the approach of the features, and slows their slide. What it gave before it takes back where other contacts
    /// have given too much: else features would leave each other in each substep, and layers at rest would tremble.
    fn stop(&mut self, particles: &mut Particles) {
        let velocity = relative(&particles.velocity, self.particles, self.factors);
        let approach = (-velocity.dot(self.normal)).max(-self.stopped);
        if approach == 0.0 {
            return;
        }
        let slide = velocity - self.normal * velocity.dot(self.normal);
        let most = self.friction * approach.max(0.0);
        let held = (most / slide.length().max(LEAST_LENGTH)).min(1.0);
        let inverse = self.inverse_mass(particles, self.factors);
        let change = (self.normal * approach - slide * held) / inverse;
        self.stopped += approach;
        // As far as the features approached each other at the start of the substep, this is an impact.
        let past = relative(&particles.past_velocity, self.particles, self.factors);
        let impact = (-past.dot(self.normal)).max(0.0).min(self.stopped);
        let part = (impact - self.impact) / approach;
        self.impact = impact;
        for (&particle, factor) in self.particles.iter().zip(self.factors) {
            let particle = particle as usize;
            let change = change * (particles.inverse_mass[particle] * factor);
            particles.velocity[particle] += change;
            particles.impact[particle] += change * part;
        }
    }

    /// Inverse mass of the relative motion of the features, 1/m².
    fn inverse_mass(&self, particles: &Particles, factors: [f32; 4]) -> f32 {
        let of = |(&particle, factor): (&u32, f32)| {
            particles.inverse_mass[particle as usize] * factor * factor
        };
        self.particles.iter().zip(factors).map(of).sum()
    }
}

/// Height of a particle over a triangle if it is projected into the triangle, m; else infinite.
fn height_or_far([particle, a, b, c]: [Vec3; 4]) -> f32 {
    match over(particle, [a, b, c]) {
        Some(over) if over.is_inside() => over.height.abs(),
        _ => f32::INFINITY,
    }
}

/// Distance of two edges, m.
fn distance_of_edges([a, b, c, d]: [Vec3; 4]) -> f32 {
    let [first, second] = edges([a, b], [c, d]);
    a.lerp(b, first).distance(c.lerp(d, second))
}

/// The sign of a particle's height over a triangle at the start if it has passed through the triangle; else zero.
fn passed_triangle(start: [Vec3; 4], end: [Vec3; 4]) -> f32 {
    let height = |[particle, a, b, c]: [Vec3; 4]| Some(over(particle, [a, b, c])?.height);
    let (Some(from), Some(to)) = (height(start), height(end)) else { return 0.0 };
    if from * to >= 0.0 {
        return 0.0;
    }
    let time = from / (from - to);
    let [particle, a, b, c] = core::array::from_fn(|at| start[at].lerp(end[at], time));
    match over(particle, [a, b, c]) {
        Some(over) if over.is_inside() => from.signum(),
        _ => 0.0,
    }
}

/// The sign of two edges' volume at the start if they have passed through each other; else zero.
fn passed_edge(start: [Vec3; 4], end: [Vec3; 4]) -> f32 {
    let (from, to) = (volume(start), volume(end));
    if from * to >= 0.0 {
        return 0.0;
    }
    let time = from / (from - to);
    let [a, b, c, d] = core::array::from_fn(|at| start[at].lerp(end[at], time));
    let inside = edges([a, b], [c, d]).into_iter().all(|it| it > 0.0 && it < 1.0);
    /// Part of the edges' length within which they meet at that time, which is an estimate.
    const MEETING: f32 = 0.1;
    let length = a.distance(b).min(c.distance(d));
    let meet = distance_of_edges([a, b, c, d]) < MEETING * length;
    if inside && meet { from.signum() } else { 0.0 }
}

/// Six times the volume between two edges, m³.
fn volume([a, b, c, d]: [Vec3; 4]) -> f32 {
    (b - a).cross(d - c).dot(a - c)
}

/// A particle over a triangle; none beside it.
fn over_triangle([particle, a, b, c]: [Vec3; 4], passed: f32) -> Option<Near> {
    let over = over(particle, [a, b, c]).filter(|over| over.is_inside())?;
    let side = if passed == 0.0 { over.height.signum() } else { passed };
    let [of_a, of_b, of_c] = over.coordinates;
    Some(Near {
        normal: over.normal * side,
        factors: [1.0, -of_a, -of_b, -of_c],
        gap: over.height * side,
    })
}

/// Two edges that face each other; none where they have passed through each other and do not face each other.
fn between_edges([a, b, c, d]: [Vec3; 4], passed: f32) -> Option<Near> {
    let [first, second] = edges([a, b], [c, d]);
    let away = a.lerp(b, first) - c.lerp(d, second);
    let distance = away.length();
    let factors = [1.0 - first, first, second - 1.0, -second];
    if passed != 0.0 {
        let is_inside = [first, second].iter().all(|&it| it > 0.0 && it < 1.0);
        let normal = (b - a).cross(d - c).try_normalize().filter(|_| is_inside)? * passed;
        return Some(Near { normal, factors, gap: away.dot(normal) });
    }
    if distance < LEAST_LENGTH {
        return None;
    }
    Some(Near { normal: away / distance, factors, gap: distance })
}
