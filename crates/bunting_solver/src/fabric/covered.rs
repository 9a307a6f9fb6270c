//! Grids that a border cuts: how much of a node's cells is cloth, and what follows from that for stability.

use super::fabric::Fabric;
use super::grid::Grid;

/// How many times as much tension as elsewhere there is at a hole, or where a border makes a cut grid narrower: threefold at
/// a round hole (Kirsch 1898), less in the mean over a cell. Smaller: rings that hang from their inner rim vibrate. Larger:
/// sheets with a hole cost more than twice as much as grids.
const CONCENTRATION: f32 = 2.0;

impl Fabric {
    /// The part of a node's cells that is cloth; one of particles, and where no cell is cut.
    pub(crate) fn part_of(&self, particle: usize) -> f32 {
        self.covered.get(particle).copied().unwrap_or(1.0)
    }

    /// Whether this is a background grid that the border of its mesh cuts, or a net, whose nodes stand for unlike amounts of
    /// cloth, too.
    pub(crate) fn is_cut(&self) -> bool {
        !self.covered.is_empty()
    }

    /// Whether this is the net of a mesh.
    pub(crate) fn is_net(&self) -> bool {
        self.is_cut() && self.grid().is_none()
    }

    /// Whether this is a background grid that the border of its mesh cuts.
    pub(crate) fn is_cut_grid(&self) -> bool {
        self.cut_grid().is_some()
    }

    /// The grid, where the border of the mesh cuts it.
    fn cut_grid(&self) -> Option<&Grid> {
        self.grid().filter(|_| self.is_cut())
    }

    /// Area of the first particle, m², as if all of its cells were cloth.
    pub(crate) fn first_whole_area(&self) -> f32 {
        match self.cut_grid() {
            Some(grid) => {
                let [dx, dy] = grid.spacing();
                0.25 * dx * dy
            }
            None => self.particle_areas()[0],
        }
    }

    /// Length of the cloth whose weight the topmost links carry, m: the [`reach`](Self::reach), and more of a cut grid, in which
    /// tension is concentrated.
    pub(super) fn carried_length(&self) -> f32 {
        self.reach() * if self.is_cut_grid() { CONCENTRATION } else { 1.0 }
    }
}
