//! Meshes with fewer triangles: the next coarser level of one that is not a grid, and one of a given size.

use std::collections::BTreeSet;

use meshopt::{SimplifyOptions, VertexDataAdapter, typed_to_bytes};

use super::coarser::CoarserMesh;
use super::flattened::remove_flattened;
use super::slivers::flip_slivers;
use super::source::FabricBuilder;

/// Number of triangles of the finer mesh for each triangle of the simplified one.
const REDUCTION: usize = 4;

/// Fraction of the triangles above which a simplified mesh is no level of its own.
const WORTHWHILE: f32 = 0.75;

/// Cost of the texture's distortion in the simplification, 1/m: units of texture coordinates that weigh as
/// much as a metre of shape.
const UV_COST: f32 = 1.0;

/// Fraction of the triangles that are asked for when a mesh still has too many vertices.
const FEWER: f32 = 0.75;

/// Greatest number of attempts to reach a number of vertices.
const ATTEMPTS: usize = 8;

/// Factor on the number of triangles that are asked for when no fabric can be built of those that there are.
const MORE: f32 = 1.1;

/// Greatest number of attempts with more triangles, up to ten times as many.
const ATTEMPTS_WITH_MORE: usize = 24;

impl FabricBuilder {
    /// A mesh of at most this number of vertices, if it can be reached, from which a fabric can be built: otherwise it has more
    /// vertices. None if the mesh has no more than this number, is invalid, or cannot be simplified.
    pub(super) fn simplified_to(&self, vertices: usize) -> Option<CoarserMesh> {
        if self.positions.len() <= vertices {
            return None;
        }
        self.validate().ok()?;
        // Twice as many triangles as vertices, by Euler's formula.
        let wanted = 2.0 * vertices as f32;
        let simplified = |triangles: f32| {
            let corners = 3 * triangles as usize;
            let kept = self.simplified_triangles(corners, SimplifyOptions::Regularize)?;
            Some(self.with_triangles(&kept))
        };
        let used: BTreeSet<u32> = self.indices.iter().copied().collect();
        let pins = self.pinned.intersection(&used).count();
        let is_sound = |simple: &CoarserMesh| {
            simple.builder.pinned.len() == pins && simple.builder.check().is_ok()
        };
        let (mut triangles, mut fewest, mut found) = (wanted, usize::MAX, None);
        for _ in 0..ATTEMPTS {
            let Some(simple) = simplified(triangles) else { break };
            let count = simple.vertices.len();
            if count >= fewest {
                break;
            }
            fewest = count;
            if is_sound(&simple) {
                found = Some(simple);
            }
            if count <= vertices {
                break;
            }
            triangles *= FEWER;
        }
        let mut triangles = wanted;
        found.or_else(|| {
            (0..ATTEMPTS_WITH_MORE).find_map(|_| {
                triangles *= MORE;
                simplified(triangles).filter(is_sound)
            })
        })
    }

    /// About a quarter of the triangles, with the whole border and all pins. None if hardly any can be removed.
    pub(super) fn simplified(&self) -> Option<CoarserMesh> {
        self.validate().ok()?;
        let options = SimplifyOptions::LockBorder | SimplifyOptions::Regularize;
        let kept = self.simplified_triangles(self.indices.len() / REDUCTION, options)?;
        Some(self.with_triangles(&kept))
    }

    /// The mesh of some triangles, three vertices each.
    fn with_triangles(&self, kept: &[u32]) -> CoarserMesh {
        let mut vertices = kept.to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let index = |vertex: &u32| vertices.binary_search(vertex).ok().map(|at| at as u32);
        let finer = || vertices.iter().map(|&vertex| vertex as usize);
        let builder = Self {
            positions: finer().map(|vertex| self.positions[vertex]).collect(),
            indices: kept.iter().filter_map(index).collect(),
            uv: finer().filter_map(|vertex| self.uv.get(vertex).copied()).collect(),
            pinned: self.pins_among(&vertices).collect(),
            weld_distance: Some(self.effective_weld_distance()),
            merged: self
                .merged
                .as_ref()
                .map(|merged| finer().map(|vertex| merged[vertex]).collect()),
            pinned_before_uv: false,
            tethered: self.tethered,
            grid: None,
        };
        CoarserMesh { builder, vertices }
    }

    /// Triangles of a mesh simplified to some number of corners, as three vertices of this mesh each. None if hardly any
    /// can be removed.
    fn simplified_triangles(&self, corners: usize, options: SimplifyOptions) -> Option<Vec<u32>> {
        let positions: Vec<[f32; 3]> = self.positions.iter().map(|at| at.to_array()).collect();
        let adapter =
            VertexDataAdapter::new(typed_to_bytes(&positions), size_of::<[f32; 3]>(), 0).ok()?;
        let uv: Vec<f32> = self.uv.iter().flat_map(|uv| uv.to_array()).collect();
        let costs = if uv.is_empty() { &[][..] } else { &[UV_COST; 2] };
        let locked: Vec<bool> =
            (0..positions.len()).map(|vertex| self.pinned.contains(&(vertex as u32))).collect();
        let kept = meshopt::simplify_with_attributes_and_locks(
            &self.indices,
            &adapter,
            &uv,
            costs,
            size_of_val(costs),
            &locked,
            corners,
            f32::MAX,
            options,
            None,
        );
        if kept.is_empty() || kept.len() as f32 > WORTHWHILE * self.indices.len() as f32 {
            return None;
        }
        let corners = kept.chunks_exact(3);
        let mut triangles: Vec<[u32; 3]> = corners.map(|at| [at[0], at[1], at[2]]).collect();
        let particle_of_vertex = self.weld().particle_of_vertex;
        remove_flattened(&particle_of_vertex, &self.pinned, &mut triangles);
        flip_slivers(&self.positions, &particle_of_vertex, &mut triangles);
        Some(triangles.into_flattened())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use glam::Vec3;

    use super::*;

    /// A quilt: two layers of a square metre, 2 mm or a little more apart, joined by a hem all around, with a fringe of tabs
    /// at its lower edge. A simplification that only looks at distances flattens the tabs.
    fn quilt(cells: i32, gap: f32, (tab, width, every): (i32, i32, i32)) -> FabricBuilder {
        let is_tab = |x: i32, y: i32| y < cells + tab && (x - 2).rem_euclid(every) < width;
        let is_in = |x: i32, y: i32| {
            (0..cells).contains(&x)
                && y >= 0
                && (y < cells || ((2..cells - 2).contains(&x) && is_tab(x, y)))
        };
        let mut vertices: BTreeMap<[i32; 3], u32> = BTreeMap::new();
        let mut positions = Vec::new();
        let mut indices = Vec::new();
        let mut quad = |corners: [[i32; 3]; 4]| {
            let [a, b, c, d] = corners.map(|at @ [x, y, layer]| {
                *vertices.entry(at).or_insert_with(|| {
                    let (x, y) = (x as f32 / cells as f32, -y as f32 / cells as f32);
                    let bulge = 0.3 * (x - 0.5) * (x - 0.5) + 0.1 * (y + 0.5) * (y + 0.5);
                    positions.push(Vec3::new(x, y, gap * layer as f32 + bulge));
                    positions.len() as u32 - 1
                })
            });
            indices.extend([a, b, c, a, c, d]);
        };
        for y in 0..cells + tab {
            for x in (0..cells).filter(|&x| is_in(x, y)) {
                let [a, b, c, d] = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
                let on = |[x, y]: [i32; 2], layer: i32| [x, y, layer];
                quad([on(a, 0), on(b, 0), on(c, 0), on(d, 0)]);
                quad([on(a, 1), on(d, 1), on(c, 1), on(b, 1)]);
                let sides =
                    [(a, b, x, y - 1), (b, c, x + 1, y), (c, d, x, y + 1), (d, a, x - 1, y)];
                for (from, to, x, y) in sides {
                    if !is_in(x, y) {
                        quad([on(from, 0), on(from, 1), on(to, 1), on(to, 0)]);
                    }
                }
            }
        }
        FabricBuilder::new(positions, indices)
    }

    #[test]
    fn what_is_simplified_can_be_built_whatever_lies_on_what() {
        for (gap, tabs) in [(0.002, (6, 1, 3)), (0.01, (6, 2, 4))] {
            let fine = quilt(24, gap, tabs).pin([0, 5]);
            assert!(fine.check().is_ok(), "the quilt is sound");
            for most in [100, 200, 300, 500, 800] {
                let simple = fine.decimated(most).expect("it has more vertices");
                let count = simple.vertices.len();
                assert!(count <= most + most / 4, "{count} vertices of at most {most}");
                let fabric = simple.builder.build();
                let fabric = fabric.unwrap_or_else(|error| panic!("{most}: {error}"));
                assert_eq!((0..count).filter(|&it| fabric.is_pinned(it)).count(), 2);
                let area = fabric.area();
                assert!((1.5..2.6).contains(&area), "two layers of a square metre have {area} m²");
            }
            assert!(fine.coarser().is_some_and(|coarser| coarser.builder.check().is_ok()));
        }
    }

    #[test]
    fn each_vertex_of_a_simplified_mesh_is_one_of_the_fine_mesh() {
        let fine = quilt(12, 0.01, (3, 1, 3));
        let simple = fine.decimated(80).expect("it has more vertices");
        let different: BTreeSet<u32> = simple.vertices.iter().copied().collect();
        assert_eq!(different.len(), simple.vertices.len());
        for (at, &of) in simple.builder.positions().iter().zip(&simple.vertices) {
            assert_eq!(*at, fine.positions[of as usize]);
        }
    }
}
