//! This project's solver as a peer.

use bunting_solver::FrameMotion;
use glam::{Quat, Vec3};

use super::peer::Peer;
use crate::{product::Cloth, simulation::Simulation};

impl Peer for Cloth {
    /// The frame moves within one tick; pinned particles move with it.
    fn teleport(&mut self, metres: f32) {
        let translation = Vec3::X * metres;
        self.drive.motion = FrameMotion { rotation: Quat::IDENTITY, translation };
        self.tick();
        self.drive.motion = FrameMotion::NONE;
    }

    fn hitch(&mut self, seconds: f32) {
        self.advance(seconds);
    }
}
