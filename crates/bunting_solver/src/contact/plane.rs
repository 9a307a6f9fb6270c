//! The plane of a shape's surface that is nearest to a point.

use glam::Vec3;

/// The plane of a shape's surface that is nearest to a point, in the shape's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Unit normal, out of the shape.
    pub normal: Vec3,
    /// Distance of the plane from the origin along its normal, m.
    pub offset: f32,
    /// Distance of the point from the surface, m; negative inside.
    pub distance: f32,
}

impl Plane {
    /// Least height of a triangle's corners above the plane, m.
    pub fn least_height(&self, corners: &[Vec3; 3]) -> f32 {
        corners.iter().map(|corner| self.height(*corner)).fold(f32::INFINITY, f32::min)
    }

    /// Height of a point above the plane, m.
    pub fn height(&self, at: Vec3) -> f32 {
        self.normal.dot(at) - self.offset
    }
}
