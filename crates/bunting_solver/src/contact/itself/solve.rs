//! The contacts of layers in a substep: found, put into packs, and solved in sweeps.

use glam::Vec3;

use crate::contact::itself::contact_packs::{ContactPack, Packing};
use crate::contact::itself::near::{EdgeEdge, ParticleTriangle};
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::particles::{Particles, relative};
use crate::contact::itself::points::Points;
use crate::contact::itself::rules::Rules;
use crate::contact::itself::separate::{move_apart, stop};
use crate::contact::itself::touching::{FindTouching, NearPair, Touching};
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;
use crate::simd::vec3::lane3;

/// Part of their distance below which features are pressed together. Larger: layers at rest tremble. Smaller: they pass
/// through one another by under-relaxation.
const PRESSED: f32 = 0.5;

/// The contacts of layers in a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Contacts {
    /// Contacts of particles with triangles, and of edges with edges.
    packs: [Vec<ContactPack>; 2],
    /// All particles that have contacts.
    members: Vec<u32>,
    is_member: Vec<bool>,
    packing: Packing,
    /// Scratch arrays.
    touching: [Vec<Touching>; 2],
    near: Vec<NearPair>,
}

impl Contacts {
    pub fn clear(&mut self) {
        self.packs.iter_mut().for_each(Vec::clear);
        self.forget_members();
    }

    /// Finds the contacts among pairs.
    pub fn find<R: Rules>(&mut self, pairs: &Pairs, points: &Points, by: &FindTouching<R>) {
        by.find(pairs, points, &mut self.touching, &mut self.near);
        self.forget_members();
        let count = points.end.len();
        self.is_member.resize(count, false);
        for (touching, packs) in self.touching.iter().zip(&mut self.packs) {
            self.packing.pack(touching, count, packs);
            for particle in touching.iter().flat_map(|it| it.particles) {
                if !core::mem::replace(&mut self.is_member[particle as usize], true) {
                    self.members.push(particle);
                }
            }
        }
    }

    /// Marks the particles that have contacts, and no others.
    pub fn mark_near(&self, is_near: &mut [bool]) {
        is_near.fill(false);
        self.members.iter().for_each(|&at| is_near[at as usize] = true);
    }

    fn forget_members(&mut self) {
        self.members.drain(..).for_each(|at| self.is_member[at as usize] = false);
    }

    /// Whether a particle has contacts.
    pub fn has(&self, particle: u32) -> bool {
        self.is_member[particle as usize]
    }

    /// All particles that have contacts.
    pub fn members(&self) -> impl Iterator<Item = usize> {
        self.members.iter().map(|&at| at as usize)
    }

    /// Moves all features apart that are too near, in so many sweeps over all contacts, and marks the particles that have moved. These
    /// pushes become velocities at some rate, 1/s. Returns whether there are any.
    pub fn move_apart(
        &mut self,
        points: &mut Points,
        particles: &mut Particles,
        sweeps: usize,
        rate: f32,
    ) -> bool {
        if self.members.is_empty() {
            return false;
        }
        self.read(points, particles);
        let has_moved = self.sweep(points, sweeps);
        if has_moved {
            points.write_positions(particles, &self.members);
            self.count_pushes(rate);
        }
        has_moved
    }

    /// Moves all features apart that are too near, and stops their approach, in at most so many sweeps over all contacts.
    ///
    /// The pushes become velocities at some rate, 1/s, as those of other constraints do: else what answers to them in the next substep would
    /// be a velocity without a motion. What they give is taken back where features would leave each other.
    pub fn separate(
        &mut self,
        points: &mut Points,
        particles: &mut Particles,
        sweeps: usize,
        rate: f32,
    ) {
        if self.members.is_empty() {
            return;
        }
        self.read(points, particles);
        points.read_velocities(particles, &self.members);
        if self.sweep(points, sweeps) {
            points.add_pushes(particles, &self.members, rate);
            self.count_pushes(rate);
        }
        let [triangles, edges] = &mut self.packs;
        for _ in 0..sweeps {
            let any = stop(triangles, points);
            if !(stop(edges, points) || any) {
                break;
            }
        }
        points.write_positions(particles, &self.members);
        points.write_velocities(particles, &self.members);
    }

    fn count_pushes(&mut self, rate: f32) {
        self.packs.iter_mut().flatten().for_each(|pack| pack.count_pushes(rate));
    }

    /// Reads positions and masses.
    fn read(&mut self, points: &mut Points, particles: &Particles) {
        points.read_ends(particles);
        for pack in self.packs.iter_mut().flatten() {
            pack.read_masses(&particles.inverse_mass);
        }
    }

    /// Moves features apart, in at most so many sweeps. Returns whether any were too near.
    fn sweep(&mut self, points: &mut Points, sweeps: usize) -> bool {
        let [triangles, edges] = &mut self.packs;
        let mut has_moved = false;
        for _ in 0..sweeps {
            let any = move_apart::<ParticleTriangle>(triangles, points);
            if !(move_apart::<EdgeEdge>(edges, points) || any) {
                break;
            }
            has_moved = true;
        }
        has_moved
    }

    /// The contacts of features that are as near as they may be, given what counts as such, m: their particles, a point of
    /// the first feature, m, and the unit normal on its side.
    pub fn touching(
        &self,
        particles: &Particles,
        within: f32,
    ) -> impl Iterator<Item = ([u32; 4], Vec3, Vec3)> {
        self.facing(particles).filter(move |it| it.gap < it.distance + within).map(|it| {
            let first = it.particles.iter().zip(it.factors).filter(|(_, factor)| *factor > 0.0);
            let point = first.map(|(&at, factor)| particles.end[at as usize] * factor).sum();
            (it.particles, point, it.normal)
        })
    }

    /// Particles of features that are still much nearer than they must be.
    pub fn pressed_particles(&self, particles: &Particles) -> impl Iterator<Item = usize> {
        let pressed = self.facing(particles).filter(|it| it.gap < PRESSED * it.distance);
        pressed.flat_map(|it| it.particles.map(|at| at as usize))
    }

    /// All features that face each other.
    fn facing(&self, particles: &Particles) -> impl Iterator<Item = Facing> {
        let lanes = |pack| (ContactPack::first(pack)..Pack8::WIDTH).map(move |lane| (pack, lane));
        let all = self.packs.iter().flatten().flat_map(lanes);
        all.filter(|(pack, lane)| pack.faces.lanes()[*lane] > 0.0).map(|(pack, lane)| {
            let of_lane = pack.particles_of(lane);
            let factors = pack.factors.map(|factors| factors.lanes()[lane]);
            let normal = lane3(&pack.normal, lane);
            Facing {
                particles: of_lane,
                factors,
                normal,
                distance: pack.distance.lanes()[lane],
                gap: relative(&particles.end, of_lane, factors).dot(normal),
            }
        })
    }
}

/// Two features that face each other.
struct Facing {
    particles: [u32; 4],
    factors: [f32; 4],
    normal: Vec3,
    /// Distance that they keep, m.
    distance: f32,
    /// Distance along the normal, m.
    gap: f32,
}
