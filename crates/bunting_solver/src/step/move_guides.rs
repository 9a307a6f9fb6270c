//! The guides of a tick: given to a cloth, and spread over the lanes as they move.

use crate::batch::BatchError;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::simd::lane::Pack;
use crate::simd::vec3::set_lane3;
use crate::step::guides::{ClothGuides, Guide, GuidePack, Guides, Phase};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Sets the guides of a cloth in the next tick, one for each particle; none if the list is empty.
    pub fn set_guides(&mut self, cloth: usize, guides: Vec<Guide>) -> Result<(), BatchError> {
        let expected = self.fabrics[Y::fabric_of(cloth)].fabric.particle_count();
        if !guides.is_empty() && guides.len() != expected {
            return Err(BatchError::ParticleCount { given: guides.len(), expected });
        }
        if let Some(bad) = guides.iter().position(|guide| !guide.is_valid()) {
            return Err(BatchError::Guide { particle: bad as u32 });
        }
        if let Some(state) = &mut self.lanes[cloth] {
            state.guides =
                (!guides.is_empty()).then_some(ClothGuides { guides, phase: Phase::Ahead });
        }
        Ok(())
    }

    /// Begins a tick: guides of this tick begin their motion, and those of earlier ticks come to rest.
    pub fn begin_guides(&mut self) {
        let is_guided = self.lanes.iter().flatten().any(|cloth| cloth.guides.is_some());
        if !is_guided {
            self.guides = None;
            return;
        }
        let (count, lanes) = (self.layout.pack_count(), self.lanes.len());
        let guides = self.guides.get_or_insert_with(|| {
            Box::new(Guides {
                packs: vec![GuidePack::unlimited(); count],
                guided: vec![false; lanes],
            })
        });
        for cloth in 0..lanes {
            let fabric = &self.fabrics[Y::fabric_of(cloth)].fabric;
            match self.lanes[cloth].as_mut().and_then(|state| state.guides.as_mut()) {
                Some(ClothGuides { phase: Phase::Resting, .. }) => {}
                Some(ClothGuides { guides: of_cloth, phase }) => {
                    let (from, next) = match phase {
                        Phase::Ahead => (0, Phase::Moving),
                        Phase::Moving | Phase::Resting => (1, Phase::Resting),
                    };
                    *phase = next;
                    guides.guided[cloth] = true;
                    for (particle, guide) in of_cloth.iter().enumerate() {
                        let (pack, lane) = self.layout.locate(particle, cloth);
                        let pack = &mut guides.packs[pack];
                        let behind = guide.behind();
                        for (end, source) in [from, 1].into_iter().enumerate() {
                            set_lane3(&mut pack.places[end], lane, guide.places[source]);
                            set_lane3(&mut pack.behind[end], lane, behind[source]);
                        }
                        set_lane3(&mut pack.normal, lane, guide.normals[1]);
                        // A pinned particle is where it is held.
                        if !fabric.is_pinned(particle) {
                            pack.set(lane, guide.max_distance, guide.backstop.radius);
                        }
                    }
                }
                None if guides.guided[cloth] => {
                    guides.guided[cloth] = false;
                    for particle in 0..fabric.particle_count() {
                        let (pack, lane) = self.layout.locate(particle, cloth);
                        guides.packs[pack].set(lane, f32::INFINITY, 0.0);
                    }
                }
                None => {}
            }
        }
    }
}
