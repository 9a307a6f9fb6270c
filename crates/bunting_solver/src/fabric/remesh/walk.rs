//! Walks over a surface from triangle to triangle.

use glam::DVec3;

use super::triangle::nearest;
use crate::fabric::faces::Faces;

/// Walks over the triangles of a mesh, with what is remembered from one to the next.
pub(super) struct Walks<'a> {
    faces: &'a Faces<'a>,
    /// Of each triangle the walk that reached it last.
    reached_by: Vec<u32>,
    /// Number of walks so far.
    count: u32,
    /// The triangles that the walk has reached, those of the fewest steps first.
    reached: Vec<u32>,
}

impl<'a> Walks<'a> {
    pub fn on(faces: &'a Faces<'a>) -> Self {
        Self { faces, reached_by: vec![0; faces.count()], count: 0, reached: Vec::new() }
    }

    /// Visits the triangles that are reached from one through triangles nearer to a place than a distance, m, until `ends` is true
    /// of one; returns whether it was of any.
    pub fn any_within(
        &mut self,
        (start, at): (u32, DVec3),
        distance: f64,
        mut ends: impl FnMut(u32) -> bool,
    ) -> bool {
        self.count += 1;
        self.reached.clear();
        self.reach(start);
        let mut next = 0;
        while let Some(&triangle) = self.reached.get(next) {
            if ends(triangle) {
                return true;
            }
            next += 1;
            for other in self.faces.neighbours(triangle) {
                let is_near = || {
                    let corners = self.faces.corners(other).map(|corner| corner.as_dvec3());
                    let near = |point: DVec3| point.distance_squared(at) < distance * distance;
                    corners.into_iter().any(near) || near(nearest(at, corners))
                };
                if self.reached_by[other as usize] != self.count && is_near() {
                    self.reach(other);
                }
            }
        }
        false
    }

    fn reach(&mut self, triangle: u32) {
        self.reached_by[triangle as usize] = self.count;
        self.reached.push(triangle);
    }
}
