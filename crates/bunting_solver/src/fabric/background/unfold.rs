//! A curved mesh without a texture like its shape, unfolded into the plane.
//!
//! Triangles are laid side by side, each along its warp and weft, those nearest to a line along the warp first; where
//! two ways around a cylinder meet is a seam. Then the places are found at which the gradients come nearest to warp and
//! weft in all triangles, as Bommes, Zimmer and Kobbelt do in 2009 for quadrangles.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{BVec2, DVec2, DVec3, Vec3};

use super::gradient_fit::GradientFit;
use crate::fabric::laid_yarns::{Directions, Faces, Towards};
use crate::fabric::mesh::{RestMesh, Surface};

/// Distance up to which two ways to a particle lead to one place, in lengths of the edge opposite to it. Larger: both
/// sides of a seam are one.
const NEAR: f64 = 0.5;

/// Least cosine of the angle between the warps of neighbours. Smaller: pieces whose warps are at right angles are one.
const ALONG: f64 = 0.7;

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
    /// The unfolded mesh; none if it has several pieces, or pieces with different warps, or if it is not wanted after it is known
    /// roughly.
    pub fn of(
        mesh: &RestMesh,
        surface: &Surface,
        goes_on: impl FnOnce(Self) -> bool,
    ) -> Option<Self> {
        let mut sheet = Sheet::new(mesh, surface);
        sheet.lay();
        let triangles: Vec<[u32; 3]> = sheet.triangles.iter().copied().collect::<Option<_>>()?;
        let at = |places: Vec<DVec2>| {
            let (particles, triangles) = (sheet.particles.clone(), triangles.clone());
            Self { places, particles, triangles }
        };
        let goes_on = |rough: Vec<DVec2>| goes_on(at(rough));
        let areas = &surface.triangle_areas;
        sheet.fitted(&triangles, areas, &sheet.places, goes_on).map(at)
    }

    /// The mesh unfolded without seams: where two ways around meet, both give way.
    pub fn without_seams(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        let mut sheet = Sheet::new(mesh, surface);
        sheet.lay();
        let first = |places: &Vec<u32>| Some(sheet.places[*places.first()? as usize]);
        let start: Vec<DVec2> =
            sheet.places_of_particle.iter().map(first).collect::<Option<_>>()?;
        let places = sheet.fitted(&mesh.triangles, &surface.triangle_areas, &start, |_| true)?;
        let particles = (0..places.len() as u32).collect();
        Some(Self { places, particles, triangles: mesh.triangles.clone() })
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

    /// The places whose gradients on these triangles are nearest to warp and weft, from others near them; none if they are not
    /// found, or not wanted after they are known roughly.
    fn fitted(
        &self,
        triangles: &[[u32; 3]],
        areas: &[f32],
        start: &[DVec2],
        goes_on: impl FnOnce(Vec<DVec2>) -> bool,
    ) -> Option<Vec<DVec2>> {
        let corners = |triangle| self.faces.corners(triangle).map(|corner| corner.as_dvec3());
        let corners = (0..triangles.len() as u32).map(corners);
        let fit = GradientFit::new(triangles, corners, areas, start.len());
        fit.solved(start, |_| BVec2::FALSE, |triangle| self.axes[triangle], goes_on)
    }
}
