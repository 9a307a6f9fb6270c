//! The subdivisions in use, shared by cloths of the same levels.

use std::collections::HashMap;
use std::sync::{Arc, Weak};

use bevy_ecs::prelude::*;
use bunting_solver::Subdivision;

use crate::background::Background;
use crate::fabric::levels::ClothLevels;

/// The subdivisions in use.
#[derive(Resource, Debug, Default)]
pub struct Subdivisions {
    /// By the address of the levels, the level and the number of halvings. An address is not used again as long as a
    /// weak pointer to it is here.
    known: HashMap<(usize, usize, u32), (Weak<ClothLevels>, Known)>,
}

#[derive(Debug)]
enum Known {
    Built(Arc<Subdivision>),
    Awaited(Background<Subdivision>),
}

impl Subdivisions {
    /// Forgets subdivisions of levels that no cloth has any more.
    fn forget_unused(&mut self) {
        self.known.retain(|_, (users, _)| users.strong_count() > 0);
    }

    /// The subdivision of a level; none while another thread builds it. That of a grid is built at once.
    pub fn find(
        &mut self,
        levels: &Arc<ClothLevels>,
        level: usize,
        halvings: u32,
    ) -> Option<Arc<Subdivision>> {
        let key = (Arc::as_ptr(levels).addr(), level, halvings);
        if let Some((_, known)) = self.known.get_mut(&key) {
            if let Known::Awaited(work) = known
                && work.is_done()
                && let Some((users, Known::Awaited(work))) = self.known.remove(&key)
            {
                self.known.insert(key, (users, Known::Built(Arc::new(work.take()))));
            }
        } else {
            self.known.insert(key, (Arc::downgrade(levels), begin(levels, level, halvings)));
        }
        match &self.known.get(&key)?.1 {
            Known::Built(subdivision) => Some(Arc::clone(subdivision)),
            Known::Awaited(_) => None,
        }
    }
}

/// Forgets subdivisions of cloths that are gone.
pub fn forget_subdivisions(mut subdivisions: ResMut<Subdivisions>) {
    subdivisions.forget_unused();
}

fn begin(levels: &Arc<ClothLevels>, level: usize, halvings: u32) -> Known {
    if let (None, Some(grid)) = (levels.carried(level), levels.fabric(level).grid()) {
        return Known::Built(Arc::new(Subdivision::of_grid(grid, halvings)));
    }
    let levels = Arc::clone(levels);
    Known::Awaited(Background::begin(move || {
        let drawn = levels.drawn(level, levels.fabric(level).rest_positions());
        let indices = &levels.topology(level).indices;
        let (places, place_of) = (&drawn.positions, drawn.point_of_vertex);
        match levels.halvings_to_cells(level) {
            0 => Subdivision::of_mesh(places, place_of, indices, halvings),
            _ => {
                let fabric = levels.fabric(level);
                Subdivision::on_surface(fabric, places, place_of, indices, halvings)
            }
        }
    }))
}
