//! The motion of the nodes of background grids.
//!
//! Nodes are integrated as the particles are: by the same formula, with gravity, damping, the motion of the frame, and air on
//! the grid's own cells. What else acts on the particles reaches the nodes by
//! projection (`constraints/background.rs`).
//!
//! Where the particles follow the nodes (`step/follow.rs`), the nodes also undo the turn about the pole, are
//! under-relaxed at rest, and damped internally; elsewhere particles are, and pass that on.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::set_lane3;
use crate::stability::pole::PoleTurn;
use crate::step::clock::Clock;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Sets how the nodes of a cloth are stabilised in the coming substep, given the fraction of the non-rigid velocity
    /// that internal damping leaves; not at all unless the particles follow them.
    pub fn begin_nodes(&mut self, cloth: usize, state: &LaneState, damping_factor: f32) {
        let lanes = Y::lanes(cloth);
        let (turn, factor) = match state.follows_nodes {
            true => (state.history.pole_turn, damping_factor),
            false => (PoleTurn::default(), 1.0),
        };
        self.parameters.set_pole_turn(lanes.clone(), turn);
        self.parameters.internal_damping_factor.lanes_mut()[lanes].fill(factor);
    }

    /// Predicts the positions of nodes in the substep that the particles have begun, and notes how they move. `frame_moved`
    /// says whether the frame of any cloth moves, or moved in the substep before.
    pub fn predict_nodes(
        &mut self,
        clock: Clock,
        frame_moved: bool,
        cloths: &mut [Option<LaneState>],
    ) {
        self.clock = clock;
        self.parameters.any_frame_moved = frame_moved;
        if frame_moved {
            self.carry_state();
        }
        // After the frame's motion, which gives all nodes that are held the velocity of the frame alone.
        for (cloth, state) in cloths.iter().enumerate() {
            if let Some(state) = state {
                self.set_node_velocities(cloth, &state.moving_pins.node_velocities);
            }
        }
        let feels_air = !self.fabric.patches().is_empty() && self.parameters.any_feels_air();
        if feels_air {
            self.gather_air();
        }
        let sums = self.predict(feels_air);
        for (cloth, state) in cloths.iter_mut().enumerate() {
            if let Some(state) = state {
                state.motion_of_nodes = sums.of_lane(Y::lanes(cloth).start);
            }
        }
    }

    /// Sets the velocities of some nodes of a cloth, m/s.
    pub fn set_node_velocities(&mut self, cloth: usize, of_nodes: &[(usize, Vec3)]) {
        for &(node, velocity) in of_nodes {
            let (pack, lane) = self.layout.locate(node, cloth);
            set_lane3(&mut self.velocity[pack], lane, velocity);
        }
    }

    /// Tells the tethers of the nodes where the pinned nodes of a cloth are.
    pub fn update_tethered_pins(&mut self, cloth: usize) {
        let mut positions = Vec::new();
        self.layout.read(self.positions.packs_mut(), cloth, &mut positions);
        self.layout.set_pins(cloth, &self.fabric, &positions);
    }

    /// Sets whether the nodes of a cloth are under-relaxed.
    pub fn set_nodes_near_rest(&mut self, cloth: usize, near_rest: bool) {
        if self.parameters.is_near_rest(Y::lanes(cloth)) && !near_rest {
            self.reset_relaxation(cloth);
        }
        self.parameters.set_near_rest(Y::lanes(cloth), near_rest);
    }

    /// Computes the nodes' velocities from their corrected positions, and the turns of the cloths that follow them.
    pub fn update_node_velocities(&mut self, cloths: &mut [Option<LaneState>]) {
        let turns = self.numbers.pole.is_some();
        let mut turn = P::splat(0.0);
        self.correct_velocities(turns, &mut turn);
        if turns {
            for (cloth, state) in cloths.iter_mut().enumerate() {
                if let Some(state) = state.as_mut().filter(|state| state.follows_nodes) {
                    let lane = Y::lanes(cloth).start;
                    let rate = self.parameters.inverse_step.lanes()[lane];
                    state.store_pole_turn(turn.lanes()[lane], rate);
                }
            }
        }
        self.damp_internally();
        self.keep_spin_of_nodes(cloths);
    }
}
