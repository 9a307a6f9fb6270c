//! What a cloth's state weighs in joules.

use glam::{DVec3, Vec3};

use crate::constraints::resists_twist;
use crate::fabric::{Fabric, FabricMaterial, Ribbon, hinge_angle};

/// Elastic energy, J: of links and of bending, as the constraints have it. Links that cannot stretch
/// store none.
///
/// Distances are as exact as positions are, in single precision; only sums need more.
pub(crate) fn elastic(fabric: &Fabric, material: &FabricMaterial, positions: &[Vec3]) -> f64 {
    let at = |particle: u32| positions[particle as usize];
    let stiffnesses: Vec<f64> = fabric
        .link_classes()
        .iter()
        .map(|class| f64::from(class.stiffness(material)))
        .map(|stiffness| if stiffness.is_finite() { stiffness } else { 0.0 })
        .collect();
    let stretch = fabric.links().iter().map(|link| {
        let [a, b] = link.particles.map(at);
        let stretch = a.distance(b) - link.rest_length;
        stiffnesses[link.class as usize] * f64::from(stretch * stretch)
    });
    let stretch: f64 = stretch.sum();
    let bending: f64 = if fabric.grid().is_some() {
        let lines = fabric.bend_lines().iter();
        let along: f64 =
            lines.map(|line| along_line(fabric, line.profile, &line.particles, positions)).sum();
        along + if resists_twist(fabric, material) { twist(fabric, positions) } else { 0.0 }
    } else {
        let hinges = fabric.hinges().iter();
        hinges
            .map(|hinge| {
                let corners = hinge.particles.map(|particle| positions[particle as usize]);
                let angle = f64::from(hinge_angle(corners) - hinge.rest_angle);
                let weight = fabric.hinge_classes()[hinge.class as usize].weight;
                f64::from(weight) * angle * angle
            })
            .filter(|energy| energy.is_finite())
            .sum()
    };
    0.5 * (stretch + bending * f64::from(material.bend_stiffness))
}

/// Twice the energy of a line against unit bending stiffness.
fn along_line(fabric: &Fabric, profile: u32, particles: &[u32], positions: &[Vec3]) -> f64 {
    let profile = &fabric.bend_profiles()[profile as usize];
    let at = |particle: u32| positions[particle as usize];
    let turns = particles.windows(3).map(|three| {
        let turn = (at(three[0]) - at(three[1])) + (at(three[2]) - at(three[1]));
        turn.length_squared()
    });
    let sum: f64 =
        turns.zip(&profile.weights).map(|(turn, &weight)| f64::from(turn * weight)).sum();
    sum * f64::from(profile.inverse_spacing).powi(2)
}

/// Twice the energy of a grid's twist against unit bending stiffness.
pub(crate) fn twist(fabric: &Fabric, positions: &[Vec3]) -> f64 {
    let at = |particle: u32| positions[particle as usize].as_dvec3();
    let across = |[from, to]: [u32; 2]| at(to) - at(from);
    let of_ribbon = |ribbon: &Ribbon| -> f64 {
        let weight = fabric.ribbon_profiles()[ribbon.profile as usize].weight;
        let turns = ribbon.pairs.windows(2).map(|cell| across(cell[1]) - across(cell[0]));
        f64::from(weight) * turns.map(|turn| turn.length_squared()).sum::<f64>()
    };
    fabric.ribbons().iter().map(of_ribbon).sum()
}

/// Sum of area times vector over all particles, pinned or not.
pub(crate) fn moment(fabric: &Fabric, vectors: &[Vec3]) -> DVec3 {
    let products =
        fabric.particle_areas().iter().zip(vectors).map(|(&area, &vector)| vector * area);
    products.map(|product| product.as_dvec3()).sum()
}
