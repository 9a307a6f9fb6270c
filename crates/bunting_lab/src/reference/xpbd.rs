//! An independent check of the reference: extended position-based dynamics.
//!
//! Macklin, Müller and Chentanez 2016, "XPBD", algorithm 1, in double precision, Gauss–Seidel over
//! every link, bend and twist. Bends and twists are linear in the positions, so their constraint is
//! the stencil's vector itself.

use glam::DVec3;

use super::grid::Grid;
use crate::scenes::{Scene, TICK_RATE};

/// A cloth in vacuum advanced by XPBD.
#[derive(Clone, Debug)]
pub struct Xpbd {
    scene: Scene,
    grid: Grid,
    substeps: usize,
    iterations: usize,
    /// Positions, m.
    pub positions: Vec<DVec3>,
    /// Velocities, m/s.
    pub velocities: Vec<DVec3>,
    before: Vec<DVec3>,
    stretch: Vec<f64>,
    curvature: Vec<DVec3>,
}

impl Xpbd {
    /// The scene at its start; its air is ignored.
    #[must_use]
    pub fn new(scene: &Scene, substeps: usize, iterations: usize) -> Self {
        let grid = Grid::new(scene);
        let positions = scene.positions();
        Self {
            scene: scene.clone(),
            substeps,
            iterations,
            velocities: vec![DVec3::ZERO; positions.len()],
            before: positions.clone(),
            positions,
            stretch: vec![0.0; grid.links.len()],
            curvature: vec![DVec3::ZERO; grid.bends.len() + grid.twists.len()],
            grid,
        }
    }

    /// Advances by one tick.
    pub fn tick(&mut self) {
        let h = 1.0 / (f64::from(TICK_RATE) * self.substeps as f64);
        for _ in 0..self.substeps {
            self.substep(h);
        }
    }

    fn substep(&mut self, h: f64) {
        let decay = (-self.scene.damping * h).exp();
        self.before.copy_from_slice(&self.positions);
        for ((x, v), w) in
            self.positions.iter_mut().zip(&mut self.velocities).zip(&self.grid.inverse_masses)
        {
            if *w > 0.0 {
                *v *= decay;
                v.y -= self.scene.gravity * h;
                *x += *v * h;
            }
        }
        self.stretch.fill(0.0);
        self.curvature.fill(DVec3::ZERO);
        for _ in 0..self.iterations {
            self.solve_stencils(h);
            self.solve_links(h);
        }
        for ((x, before), v) in self.positions.iter().zip(&self.before).zip(&mut self.velocities) {
            *v = (*x - *before) / h;
        }
    }

    fn solve_links(&mut self, h: f64) {
        for (link, lambda) in self.grid.links.iter().zip(&mut self.stretch) {
            let (wa, wb) = (self.grid.inverse_masses[link.a], self.grid.inverse_masses[link.b]);
            let compliance = 1.0 / (link.stiffness * h * h);
            let d = self.positions[link.b] - self.positions[link.a];
            let length = d.length_squared().sqrt();
            let change = (link.rest - length - compliance * *lambda) / (wa + wb + compliance);
            *lambda += change;
            let push = d * (change / length);
            self.positions[link.a] -= push * wa;
            self.positions[link.b] += push * wb;
        }
    }

    fn solve_stencils(&mut self, h: f64) {
        let (bends, twists) = self.curvature.split_at_mut(self.grid.bends.len());
        for (bend, lambda) in self.grid.bends.iter().zip(bends) {
            let (weights, compliance) = ([1.0, -2.0, 1.0], 1.0 / (bend.stiffness * h * h));
            solve_stencil(
                &mut self.positions,
                &self.grid,
                bend.vertices,
                weights,
                compliance,
                lambda,
            );
        }
        for (twist, lambda) in self.grid.twists.iter().zip(twists) {
            let (weights, compliance) = ([1.0, -1.0, -1.0, 1.0], 1.0 / (twist.stiffness * h * h));
            solve_stencil(
                &mut self.positions,
                &self.grid,
                twist.vertices,
                weights,
                compliance,
                lambda,
            );
        }
    }
}

fn solve_stencil<const N: usize>(
    positions: &mut [DVec3],
    grid: &Grid,
    vertices: [usize; N],
    weights: [f64; N],
    compliance: f64,
    lambda: &mut DVec3,
) {
    let (mut value, mut mobility) = (DVec3::ZERO, compliance);
    for (v, weight) in vertices.into_iter().zip(weights) {
        value += positions[v] * weight;
        mobility += grid.inverse_masses[v] * weight * weight;
    }
    let change = -(value + *lambda * compliance) / mobility;
    *lambda += change;
    for (v, weight) in vertices.into_iter().zip(weights) {
        positions[v] += change * (grid.inverse_masses[v] * weight);
    }
}
