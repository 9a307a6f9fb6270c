//! Grids that a border cuts: how much of a node's cells is cloth.

use super::fabric::Fabric;

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

    /// Whether it resists bending along its lines, not at hinges.
    pub(crate) fn bends_along_lines(&self) -> bool {
        self.grid().is_some() || self.is_net()
    }

    /// Whether this is a background grid that the border of its mesh cuts.
    pub(crate) fn is_cut_grid(&self) -> bool {
        self.is_cut() && self.grid().is_some()
    }

    /// Area of the first particle, m², as if all of its cells were cloth.
    pub(crate) fn first_whole_area(&self) -> f32 {
        match self.grid() {
            Some(grid) if self.is_cut() => {
                let [dx, dy] = grid.spacing();
                0.25 * dx * dy
            }
            _ => self.particle_areas()[0],
        }
    }
}
