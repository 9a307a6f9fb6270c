//! The air of one cloth in a batch.

use glam::Vec3;

use super::air::Pressure;
use crate::batch::BatchError;
use crate::fabric::Fabric;

/// Area of the holes, as a part of the cloth's, up to which a cloth counts as closed. Smaller: a ball with a valve is open. Larger:
/// lids carry a force that the eye misses.
const CLOSED: f32 = 0.05;

/// The air of one cloth.
#[derive(Clone, Debug)]
pub(crate) struct LanePressure {
    pub air: Pressure,
    /// Particles on the border, each once.
    pub border: Vec<u32>,
    /// Edges of the border, in the direction in which their triangles run, if lids close it: triangles from each edge to
    /// the border's middle.
    pub lids: Vec<[u32; 2]>,
    /// Mean mass of a particle over the material's area density, m²: the square of the particles' distance where the material is the same
    /// everywhere.
    pub spacing_squared: f32,
    /// Volume at rest, m³.
    pub rest_volume: f32,
    /// Gradient of the volume at each particle, as of its last use in the substep, m².
    pub gradient: Vec<Vec3>,
    /// Positions of the particles then, m.
    pub positions: Vec<Vec3>,
}

impl LanePressure {
    /// The air of a cloth of a fabric.
    ///
    /// # Errors
    ///
    /// A number cannot be, or the air of an open cloth cannot leave.
    pub fn new(air: Pressure, fabric: &Fabric) -> Result<Self, BatchError> {
        air.validate()?;
        let edges = border_of(fabric.triangles());
        let mut border: Vec<u32> = edges.iter().map(|edge| edge[0]).collect();
        border.sort_unstable();
        border.dedup();
        let rest = fabric.rest_positions();
        let area = area_vector(rest, fabric.triangles());
        let is_closed = area.length() <= CLOSED * fabric.area();
        if let (Pressure::Sealed { .. }, false) = (air, is_closed) {
            return Err(BatchError::Open { area: area.length() });
        }
        let has_lids = is_closed && !matches!(air, Pressure::Canopy { .. });
        let mut state = Self {
            air,
            border,
            lids: if has_lids { edges } else { Vec::new() },
            spacing_squared: fabric.mass_area() / fabric.particle_count() as f32,
            rest_volume: 0.0,
            gradient: gradient_of(rest, fabric.triangles()),
            positions: rest.to_vec(),
        };
        state.close();
        state.rest_volume = state.volume();
        Ok(state)
    }

    /// Adds the lids to the gradient.
    pub fn close(&mut self) {
        if self.lids.is_empty() {
            return;
        }
        let middle = self.middle();
        let mut of_middle = Vec3::ZERO;
        for &[from, to] in &self.lids {
            // Seen from outside, a lid has its edge the other way round.
            let [a, b] = [to, from].map(|at| self.positions[at as usize]);
            let part = (b - a).cross(middle - a) / 6.0;
            self.gradient[to as usize] += part;
            self.gradient[from as usize] += part;
            of_middle += part;
        }
        // The middle is the mean of the border, which shares its part.
        let share = of_middle / self.border.len() as f32;
        for &particle in &self.border {
            self.gradient[particle as usize] += share;
        }
    }

    /// The point about which the volume is measured, m: the middle of the border, or some point of a closed cloth.
    fn middle(&self) -> Vec3 {
        let at = |&particle: &u32| self.positions[particle as usize];
        match self.border.len() {
            0 => self.positions.first().copied().unwrap_or_default(),
            count => self.border.iter().map(at).sum::<Vec3>() / count as f32,
        }
    }

    /// The volume between the cloth and its border's middle, m³; negative where the triangles' normals point inwards.
    pub fn volume(&self) -> f32 {
        let middle = self.middle();
        let parts = self.positions.iter().zip(&self.gradient);
        parts.map(|(&at, gradient)| (at - middle).dot(*gradient)).sum::<f32>() / 3.0
    }

    /// Tension by a unit of pressure, m: p r/2 in a sphere of radius r = 3V/A, p r in a cylinder of radius r = 2V/A; this is that of
    /// the cylinder.
    pub fn tension(&self, fabric: &Fabric) -> f32 {
        2.0 * self.volume().abs() / fabric.area()
    }

    /// Load by the tension of a cloth of an area density, kg/m², that has this pressure inside, Pa, for
    /// [`Loads::tension`](crate::Loads::tension), m/s²: that of which [`StepLimits`](crate::StepLimits) conclude on τ² T/(σ l²).
    pub fn load(&self, fabric: &Fabric, area_density: f32, pressure: f32) -> f32 {
        let tautness_squared = fabric.tautness() * fabric.tautness();
        let weight = area_density * self.spacing_squared * tautness_squared;
        pressure.abs() * self.tension(fabric) / weight
    }

    /// Whether the cloth has no holes, or lids close them.
    pub fn is_closed(&self) -> bool {
        self.border.is_empty() || !self.lids.is_empty()
    }

    /// The area of the mouth as a vector, m².
    pub fn mouth(&self) -> Vec3 {
        self.gradient.iter().sum()
    }
}

/// Edges with a triangle on one side alone, in the direction of that triangle.
fn border_of(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let edges = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut sorted: Vec<[u32; 2]> = edges.collect();
    sorted.sort_unstable();
    let has = |edge: &[u32; 2]| sorted.binary_search(edge).is_ok();
    sorted.iter().filter(|&&[a, b]| !has(&[b, a])).copied().collect()
}

/// The gradient at each particle, a third of a triangle's area at each corner, m².
fn gradient_of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut gradient = vec![Vec3::ZERO; positions.len()];
    for &corners in triangles {
        let part = face(positions, corners) / 6.0;
        corners.iter().for_each(|&at| gradient[at as usize] += part);
    }
    gradient
}

/// The sum of all triangles' areas as vectors, m².
fn area_vector(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec3 {
    triangles.iter().map(|&corners| 0.5 * face(positions, corners)).sum()
}

/// The normal of a triangle, twice as long as its area, m².
fn face(positions: &[Vec3], corners: [u32; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|at| positions[at as usize]);
    (b - a).cross(c - a)
}
