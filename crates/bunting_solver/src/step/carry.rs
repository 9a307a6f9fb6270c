//! Transformation of the state into the frame after the frame has moved by one substep.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Transforms the state into the moved frame. Free particles keep their positions in the world; pinned
    /// ones move with the frame, and so have a velocity.
    pub fn carry_state(&mut self) {
        P::run(CarryState {
            inverse_areas: &self.masses.inverse_areas,
            parameters: &self.parameters,
            inverse_step: 1.0 / self.clock.step,
            position: self.positions.packs_mut(),
            velocity: &mut self.velocity,
            history: [
                &mut self.displacement,
                &mut self.older_displacement,
                &mut self.older_velocity,
                &mut self.oldest_velocity,
            ],
        });
    }
}

/// The frame's motion in a substep, in registers.
pub(crate) struct FrameRegisters<L: Lane> {
    /// Rows of the rotation minus the identity.
    turn: [V3<L>; 3],
    /// Shift of the coordinates, m.
    shift: V3<L>,
    /// Lanes whose frame moves.
    pub moves: L::Mask,
}

impl<L: Lane> FrameRegisters<L> {
    #[inline(always)]
    pub fn load(token: L::Token, parameters: &Parameters<L::Pack>) -> Self {
        let [x, y, z] = &parameters.frame_turn;
        Self {
            turn: [V3::load(token, x), V3::load(token, y), V3::load(token, z)],
            shift: V3::load(token, &parameters.frame_shift),
            moves: L::splat(token, 0.0).lt(L::load(token, &parameters.frame_moves)),
        }
    }

    /// Change of the coordinates of a direction that is constant in the world.
    #[inline(always)]
    fn change_of_direction(&self, direction: V3<L>) -> V3<L> {
        let [x, y, z] = &self.turn;
        V3 { x: x.dot(direction), y: y.dot(direction), z: z.dot(direction) }
    }

    /// Change of the coordinates of a point that is fixed in the world, m.
    #[inline(always)]
    pub fn change_of_point(&self, point: V3<L>) -> V3<L> {
        self.change_of_direction(point) + self.shift
    }

    /// Change of the coordinates of a point that is fixed in the world, along the tangent of its path in the
    /// frame, m. The chord of a turn points outwards, and damping towards the chord would throw the cloth
    /// outwards.
    #[inline(always)]
    pub fn tangent_at(&self, point: V3<L>, half: L) -> V3<L> {
        let [x, y, z] = &self.turn;
        let transposed = (*x * point.x).plus_scaled(*y, point.y).plus_scaled(*z, point.z);
        self.shift.plus_scaled(self.change_of_direction(point) - transposed, half)
    }

    /// Transforms a direction that is constant in the world.
    #[inline(always)]
    fn rewrite(&self, token: L::Token, direction: &mut Pack3<L::Pack>) {
        let d: V3<L> = V3::load(token, direction);
        self.apply(d, self.change_of_direction(d)).store(direction);
    }

    /// The changed vector in lanes with a moving frame; other lanes keep their bits.
    #[inline(always)]
    fn apply(&self, vector: V3<L>, change: V3<L>) -> V3<L> {
        (vector + change).or_where_not(self.moves, vector)
    }
}

struct CarryState<'a, P: Pack, C> {
    inverse_areas: &'a [C],
    parameters: &'a Parameters<P>,
    /// Rate of substeps, 1/h, 1/s.
    inverse_step: f32,
    position: &'a mut [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
    /// All other vectors that are transformed as directions.
    history: [&'a mut [Pack3<P>]; 4],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for CarryState<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let frame = FrameRegisters::<L>::load(token, self.parameters);
        let inverse_step = L::splat(token, self.inverse_step);
        let particles = self.position.iter_mut().zip(self.velocity);
        for ((position, velocity), &inverse_area) in particles.zip(self.inverse_areas) {
            let x: V3<L> = V3::load(token, position);
            let carried = frame.apply(x, frame.change_of_point(x));
            let of_pin = (x - carried) * inverse_step;
            if inverse_area.is_zero() {
                of_pin.store(velocity);
                continue;
            }
            inverse_area.select3(token, carried, x).store(position);
            frame.rewrite(token, velocity);
            let free: V3<L> = V3::load(token, velocity);
            inverse_area.select3(token, free, of_pin).store(velocity);
        }
        for directions in self.history {
            for direction in directions {
                frame.rewrite(token, direction);
            }
        }
    }
}
