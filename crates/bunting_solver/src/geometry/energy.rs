//! Elastic energy of a state, and area-weighted sums over its particles.

use glam::{DVec3, Vec3};

use crate::constraints::resists_twist;
use crate::fabric::{BendLine, Fabric, FabricMaterial, Ribbon};

/// Elastic energy of links and bending, J, at positions in m, by the formulas of the constraints.
/// Inextensible links store none.
///
/// Distances are computed in single precision, like the positions; only their sums need double precision.
pub(crate) fn elastic(fabric: &Fabric, material: &FabricMaterial, positions: &[Vec3]) -> f64 {
    let lines = fabric.bend_lines().iter();
    let along_lines: f64 = lines.map(|line| line_bending(fabric, line, positions)).sum();
    let twists = resists_twist(fabric, material);
    let bending = along_lines + if twists { twist(fabric, positions) } else { 0.0 };
    0.5 * (stretch(fabric, material, positions) + bending * f64::from(material.bend_stiffness))
}

/// Twice the energy of all links, J.
fn stretch(fabric: &Fabric, material: &FabricMaterial, positions: &[Vec3]) -> f64 {
    let stiffnesses: Vec<f64> = fabric
        .link_classes()
        .iter()
        .map(|class| f64::from(class.stiffness(material)))
        .map(|stiffness| if stiffness.is_finite() { stiffness } else { 0.0 })
        .collect();
    let energies = fabric.links().iter().map(|link| {
        let [a, b] = link.particles.map(|particle| positions[particle as usize]);
        let stretch = a.distance(b) - link.rest_length;
        stiffnesses[link.class as usize] * f64::from(stretch * stretch)
    });
    energies.sum()
}

/// Twice the energy of a line at a bending stiffness of 1 N·m, J.
fn line_bending(fabric: &Fabric, line: &BendLine, positions: &[Vec3]) -> f64 {
    let profile = &fabric.bend_profiles()[line.profile as usize];
    let at = |particle: u32| positions[particle as usize];
    let turns = line.particles.windows(3).map(|three| {
        let turn = (at(three[0]) - at(three[1])) + (at(three[2]) - at(three[1]));
        let rest = fabric.rest_bends();
        (turn - rest.map_or(Vec3::ZERO, |rest| rest.turned(three[1], line.is_row, positions)))
            .length_squared()
    });
    let energies = turns.zip(&profile.coefficients);
    let sum: f64 = energies.map(|(turn, &coefficient)| f64::from(turn * coefficient)).sum();
    sum * f64::from(profile.inverse_spacing).powi(2)
}

/// Twice the energy of a grid's twist at a bending stiffness of 1 N·m, J.
pub(crate) fn twist(fabric: &Fabric, positions: &[Vec3]) -> f64 {
    let at = |particle: u32| positions[particle as usize].as_dvec3();
    let across = |[from, to]: [u32; 2]| at(to) - at(from);
    let of_ribbon = |ribbon: &Ribbon| -> f64 {
        let coefficients = &fabric.ribbon_profiles()[ribbon.profile as usize].coefficients;
        let turns = ribbon.pairs.windows(2).map(|cell| across(cell[1]) - across(cell[0]));
        let of_cell = |(turn, &of): (DVec3, &f32)| f64::from(of) * turn.length_squared();
        turns.zip(coefficients).map(of_cell).sum::<f64>()
    };
    fabric.ribbons().iter().map(of_ribbon).sum()
}

/// Sum of area times vector over all particles, pinned or not. For velocities (m/s) it is the momentum per
/// area density, m³/s; for positions the first moment of area, m³.
pub(crate) fn area_moment(fabric: &Fabric, vectors: &[Vec3]) -> DVec3 {
    let products =
        fabric.particle_areas().iter().zip(vectors).map(|(&area, &vector)| vector * area);
    products.map(|product| product.as_dvec3()).sum()
}
