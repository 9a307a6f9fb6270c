//! The motion of the nodes of background grids.
//!
//! Nodes are integrated as the particles are: by the same formula, with gravity, damping and the motion of the frame.
//! What else acts on the particles reaches the nodes by projection (`constraints/background.rs`).

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::simd::lane::Pack;
use crate::step::clock::Clock;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Predicts the positions of nodes in the substep that the particles have begun. `frame_moved` says whether the frame
    /// of any cloth moves, or moved in the substep before.
    pub fn predict_nodes(&mut self, clock: Clock, frame_moved: bool) {
        self.clock = clock;
        self.parameters.any_frame_moved = frame_moved;
        if frame_moved {
            self.carry_state();
        }
        self.predict(false);
    }

    /// Computes the nodes' velocities from their corrected positions.
    pub fn update_node_velocities(&mut self) {
        self.correct_velocities(false, &mut P::splat(0.0));
    }
}
