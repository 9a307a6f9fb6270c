//! Stitches with the lines of cloth that end at them.

use core::ops::Range;
use std::collections::{HashMap, HashSet};

use crate::batch::BatchError;
use crate::fabric::{Fabric, LinkFamily, ascending};
use crate::seams::stitch::Stitch;

/// Number of times that all stitches are solved in a pass, in one order and in the other, if any two share a line or a particle. Fewer:
/// panels between others are drawn to one side. More: costs more.
const SWEEPS_OF_SHARED_LINES: usize = 2;

/// The stitches of a cloth, with the lines of its fabric that end at them: see [`ClothBatch::sew`](crate::ClothBatch::sew).
///
/// ```
/// use bunting_solver::{FabricBuilder, Grid, Seams, Stitch};
///
/// // The left edge of a sheet is sewn to its right edge, which makes a tube of it.
/// let fabric = FabricBuilder::grid(Grid::new(9, 5, 1.0, 0.5)).build()?;
/// let stitches: Vec<Stitch> =
///     (0..5).map(|row| Stitch::to_particle(9 * row, 9 * row + 8)).collect();
/// let seams = Seams::new(&fabric, &stitches)?;
/// assert_eq!(seams.count(), 5);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Seams {
    pub(super) stitches: Vec<Sewn>,
    pub(super) lines: Vec<SewnLine>,
    /// Along each line, from the seam into the cloth, indices of `particles`.
    pub(super) points: Vec<u32>,
    /// The particles of all stitches and lines.
    pub(super) particles: Vec<u32>,
    /// The ends of all links of lines, ascending.
    pub(super) links: Vec<[u32; 2]>,
    /// Number of times that all stitches are solved in a pass.
    pub(super) sweeps: usize,
    /// Number of the fabric's particles.
    pub(crate) of_fabric: usize,
}

/// A stitch: the sum of its ends' positions times their weights is zero if it is closed.
#[derive(Clone, Debug)]
pub(super) struct Sewn {
    pub ends: Vec<End>,
}

/// A particle of a stitch.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// Index in [`Seams::particles`].
    pub at: u32,
    pub weight: f32,
    /// Index of the line that ends there.
    pub line: Option<u32>,
}

/// A line of cloth that ends at a seam.
#[derive(Clone, Debug)]
pub(super) struct SewnLine {
    /// Its range in [`Seams::points`]: at least two.
    pub points: Range<usize>,
    /// Its range in [`Seams::links`].
    pub links: Range<usize>,
}

impl Seams {
    /// The stitches of a cloth of this fabric, in the order in which they follow one another along the seams.
    ///
    /// # Errors
    ///
    /// [`BatchError::Stitch`] if a stitch names a particle that the fabric does not have, sews a particle to itself, or its part is not
    /// within 0 to 1.
    pub fn new(fabric: &Fabric, stitches: &[Stitch]) -> Result<Self, BatchError> {
        let count = fabric.particle_count();
        let is_bad = |stitch: &Stitch| {
            let Stitch { particle, onto, part } = *stitch;
            [particle, onto[0], onto[1]].iter().any(|&at| at as usize >= count)
                || !(0.0..=1.0).contains(&part)
                || weights(stitch).iter().skip(1).any(|&(at, _)| at == particle)
        };
        if let Some(stitch) = stitches.iter().position(is_bad) {
            return Err(BatchError::Stitch { stitch });
        }
        let sewn: HashSet<u32> = stitches.iter().flat_map(weights).map(|it| it.0).collect();
        let paths = paths_from(fabric, &sewn);
        let mut seams = Self {
            stitches: Vec::new(),
            lines: Vec::new(),
            points: Vec::new(),
            particles: Vec::new(),
            links: Vec::new(),
            sweeps: 1,
            of_fabric: count,
        };
        let mut known = Known::default();
        // Whether each line is that of one stitch alone: then it is solved with all that acts on it.
        let mut yarns_so_far = HashSet::new();
        let mut particles_so_far = HashSet::new();
        for stitch in stitches {
            let ends = weights(stitch);
            let yarns: Vec<Option<usize>> =
                ends.iter().map(|(at, _)| paths.get(at).map(|path| path.yarn)).collect();
            // The two ends of one line have a half each, so that they share no particle.
            let is_shared =
                |yarn: usize| yarns.iter().filter(|other| **other == Some(yarn)).count() > 1;
            let of_stitch: HashSet<usize> = yarns.iter().copied().flatten().collect();
            let are_new = of_stitch.into_iter().all(|yarn| yarns_so_far.insert(yarn))
                & ends.iter().all(|&(at, _)| particles_so_far.insert(at));
            if !are_new {
                seams.sweeps = SWEEPS_OF_SHARED_LINES;
            }
            let ends = ends.into_iter().map(|(particle, weight)| End {
                at: seams.index(particle, &mut known),
                weight,
                line: paths.get(&particle).and_then(|path| {
                    let is_half = is_shared(path.yarn);
                    seams.line(particle, &path.particles, is_half, &mut known)
                }),
            });
            let ends = ends.collect();
            seams.stitches.push(Sewn { ends });
        }
        Ok(seams)
    }

    /// Number of stitches.
    #[must_use]
    pub fn count(&self) -> usize {
        self.stitches.len()
    }
}

/// The particles of a stitch with their weights, without those of weight zero.
fn weights(stitch: &Stitch) -> Vec<(u32, f32)> {
    let Stitch { particle, onto: [one, other], part } = *stitch;
    if one == other {
        return vec![(particle, 1.0), (one, -1.0)];
    }
    let all = [(particle, 1.0), (one, part - 1.0), (other, -part)];
    all.into_iter().filter(|(_, weight)| *weight != 0.0).collect()
}

/// A path of warp or weft from a particle of a stitch to its other end.
struct Path {
    /// Index of the yarn.
    yarn: usize,
    particles: Vec<u32>,
}

/// For each of some particles, the longest path of warp or weft from there into the cloth. Lines along a seam are left out: what they do
/// is the same on both sides.
fn paths_from(fabric: &Fabric, sewn: &HashSet<u32>) -> HashMap<u32, Path> {
    let mut paths: HashMap<u32, Path> = HashMap::new();
    for (yarn, of_yarn) in fabric.yarns().iter().enumerate() {
        let family = fabric.links()[of_yarn.links[0] as usize].family;
        if family == LinkFamily::Diagonal || of_yarn.is_ring() {
            continue;
        }
        let there = of_yarn.particles.clone();
        let back = there.iter().rev().copied().collect();
        for particles in [there, back] {
            let [first, second] = [particles[0], particles[1]];
            let is_longest =
                paths.get(&first).is_none_or(|known| known.particles.len() < particles.len());
            if sewn.contains(&first) && !sewn.contains(&second) && is_longest {
                paths.insert(first, Path { yarn, particles });
            }
        }
    }
    paths
}

/// What is known of particles while seams are planned.
#[derive(Default)]
struct Known {
    /// Index of each in [`Seams::particles`].
    at: HashMap<u32, u32>,
    /// The line of each particle of a stitch, whole and halved.
    lines: HashMap<(u32, bool), Option<u32>>,
}

impl Seams {
    fn index(&mut self, particle: u32, known: &mut Known) -> u32 {
        *known.at.entry(particle).or_insert_with(|| {
            self.particles.push(particle);
            self.particles.len() as u32 - 1
        })
    }

    /// The line of a particle of a stitch along a path, or along half of it; none if nothing is left of it.
    fn line(
        &mut self,
        particle: u32,
        path: &[u32],
        is_half: bool,
        known: &mut Known,
    ) -> Option<u32> {
        if let Some(line) = known.lines.get(&(particle, is_half)) {
            return *line;
        }
        let path = if is_half { &path[..path.len() / 2] } else { path };
        let line = (path.len() > 1).then(|| {
            let (point, link) = (self.points.len(), self.links.len());
            for &particle in path {
                let index = self.index(particle, known);
                self.points.push(index);
            }
            self.links.extend(path.windows(2).map(|ends| ascending([ends[0], ends[1]])));
            let (points, links) = (point..self.points.len(), link..self.links.len());
            self.lines.push(SewnLine { points, links });
            self.lines.len() as u32 - 1
        });
        known.lines.insert((particle, is_half), line);
        line
    }
}
