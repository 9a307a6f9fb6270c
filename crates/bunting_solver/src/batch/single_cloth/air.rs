//! The air on a cloth whose cells lie in the lanes.

use super::Weave;
use super::cells::{Cells, Corners, Giver};
use super::sheets::Plane;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::air::Stream;
use crate::step::parameters::Parameters;

impl<P: Pack> Weave<P> {
    /// Gathers what the air does to each particle in this substep.
    pub fn gather_air(
        &mut self,
        parameters: &Parameters<P>,
        position: &[Pack3<P>],
        velocity: &[Pack3<P>],
        impulse: &mut [Pack3<P>],
    ) {
        self.sheets.read(position);
        self.velocity.read(velocity);
        P::run(Air {
            cells: &mut self.cells,
            parameters,
            position: self.sheets.straight(),
            velocity: &self.velocity,
            impulse,
        });
    }
}

struct Air<'a, P: Pack> {
    cells: &'a mut Cells<P>,
    parameters: &'a Parameters<P>,
    position: &'a Plane,
    velocity: &'a Plane,
    impulse: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Air<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let Self { cells, parameters, position, velocity, impulse } = self;
        let stream = Stream::<L>::load(token, parameters);
        cells.sum(token, &mut Blown { stream, position, velocity, impulse });
    }
}

struct Blown<'a, L: Lane> {
    stream: Stream<L>,
    position: &'a Plane,
    velocity: &'a Plane,
    impulse: &'a mut [Pack3<L::Pack>],
}

impl<L: Lane> Giver<L> for Blown<'_, L> {
    #[inline(always)]
    fn give(&self, token: L::Token, corners: Corners<L>, shares: [L; 2]) -> [V3<L>; 2] {
        let at = corners.of(token, self.position);
        self.stream.blow(at, corners.of(token, self.velocity), shares)
    }

    #[inline(always)]
    fn put(&mut self, _: L::Token, pack: usize, sum: V3<L>) {
        sum.store(&mut self.impulse[pack]);
    }
}
