//! Hinges of a lone mesh, eight at once.

use fearless_simd::{Simd, f32x8};

use super::in_order::packs_in_order;
use crate::constraints::gauss_seidel::dihedral::{HingeStep, hinge_step};
use crate::constraints::vector_particles::VectorParticles;
use crate::fabric::{Fabric, Hinge};
use crate::simd::lane::{Lane, Pack};
use crate::simd::registers::Pack8;

/// Hinges that share no particle. Lanes without a hinge repeat the first one.
#[derive(Clone, Debug)]
pub(super) struct HingePack {
    /// The particles of the hinges, corner by corner.
    particles: [[u32; Pack8::WIDTH]; 4],
    /// Angle at rest, rad.
    rest_angle: Pack8,
    /// Index of the compliance of each hinge.
    classes: [u32; Pack8::WIDTH],
    /// XPBD multiplier in this substep.
    multiplier: Pack8,
    /// Number of hinges: the first lanes have them.
    count: usize,
}

/// The hinges of a fabric in packs.
pub(super) fn hinge_packs(fabric: &Fabric) -> Vec<HingePack> {
    let hinges = fabric.hinges();
    let particles = hinges.iter().map(|hinge| &hinge.particles[..]);
    let packs = packs_in_order(Pack8::WIDTH, fabric.particle_count(), particles);
    packs.iter().map(|pack| HingePack::new(hinges, pack)).collect()
}

impl HingePack {
    fn new(hinges: &[Hinge], pack: &[usize]) -> Self {
        let hinge = |lane: usize| &hinges[*pack.get(lane).unwrap_or(&pack[0])];
        let particles =
            [0, 1, 2, 3].map(|corner| core::array::from_fn(|lane| hinge(lane).particles[corner]));
        let mut rest_angle = Pack8::splat(0.0);
        for (lane, angle) in rest_angle.lanes_mut().iter_mut().enumerate() {
            *angle = hinge(lane).rest_angle;
        }
        Self {
            particles,
            rest_angle,
            classes: core::array::from_fn(|lane| hinge(lane).class),
            multiplier: Pack8::splat(0.0),
            count: pack.len(),
        }
    }
}

/// Projects every hinge, from the first to the last and then backwards.
pub(super) struct SolveHinges<'a> {
    pub packs: &'a mut [HingePack],
    /// Compliance of each class, 1/m⁴.
    pub compliance: &'a [f32],
    pub particles: VectorParticles<'a>,
}

impl SolveHinges<'_> {
    #[inline(always)]
    pub fn run<S: Simd>(mut self, token: S) {
        let zero = <f32x8<S> as Lane>::splat(token, 0.0);
        for pack in &mut *self.packs {
            zero.store(&mut pack.multiplier);
            solve(token, pack, self.compliance, &mut self.particles);
        }
        for pack in self.packs.iter_mut().rev() {
            solve(token, pack, self.compliance, &mut self.particles);
        }
    }
}

#[inline(always)]
fn solve<S: Simd>(
    token: S,
    pack: &mut HingePack,
    of_classes: &[f32],
    particles: &mut VectorParticles<'_>,
) {
    let [a, b, c, d] = &pack.particles;
    let corners = [
        particles.gather(token, a),
        particles.gather(token, b),
        particles.gather(token, c),
        particles.gather(token, d),
    ];
    let masses = [
        particles.inverse_masses(token, a),
        particles.inverse_masses(token, b),
        particles.inverse_masses(token, c),
        particles.inverse_masses(token, d),
    ];
    let mut compliance = Pack8::splat(0.0);
    for (compliance, &class) in compliance.lanes_mut().iter_mut().zip(&pack.classes) {
        *compliance = of_classes[class as usize];
    }
    let compliance: f32x8<S> = Lane::load(token, &compliance);
    let rest_angle = Lane::load(token, &pack.rest_angle);
    let multiplier: f32x8<S> = Lane::load(token, &pack.multiplier);
    let HingeStep { step, gradient } =
        hinge_step(token, corners, masses, rest_angle, compliance, Some(multiplier));
    Lane::store(multiplier + step, &mut pack.multiplier);
    for ((of_corner, mass), by) in pack.particles.iter().zip(masses).zip(gradient) {
        particles.scatter(token, &of_corner[..pack.count], by, mass * step);
    }
}
