//! The particles of a fabric onto which regions are laid.

use super::kites::Kite;
use super::region::{MaterialRegion, RegionShape};
use super::variation::Variation;
use crate::fabric::interpolation::Term;
use crate::fabric::mesh::RestMesh;
use crate::fabric::rest_paths::RestPaths;
use crate::fabric::tethers::pins;
use crate::fabric::topology::Edge;

/// What is known of a fabric's particles before there are links between them.
pub(in crate::fabric) struct Ground<'a> {
    pub mesh: &'a RestMesh,
    pub edges: &'a [Edge],
    /// Whether paths along the cloth are straight.
    pub is_flat: bool,
    /// Particles around each cell.
    pub cells: Vec<Vec<u32>>,
    /// Of each particle the vertices of the source mesh around it, with their weights.
    pub corners: Vec<Vec<Term>>,
}

impl Ground<'_> {
    /// How regions vary the material. Their lists fit the source mesh.
    pub fn variation(&self, regions: &[MaterialRegion]) -> Variation {
        let mut variation = Variation::default();
        let mut kites = None;
        for region in regions {
            let weights = match &region.shape {
                RegionShape::Vertices(weights) => self.of_vertices(weights),
                RegionShape::Depth(weights) => self.by_depth(weights),
                shape => {
                    let kites = kites.get_or_insert_with(|| Kite::all(self.mesh, &self.cells));
                    self.by_texture(shape, kites)
                }
            };
            variation.add(region, &weights);
        }
        variation
    }

    fn count(&self) -> usize {
        self.mesh.positions.len()
    }

    fn of_vertices(&self, weights: &[f32]) -> Vec<f32> {
        let of_particle = |corners: &Vec<Term>| {
            let inside = || corners.iter().filter(|term| term.weight > 0.0);
            let sum: f32 = inside().map(|term| term.weight).sum();
            inside().map(|term| weights[term.from as usize] * (term.weight / sum)).sum::<f32>()
        };
        self.corners.iter().map(of_particle).map(|weight| weight.clamp(0.0, 1.0)).collect()
    }

    /// The part of each particle's cloth that a region of the texture covers.
    fn by_texture(&self, shape: &RegionShape, kites: &[Kite]) -> Vec<f32> {
        let mut sums = vec![(0.0, 0.0); self.count()];
        for kite in kites {
            let sum: &mut (f32, f32) = &mut sums[kite.particle as usize];
            for weight in kite.samples().filter_map(|sample| shape.at(&sample)) {
                sum.0 += kite.area * weight;
                sum.1 += kite.area;
            }
        }
        sums.into_iter().map(|(sum, area)| if area > 0.0 { sum / area } else { 0.0 }).collect()
    }

    /// Weights of a curve, by the distance of each particle from its nearest pin in units of the greatest one.
    fn by_depth(&self, weights: &[f32]) -> Vec<f32> {
        let ends = self.edges.iter().map(|edge| edge.ends);
        let paths = RestPaths::new(&self.mesh.positions, ends, self.is_flat);
        let distances: Vec<Option<f32>> = (paths.nearest(&pins(self.mesh, self.edges)).into_iter())
            .map(|nearest| nearest.map(|(distance, _)| distance))
            .collect();
        let farthest = distances.iter().flatten().copied().fold(f32::MIN_POSITIVE, f32::max);
        let last = weights.len() - 1;
        let weight = |distance: Option<f32>| {
            let depth = distance.map_or(1.0, |distance| distance / farthest);
            let at = depth * last as f32;
            let before = (at as usize).min(last);
            let part = at - before as f32;
            weights[before] * (1.0 - part) + weights[(before + 1).min(last)] * part
        };
        distances.into_iter().map(weight).collect()
    }
}
