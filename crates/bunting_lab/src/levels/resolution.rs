//! The resolution of a level: distance between the surface of a flag and the same surface sampled at a
//! coarser level's vertices, with triangles between them. The plugin's estimate of a level's error follows
//! from this table.

use bunting_solver::{LevelTransfer, StepSettings};
use serde::Serialize;

use crate::{
    fleet::Fleet,
    levels::{FLAGS, INTERVAL, SETTLING},
    product,
    scenes::{Scene, ticks},
    settings::scheme_name,
    stats,
};

/// Distances of a flag's surface from that of a coarser level.
#[derive(Clone, Debug, Serialize)]
pub struct Resolution {
    /// Scheme.
    pub scheme: &'static str,
    /// Vertices along each side of the flag.
    pub fine: usize,
    /// Vertices along each side of the coarser level.
    pub coarse: usize,
    /// Root mean square distance, m.
    pub rms_m: f64,
    /// 95th percentile of the distance, m.
    pub p95_m: f64,
    /// 95th percentile over the distance between the coarser level's vertices.
    pub p95_of_cell: f64,
}

impl Resolution {
    /// Distances of a flag of `fine` vertices a side from every coarser level, at many moments of its flight.
    ///
    /// # Panics
    ///
    /// Never: each level is half of the one before.
    #[must_use]
    pub fn of(fine: usize, settings: StepSettings, moments: usize) -> Vec<Self> {
        let sizes: Vec<usize> =
            std::iter::successors(Some(fine), |n| (*n > 5).then_some(n / 2 + 1)).collect();
        let fabrics: Vec<_> = sizes.iter().map(|&n| product::fabric(&Scene::flag(n))).collect();
        let transfers: Vec<LevelTransfer> = fabrics
            .windows(2)
            .map(|pair| LevelTransfer::between(&pair[0], &pair[1]).expect("neighbours"))
            .collect();
        let mut fleet = Fleet::new(Scene::flag(fine), FLAGS, settings);
        fleet.advance(ticks(SETTLING));
        let mut distances = vec![Vec::new(); transfers.len()];
        for _ in 0..moments {
            fleet.advance(ticks(INTERVAL));
            for flag in fleet.snapshots() {
                for (depth, distances) in distances.iter_mut().enumerate() {
                    let down = transfers[..=depth].iter();
                    let coarse = down.fold(flag.positions.clone(), |fine, next| next.pick(&fine));
                    let up = transfers[..=depth].iter().rev();
                    let shown = up.fold(coarse, |coarse, next| next.spread(&coarse).collect());
                    let pairs = flag.positions.iter().zip(&shown);
                    distances.extend(pairs.map(|(a, b)| f64::from(a.distance(*b))));
                }
            }
        }
        sizes[1..]
            .iter()
            .zip(distances)
            .map(|(&coarse, mut distances)| {
                distances.sort_by(f64::total_cmp);
                let squares: Vec<f64> = distances.iter().map(|d| d * d).collect();
                let p95_m = stats::percentile(&distances, 0.95);
                let cell = Scene::flag(coarse).width / (coarse - 1) as f64;
                Self {
                    scheme: scheme_name(settings),
                    fine,
                    coarse,
                    rms_m: stats::mean(&squares).sqrt(),
                    p95_m,
                    p95_of_cell: p95_m / cell,
                }
            })
            .collect()
    }
}
