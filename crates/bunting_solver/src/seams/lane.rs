//! The seams of cloths in their lanes.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::seams::closing::Moment;
use crate::seams::state::LaneSeams;
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3};
use crate::stability::relaxation::EXEMPT;
use crate::step::Scheme;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves seams with the lines that end there, and closes their stitches, after all that holds each cloth together.
    pub fn close_seams(&mut self) {
        self.with_seams(Self::solve_seams_of);
    }

    /// Exempts the particles of closed stitches from under-relaxation, which would draw their sides apart.
    pub fn suspend_relaxation_of_seams(&mut self) {
        for cloth in 0..self.lanes.len() {
            if !self.parameters.is_near_rest(Y::lanes(cloth)) {
                continue;
            }
            let Some(seams) = self.lanes[cloth].as_ref().and_then(|state| state.seams.as_ref())
            else {
                continue;
            };
            for particle in seams.closed_particles() {
                let (pack, lane) = self.layout.locate(particle as usize, cloth);
                self.relaxation[pack].lanes_mut()[lane] = EXEMPT;
            }
        }
    }

    /// Ends the exemption of the last substep.
    pub fn resume_relaxation_of_seams(&mut self, cloth: usize) {
        let Some(seams) = self.lanes[cloth].as_ref().and_then(|state| state.seams.as_ref()) else {
            return;
        };
        for &particle in &seams.seams.particles {
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            let factor = &mut self.relaxation[pack].lanes_mut()[lane];
            *factor = factor.min(1.0);
        }
    }

    /// Calls `solve` for each cloth with closed stitches, with its seams taken out, so that the batch can be written.
    fn with_seams(&mut self, solve: impl Fn(&mut Self, usize, &mut LaneSeams)) {
        let are_closed = |state: &LaneState| state.seams.as_ref().is_some_and(|it| it.are_closed());
        for cloth in 0..self.lanes.len() {
            let state = self.lanes[cloth].as_mut().filter(|state| are_closed(state));
            let Some(mut seams) = state.and_then(|state| state.seams.take()) else { continue };
            solve(self, cloth, &mut seams);
            if let Some(state) = &mut self.lanes[cloth] {
                state.seams = Some(seams);
            }
        }
    }

    fn solve_seams_of(&mut self, cloth: usize, seams: &mut LaneSeams) {
        let has_lines = self.clock.settings.scheme == Scheme::Yarns;
        if has_lines && seams.places.is_empty() {
            seams.places = self.link_places(cloth, &seams.seams.links);
        }
        self.gather_sewn(cloth, seams, has_lines);
        let step = self.clock.step;
        // `integrate` has counted this substep already.
        let moment = Moment { step, passed: (self.clock.begun - 1) as f32 * step };
        let LaneSeams { seams: plan, lacings, sewing, .. } = &mut *seams;
        let limits = plan.limits(sewing, lacings, moment);
        if has_lines {
            plan.solve(sewing, &limits);
        }
        plan.close(sewing, &limits);
        self.scatter_sewn(cloth, seams, has_lines);
    }

    fn gather_sewn(&mut self, cloth: usize, seams: &mut LaneSeams, has_lines: bool) {
        let LaneSeams { seams, places, sewing, .. } = seams;
        // This call copies the positions back from the constraints' arrays.
        let positions = self.positions.packs_mut();
        sewing.at.clear();
        sewing.start.clear();
        sewing.inverse_mass.clear();
        for &particle in &seams.particles {
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            sewing.at.push(lane3(&positions[pack], lane));
            sewing.inverse_mass.push(self.masses.inverse[pack].lanes()[lane]);
        }
        for &particle in &seams.particles {
            sewing.start.push(self.start_of(cloth, particle));
        }
        if !has_lines {
            return;
        }
        sewing.rows.resize(places.len(), Default::default());
        sewing.target.clear();
        sewing.compliance.clear();
        let compliance = &self.layout.factors().link_compliance;
        for place in &*places {
            let lane = place.lane as usize;
            sewing.target.push(self.link_target[place.target as usize].lanes()[lane]);
            sewing.compliance.push(compliance[place.class as usize].lanes()[lane]);
        }
    }

    fn scatter_sewn(&mut self, cloth: usize, seams: &LaneSeams, has_lines: bool) {
        let LaneSeams { seams, places, sewing, .. } = seams;
        let positions = self.positions.packs_mut();
        for (&particle, &at) in seams.particles.iter().zip(&sewing.at) {
            let (pack, lane) = self.layout.locate(particle as usize, cloth);
            set_lane3(&mut positions[pack], lane, at);
        }
        if has_lines {
            for (place, &target) in places.iter().zip(&sewing.target) {
                let stored = &mut self.link_target[place.target as usize];
                stored.lanes_mut()[place.lane as usize] = target;
            }
        }
    }
}
