//! Air: pressure and skin friction on each triangle (thesis, eq. 5.1 and 5.2 in one).
//!
//! With the air's velocity u relative to a triangle of area A and normal n, the pressure force is
//! ½ρ C_n A |u·n| (u·n) n and the friction ½ρ C_t A |u| (u − (u·n) n). In a substep of h seconds the
//! pressure would change the velocity by the part a = ½ρ C_n |u·n| h/σ of u·n: explicitly, which
//! turns the motion round where a > 1 (the thesis then sets it to zero), or implicitly by a/(1 + a),
//! which loses the part a of the force that a cloth at rest in the wind feels. Here it is
//! a/√(1 + a²): right to second order, and never more than the whole. A third of a triangle's impulse
//! goes to each corner. A particle's change is then a mean of its triangles' changes, none of which
//! adds energy in still air, and neither does the mean.

use crate::constants::LEAST_AREA_SQUARED;
use crate::fabric::Fabric;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Mask, Pack};
use crate::parameters::Parameters;
use crate::vector::{Pack3, V3, splat3};

impl<P: Pack> LaneBatch<P> {
    /// Gathers what the air does to each particle in this substep.
    pub fn apply_air(&mut self) {
        if !self.parameters.feels_air() && !self.felt_air {
            return;
        }
        self.felt_air = self.parameters.feels_air();
        self.air_impulse.fill(splat3(glam::Vec3::ZERO));
        P::run(Air {
            fabric: &self.fabric,
            parameters: &self.parameters,
            position: &self.position,
            velocity: &self.velocity,
            impulse: &mut self.air_impulse,
        });
    }
}

struct Air<'a, P: Pack> {
    fabric: &'a Fabric,
    parameters: &'a Parameters<P>,
    position: &'a [Pack3<P>],
    velocity: &'a [Pack3<P>],
    impulse: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Air<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let wind: V3<L> = V3::load(token, &self.parameters.wind);
        let pressure = L::load(token, &self.parameters.pressure);
        let friction = L::load(token, &self.parameters.friction);
        let rubs = L::splat(token, 0.0).lt(friction);
        let any_rubs = rubs.any();
        let third = L::splat(token, 1.0 / 3.0);
        let one = L::splat(token, 1.0);
        let least = L::splat(token, LEAST_AREA_SQUARED);
        for (corners, &area) in self.fabric.triangles().iter().zip(self.fabric.triangle_areas()) {
            let [a, b, c] = corners.map(|corner| corner as usize);
            let at: [V3<L>; 3] = [a, b, c].map(|corner| V3::load(token, &self.position[corner]));
            let going: [V3<L>; 3] = [a, b, c].map(|corner| V3::load(token, &self.velocity[corner]));
            let u = wind - (going[0] + going[1] + going[2]) * third;
            let normal = (at[1] - at[0]).cross(at[2] - at[0]);
            let squared = normal.dot(normal).max(least);
            let across = u.dot(normal);
            let braking = pressure * across.abs();
            // (u·n) a/√(1 + a²) n with n not normalised.
            let root = (squared + braking * braking).sqrt();
            let mut change = normal * (across * braking / (squared * root));
            if any_rubs {
                let along = u - normal * (across / squared);
                let rub = friction * friction * u.dot(u);
                let rubbed = change + along * (rub / (one + rub)).sqrt();
                change = rubbed.or_where_not(rubs, change);
            }
            let share = change * L::splat(token, area / 3.0);
            for corner in [a, b, c] {
                let sum: V3<L> = V3::load(token, &self.impulse[corner]);
                (sum + share).store(&mut self.impulse[corner]);
            }
        }
    }
}
