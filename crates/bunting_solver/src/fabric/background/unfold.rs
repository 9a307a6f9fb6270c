//! A curved mesh without a texture like its shape, unfolded into the plane.
//!
//! Triangles are laid side by side, each along its warp and weft, those nearest to a line along the warp first; where
//! two ways around a cylinder meet is a seam. Then the places are found at which the gradients come nearest to warp and
//! weft in all triangles, as Bommes, Zimmer and Kobbelt do in 2009 for quadrangles.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DVec2, DVec3, Vec3};

use crate::fabric::laid_yarns::{Directions, Faces, Towards};
use crate::fabric::mesh::{RestMesh, Surface};

/// Distance up to which two ways to a particle lead to one place, in lengths of the edge opposite to it. Larger: both
/// sides of a seam are one.
const NEAR: f64 = 0.5;

/// Least cosine of the angle between the warps of neighbours. Smaller: pieces whose warps are at right angles are one.
const ALONG: f64 = 0.7;

/// Most steps of conjugate gradients.
const STEPS: usize = 200;

/// Square of the residual, relative to that at first, that is left.
const ACCURATE: f64 = 1e-12;

/// The triangles of a mesh in the plane.
pub(super) struct Unfolded {
    /// Places, m. The first axis is the warp.
    pub places: Vec<DVec2>,
    /// The particle at each place.
    pub particles: Vec<u32>,
    /// Three places for each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Unfolded {
    /// The unfolded mesh; none if it has several pieces, or pieces with different warps.
    pub fn of(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        let mut sheet = Sheet::new(mesh, surface);
        sheet.lay();
        let triangles: Vec<[u32; 3]> = sheet.triangles.iter().copied().collect::<Option<_>>()?;
        let system = GradientFit::new(&sheet, &triangles, &surface.triangle_areas);
        let places = system.solved(sheet.places);
        Some(Self { places, particles: sheet.particles, triangles })
    }
}

/// Triangles that are laid one beside the other.
struct Sheet<'a> {
    faces: Faces<'a>,
    /// Warp and weft of each triangle.
    axes: Vec<[DVec3; 2]>,
    places: Vec<DVec2>,
    /// The particle at each place.
    particles: Vec<u32>,
    places_of_particle: Vec<Vec<u32>>,
    /// Three places for each triangle that is laid.
    triangles: Vec<Option<[u32; 3]>>,
}

impl<'a> Sheet<'a> {
    fn new(mesh: &'a RestMesh, surface: &Surface) -> Self {
        let faces = Faces::new(&mesh.positions, &mesh.triangles, &surface.edges);
        let directions = Directions::of(&faces, &surface.corner_uv);
        let axes = (0..faces.count() as u32).map(|triangle| {
            let of = |towards| directions.of_triangle(triangle, towards).as_dvec3();
            [of(Towards::Warp), of(Towards::Weft)]
        });
        Self {
            axes: axes.collect(),
            places: Vec::new(),
            particles: Vec::new(),
            places_of_particle: vec![Vec::new(); mesh.positions.len()],
            triangles: vec![None; faces.count()],
            faces,
        }
    }

    /// A vector in the plane of a triangle, along its warp and weft.
    fn in_plane(&self, triangle: u32, vector: Vec3) -> DVec2 {
        let [warp, weft] = self.axes[triangle as usize];
        DVec2::new(warp.dot(vector.as_dvec3()), weft.dot(vector.as_dvec3()))
    }

    fn lay(&mut self) {
        let corners = self.faces.corners(0);
        let first = corners.map(|corner| self.in_plane(0, corner - corners[0]));
        let particles = self.faces.particles(0);
        self.triangles[0] = Some([0, 1, 2].map(|at| self.new_place(particles[at], first[at])));
        // Numbers that are not negative are ordered as their bits.
        let mut next = BinaryHeap::from([Reverse((0_u64, 0_u32))]);
        while let Some(Reverse((_, triangle))) = next.pop() {
            for side in 0..3 {
                let Some(other) = self.faces.across(triangle, side) else { continue };
                if self.triangles[other as usize].is_none()
                    && let Some(centre) = self.lay_beside(triangle, side, other)
                {
                    next.push(Reverse((centre.y.abs().to_bits(), other)));
                }
            }
        }
    }

    fn new_place(&mut self, particle: u32, at: DVec2) -> u32 {
        let place = self.places.len() as u32;
        self.places.push(at);
        self.particles.push(particle);
        self.places_of_particle[particle as usize].push(place);
        place
    }

    /// Lays a triangle across a side of one that is laid, and returns its centre; none if their warps differ.
    fn lay_beside(&mut self, triangle: u32, side: usize, other: u32) -> Option<DVec2> {
        let laid = self.triangles[triangle as usize]?;
        let ends = [side, (side + 1) % 3];
        let shared = ends.map(|end| self.faces.particles(triangle)[end]);
        let shared_places = ends.map(|end| laid[end]);
        let [from, to] = shared_places.map(|place| self.places[place as usize]);
        let (particles, corners) = (self.faces.particles(other), self.faces.corners(other));
        let corner_of = |particle: u32| particles.iter().position(|&at| at == particle);
        let [start, end] = [corners[corner_of(shared[0])?], corners[corner_of(shared[1])?]];
        let third = (0..3).find(|&at| !shared.contains(&particles[at]))?;
        let along = self.in_plane(other, end - start);
        let agreement = along.dot(to - from) / (along.length() * from.distance(to));
        if agreement.abs() < ALONG {
            return None;
        }
        // The warp may run either way.
        if agreement < 0.0 {
            self.axes[other as usize] = self.axes[other as usize].map(|axis| -axis);
        }
        let at = (from + to) * 0.5 + self.in_plane(other, corners[third] - (start + end) * 0.5);
        let distance = |place: &u32| self.places[*place as usize].distance(at);
        let known = self.places_of_particle[particles[third] as usize].iter().copied();
        let near = known.filter(|place| distance(place) < NEAR * along.length());
        let nearest = near.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let place = nearest.unwrap_or_else(|| self.new_place(particles[third], at));
        let places = particles.map(|particle| {
            let end = shared.iter().position(|&at| at == particle);
            end.map_or(place, |end| shared_places[end])
        });
        self.triangles[other as usize] = Some(places);
        Some(places.iter().map(|&place| self.places[place as usize]).sum::<DVec2>() / 3.0)
    }
}

/// A system of equations for two coordinates of places, whose gradients are to be warp and weft.
struct GradientFit<'a> {
    triangles: &'a [[u32; 3]],
    areas: &'a [f32],
    /// Warp and weft of each triangle.
    axes: Vec<[DVec3; 2]>,
    /// For each triangle the gradients of the functions that are one at a corner and zero at the others, 1/m.
    gradients: Vec<[DVec3; 3]>,
    /// Diagonal of the system.
    diagonal: Vec<f64>,
}

impl<'a> GradientFit<'a> {
    fn new(sheet: &Sheet, triangles: &'a [[u32; 3]], areas: &'a [f32]) -> Self {
        let gradients_of = |triangle: u32| {
            let [a, b, c] = sheet.faces.corners(triangle).map(|corner| corner.as_dvec3());
            let normal = (b - a).cross(c - a);
            let scaled = normal / normal.length_squared();
            [c - b, a - c, b - a].map(|opposite| scaled.cross(opposite))
        };
        let gradients: Vec<[DVec3; 3]> = (0..triangles.len() as u32).map(gradients_of).collect();
        let mut diagonal = vec![0.0; sheet.places.len()];
        for ((corners, gradients), &area) in triangles.iter().zip(&gradients).zip(areas) {
            for (&corner, gradient) in corners.iter().zip(gradients) {
                diagonal[corner as usize] += gradient.length_squared() * f64::from(area);
            }
        }
        Self { triangles, areas, axes: sheet.axes.clone(), gradients, diagonal }
    }

    /// The derivatives of ½ Σ A (|∇u − `wanted` warp|² + |∇v − `wanted` weft|²) by u and v of each place, m.
    fn derivatives(&self, values: &[DVec2], wanted: f64) -> Vec<DVec2> {
        let mut derivatives = vec![DVec2::ZERO; values.len()];
        let triangles = self.triangles.iter().zip(&self.gradients).zip(self.areas).zip(&self.axes);
        for (((corners, gradients), &area), [warp, weft]) in triangles {
            let (mut of_u, mut of_v) = (*warp * -wanted, *weft * -wanted);
            for (&corner, gradient) in corners.iter().zip(gradients) {
                let value = values[corner as usize];
                of_u += *gradient * value.x;
                of_v += *gradient * value.y;
            }
            for (&corner, gradient) in corners.iter().zip(gradients) {
                let derivative = DVec2::new(gradient.dot(of_u), gradient.dot(of_v));
                derivatives[corner as usize] += derivative * f64::from(area);
            }
        }
        derivatives
    }

    /// The solution, from places near it, by conjugate gradients (Hestenes and Stiefel 1952).
    fn solved(&self, mut places: Vec<DVec2>) -> Vec<DVec2> {
        let dot = |a: &[DVec2], b: &[DVec2]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
        let conditioned = |residual: &[DVec2]| -> Vec<DVec2> {
            residual.iter().zip(&self.diagonal).map(|(value, scale)| *value / *scale).collect()
        };
        let mut residual = self.derivatives(&places, 1.0);
        residual.iter_mut().for_each(|value| *value = -*value);
        let mut step = conditioned(&residual);
        let mut size = dot(&residual, &step);
        let accurate = ACCURATE * size;
        for _ in 0..STEPS {
            if size <= accurate {
                break;
            }
            let change = self.derivatives(&step, 0.0);
            let length = size / dot(&step, &change);
            for (place, step) in places.iter_mut().zip(&step) {
                *place += *step * length;
            }
            for (residual, change) in residual.iter_mut().zip(&change) {
                *residual -= *change * length;
            }
            let scaled = conditioned(&residual);
            let before = core::mem::replace(&mut size, dot(&residual, &scaled));
            for (step, scaled) in step.iter_mut().zip(scaled) {
                *step = scaled + *step * (size / before);
            }
        }
        places
    }
}
