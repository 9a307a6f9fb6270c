//! Where the targets of single links are in a batch.

use std::collections::HashMap;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Layout;
use crate::fabric::{LinkFamily, ascending};
use crate::seams::link_place::LinkPlace;
use crate::simd::lane::Pack;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// The place of each link of warp and weft with these ends in the lanes of a cloth, in the scheme of yarns.
    pub(super) fn link_places(&self, cloth: usize, links: &[[u32; 2]]) -> Vec<LinkPlace> {
        let chains = self.layout.chains(&self.fabric);
        let linked = self.layout.linked();
        let mut places: HashMap<[u32; 2], LinkPlace> = HashMap::new();
        for (colour, of_colour) in chains.colours.iter().enumerate() {
            if of_colour.family == LinkFamily::Diagonal {
                continue;
            }
            let order = self.layout.order_of_chains(colour);
            for pair in &chains.pairs[of_colour.pairs.clone()] {
                for (row, links) in pair.links.iter().enumerate() {
                    for (column, link) in links[..pair.count].iter().enumerate() {
                        let target = (pair.targets.start + row * pair.count + column) as u32;
                        for lane in Y::lanes(cloth) {
                            let particle = |row: usize| {
                                let index = pair.particles[row][column];
                                self.layout.particle_at(order, index, lane)
                            };
                            let (Some(one), Some(other)) = (particle(row), particle(row + 1))
                            else {
                                continue;
                            };
                            let is_link = linked
                                .get(link.class as usize)
                                .is_none_or(|linked| linked.lanes()[lane] != 0.0);
                            if is_link && one != other {
                                let place =
                                    LinkPlace { target, class: link.class, lane: lane as u8 };
                                places.insert(ascending([one, other]), place);
                            }
                        }
                    }
                }
            }
        }
        links.iter().map(|ends| places[ends]).collect()
    }
}
