//! Velocities of particles that colliders have pushed along their surfaces, in lanes: as `LaneBatch::change_velocity` for single particles.

use crate::contact::collider_packs::{ColliderPacks, slides};
use crate::contact::lane_shapes::Affine;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};

/// Kernel that changes the velocities of particles that slide.
pub(super) struct ChangeVelocities<'a, P: Pack> {
    pub set: &'a mut ColliderPacks<P>,
    /// One in lanes whose velocities change, zero in others.
    pub changed: P,
    /// Length of a substep, s.
    pub step: f32,
    /// Effective length of the substep, s.
    pub effective_step: &'a P,
    /// Positions at the start of the substep, m.
    pub start: &'a [Pack3<P>],
    /// Changes of position that were predicted, m.
    pub displacement: &'a [Pack3<P>],
    /// Positions after the pushes, m.
    pub position: &'a [Pack3<P>],
    /// Velocities, m/s, of this substep and of the two before.
    pub velocities: [&'a mut [Pack3<P>]; 3],
}

impl<P: Pack> Kernel<P> for ChangeVelocities<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let set = self.set;
        let zero = L::splat(token, 0.0);
        let one = L::splat(token, 1.0);
        let into_collider = Affine::<L>::load(token, &set.into_collider[1]);
        let into_cloth = Affine::<L>::load(token, &set.into_cloth);
        let into_motion = Affine::<L>::load(token, &set.into_motion);
        let step = L::splat(token, self.step);
        let per_step = one / step;
        let per_effective_step = one / L::load(token, self.effective_step);
        let changed = zero.lt(L::load(token, &self.changed));
        let [velocity, older, oldest] = self.velocities;
        for near in &mut set.near {
            let slides = slides::<L>(token, near) & changed;
            if !slides.any() {
                continue;
            }
            let pack = near.pack as usize;
            let after: V3<L> = V3::load(token, &self.position[pack]);
            let start: V3<L> = V3::load(token, &self.start[pack]);
            let normal = into_cloth.turned(V3::load(token, &near.normal));
            let of_surface = into_motion.moved(into_collider.moved(after)) * per_step;
            let given = V3::load(token, &near.pushed) * per_effective_step;
            let given_away = given.dot(normal);
            let predicted = start + V3::load(token, &self.displacement[pack]);
            let present: V3<L> = V3::load(token, &velocity[pack]);
            let leaving = present + (after - predicted) * per_effective_step - of_surface;
            let thrown = leaving.dot(normal).min(given_away).max(zero);
            let thrown = thrown.or_where_not(slides, zero);
            present.minus_scaled(normal, thrown).store(&mut velocity[pack]);

            let approach = (of_surface - V3::load(token, &older[pack])).dot(normal);
            let impact = approach.min(given_away - thrown).max(zero);
            let impact = impact.or_where_not(slides, zero);
            for past in [&mut older[pack], &mut oldest[pack]] {
                V3::load(token, past).plus_scaled(normal, impact).store(past);
            }
            let steady = given.minus_scaled(normal, thrown + impact);
            // A steady force acts for the whole substep, of which the formula takes β.
            let gained = (steady * (step * per_effective_step)).plus_scaled(normal, impact);
            gained.store(&mut near.gained);
            (steady.dot(steady).sqrt() * per_effective_step).store(&mut near.steady);
        }
    }
}
