//! What a cloth is like at the end of a scene: hashes say whether a machine or a change differs, and these how.

use bunting_solver::Fabric;
use glam::Vec3;

use crate::{
    figure::Figure,
    product::yarn_strains,
    stats::{Strain, mean},
};

/// Differences that do not matter: of a position, m; of a strain, %; of a speed, m/s.
const POSITION: f64 = 1e-3;
const STRAIN: f64 = 0.02;
const SPEED: f64 = 5e-3;

/// Figures of a cloth with these positions (m) and velocities (m/s). Its tip is the last particle: the lower right corner of a grid.
pub fn figures(fabric: &Fabric, positions: &[Vec3], velocities: &[Vec3]) -> Vec<Figure> {
    let tip = positions.last().copied().unwrap_or_default().as_dvec3();
    let heights: Vec<f64> = positions.iter().map(|at| at.y.into()).collect();
    let squares: Vec<f64> = velocities.iter().map(|v| v.length_squared().into()).collect();
    let strain = Strain::of(yarn_strains(fabric, positions));
    vec![
        Figure::new("tip, x, m", tip.x, POSITION),
        Figure::new("tip, y, m", tip.y, POSITION),
        Figure::new("tip, z, m", tip.z, POSITION),
        Figure::new("mean height, m", mean(&heights), POSITION),
        Figure::new("mean strain of warp and weft, %", strain.mean * 100.0, STRAIN),
        Figure::new("99.9 % of the strain, %", strain.p999 * 100.0, STRAIN),
        Figure::new("RMS speed, m/s", mean(&squares).sqrt(), SPEED),
    ]
}
