//! The search for pairs of cells whose paths come near one another in a substep: from patches to cells.

use core::ops::Range;

use glam::Vec3;

use crate::contact::itself::boxes::{Boxes, FindMeeting};
use crate::contact::itself::cell_pairs::CellPairs;
use crate::contact::itself::cloth::Cloth;
use crate::contact::itself::flat::Cone;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::patches::Neighbour;
use crate::contact::itself::planes::are_apart;
use crate::contact::itself::points::vector_of;
use crate::contact::itself::rules::Rules;
use crate::contact::itself::swept::Swept;
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};

/// Scratch arrays of the search.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Search {
    /// Positions of all particles at the end of their paths in the last search, m.
    ends: Vec<Pack4>,
    /// Cones about the normals of the cells and of the patches at the end of the substep.
    cones_of_cells: Vec<Cone>,
    cones_of_patches: Vec<Cone>,
    /// Boxes around the paths of patches, widened by half of the thickness, in lanes.
    patches: Vec<Boxes>,
    /// Boxes around the paths of cells, widened by half of the thickness, of the patches that have been compared.
    cells: Vec<Swept>,
    has_boxes: Vec<bool>,
    /// Indices of patches that meet one.
    met: Vec<usize>,
}

impl Search {
    /// Whether any particle ends farther than a distance, m, from where it ended in the last search.
    pub fn is_outdated(&self, ends: &[Vec3], within: f32) -> bool {
        let mut ends = self.ends.iter().zip(ends);
        ends.any(|(last, &end)| vector_of(last).distance_squared(end.into()) > within * within)
    }

    /// Marks the particles that end farther than a distance, m, from where they ended in the last search.
    pub fn mark_moved(&self, ends: &[Vec3], within: f32, has_moved: &mut [bool]) {
        for ((last, &end), has_moved) in self.ends.iter().zip(ends).zip(has_moved) {
            *has_moved |= vector_of(last).distance_squared(end.into()) > within * within;
        }
    }

    /// Finds all pairs that are kept apart and may come nearer than the thickness.
    pub fn find(&mut self, cloth: &Cloth, rules: &impl Rules, pairs: &mut CellPairs) {
        let Cloth { mesh, points, .. } = *cloth;
        pairs.pairs.clear();
        self.ends.clone_from(&points.end);
        self.cones_of_cells.resize(mesh.cells.len(), Cone::ALL);
        self.cones_of_patches.resize(mesh.patches.len(), Cone::ALL);
        self.cells.resize(mesh.cells.len(), Swept::EMPTY);
        self.has_boxes.resize(mesh.patches.len(), false);
        self.patches.clear();
        self.patches.resize(mesh.patches.len().div_ceil(Pack8::WIDTH), Boxes::empty());
        mesh.cell_groups.compute_cones(&mesh.cells, &self.ends, &mut self.cones_of_cells);
        (0..mesh.patches.len()).for_each(|patch| self.bound(cloth, patch));
        for one in 0..mesh.patches.len() {
            self.compare_patch(cloth, rules, one, pairs);
        }
        pairs.find_members(mesh.cells.len());
    }

    /// Finds the pairs of a patch, among those of itself and of later patches.
    fn compare_patch(
        &mut self,
        cloth: &Cloth,
        rules: &impl Rules,
        one: usize,
        pairs: &mut CellPairs,
    ) {
        let neighbours = &cloth.mesh.patches[one].neighbours;
        if rules.compare([one, one]) && !self.cones_of_patches[one].is_flat() {
            self.compare_patches(cloth, [one, one], pairs);
        }
        self.find_patches(one, one / Pack8::WIDTH);
        let mut met = core::mem::take(&mut self.met);
        for &other in &met {
            if other > one
                && rules.compare([one, other])
                && !are_neighbours_flat(&self.cones_of_patches, neighbours, [one, other])
                    .is_some_and(|are_flat| are_flat)
            {
                self.compare_patches(cloth, [one, other], pairs);
            }
        }
        met.clear();
        self.met = met;
    }

    /// Finds the patches that meet one, among those from the lanes of a group on.
    fn find_patches(&mut self, patch: usize, first: usize) {
        let (group, lane) = (patch / Pack8::WIDTH, patch % Pack8::WIDTH);
        let (one, others) = (&self.patches[group], &self.patches[first..]);
        let first = first * Pack8::WIDTH;
        Pack8::run(FindMeeting { one, lane, others, first, found: &mut self.met });
    }

    /// Computes the box and the cone of a patch, given those of its cells' normals.
    fn bound(&mut self, &Cloth { mesh, points, thickness }: &Cloth, patch: usize) {
        let cells = cells_of(mesh, patch);
        self.cones_of_patches[patch] = Cone::around(&self.cones_of_cells[cells]);
        let around = Swept::around(&mesh.patches[patch].particles, points);
        let around = around.widened(0.5 * thickness);
        self.patches[patch / Pack8::WIDTH].set(patch % Pack8::WIDTH, &around);
        self.has_boxes[patch] = false;
    }

    /// Computes the boxes of a patch's cells, if they have not been in this search.
    fn bound_cells(&mut self, &Cloth { mesh, points, thickness }: &Cloth, patch: usize) {
        if !core::mem::replace(&mut self.has_boxes[patch], true) {
            for cell in cells_of(mesh, patch) {
                let around = Swept::around(&mesh.cells[cell].particles, points);
                self.cells[cell] = around.widened(0.5 * thickness);
            }
        }
    }

    /// Whether two cells are neighbours and do not touch each other.
    fn are_neighbours_apart(&self, cloth: &Cloth, cells: [usize; 2]) -> bool {
        let cones = &self.cones_of_cells;
        let [one, other] = cells.map(|cell| &cloth.mesh.cells[cell]);
        let Some(are_flat) = are_neighbours_flat(cones, &one.neighbours, cells) else {
            return false;
        };
        are_flat
            || (cells.iter().all(|&cell| cones[cell].is_flat())
                && are_apart([one, other], cloth.points, cloth.thickness))
    }

    /// Compares the cells of two patches, or of one with itself.
    fn compare_patches(&mut self, cloth: &Cloth, patches: [usize; 2], pairs: &mut CellPairs) {
        patches.iter().for_each(|&patch| self.bound_cells(cloth, patch));
        let [one, other] = patches.map(|patch| cells_of(cloth.mesh, patch));
        for first in one {
            if patches[0] == patches[1] && !self.cones_of_cells[first].is_flat() {
                pairs.pairs.push([first as u32; 2]);
            }
            for second in other.clone() {
                if (patches[0] != patches[1] || first < second)
                    && self.cells[first].meets(&self.cells[second])
                    && !self.are_neighbours_apart(cloth, [first, second])
                {
                    pairs.pairs.push([first as u32, second as u32]);
                }
            }
        }
    }
}

/// The cells of a patch.
fn cells_of(mesh: &ContactMesh, patch: usize) -> Range<usize> {
    let Range { start, end } = mesh.patches[patch].cells;
    start as usize..end as usize
}

/// Whether two parts do not touch each other, with their bridge if they need it; none if they are no neighbours.
fn are_neighbours_flat(
    cones: &[Cone],
    neighbours: &[Neighbour],
    [one, other]: [usize; 2],
) -> Option<bool> {
    let found = neighbours.binary_search_by_key(&(other as u32), |neighbour| neighbour.index);
    let bridge = neighbours[found.ok()?].bridge.map(|bridge| &cones[bridge as usize]);
    Some(Cone::are_flat(&cones[one], &cones[other], bridge))
}
