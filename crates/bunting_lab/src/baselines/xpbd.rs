//! Extended position-based dynamics with small steps (Macklin et al. 2016, algorithm 1; Macklin et al.
//! 2019, "Small steps in physics simulation").

use glam::Vec3;

use super::{
    sheet::{Sheet, Stencil},
    stepper::Stepper,
};

/// A cloth under XPBD.
#[derive(Clone, Debug)]
pub struct Xpbd {
    passes: usize,
    previous: Vec<Vec3>,
    stretch: Vec<f32>,
    bend: Vec<Vec3>,
    twist: Vec<Vec3>,
}

impl Xpbd {
    /// The method, initialised for a sheet.
    #[must_use]
    pub fn new(sheet: &Sheet, passes: usize) -> Self {
        Self {
            previous: sheet.positions.clone(),
            stretch: vec![0.0; sheet.links.len()],
            bend: vec![Vec3::ZERO; sheet.bends.len()],
            twist: vec![Vec3::ZERO; sheet.twists.len()],
            passes,
        }
    }
}

impl Stepper for Xpbd {
    fn substep(&mut self, sheet: &mut Sheet, h: f32) {
        sheet.predict(&mut self.previous, h);
        self.stretch.fill(0.0);
        self.bend.fill(Vec3::ZERO);
        self.twist.fill(Vec3::ZERO);
        for _ in 0..self.passes {
            for (bend, lambda) in sheet.bends.iter().zip(&mut self.bend) {
                solve_stencil(bend, &mut sheet.positions, &sheet.inverse_masses, lambda, h);
            }
            for (twist, lambda) in sheet.twists.iter().zip(&mut self.twist) {
                solve_stencil(twist, &mut sheet.positions, &sheet.inverse_masses, lambda, h);
            }
            solve_links(sheet, &mut self.stretch, h);
        }
        sheet.take_velocities_from(&self.previous, h);
    }
}

fn solve_links(sheet: &mut Sheet, lambdas: &mut [f32], h: f32) {
    for (link, lambda) in sheet.links.iter().zip(lambdas) {
        let (wa, wb) = (sheet.inverse_masses[link.a], sheet.inverse_masses[link.b]);
        let compliance = 1.0 / (link.stiffness * h * h);
        let d = sheet.positions[link.b] - sheet.positions[link.a];
        let length = d.length_squared().sqrt();
        if length == 0.0 {
            continue;
        }
        let change = (link.rest - length - compliance * *lambda) / (wa + wb + compliance);
        *lambda += change;
        let push = d * (change / length);
        sheet.positions[link.a] -= push * wa;
        sheet.positions[link.b] += push * wb;
    }
}

fn solve_stencil<const N: usize>(
    stencil: &Stencil<N>,
    positions: &mut [Vec3],
    inverse_masses: &[f32],
    lambda: &mut Vec3,
    h: f32,
) {
    let compliance = 1.0 / (stencil.stiffness * h * h);
    let mut mobility = compliance;
    for (v, weight) in stencil.vertices.into_iter().zip(stencil.weights) {
        mobility += inverse_masses[v] * weight * weight;
    }
    let change = -(stencil.value(positions) + *lambda * compliance) / mobility;
    *lambda += change;
    for (v, weight) in stencil.vertices.into_iter().zip(stencil.weights) {
        positions[v] += change * (inverse_masses[v] * weight);
    }
}
