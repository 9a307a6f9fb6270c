//! Distance: C = |x₂ − x₁| − l (thesis, eq. 4.15 to 4.18), along warp, weft and diagonals.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::constants::LEAST_LENGTH;
use crate::fabric::Link;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Projects every link once. With `accumulate`, targets are kept from pass to pass.
    pub fn solve_distance(&mut self, accumulate: bool) {
        let solve = Distance {
            links: self.fabric.links(),
            inverse_masses: self.fabric.inverse_areas(),
            compliance: &self.layout.factors().link_compliance,
            target: &mut self.link_target,
            position: self.positions.packs_mut(),
        };
        if accumulate {
            P::run(Accumulating(solve));
        } else {
            P::run(solve);
        }
    }
}

struct Distance<'a, P: Pack> {
    links: &'a [Link],
    inverse_masses: &'a [f32],
    compliance: &'a [P],
    /// Length that each link has under the tension found so far, l − α̃ λ, m.
    target: &'a mut [P],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Distance<'_, P> {
    #[inline(always)]
    fn solve<L: Lane<Pack = P>, const ACCUMULATE: bool>(self, token: L::Token) {
        let inverse_masses = self.inverse_masses;
        let least = L::splat(token, LEAST_LENGTH);
        for (link, stored) in self.links.iter().zip(self.target) {
            let (a, b) = (link.particles[0] as usize, link.particles[1] as usize);
            let [mass_a, mass_b] =
                [L::splat(token, inverse_masses[a]), L::splat(token, inverse_masses[b])];
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = V3::load(token, &self.position[a]);
            let to: V3<L> = V3::load(token, &self.position[b]);
            let along = to - from;
            let length = along.dot(along).sqrt().max(least);
            let target =
                if ACCUMULATE { L::load(token, stored) } else { L::splat(token, link.rest_length) };
            // The result is −Δλ/|d|, with a single division: |d| is part of the denominator.
            let pull = (length - target) / ((mass_a + mass_b + compliance) * length);
            if ACCUMULATE {
                target.plus_product(compliance * length, pull).store(stored);
            }
            from.plus_scaled(along, pull * mass_a).store(&mut self.position[a]);
            to.minus_scaled(along, pull * mass_b).store(&mut self.position[b]);
        }
    }
}

impl<P: Pack> Kernel<P> for Distance<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.solve::<L, false>(token);
    }
}

/// The same projection with targets that are kept from pass to pass.
struct Accumulating<K>(K);

impl<P: Pack> Kernel<P> for Accumulating<Distance<'_, P>> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        self.0.solve::<L, true>(token);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::constraints::bench::{cloth_at, positions, soft_step};
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};

    #[test]
    fn a_soft_step_follows_the_gradient() {
        let fabric = FabricBuilder::grid(Grid::new(4, 3, 1.0, 0.7)).pin([0]).build().expect("good");
        let material = FabricMaterial {
            warp_stiffness: 0.02,
            weft_stiffness: 0.03,
            shear_stiffness: 0.004,
            ..FabricMaterial::COTTON
        };
        let start: Vec<Vec3> = fabric
            .rest_positions()
            .iter()
            .map(|at| *at * 1.05 + Vec3::Z * 0.1 * libm::sinf(4.0 * at.x + 7.0 * at.y))
            .collect();
        let expected = soft_step(&fabric, &material, &start, |at| {
            let of_link = |link: &crate::fabric::Link| {
                let [a, b] = link.particles.map(|particle| at[particle as usize].as_dvec3());
                let stiffness = fabric.link_classes()[link.class as usize].stiffness(&material);
                0.5 * f64::from(stiffness) * (a.distance(b) - f64::from(link.rest_length)).powi(2)
            };
            fabric.links().iter().map(of_link).sum()
        });
        let mut batch = cloth_at(&fabric, material, &start);
        batch.solve_distance(false);
        let largest = expected.iter().map(|step| step.length()).fold(0.0, f32::max);
        for ((end, start), expected) in positions(&batch).iter().zip(&start).zip(&expected) {
            let moved = *end - *start;
            assert!(moved.distance(*expected) < 0.03 * largest, "{moved} {expected}");
        }
    }
}
