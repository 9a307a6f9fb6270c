//! Factors on the material of a fabric's particles.

use super::region::MaterialRegion;
use crate::fabric::material::FabricMaterial;
use crate::fabric::mesh::RestMesh;

/// Factors on the material of each particle. An empty list is one everywhere.
#[derive(Clone, Debug, Default)]
pub(in crate::fabric) struct Variation {
    stretch: Vec<f32>,
    bending: Vec<f32>,
    density: Vec<f32>,
}

/// The least and the greatest factors of a fabric, by which bounds on a whole cloth are found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extremes {
    /// Least factor on stretch stiffnesses.
    pub softest: f32,
    /// Greatest factor on stretch stiffnesses.
    pub stiffest: f32,
    /// Least factor on the area density.
    pub lightest: f32,
    /// Greatest factor on the area density.
    pub heaviest: f32,
    /// Greatest factor on the bending stiffness over that on the area density, by which bending waves are faster.
    pub liveliest: f32,
    /// Mass of the first particle over the material's area density, m², if it were as light as the lightest.
    pub light_mass: f32,
}

impl Variation {
    /// Multiplies by the factors of a region, given its weight at each particle.
    pub fn add(&mut self, region: &MaterialRegion, weights: &[f32]) {
        let lists = [
            (&mut self.stretch, region.stretch),
            (&mut self.bending, region.bending),
            (&mut self.density, region.density),
        ];
        for (list, factor) in lists {
            // Factors of one cost nothing.
            if factor == 1.0 {
                continue;
            }
            list.resize(weights.len(), 1.0);
            for (known, &weight) in list.iter_mut().zip(weights) {
                *known *= (1.0 - weight) + weight * factor;
            }
        }
    }

    /// Factor on the stiffness of a link: half of it has the stiffness at one end, half that at the other, one behind the other.
    pub fn of_link(&self, ends: [u32; 2]) -> f32 {
        harmonic_mean(&self.stretch, &ends)
    }

    /// Factor on the stiffness against bending at a particle.
    pub fn of_bend(&self, particle: u32) -> f32 {
        factor(&self.bending, particle)
    }

    /// Factor on the stiffness of a hinge between two triangles, given the ends of their edge.
    pub fn of_hinge(&self, ends: [u32; 2]) -> f32 {
        let [one, other] = ends.map(|end| self.of_bend(end));
        0.5 * (one + other)
    }

    /// Factor on the stiffness of a cell against twist. That of a batten along one side twists hardly less easily than the others.
    pub fn of_twist(&self, corners: [u32; 4]) -> f32 {
        harmonic_mean(&self.bending, &corners)
    }

    /// Multiplies the areas of particles, by which their masses are measured, by the factors on density.
    pub fn weigh(&self, mesh: &mut RestMesh) {
        if !self.density.is_empty() {
            let areas = mesh.areas.iter().zip(&self.density);
            mesh.set_areas(areas.map(|(area, factor)| area * factor).collect());
        }
    }

    /// The extremes on the particles of a mesh, whose areas are weighed.
    pub fn extremes(&self, mesh: &RestMesh) -> Extremes {
        let least = |of: &[f32]| of.iter().copied().reduce(f32::min).unwrap_or(1.0);
        let most = |of: &[f32]| of.iter().copied().reduce(f32::max).unwrap_or(1.0);
        let count = self.bending.len().max(self.density.len()) as u32;
        let speeds: Vec<f32> =
            (0..count).map(|at| self.of_bend(at) / factor(&self.density, at)).collect();
        let lightest = least(&self.density);
        let first = mesh.areas.first().copied().unwrap_or_default();
        Extremes {
            softest: least(&self.stretch),
            stiffest: most(&self.stretch),
            lightest,
            heaviest: most(&self.density),
            liveliest: most(&speeds),
            light_mass: first / factor(&self.density, 0) * lightest,
        }
    }
}

impl Extremes {
    /// A material where the cloth is softest and heaviest.
    pub fn weakest(&self, material: &FabricMaterial) -> FabricMaterial {
        FabricMaterial {
            area_density: material.area_density * self.heaviest,
            warp_stiffness: material.warp_stiffness * self.softest,
            weft_stiffness: material.weft_stiffness * self.softest,
            shear_stiffness: material.shear_stiffness * self.softest,
            ..*material
        }
    }

    /// The greatest stretch stiffness with a material, N/m.
    pub fn stiffest_stretch(&self, material: &FabricMaterial) -> f32 {
        material.warp_stiffness.max(material.weft_stiffness) * self.stiffest
    }
}

fn factor(list: &[f32], particle: u32) -> f32 {
    list.get(particle as usize).copied().unwrap_or(1.0)
}

fn harmonic_mean(list: &[f32], particles: &[u32]) -> f32 {
    if list.is_empty() {
        return 1.0;
    }
    let softness: f32 = particles.iter().map(|&at| 1.0 / factor(list, at)).sum();
    particles.len() as f32 / softness
}
