//! Cells whose features may touch in a substep.

/// Cells whose features may touch in a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct CellPairs {
    /// Indices of two cells, or of one twice.
    pub pairs: Vec<[u32; 2]>,
    /// All cells of these.
    pub members: Vec<u32>,
    is_member: Vec<bool>,
}

impl CellPairs {
    /// Finds some of other pairs, and their members.
    pub fn find_among(&mut self, others: &Self, is_one: impl Fn([u32; 2]) -> bool) {
        self.pairs.clear();
        self.pairs.extend(others.pairs.iter().copied().filter(|&pair| is_one(pair)));
        self.find_members(others.is_member.len());
    }

    /// Finds the members, given the number of all cells.
    pub fn find_members(&mut self, cells: usize) {
        self.members.drain(..).for_each(|cell| self.is_member[cell as usize] = false);
        self.is_member.resize(cells, false);
        for &cell in self.pairs.iter().flatten() {
            if !core::mem::replace(&mut self.is_member[cell as usize], true) {
                self.members.push(cell);
            }
        }
    }
}
