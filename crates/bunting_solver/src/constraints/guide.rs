//! Guides: a free particle leaves neither the sphere of the greatest distance around its animated place nor enters the
//! sphere behind it.
//!
//! Both are solved after all that holds the cloth together, so that they hold at the end of a substep, and before contacts,
//! which may push a particle out of its sphere: a body that is hit matters more. They act as contacts without friction do:
//! a taut limit holds a particle like the rod of a pendulum, but takes the velocity across it instead of throwing the
//! particle back.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::constants::LEAST_LENGTH;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::carry::FrameRegisters;
use crate::step::guides::GuidePack;
use crate::step::parameters::Parameters;

/// Distance from the centre of a sphere below which a particle leaves it along the animated normal, m. Smaller: rounding of
/// coordinates decides where it goes. Larger: particles near the centre jump.
const CENTRE: f32 = 1e-5;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Projects every free particle to within the limits of its guide.
    pub fn solve_guides(&mut self) {
        let Some(guides) = &self.guides else { return };
        let substeps = self.clock.settings.substeps as f32;
        // `integrate` has counted this substep already.
        let [from, to] =
            [self.clock.begun - 1, self.clock.begun].map(|count| count as f32 / substeps);
        P::run(SolveGuides {
            guides: &guides.packs,
            parts: [from, to],
            parameters: &self.parameters,
            rate: 1.0 / self.clock.step,
            position: self.positions.packs_mut(),
            start: &self.scratch,
            displacement: &self.displacement,
            velocity: &mut self.velocity,
            past_velocities: [&mut self.older_velocity, &mut self.oldest_velocity],
        });
    }
}

struct SolveGuides<'a, P: Pack> {
    guides: &'a [GuidePack<P>],
    /// Parts of the tick that have passed at the start and at the end of the substep.
    parts: [f32; 2],
    parameters: &'a Parameters<P>,
    /// Rate of substeps, 1/h, 1/s.
    rate: f32,
    position: &'a mut [Pack3<P>],
    /// Positions at the start of the substep, m.
    start: &'a [Pack3<P>],
    displacement: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    past_velocities: [&'a mut [Pack3<P>]; 2],
}

/// A moving sphere, and the side of it on which a particle stays.
struct Sphere<L> {
    /// Centres at the start and at the end of the substep, m.
    centres: [V3<L>; 2],
    /// Unit vector along which a particle leaves the centre.
    outwards: V3<L>,
    radius: L,
    /// 1 for the inside, −1 for the outside.
    side: L,
}

impl<P: Pack> Kernel<P> for SolveGuides<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let frame = FrameRegisters::<L>::load(token, self.parameters);
        let [from, to] = self.parts;
        let parts = [L::splat(token, from), L::splat(token, to)];
        let one = L::splat(token, 1.0);
        for (at, guide) in self.guides.iter().enumerate() {
            let outwards = V3::load(token, &guide.normal);
            let around = Sphere {
                centres: along(token, &guide.places, parts),
                outwards,
                radius: L::load(token, &guide.max_distance),
                side: one,
            };
            self.hold(token, &frame, at, &around);
            let behind = Sphere {
                centres: along(token, &guide.behind, parts),
                outwards,
                radius: L::load(token, &guide.radius),
                side: -one,
            };
            self.hold(token, &frame, at, &behind);
        }
    }
}

/// Points on the straight line between two ends.
#[inline(always)]
fn along<L: Lane>(
    token: L::Token,
    [from, to]: &[Pack3<L::Pack>; 2],
    [first, second]: [L; 2],
) -> [V3<L>; 2] {
    let from: V3<L> = V3::load(token, from);
    let way = V3::load(token, to) - from;
    [from.plus_scaled(way, first), from.plus_scaled(way, second)]
}

impl<P: Pack> SolveGuides<'_, P> {
    /// Keeps a pack of particles on their side of spheres.
    #[inline(always)]
    fn hold<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        frame: &FrameRegisters<L>,
        at: usize,
        sphere: &Sphere<L>,
    ) {
        let before: V3<L> = V3::load(token, &self.position[at]);
        let away = before - sphere.centres[1];
        let squared = away.dot(away);
        let crossed = (sphere.radius * sphere.radius * sphere.side).lt(squared * sphere.side);
        // Most particles are within their limits in every lane.
        if !crossed.any() {
            return;
        }
        let distance = squared.sqrt();
        let least = L::splat(token, LEAST_LENGTH);
        let outwards = away * (L::splat(token, 1.0) / distance.max(least));
        let is_at_centre = distance.lt(L::splat(token, CENTRE));
        let outwards = sphere.outwards.or_where_not(is_at_centre, outwards);
        let after = sphere.centres[1].plus_scaled(outwards, sphere.radius);
        after.or_where_not(crossed, before).store(&mut self.position[at]);

        // As in contacts: velocity away from the surface that the correction gave is taken again, and an impact is not
        // extrapolated.
        let zero = L::splat(token, 0.0);
        let normal = outwards * -sphere.side;
        let inverse_step = L::load(token, &self.parameters.inverse_step);
        let centre = sphere.centres[0];
        let moved = sphere.centres[1] - (centre + frame.change_of_point(centre));
        let of_surface = moved * L::splat(token, self.rate);
        let velocity: V3<L> = V3::load(token, &self.velocity[at]);
        let predicted =
            V3::<L>::load(token, &self.start[at]) + V3::load(token, &self.displacement[at]);
        let leaving = velocity + (after - predicted) * inverse_step - of_surface;
        let given = ((after - before) * inverse_step).dot(normal);
        let thrown = leaving.dot(normal).min(given).max(zero);
        let kept = velocity.minus_scaled(normal, thrown);
        kept.or_where_not(crossed, velocity).store(&mut self.velocity[at]);
        let older: V3<L> = V3::load(token, &self.past_velocities[0][at]);
        let approach = (of_surface - older).dot(normal);
        let impact = approach.min(given - thrown).max(zero);
        for past in &mut self.past_velocities {
            let former: V3<L> = V3::load(token, &past[at]);
            let changed = former.plus_scaled(normal, impact);
            changed.or_where_not(crossed, former).store(&mut past[at]);
        }
    }
}
