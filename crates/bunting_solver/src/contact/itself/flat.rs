//! Parts of a cloth that are bent so little that they do not touch themselves.

use core::ops::Range;

use glam::{Vec3, Vec3A};

use crate::constants::LEAST_AREA_SQUARED;
use crate::contact::itself::apart::gather;
use crate::contact::itself::patches::Cell;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::registers::Pack8;
use crate::simd::vec3::{Pack3, V3};

/// Cosine of the greatest angle between a triangle's normal and the mean of a part's normals. Smaller: parts that are about
/// to fold upon themselves are skipped. Larger: more of them are compared in vain.
const LEAST_COSINE: f32 = 0.2;

/// Unit normals of the triangles of each cell; zero of collapsed triangles.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct Normals {
    /// The normals of each cell, one in each lane.
    cells: Vec<Pack3<Pack8>>,
    /// Sum of each cell's normals.
    sums: Vec<Vec3>,
}

impl Normals {
    /// Computes the normals of all cells, given the positions of all particles, m.
    pub fn compute(&mut self, cells: &[Cell], positions: &[Vec3]) {
        self.cells.resize(cells.len(), [Pack8::splat(0.0); 3]);
        self.sums.resize(cells.len(), Vec3::ZERO);
        Pack8::run(Compute { cells, positions, normals: self });
    }

    /// Whether cells that are connected along edges do not touch one another nor themselves: whether all their normals lie
    /// in one half space (Volino and Magnenat-Thalmann 1994, without their test of the contour).
    pub fn are_flat<const COUNT: usize>(&self, parts: [Range<u32>; COUNT]) -> bool {
        let parts = parts.map(|part| part.start as usize..part.end as usize);
        let mut direction = Vec3::ZERO;
        for part in &parts {
            self.sums[part.clone()].iter().for_each(|&sum| direction += sum);
        }
        let normals = parts.map(|part| &self.cells[part]);
        let mut are_flat = false;
        Pack8::run(AreAbout {
            normals: &normals,
            direction: direction.into(),
            are_about: &mut are_flat,
        });
        are_flat
    }
}

struct Compute<'a> {
    cells: &'a [Cell],
    positions: &'a [Vec3],
    normals: &'a mut Normals,
}

impl Kernel<Pack8> for Compute<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let least = L::splat(token, LEAST_AREA_SQUARED);
        let mut corners = [[Pack8::splat(0.0); 3]; 3];
        let Normals { cells: into, sums } = self.normals;
        for ((cell, into), sum) in self.cells.iter().zip(into).zip(sums) {
            gather(cell, self.positions, &mut corners);
            let a = V3::<L>::load(token, &corners[0]);
            let b = V3::load(token, &corners[1]);
            let c = V3::load(token, &corners[2]);
            let normal = (b - a).cross(c - a);
            let length = normal.dot(normal).max(least).sqrt();
            (normal * (L::splat(token, 1.0) / length)).store(into);
            *sum = Vec3::new(total(&into[0]), total(&into[1]), total(&into[2]));
        }
    }
}

/// Finds whether normals are about a direction.
struct AreAbout<'a> {
    normals: &'a [&'a [Pack3<Pack8>]],
    direction: Vec3A,
    are_about: &'a mut bool,
}

impl Kernel<Pack8> for AreAbout<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let direction = V3::<L>::splat3(token, self.direction);
        let bound = L::splat(token, LEAST_COSINE) * direction.dot(direction).sqrt();
        let mut least = L::splat(token, f32::INFINITY);
        for part in self.normals {
            for normals in *part {
                least = least.min(direction.dot(V3::load(token, normals)));
            }
        }
        let is_below = least.lt(bound) | bound.lt(L::splat(token, f32::MIN_POSITIVE));
        *self.are_about = !is_below.any();
    }
}

/// Sum of the lanes.
#[inline(always)]
fn total(pack: &Pack8) -> f32 {
    let mut sum = 0.0;
    for lane in pack.lanes() {
        sum += lane;
    }
    sum
}
