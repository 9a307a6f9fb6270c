//! Rest by kinetic damping.
//!
//! Cundall 1976; Barnes 1999, "Form finding and analysis of tension structures by dynamic relaxation": the
//! undamped cloth moves freely, and is stopped whenever its kinetic energy passes a peak.

use glam::DVec3;

use super::verlet::Verlet;

impl Verlet {
    /// Relaxes until no vertex has a residual force of more than `tolerance` newtons, or for `limit` steps.
    /// Returns the residual, N.
    pub fn relax(&mut self, h: f64, tolerance: f64, limit: usize) -> f64 {
        let mut before = 0.0;
        for _ in 0..limit {
            self.step(h, 0.0);
            let kinetic = self.grid().kinetic_energy(&self.velocities);
            if kinetic >= before {
                before = kinetic;
                continue;
            }
            self.velocities.fill(DVec3::ZERO);
            before = 0.0;
            if self.residual() < tolerance {
                break;
            }
        }
        self.residual()
    }
}
