//! The search for pairs of features whose paths come near one another in a substep: from patches to cells, triangles and
//! features.

use core::ops::Range;

use glam::Vec3;

use crate::contact::itself::apart::{Meeting, TrianglePaths, find_meetings};
use crate::contact::itself::boxes::{Boxes, FindMeeting};
use crate::contact::itself::cloth::Cloth;
use crate::contact::itself::flat::{Cone, compute_cones};
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::pairs::{EdgeTriangle, Pairs};
use crate::contact::itself::patches::Neighbour;
use crate::contact::itself::rules::Rules;
use crate::contact::itself::swept::{End, Path, Swept, end_at, position_of};
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};

/// Part of the thickness by which particles may move until pairs of an earlier substep of the tick are not used any more.
/// Larger: layers come nearer before they are found. Smaller: more searches.
const REUSED: f32 = 0.25;

/// Which pairs a search finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    All,
    /// Edges and triangles that may pass through one another.
    Crossings,
}

/// Scratch arrays of the search.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Search {
    /// Whether all pairs have been found in this tick.
    is_complete: bool,
    /// Paths of all particles when pairs were found.
    paths: Vec<Path>,
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
    /// Whether each patch has moved, in a search among such patches.
    has_moved: Vec<bool>,
    /// For each cell, the index of its triangles' paths, if they have been computed in this search.
    triangles_of: Vec<Option<u32>>,
    /// Paths of triangles, of which the first `triangles_count` are of this search.
    triangles: Vec<TrianglePaths>,
    triangles_count: usize,
    meetings: Vec<Meeting>,
}

impl Search {
    /// Whether a particle has moved since pairs were found such that pairs may be missing.
    pub fn is_outdated(&self, cloth: Cloth) -> bool {
        let mut ends = self.paths.iter().zip(&cloth.particles.end);
        ends.any(|(path, &end)| is_outdated(path, end, cloth.thickness))
    }

    /// Whether the pairs that were found earlier in the tick are good in this substep.
    pub fn is_good(&self, Cloth { particles, thickness, .. }: Cloth) -> bool {
        let far = REUSED * thickness;
        let is_near =
            |from: &Pack4, to: Vec3| position_of(from).distance_squared(to.into()) <= far * far;
        let paths = self.paths.iter().zip(particles.start.iter().zip(&particles.end));
        self.is_complete && { paths }
            .all(|([first, last], (&start, &end))| is_near(first, start) && is_near(last, end))
    }

    /// Begins a tick, so that what is found in it does not depend on the last one.
    pub fn begin_tick(&mut self) {
        self.is_complete = false;
    }

    /// Finds all pairs that are kept apart and come nearer than the thickness.
    pub fn find(&mut self, cloth: Cloth, rules: &impl Rules, pairs: &mut Pairs) {
        let Cloth { mesh, particles, .. } = cloth;
        pairs.clear();
        self.is_complete = true;
        self.paths.clear();
        let paths = particles.start.iter().zip(&particles.end);
        self.paths.extend(paths.map(|(&start, &end)| [end_at(start), end_at(end)]));
        self.cones_of_cells.resize(mesh.cells.len(), Cone::ALL);
        self.cones_of_patches.resize(mesh.patches.len(), Cone::ALL);
        self.cells.resize(mesh.cells.len(), Swept::EMPTY);
        self.has_boxes.resize(mesh.patches.len(), false);
        self.patches.clear();
        self.patches.resize(mesh.patches.len().div_ceil(Pack8::WIDTH), Boxes::empty());
        mesh.cell_groups.compute_cones(&mesh.cells, &self.paths, &mut self.cones_of_cells);
        self.forget_triangles(mesh);
        (0..mesh.patches.len()).for_each(|patch| self.bound(cloth, patch));
        for one in 0..mesh.patches.len() {
            self.compare_patch(cloth, rules, one, pairs, Wanted::All);
        }
    }

    /// Finds edges and triangles that may pass through one another anew where particles have moved since the last search.
    /// Returns whether any have.
    pub fn find_moved(&mut self, cloth: Cloth, rules: &impl Rules, pairs: &mut Pairs) -> bool {
        if !self.is_outdated(cloth) {
            return false;
        }
        let Cloth { mesh, particles, thickness } = cloth;
        let is_moved = |path: &Path, particle: u32| {
            is_outdated(path, particles.end[particle as usize], thickness)
        };
        self.has_moved.clear();
        self.has_moved.extend(
            mesh.patches.iter().map(|patch| {
                patch.particles.iter().any(|&at| is_moved(&self.paths[at as usize], at))
            }),
        );
        self.is_complete = false;
        pairs
            .edges_triangles
            .retain(|pair| !pair.patches.iter().any(|&patch| self.has_moved[patch as usize]));
        for (path, &end) in self.paths.iter_mut().zip(&particles.end) {
            if is_outdated(path, end, thickness) {
                path[End::Last as usize] = end_at(end);
            }
        }
        self.forget_triangles(mesh);
        for patch in 0..mesh.patches.len() {
            if self.has_moved[patch] {
                let cells = cells_of(mesh, patch);
                let cones = &mut self.cones_of_cells[cells.clone()];
                compute_cones(&mesh.cells[cells], &self.paths, cones);
                self.bound(cloth, patch);
            }
        }
        for one in 0..mesh.patches.len() {
            if self.has_moved[one] {
                self.compare_patch(cloth, rules, one, pairs, Wanted::Crossings);
            }
        }
        true
    }

    /// Finds the pairs of a patch, among those of itself and of later patches; with [`Wanted::Crossings`], those of earlier
    /// patches, too, unless they have moved.
    fn compare_patch(
        &mut self,
        cloth: Cloth,
        rules: &impl Rules,
        one: usize,
        pairs: &mut Pairs,
        wanted: Wanted,
    ) {
        let neighbours = &cloth.mesh.patches[one].neighbours;
        if rules.compare([one, one]) && !self.cones_of_patches[one].is_flat() {
            self.compare_patches(cloth, [one, one], pairs, wanted);
        }
        let first = if wanted == Wanted::All { one / Pack8::WIDTH } else { 0 };
        self.find_patches(one, first);
        let mut met = core::mem::take(&mut self.met);
        for &other in &met {
            let is_due = other > one || wanted == Wanted::Crossings && !self.has_moved[other];
            let parts = [one.min(other), one.max(other)];
            if is_due
                && one != other
                && rules.compare(parts)
                && !are_neighbours_flat(&self.cones_of_patches, neighbours, [one, other])
            {
                self.compare_patches(cloth, parts, pairs, wanted);
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
    fn bound(&mut self, Cloth { mesh, thickness, .. }: Cloth, patch: usize) {
        let cells = cells_of(mesh, patch);
        self.cones_of_patches[patch] = Cone::around(&self.cones_of_cells[cells]);
        let around = Swept::around(&mesh.patches[patch].particles, &self.paths);
        let around = around.widened(0.5 * thickness);
        self.patches[patch / Pack8::WIDTH].set(patch % Pack8::WIDTH, &around);
        self.has_boxes[patch] = false;
    }

    /// Computes the boxes of a patch's cells, if they have not been in this search.
    fn bound_cells(&mut self, Cloth { mesh, thickness, .. }: Cloth, patch: usize) {
        if !core::mem::replace(&mut self.has_boxes[patch], true) {
            for cell in cells_of(mesh, patch) {
                let around = Swept::around(&mesh.cells[cell].particles, &self.paths);
                self.cells[cell] = around.widened(0.5 * thickness);
            }
        }
    }

    /// Forgets the paths of triangles.
    fn forget_triangles(&mut self, mesh: &ContactMesh) {
        self.triangles_count = 0;
        self.triangles_of.clear();
        self.triangles_of.resize(mesh.cells.len(), None);
    }

    /// Compares the cells of two patches, or of one with itself.
    fn compare_patches(
        &mut self,
        cloth: Cloth,
        patches: [usize; 2],
        pairs: &mut Pairs,
        wanted: Wanted,
    ) {
        patches.iter().for_each(|&patch| self.bound_cells(cloth, patch));
        let found = pairs.edges_triangles.len();
        let [one, other] = patches.map(|patch| cells_of(cloth.mesh, patch));
        for first in one {
            if patches[0] == patches[1] && !self.cones_of_cells[first].is_flat() {
                self.compare_cells(cloth, [first, first], pairs, wanted);
            }
            let neighbours = &cloth.mesh.cells[first].neighbours;
            for second in other.clone() {
                if (patches[0] != patches[1] || first < second)
                    && self.cells[first].meets(&self.cells[second])
                    && !are_neighbours_flat(&self.cones_of_cells, neighbours, [first, second])
                {
                    self.compare_cells(cloth, [first, second], pairs, wanted);
                }
            }
        }
        let patches = patches.map(|patch| patch as u32);
        pairs.edges_triangles[found..].iter_mut().for_each(|pair| pair.patches = patches);
    }

    /// Compares the triangles of two cells, or of one with itself.
    fn compare_cells(
        &mut self,
        cloth: Cloth,
        cells: [usize; 2],
        pairs: &mut Pairs,
        wanted: Wanted,
    ) {
        let paths = cells.map(|cell| self.triangles_of(cloth, cell)).map(|at| &self.triangles[at]);
        find_meetings(paths, &self.cells[cells[1]], cloth.thickness, &mut self.meetings);
        let firsts = cells.map(|cell| cloth.mesh.cells[cell].triangles.start as usize);
        for &Meeting { lanes: [one, other], is_hinged } in &self.meetings {
            let triangles = [firsts[0] + one, firsts[1] + other];
            if triangles[0] < triangles[1] || cells[0] != cells[1] {
                let most_common = if is_hinged { 0 } else { 1 };
                if !cloth.mesh.share_corners(triangles, most_common + 1) {
                    add_features(cloth, &self.paths, triangles, pairs, wanted);
                }
            }
        }
    }

    /// The index of the paths of a cell's triangles.
    fn triangles_of(&mut self, Cloth { mesh, thickness, .. }: Cloth, cell: usize) -> usize {
        let index = self.triangles_of[cell].get_or_insert_with(|| {
            let index = self.triangles_count;
            if index == self.triangles.len() {
                self.triangles.push(TrianglePaths::empty());
            }
            self.triangles[index].set(&mesh.cells[cell], &self.paths, thickness);
            self.triangles_count += 1;
            index as u32
        });
        *index as usize
    }
}

/// Whether a particle is so far from the end of its path when pairs were found, m, that pairs may be missing.
fn is_outdated([_, searched]: &Path, end: Vec3, thickness: f32) -> bool {
    let far = 0.5 * thickness;
    position_of(searched).distance_squared(end.into()) > far * far
}

/// The cells of a patch.
fn cells_of(mesh: &ContactMesh, patch: usize) -> Range<usize> {
    let Range { start, end } = mesh.patches[patch].cells;
    start as usize..end as usize
}

/// Whether two parts are neighbours and do not touch each other, with their bridge if they need it.
fn are_neighbours_flat(cones: &[Cone], neighbours: &[Neighbour], [one, other]: [usize; 2]) -> bool {
    let find = neighbours.binary_search_by_key(&(other as u32), |neighbour| neighbour.index);
    let Ok(found) = find else { return false };
    let bridge = neighbours[found].bridge.map(|bridge| &cones[bridge as usize]);
    Cone::are_flat(&cones[one], &cones[other], bridge)
}

/// Adds the pairs of features that two triangles stand for.
fn add_features(
    cloth: Cloth,
    paths: &[Path],
    triangles: [usize; 2],
    pairs: &mut Pairs,
    wanted: Wanted,
) {
    let Cloth { mesh, thickness, .. } = cloth;
    let corners = triangles.map(|triangle| mesh.triangles[triangle]);
    let swept = |particles: &[u32]| Swept::around(particles, paths);
    let near = |one: Swept, other: Swept| one.widened(thickness).meets(&other);
    let represented = triangles.map(|triangle| &mesh.represented[triangle]);
    for (one, other) in [(0, 1), (1, 0)] {
        let triangle = corners[other];
        let [a, b, c] = triangle;
        let around = swept(&triangle);
        for &index in &represented[one].edges {
            let edge = mesh.edges[index as usize].ends;
            let apart = edge.iter().all(|end| !triangle.contains(end));
            if apart && near(swept(&edge), around) {
                pairs.edges_triangles.push(EdgeTriangle { index, edge, triangle, patches: [0; 2] });
            }
        }
        for &particle in &represented[one].particles {
            let apart = wanted == Wanted::All && !triangle.contains(&particle);
            if apart && near(swept(&[particle]), around) {
                pairs.particles_triangles.push([particle, a, b, c]);
            }
        }
    }
    if wanted == Wanted::Crossings {
        return;
    }
    for &one in &represented[0].edges {
        let [a, b] = mesh.edges[one as usize].ends;
        let around = swept(&[a, b]);
        for &other in &represented[1].edges {
            let [c, d] = mesh.edges[other as usize].ends;
            let apart = a != c && a != d && b != c && b != d;
            if apart && near(around, swept(&[c, d])) {
                pairs.edges_edges.push([a, b, c, d]);
            }
        }
    }
}
