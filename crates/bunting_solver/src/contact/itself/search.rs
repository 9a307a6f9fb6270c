//! The search for pairs of features whose paths come near one another in a substep: from patches to cells, triangles and
//! features.

use core::ops::Range;

use glam::{Vec3, Vec3A};

use crate::contact::itself::apart::{Meeting, TrianglePaths, find_meetings};
use crate::contact::itself::boxes::{Boxes, FindMeeting};
use crate::contact::itself::cloth::Cloth;
use crate::contact::itself::flat::Normals;
use crate::contact::itself::pairs::{EdgeTriangle, Pairs};
use crate::contact::itself::patches::Neighbour;
use crate::contact::itself::rules::Rules;
use crate::contact::itself::swept::{Path, Swept};
use crate::simd::lane::Pack;
use crate::simd::registers::Pack8;

/// Part of the thickness by which particles may move until pairs of an earlier substep of the tick are not used any more.
/// Larger: layers come nearer before they are found. Smaller: more searches.
const REUSED: f32 = 0.25;

/// Which pairs a search finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::contact) enum Wanted {
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
    /// Normals of the cells at the end of the substep.
    normals: Normals,
    /// Boxes around the paths of cells, widened by half of the thickness.
    cells: Vec<Swept>,
    /// Boxes around the paths of patches, widened by half of the thickness, in lanes.
    patches: Vec<Boxes>,
    /// Indices of patches that meet one.
    met: Vec<usize>,
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
        let far = 0.5 * cloth.thickness;
        ends.any(|([_, searched], &end)| Vec3::from(*searched).distance_squared(end) > far * far)
    }

    /// Whether the pairs that were found earlier in the tick are good in this substep.
    pub fn is_good(&self, Cloth { particles, thickness, .. }: Cloth) -> bool {
        let far = REUSED * thickness;
        let is_near = |from: Vec3A, to: Vec3| Vec3::from(from).distance_squared(to) <= far * far;
        let paths = self.paths.iter().zip(particles.start.iter().zip(&particles.end));
        self.is_complete && { paths }
            .all(|([from, to], (&start, &end))| is_near(*from, start) && is_near(*to, end))
    }

    /// Begins a tick, so that what is found in it does not depend on the last one.
    pub fn begin_tick(&mut self) {
        self.is_complete = false;
    }

    /// Finds all pairs that are kept apart and come nearer than the thickness.
    pub fn find(&mut self, cloth: Cloth, rules: &impl Rules, pairs: &mut Pairs, wanted: Wanted) {
        pairs.clear();
        self.is_complete = wanted == Wanted::All;
        self.bound(cloth);
        let cells_of = |patch: usize| cloth.mesh.patches[patch].cells.clone();
        for (one, patch) in cloth.mesh.patches.iter().enumerate() {
            if rules.compare([one, one]) && !self.normals.are_flat([cells_of(one)]) {
                self.compare_patches(cloth, [one, one], pairs, wanted);
            }
            self.find_patches(one);
            let mut met = core::mem::take(&mut self.met);
            for &other in met.iter().filter(|&&other| other > one) {
                let parts = [one, other];
                if rules.compare(parts)
                    && !self.are_neighbours_flat(cells_of, &patch.neighbours, parts)
                {
                    self.compare_patches(cloth, [one, other], pairs, wanted);
                }
            }
            met.clear();
            self.met = met;
        }
    }

    /// Finds the patches that meet one, among those from its own lanes on.
    fn find_patches(&mut self, patch: usize) {
        let (group, lane) = (patch / Pack8::WIDTH, patch % Pack8::WIDTH);
        let first = group * Pack8::WIDTH;
        let others = &self.patches[group..];
        Pack8::run(FindMeeting { one: &others[0], lane, others, first, found: &mut self.met });
    }

    /// Computes the boxes of cells and patches, and the normals.
    fn bound(&mut self, cloth: Cloth) {
        let Cloth { mesh, particles, thickness } = cloth;
        self.paths.clear();
        let paths = particles.start.iter().zip(&particles.end);
        self.paths.extend(paths.map(|(&start, &end)| [start.into(), end.into()]));
        self.normals.compute(&mesh.cells, &particles.end);
        self.cells.clear();
        let boxes = mesh.cells.iter().map(|cell| Swept::around(&cell.particles, &self.paths));
        self.cells.extend(boxes.map(|swept| swept.widened(0.5 * thickness)));
        self.patches.clear();
        self.patches.resize(mesh.patches.len().div_ceil(Pack8::WIDTH), Boxes::empty());
        for (index, patch) in mesh.patches.iter().enumerate() {
            let cells = &self.cells[patch.cells.start as usize..patch.cells.end as usize];
            let around = cells.iter().fold(Swept::EMPTY, |around, &cell| around.merged(cell));
            self.patches[index / Pack8::WIDTH].set(index % Pack8::WIDTH, &around);
        }
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
        let [one, other] = patches.map(|patch| cloth.mesh.patches[patch].cells.clone());
        let cells_of = |cell: usize| cell as u32..cell as u32 + 1;
        for first in one {
            let first = first as usize;
            if patches[0] == patches[1] && !self.normals.are_flat([cells_of(first)]) {
                self.compare_cells(cloth, [first, first], pairs, wanted);
            }
            let neighbours = &cloth.mesh.cells[first].neighbours;
            for second in other.clone() {
                let second = second as usize;
                if (patches[0] != patches[1] || first < second)
                    && self.cells[first].meets(&self.cells[second])
                    && !self.are_neighbours_flat(cells_of, neighbours, [first, second])
                {
                    self.compare_cells(cloth, [first, second], pairs, wanted);
                }
            }
        }
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
    fn triangles_of(&mut self, Cloth { mesh, particles, thickness }: Cloth, cell: usize) -> usize {
        let index = self.triangles_of[cell].get_or_insert_with(|| {
            let index = self.triangles_count;
            if index == self.triangles.len() {
                self.triangles.push(TrianglePaths::empty());
            }
            let positions = [&particles.start[..], &particles.end[..]];
            self.triangles[index].set(&mesh.cells[cell], positions, thickness);
            self.triangles_count += 1;
            index as u32
        });
        *index as usize
    }

    /// Whether two parts are neighbours and do not touch each other, with their bridge if they need it.
    fn are_neighbours_flat(
        &self,
        cells_of: impl Fn(usize) -> Range<u32>,
        neighbours: &[Neighbour],
        [one, other]: [usize; 2],
    ) -> bool {
        let find = neighbours.binary_search_by_key(&(other as u32), |neighbour| neighbour.index);
        let Ok(found) = find else { return false };
        let [one, other] = [one, other].map(&cells_of);
        match neighbours[found].bridge {
            Some(bridge) => self.normals.are_flat([one, cells_of(bridge as usize), other]),
            None => self.normals.are_flat([one, other]),
        }
    }
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
                pairs.edges_triangles.push(EdgeTriangle { index, edge, triangle });
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
