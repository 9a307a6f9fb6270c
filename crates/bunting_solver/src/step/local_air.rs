//! Wind that differs from particle to particle.
//!
//! The air on a triangle follows from the velocity of its corners relative to the wind. A wind that moves corner i by wᵢ
//! faster than the [`Drive`](crate::step::Drive) says is the same as a corner that moves by wᵢ slower: the air is summed
//! with velocities less wᵢ, at positions that make the triangle in the middle of the substep the same. So the sum itself, and
//! cloths in one wind, know nothing of this.

use glam::{Quat, Vec3};

use crate::batch::BatchError;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::{lane3, set_lane3, splat3};
use crate::step::local_wind::LocalWind;

impl LaneState {
    /// Greatest velocity of the wind at a particle besides that of the drive, m/s.
    pub fn greatest_local_wind(&self) -> f32 {
        let winds = self.local_wind.iter().flatten();
        winds.map(|wind| wind.length_squared()).fold(0.0, f32::max).sqrt()
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Sets the wind at each particle of a cloth less that of its drive, m/s; none if the list is empty.
    pub fn set_local_wind(&mut self, cloth: usize, winds: Vec<Vec3>) -> Result<(), BatchError> {
        let expected = self.fabrics[Y::fabric_of(cloth)].fabric.particle_count();
        if !winds.is_empty() && winds.len() != expected {
            return Err(BatchError::ParticleCount { given: winds.len(), expected });
        }
        if !winds.iter().all(|wind| wind.is_finite()) {
            return Err(BatchError::Drive { name: "local wind" });
        }
        if let Some(state) = &mut self.lanes[cloth] {
            state.local_wind = (!winds.is_empty()).then_some(winds);
        }
        Ok(())
    }

    /// Begins a tick: spreads the winds of all cloths over the lanes.
    pub fn begin_local_wind(&mut self) {
        let has_any = self.lanes.iter().flatten().any(|cloth| cloth.local_wind.is_some());
        if !has_any && self.local_wind.is_none() {
            return;
        }
        let of_cloths = self.lanes.iter().enumerate();
        let of_cloths = of_cloths
            .filter_map(|(cloth, state)| Some((cloth, state.as_ref()?.local_wind.clone()?)));
        let of_cloths: Vec<(usize, Vec<Vec3>)> = of_cloths.collect();
        self.spread_local_wind(&of_cloths);
    }

    /// Spreads the winds of some cloths over the lanes; in the lanes of others there is none.
    fn spread_local_wind(&mut self, of_cloths: &[(usize, Vec<Vec3>)]) {
        if of_cloths.is_empty() {
            self.local_wind = None;
            return;
        }
        let none = vec![splat3(Vec3::ZERO); self.layout.pack_count()];
        let local = self.local_wind.get_or_insert_with(|| {
            Box::new(LocalWind {
                winds: none.clone(),
                turns: vec![Quat::IDENTITY; P::WIDTH],
                relative: none.clone(),
                kept: none.clone(),
            })
        });
        local.winds = none;
        for (cloth, winds) in of_cloths {
            for (particle, wind) in winds.iter().enumerate() {
                let (pack, lane) = self.layout.locate(particle, *cloth);
                set_lane3(&mut local.winds[pack], lane, *wind);
            }
        }
    }

    /// Sums the air as [`gather_air`](Self::gather_air) does, in winds that differ from particle to particle.
    pub fn gather_local_air(&mut self, local: &mut LocalWind<P>) {
        let LocalWind { winds, turns, relative, kept } = local;
        let half_step = 0.5 * self.clock.step;
        let positions = self.positions.packs_mut();
        kept.clone_from(positions);
        relative.clone_from(&self.velocity);
        for ((at, velocity), wind) in positions.iter_mut().zip(relative.iter_mut()).zip(winds) {
            for (lane, &turn) in turns.iter().enumerate() {
                let wind = turn * lane3(wind, lane);
                let relative = lane3(velocity, lane) - wind;
                set_lane3(velocity, lane, relative);
                let shifted = lane3(at, lane) + wind * half_step;
                set_lane3(at, lane, shifted);
            }
        }
        self.sum_air(Some(relative));
        self.positions.packs_mut().clone_from(kept);
    }
}
