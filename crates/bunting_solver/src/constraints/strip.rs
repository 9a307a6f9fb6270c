//! Strips of a narrow grid, pairs of neighbouring lines of particles: all links of a strip at once, exactly.
//!
//! Held in its own plane a narrow grid is a beam: its lines carry the moment as tension and compression, and its cells
//! the shear between them. Chains and diagonals solved in turn find that equilibrium by diffusion along the lines: on
//! edge, 34 rows of two sagged thirty times too far. A shear of each cell, C = |d₁| − |d₂| of its two diagonals, a link
//! along each line and one across are four unknowns a row, and those of a row share particles with those of the next
//! alone. The XPBD system (J M⁻¹ Jᵀ + α̃) Δλ = −C − α̃ λ is block tridiagonal, with blocks of 4 × 4. It is eliminated
//! along the strip and substituted back, as that of a chain.
//!
//! Where a grid has more than two lines, each strip is a beam by itself, and shares its lines with its neighbours
//! (overlapping Schwarz method). In each pass the strips that begin at even lines are solved first, which share no
//! particles, and then those at odd lines: a product of two projections, which has real eigenvalues.
//!
//! The two diagonals of a cell of compliance α̃ are one constraint of compliance 2 α̃.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::constants::LEAST_LENGTH;
use crate::constraints::chain::Pass;
use crate::constraints::strip_block::StripBlock;
use crate::constraints::strip_system::{Linearised, Solved, UNKNOWNS, coupling, diagonal};
use crate::fabric::{StripLink, StripRow};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves all strips in each pass.
    pub(super) fn solve_strips(&mut self, passes: u32) {
        self.solve_warp_and_weft(Pass::First);
        if self.clock.begun == 1 {
            self.find_diagonal_targets();
        }
        for pass in 0..passes {
            for strip in 0..self.fabric.strips().len() {
                self.solve_strip(strip, pass == 0);
            }
            self.solve_contacts_of_pass();
        }
    }

    fn solve_strip(&mut self, strip: usize, is_first: bool) {
        let rows = &self.fabric.strips()[strip];
        if self.strip_blocks.is_empty() {
            self.strip_blocks.resize(rows.len(), StripBlock::new());
        }
        P::run(SolveStrip {
            rows,
            compliance: &self.layout.factors().link_compliance,
            blocks: &mut self.strip_blocks,
            target: &mut self.link_target,
            is_first,
            inverse_masses: &self.masses.inverse,
            position: self.positions.packs_mut(),
        });
    }
}

struct SolveStrip<'a, P: Pack> {
    rows: &'a [StripRow],
    compliance: &'a [P],
    blocks: &'a mut [StripBlock<P>],
    target: &'a mut [P],
    /// Whether diagonals have no tension yet.
    is_first: bool,
    inverse_masses: &'a [P],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for SolveStrip<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        if self.is_first {
            self.forget_shear::<L>(token);
        }
        self.eliminate::<L>(token);
        self.substitute::<L>(token);
    }
}

impl<P: Pack> SolveStrip<'_, P> {
    /// Makes the targets of the two diagonals of each cell equal, as they are without tension. Tension takes as much
    /// from one as it adds to the other.
    #[inline(always)]
    fn forget_shear<L: Lane<Pack = P>>(&mut self, token: L::Token) {
        let half = L::splat(token, 0.5);
        for row in self.rows {
            let Some([falling, rising]) = row.diagonals else { continue };
            let [falling, rising] = [falling.target as usize, rising.target as usize];
            let sum = L::load(token, &self.target[falling]) + L::load(token, &self.target[rising]);
            (sum * half).store(&mut self.target[falling]);
            (sum * half).store(&mut self.target[rising]);
        }
    }

    /// Direction of a link, and its target less its length, m.
    #[inline(always)]
    fn stretch<L: Lane<Pack = P>>(
        &self,
        token: L::Token,
        [from, to]: [V3<L>; 2],
        link: &StripLink,
    ) -> (V3<L>, L) {
        let along = to - from;
        let length = along.dot(along).sqrt();
        let target = L::load(token, &self.target[link.target as usize]);
        let direction = along * (L::splat(token, 1.0) / length.max(L::splat(token, LEAST_LENGTH)));
        (direction, target - length)
    }

    /// The constraints of a row between the positions of its particles and those of the next row's.
    #[inline(always)]
    fn linearise<L: Lane<Pack = P>>(
        &self,
        token: L::Token,
        row: &StripRow,
        [first, second]: [V3<L>; 2],
        [next_first, next_second]: [V3<L>; 2],
    ) -> Linearised<L> {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let mut constraints = Linearised {
            directions: [V3::splat(token, 0.0); 5],
            right: [zero; UNKNOWNS],
            compliance: [one; UNKNOWNS],
        };
        let links = [
            (&row.across, [first, second]),
            (&row.along[0], [first, next_first]),
            (&row.along[1], [second, next_second]),
        ];
        for (at, (link, ends)) in links.into_iter().enumerate() {
            let Some(link) = link else { continue };
            let (direction, right) = self.stretch::<L>(token, ends, link);
            constraints.directions[at] = direction;
            constraints.right[at] = right;
            constraints.compliance[at] = L::load(token, &self.compliance[link.class as usize]);
        }
        if let Some([falling, rising]) = &row.diagonals {
            let (one_way, right) = self.stretch::<L>(token, [first, next_second], falling);
            let (back, right_back) = self.stretch::<L>(token, [second, next_first], rising);
            constraints.directions[3] = one_way;
            constraints.directions[4] = back;
            constraints.right[3] = right - right_back;
            constraints.compliance[3] = L::load(token, &self.compliance[falling.class as usize])
                + L::load(token, &self.compliance[rising.class as usize]);
        }
        constraints
    }

    /// Eliminates the unknowns from the first row to the last.
    #[inline(always)]
    fn eliminate<L: Lane<Pack = P>>(&mut self, token: L::Token) {
        let count = self.rows.len();
        let mut at = self.positions_of::<L>(token, 0);
        let mut masses = self.masses_of::<L>(token, 0);
        // Of the row before: its directions, its part in this row's unknowns, and its unknowns.
        let mut before = [V3::<L>::splat(token, 0.0); 5];
        let mut solved = Solved::<L>::first(token);
        for index in 0..count {
            let next = (index + 1).min(count - 1);
            let (next_at, next_masses) =
                (self.positions_of::<L>(token, next), self.masses_of::<L>(token, next));
            let constraints = self.linearise::<L>(token, &self.rows[index], at, next_at);
            let coupling = coupling(token, &before, &constraints.directions, masses);
            let block = diagonal(token, &constraints, masses, next_masses);
            let (part, following) = solved.followed_by(token, coupling, block, constraints.right);
            if index > 0 {
                let stored = self.blocks[index - 1].next.as_flattened_mut();
                for (part, stored) in part.as_flattened().iter().zip(stored) {
                    part.store(stored);
                }
            }
            solved = following;
            let stored = &mut self.blocks[index];
            for (direction, stored) in
                constraints.directions.into_iter().zip(&mut stored.directions)
            {
                direction.store(stored);
            }
            for (unknown, stored) in solved.unknowns.into_iter().zip(&mut stored.unknowns) {
                unknown.store(stored);
            }
            (before, at, masses) = (constraints.directions, next_at, next_masses);
        }
    }

    /// Substitutes from the last row to the first, and moves each particle by all its links at once.
    #[inline(always)]
    fn substitute<L: Lane<Pack = P>>(&mut self, token: L::Token) {
        let zero = L::splat(token, 0.0);
        let mut unknowns = [zero; UNKNOWNS];
        for index in (0..self.rows.len()).rev() {
            let block = &self.blocks[index];
            let mut own = [zero; UNKNOWNS];
            for (own, stored) in own.iter_mut().zip(&block.unknowns) {
                *own = L::load(token, stored);
            }
            // The last row's part is zero.
            for (own, parts) in own.iter_mut().zip(&block.next) {
                for (part, &next) in parts.iter().zip(&unknowns) {
                    *own = own.minus_product(L::load(token, part), next);
                }
            }
            unknowns = own;
            for (unknown, stored) in unknowns.into_iter().zip(&mut self.blocks[index].unknowns) {
                unknown.store(stored);
            }
            self.store_targets::<L>(token, index, unknowns);
        }
        // Pulls on the particles of a row by the row before.
        let mut pulls = [V3::<L>::splat(token, 0.0); 2];
        for index in 0..self.rows.len() {
            let block = &self.blocks[index];
            let mut unknowns = [zero; UNKNOWNS];
            for (unknown, stored) in unknowns.iter_mut().zip(&block.unknowns) {
                *unknown = L::load(token, stored);
            }
            let mut directions = [V3::<L>::splat(token, 0.0); 5];
            for (direction, stored) in directions.iter_mut().zip(&block.directions) {
                *direction = V3::load(token, stored);
            }
            let [across, along_first, along_second, shear] = unknowns;
            let [c, a, b, falling, rising] = directions;
            let first = pulls[0]
                .minus_scaled(c, across)
                .minus_scaled(a, along_first)
                .minus_scaled(falling, shear);
            let second = pulls[1]
                .plus_scaled(c, across)
                .minus_scaled(b, along_second)
                .plus_scaled(rising, shear);
            for (pull, particle) in [first, second].into_iter().zip(self.rows[index].particles) {
                let mass = L::load(token, &self.inverse_masses[particle as usize]);
                let position = &mut self.position[particle as usize];
                V3::<L>::load(token, position).plus_scaled(pull, mass).store(position);
            }
            pulls = [
                (a * along_first).minus_scaled(rising, shear),
                (b * along_second).plus_scaled(falling, shear),
            ];
        }
    }

    /// Stores the targets of a row's links under the tension found, l − α̃ λ.
    #[inline(always)]
    fn store_targets<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        index: usize,
        unknowns: [L; UNKNOWNS],
    ) {
        let row = &self.rows[index];
        let [across, along_first, along_second, shear] = unknowns;
        let [falling, rising] = match row.diagonals {
            Some([falling, rising]) => [Some(falling), Some(rising)],
            None => [None; 2],
        };
        let stretches = [
            (row.across, across),
            (row.along[0], along_first),
            (row.along[1], along_second),
            (falling, shear),
            (rising, -shear),
        ];
        for (link, unknown) in stretches {
            let Some(link) = link else { continue };
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let stored = &mut self.target[link.target as usize];
            L::load(token, stored).minus_product(compliance, unknown).store(stored);
        }
    }

    #[inline(always)]
    fn positions_of<L: Lane<Pack = P>>(&self, token: L::Token, row: usize) -> [V3<L>; 2] {
        let [first, second] = self.rows[row].particles;
        [
            V3::load(token, &self.position[first as usize]),
            V3::load(token, &self.position[second as usize]),
        ]
    }

    #[inline(always)]
    fn masses_of<L: Lane<Pack = P>>(&self, token: L::Token, row: usize) -> [L; 2] {
        let [first, second] = self.rows[row].particles;
        [
            L::load(token, &self.inverse_masses[first as usize]),
            L::load(token, &self.inverse_masses[second as usize]),
        ]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use crate::{
        ClothBatch, ClothSnapshot, Drive, FabricBuilder, FabricMaterial, Grid, LaneCount,
        StepSettings,
    };

    /// Links along the free metre of the grid.
    const LINKS: u32 = 16;
    /// N/m.
    const STIFFNESS: f32 = 1e5;

    /// Sag of the end of a grid of square cells that is clamped level and on edge, m.
    fn sag(lines: u32, settings: StepSettings) -> f32 {
        let link = 1.0 / LINKS as f32;
        let grid = Grid::new(lines, LINKS + 2, link * (lines - 1) as f32, 1.0 + link);
        let fabric = FabricBuilder::grid(grid).pin(0..2 * lines).build().expect("a good fabric");
        let fabric = Arc::new(fabric);
        let material = FabricMaterial {
            area_density: 0.2,
            warp_stiffness: STIFFNESS,
            weft_stiffness: STIFFNESS,
            shear_stiffness: 0.1 * STIFFNESS,
            bend_stiffness: 0.1,
            damping: 4.0,
            ..FabricMaterial::FLAG_POLYESTER
        };
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        batch.insert(&ClothSnapshot::at_rest(&fabric), material).expect("a good cloth");
        // Within the plane of the grid, across its length.
        let drive = Drive { gravity: Vec3::X * 9.81, ..Drive::NONE };
        batch.drive(0, drive).expect("a good drive");
        (0..300).for_each(|_| batch.step(1.0 / 60.0, settings));
        let mut positions = Vec::new();
        batch.copy_positions(0, &mut positions);
        positions[(lines * (LINKS + 1)) as usize].x
    }

    /// Sag of Timoshenko's beam, m. Lines in the distances y from the middle carry the moment: E I = Y w Σ y², with the
    /// width w of a link and half as much of the lines at the border.
    fn sag_of_beam(lines: u32) -> f32 {
        let width = 1.0 / LINKS as f32;
        let load = 0.2 * 9.81 * width * (lines - 1) as f32;
        let line = |line: u32| {
            let part = if line == 0 || line + 1 == lines { 0.5 } else { 1.0 };
            part * (width * (line as f32 - 0.5 * (lines - 1) as f32)).powi(2)
        };
        let rigidity = STIFFNESS * width * (0..lines).map(line).sum::<f32>();
        let shear = 0.1 * STIFFNESS * width * (lines - 1) as f32;
        load / (8.0 * rigidity) + load / (2.0 * shear)
    }

    /// A strip is exact, and more lines converge with the passes.
    #[test]
    fn narrow_grids_on_edge_sag_as_beams_at_any_substep() {
        for (lines, passes, tolerance) in [(2, 1, 0.01), (3, 2, 0.03), (4, 4, 0.03), (5, 4, 0.06)] {
            for substeps in [1, 2, 8] {
                let settings = StepSettings { passes, ..StepSettings::yarns(substeps) };
                let (sag, expected) = (sag(lines, settings), sag_of_beam(lines));
                let error = sag / expected - 1.0;
                assert!(error.abs() < tolerance, "{lines} lines, {substeps} substeps: {error}");
            }
        }
    }
}
