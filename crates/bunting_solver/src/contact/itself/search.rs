//! The search for pairs of features whose paths come near one another in a substep: from patches to cells, triangles and
//! features.

use core::ops::Range;

use glam::{Vec3, Vec3A};

use crate::contact::itself::apart::Cloth;
use crate::contact::itself::pairs::{EdgeTriangle, Pairs};
use crate::contact::itself::particles::Particles;
use crate::contact::itself::patches::Neighbour;
use crate::contact::itself::region::{Normals, Region, Swept, is_about};

/// Scratch arrays of the search.
#[derive(Clone, Debug, Default)]
pub(super) struct Search {
    /// Positions of all particles at the end of the substep when pairs were found, m.
    end: Vec<Vec3>,
    patches: Vec<Region>,
    /// Normals of all triangles at the end of the substep, as long as twice their areas, m².
    normals: Vec<Vec3A>,
    /// Whether the cells and triangles of a patch are those of this substep.
    refined: Vec<bool>,
    cells: Vec<Region>,
    /// Boxes around the paths of triangles, widened by half of the thickness.
    triangles: Vec<Swept>,
}

impl Search {
    /// Whether a particle has moved since pairs were found such that pairs may be missing.
    pub fn is_outdated(&self, cloth: Cloth) -> bool {
        let mut ends = self.end.iter().zip(&cloth.particles.end);
        let far = 0.5 * cloth.thickness;
        ends.any(|(searched, &end)| searched.distance_squared(end) > far * far)
    }

    /// Finds all pairs of a cloth that come nearer than the thickness.
    pub fn find(&mut self, cloth: Cloth, pairs: &mut Pairs) {
        pairs.clear();
        self.bound(cloth);
        for (one, patch) in cloth.mesh.patches.iter().enumerate() {
            let part =
                |index: usize| (&self.patches[index], cloth.mesh.patches[index].triangles.clone());
            if !self.are_flat([part(one)]) {
                self.compare_patches(cloth, [one, one], pairs);
            }
            for other in one + 1..self.patches.len() {
                let part = |index: usize| {
                    (&self.patches[index], cloth.mesh.patches[index].triangles.clone())
                };
                if self.patches[one].around.meets(&self.patches[other].around)
                    && !self.are_neighbours_flat(part, &patch.neighbours, [one, other])
                {
                    self.compare_patches(cloth, [one, other], pairs);
                }
            }
        }
    }

    /// Computes the patches.
    fn bound(&mut self, Cloth { mesh, particles, thickness }: Cloth) {
        let Particles { start, end, .. } = particles;
        self.end.clone_from(end);
        self.patches.clear();
        self.normals.clear();
        for patch in &mesh.patches {
            let mut around = Swept::EMPTY;
            for &particle in &patch.particles {
                around.add(start[particle as usize], end[particle as usize]);
            }
            let mut normals = Normals::EMPTY;
            let Range { start: first, end: last } = patch.triangles;
            for triangle in &mesh.triangles[first as usize..last as usize] {
                let [a, b, c] = triangle.map(|corner| Vec3A::from(end[corner as usize]));
                let normal = (b - a).cross(c - a);
                normals.add(normal);
                self.normals.push(normal);
            }
            self.patches.push(Region { around: around.widened(0.5 * thickness), normals });
        }
        self.refined.clear();
        self.refined.resize(mesh.patches.len(), false);
        self.cells.resize(mesh.cells.len(), Region::EMPTY);
        self.triangles.resize(mesh.triangles.len(), Swept::EMPTY);
    }

    /// Computes the cells and triangles of a patch, once a substep.
    fn refine(&mut self, cloth: Cloth, patch: usize) {
        if core::mem::replace(&mut self.refined[patch], true) {
            return;
        }
        for cell in cloth.mesh.patches[patch].cells.clone() {
            let mut region = Region::EMPTY;
            for triangle in cloth.mesh.cells[cell as usize].triangles.clone() {
                let [start, end] = cloth.positions(cloth.mesh.triangles[triangle as usize]);
                let around = Swept::around(start, end, 0.5 * cloth.thickness);
                region.around = region.around.merged(around);
                region.normals.add(self.normals[triangle as usize]);
                self.triangles[triangle as usize] = around;
            }
            self.cells[cell as usize] = region;
        }
    }

    /// Compares the cells of two patches, or of one with itself.
    fn compare_patches(&mut self, cloth: Cloth, patches: [usize; 2], pairs: &mut Pairs) {
        patches.iter().for_each(|&patch| self.refine(cloth, patch));
        let [one, other] = patches.map(|patch| &cloth.mesh.patches[patch]);
        let around = self.patches[patches[1]].around;
        for first in one.cells.clone() {
            let of_first = &self.cells[first as usize];
            if !of_first.around.meets(&around) {
                continue;
            }
            let part =
                |index: usize| (&self.cells[index], cloth.mesh.cells[index].triangles.clone());
            if patches[0] == patches[1] && !self.are_flat([part(first as usize)]) {
                self.compare_cells(cloth, [first, first], pairs);
            }
            let neighbours = &cloth.mesh.cells[first as usize].neighbours;
            for second in other.cells.clone() {
                if (patches[0] != patches[1] || first < second)
                    && of_first.around.meets(&self.cells[second as usize].around)
                    && !self.are_neighbours_flat(
                        part,
                        neighbours,
                        [first, second].map(|it| it as usize),
                    )
                {
                    self.compare_cells(cloth, [first, second], pairs);
                }
            }
        }
    }

    /// Compares the triangles of two cells, or of one with itself.
    fn compare_cells(&self, cloth: Cloth, cells: [u32; 2], pairs: &mut Pairs) {
        let [one, other] = cells.map(|cell| cloth.mesh.cells[cell as usize].triangles.clone());
        let around = self.cells[cells[1] as usize].around;
        for first in one {
            let of_first = &self.triangles[first as usize];
            if !of_first.meets(&around) {
                continue;
            }
            for second in other.clone() {
                let of_second = &self.triangles[second as usize];
                if (cells[0] != cells[1] || first < second)
                    && of_first.meets(of_second)
                    && cloth.may_touch([first, second])
                {
                    self.add_features(cloth, [first, second], pairs);
                }
            }
        }
    }

    /// Adds the pairs of features that two triangles stand for.
    fn add_features(&self, cloth: Cloth, triangles: [u32; 2], pairs: &mut Pairs) {
        let Cloth { mesh, thickness, .. } = cloth;
        let corners = triangles.map(|triangle| mesh.triangles[triangle as usize]);
        let near = |one: Swept, other: Swept| one.widened(thickness).meets(&other);
        let represented = triangles.map(|triangle| &mesh.represented[triangle as usize]);
        for (one, other) in [(0, 1), (1, 0)] {
            let triangle = corners[other];
            let [a, b, c] = triangle;
            let around = cloth.swept(triangle);
            for &particle in &represented[one].particles {
                if !triangle.contains(&particle) && near(cloth.swept([particle]), around) {
                    pairs.particles_triangles.push([particle, a, b, c]);
                }
            }
            for &index in &represented[one].edges {
                let edge = mesh.edges[index as usize].ends;
                let apart = edge.iter().all(|end| !triangle.contains(end));
                if apart && near(cloth.swept(edge), around) {
                    pairs.edges_triangles.push(EdgeTriangle { index, edge, triangle });
                }
            }
        }
        for &one in &represented[0].edges {
            let [a, b] = mesh.edges[one as usize].ends;
            for &other in &represented[1].edges {
                let [c, d] = mesh.edges[other as usize].ends;
                let apart = a != c && a != d && b != c && b != d;
                if apart && near(cloth.swept([a, b]), cloth.swept([c, d])) {
                    pairs.edges_edges.push([a, b, c, d]);
                }
            }
        }
    }

    /// Whether parts of the cloth that are connected along edges do not touch themselves: whether all their normals lie in
    /// one half space (Volino and Magnenat-Thalmann 1994, without their test of the contour).
    fn are_flat<const COUNT: usize>(&self, parts: [Part; COUNT]) -> bool {
        let direction = parts.iter().fold(Vec3A::ZERO, |sum, (it, _)| sum + it.normals.sum);
        parts.iter().all(|(region, triangles)| {
            let normals = &self.normals[triangles.start as usize..triangles.end as usize];
            region.normals.are_about(direction)
                || normals.iter().all(|&normal| is_about(normal, direction))
        })
    }

    /// Whether two parts are neighbours and do not touch each other, with their bridge if they need it.
    fn are_neighbours_flat<'a>(
        &self,
        part: impl Fn(usize) -> Part<'a>,
        neighbours: &[Neighbour],
        [one, other]: [usize; 2],
    ) -> bool {
        let find = neighbours.binary_search_by_key(&(other as u32), |neighbour| neighbour.index);
        let Ok(found) = find else { return false };
        match neighbours[found].bridge {
            Some(bridge) => self.are_flat([part(one), part(bridge as usize), part(other)]),
            None => self.are_flat([part(one), part(other)]),
        }
    }
}

/// A patch or a cell, and its triangles.
type Part<'a> = (&'a Region, Range<u32>);
