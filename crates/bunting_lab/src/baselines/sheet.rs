//! The state that every baseline advances, in single precision.

use glam::{Vec3, vec3};

use crate::{
    reference::grid::Grid,
    scenes::{Air, Scene},
};

/// A spring or distance between two vertices.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// First vertex.
    pub a: usize,
    /// Second vertex.
    pub b: usize,
    /// Length at rest, m.
    pub rest: f32,
    /// Stiffness, N/m.
    pub stiffness: f32,
}

/// A linear bending element: energy ½ stiffness |Σ weight · x|².
#[derive(Clone, Copy, Debug)]
pub struct Stencil<const N: usize> {
    /// Vertices of the element.
    pub vertices: [usize; N],
    /// Weights of the vertices.
    pub weights: [f32; N],
    /// Stiffness, N/m.
    pub stiffness: f32,
}

/// Positions, velocities, masses, connections and surroundings of one cloth.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Positions, m.
    pub positions: Vec<Vec3>,
    /// Velocities, m/s.
    pub velocities: Vec<Vec3>,
    /// Masses, kg.
    pub masses: Vec<f32>,
    /// Reciprocal masses, 1/kg; zero where pinned.
    pub inverse_masses: Vec<f32>,
    /// Warp, weft and diagonals.
    pub links: Vec<Link>,
    /// Bending along rows and columns.
    pub bends: Vec<Stencil<3>>,
    /// Twist of the cells.
    pub twists: Vec<Stencil<4>>,
    /// Triangles.
    pub triangles: Vec<[usize; 3]>,
    /// Corners of the cells, of two triangles each.
    cells: Vec<[usize; 4]>,
    /// Gravitational acceleration, m/s².
    pub gravity: Vec3,
    /// Distance between neighbours along warp and weft at rest, m.
    pub spacing: [f32; 2],
    damping: f32,
    air: Air,
    time: f64,
}

impl Sheet {
    /// The scene at its start.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let grid = Grid::new(scene);
        let positions: Vec<Vec3> = scene.positions().iter().map(|x| x.as_vec3()).collect();
        Self {
            velocities: vec![Vec3::ZERO; positions.len()],
            positions,
            masses: grid.masses.iter().map(|m| *m as f32).collect(),
            inverse_masses: grid.inverse_masses.iter().map(|w| *w as f32).collect(),
            links: grid
                .links
                .iter()
                .map(|l| Link {
                    a: l.a,
                    b: l.b,
                    rest: l.rest as f32,
                    stiffness: l.stiffness as f32,
                })
                .collect(),
            bends: grid
                .bends
                .iter()
                .map(|b| Stencil {
                    vertices: b.vertices,
                    weights: [1.0, -2.0, 1.0],
                    stiffness: b.stiffness as f32,
                })
                .collect(),
            twists: grid
                .twists
                .iter()
                .map(|t| Stencil {
                    vertices: t.vertices,
                    weights: [1.0, -1.0, -1.0, 1.0],
                    stiffness: t.stiffness as f32,
                })
                .collect(),
            cells: grid.cells.clone(),
            triangles: grid.triangles.iter().map(|t| t.to_array().map(|v| v as usize)).collect(),
            gravity: vec3(0.0, -scene.gravity as f32, 0.0),
            spacing: scene.spacing().map(|d| d as f32),
            damping: scene.damping as f32,
            air: scene.air,
            time: 0.0,
        }
    }

    /// Changes the velocities by gravity, damping and air over `h` seconds.
    pub fn apply_outer_forces(&mut self, h: f32) {
        if !self.air.is_vacuum() {
            self.apply_air(h);
        }
        let decay = (-self.damping * h).exp();
        for (v, w) in self.velocities.iter_mut().zip(&self.inverse_masses) {
            if *w > 0.0 {
                *v = *v * decay + self.gravity * h;
            }
        }
        self.time += f64::from(h);
    }

    /// Applies the outer forces, moves every vertex by its velocity, and stores the positions before: the
    /// start of a substep of position-based methods.
    pub fn predict(&mut self, previous: &mut [Vec3], h: f32) {
        self.apply_outer_forces(h);
        for ((x, before), v) in self.positions.iter_mut().zip(previous).zip(&self.velocities) {
            *before = *x;
            *x += *v * h;
        }
    }

    /// Sets the velocities to the changes from the previous positions over `h` seconds.
    pub fn take_velocities_from(&mut self, previous: &[Vec3], h: f32) {
        for ((x, before), v) in self.positions.iter().zip(previous).zip(&mut self.velocities) {
            *v = (*x - *before) / h;
        }
    }

    /// Adds the forces of links, bends and twists, N.
    pub fn add_elastic_forces(&self, forces: &mut [Vec3]) {
        for link in &self.links {
            let d = self.positions[link.b] - self.positions[link.a];
            let pull = d * (link.stiffness * (1.0 - link.rest / d.length_squared().sqrt()));
            forces[link.a] += pull;
            forces[link.b] -= pull;
        }
        for bend in &self.bends {
            bend.add_force(&self.positions, forces);
        }
        for twist in &self.twists {
            twist.add_force(&self.positions, forces);
        }
    }

    /// Pressure and skin friction of the air, explicitly and triangle after triangle (thesis, equations 5.1 and 5.2).
    fn apply_air(&mut self, h: f32) {
        let wind = self.air.wind_at(self.time).as_vec3();
        let (pressure, friction) = (self.air.pressure as f32, self.air.friction as f32);
        for (index, [a, b, c]) in self.triangles.iter().copied().enumerate() {
            let origin = self.positions[a];
            let cross = (self.positions[b] - origin).cross(self.positions[c] - origin);
            let double_area = cross.length_squared().sqrt();
            if double_area == 0.0 {
                continue;
            }
            let normal = cross / double_area;
            let u = wind - (self.velocities[a] + self.velocities[b] + self.velocities[c]) / 3.0;
            let through = u.dot(normal);
            let speed = u.length_squared().sqrt();
            let force = normal * (pressure * through.abs() * through)
                + (u - normal * through) * (friction * speed);
            let quarter = force * (double_area * h / 16.0);
            for v in self.cells[index / 2] {
                self.velocities[v] += quarter * self.inverse_masses[v];
            }
        }
    }
}

impl<const N: usize> Stencil<N> {
    /// Weighted sum of the element's vertices, m.
    #[must_use]
    pub fn value(&self, positions: &[Vec3]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for k in 0..N {
            sum += positions[self.vertices[k]] * self.weights[k];
        }
        sum
    }

    fn add_force(&self, positions: &[Vec3], forces: &mut [Vec3]) {
        let pull = self.value(positions) * -self.stiffness;
        for k in 0..N {
            forces[self.vertices[k]] += pull * self.weights[k];
        }
    }
}
