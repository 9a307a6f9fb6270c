//! Forces and energies of the grid cloth in double precision.

use glam::DVec3;

use super::grid::Grid;
use crate::scenes::Air;

impl Grid {
    /// Adds the forces of links, bends and twists, N.
    pub fn add_elastic_forces(&self, positions: &[DVec3], forces: &mut [DVec3]) {
        for link in &self.links {
            let d = positions[link.b] - positions[link.a];
            let pull = d * (link.stiffness * (1.0 - link.rest / d.length_squared().sqrt()));
            forces[link.a] += pull;
            forces[link.b] -= pull;
        }
        for bend in &self.bends {
            let [a, b, c] = bend.vertices;
            let push = (positions[a] - 2.0 * positions[b] + positions[c]) * bend.stiffness;
            forces[a] -= push;
            forces[b] += 2.0 * push;
            forces[c] -= push;
        }
        for twist in &self.twists {
            let [a, b, c, d] = twist.vertices;
            let push =
                (positions[a] - positions[b] - positions[c] + positions[d]) * twist.stiffness;
            forces[a] -= push;
            forces[b] += push;
            forces[c] += push;
            forces[d] -= push;
        }
    }

    /// Adds the forces of the air on every triangle, N: pressure ½ρC_n A|u·n|(u·n)n (thesis, equations 5.1
    /// and 5.2) and skin friction ½ρC_t A|u|(u − (u·n)n), with u the velocity of the air relative to the
    /// triangle. A quarter of each acts on each corner of the triangle's cell, as masses are quarters of cells.
    pub fn add_air_forces(
        &self,
        air: &Air,
        wind: DVec3,
        positions: &[DVec3],
        velocities: &[DVec3],
        forces: &mut [DVec3],
    ) {
        for (index, triangle) in self.triangles.iter().enumerate() {
            let [a, b, c] = triangle.to_array().map(|v| v as usize);
            let cross = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
            let double_area = cross.length_squared().sqrt();
            if double_area == 0.0 {
                continue;
            }
            let normal = cross / double_area;
            let u = wind - (velocities[a] + velocities[b] + velocities[c]) / 3.0;
            let through = u.dot(normal);
            let pressure = normal * (air.pressure * through.abs() * through);
            let friction = (u - normal * through) * (air.friction * u.length_squared().sqrt());
            let quarter = (pressure + friction) * (double_area / 16.0);
            for vertex in self.cells[index / 2] {
                forces[vertex] += quarter;
            }
        }
    }

    /// Energy stored in links, bends and twists, J.
    #[must_use]
    pub fn elastic_energy(&self, positions: &[DVec3]) -> f64 {
        let links = self.links.iter().map(|link| {
            let stretch = positions[link.a].distance(positions[link.b]) - link.rest;
            link.stiffness * stretch * stretch
        });
        let bends = self.bends.iter().map(|bend| {
            let [a, b, c] = bend.vertices.map(|v| positions[v]);
            bend.stiffness * (a - 2.0 * b + c).length_squared()
        });
        let twists = self.twists.iter().map(|twist| {
            let [a, b, c, d] = twist.vertices.map(|v| positions[v]);
            twist.stiffness * (a - b - c + d).length_squared()
        });
        0.5 * (links.sum::<f64>() + bends.sum::<f64>() + twists.sum::<f64>())
    }

    /// Energy of the vertices' heights over y = 0, J.
    #[must_use]
    pub fn gravity_energy(&self, gravity: f64, positions: &[DVec3]) -> f64 {
        self.masses.iter().zip(positions).map(|(m, x)| m * gravity * x.y).sum()
    }

    /// Energy of the vertices' motion, J.
    #[must_use]
    pub fn kinetic_energy(&self, velocities: &[DVec3]) -> f64 {
        self.masses.iter().zip(velocities).map(|(m, v)| 0.5 * m * v.length_squared()).sum()
    }
}
