//! Places at which the air is sampled, four beside one another in the lanes of vectors. Each place has the bits that it
//! would have alone.

use bevy_math::{BVec4A, Isometry3d, Vec3, Vec4};
use bevy_reflect::Reflect;

/// Number of places that are sampled at once.
pub(crate) const PLACES: usize = 4;

/// A frame in the world.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Frame {
    /// Its origin, m.
    origin: Vec3,
    /// Unit vectors along its axes.
    axes: [Vec3; 3],
}

impl Frame {
    /// The frame with a pose.
    pub fn of(pose: Isometry3d) -> Self {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| pose.rotation * axis);
        Self { origin: Vec3::from(pose.translation), axes }
    }

    /// Moves the frame along with the world, m.
    pub fn shift(&mut self, by: Vec3) {
        self.origin += by;
    }

    /// A vector along the axes of this frame, along those of the world.
    pub fn to_world(self, vector: Vec3) -> Vec3 {
        self.axes[0] * vector.x + self.axes[1] * vector.y + self.axes[2] * vector.z
    }
}

/// Vectors at four places, axis by axis: positions (m) or velocities (m/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Places {
    pub(super) x: Vec4,
    pub(super) y: Vec4,
    pub(super) z: Vec4,
}

impl Places {
    /// Zero at all places.
    pub const ZERO: Self = Self { x: Vec4::ZERO, y: Vec4::ZERO, z: Vec4::ZERO };

    /// Up to four vectors; the last of fewer is repeated.
    pub fn of(vectors: &[Vec3]) -> Self {
        let Some(last) = vectors.last() else { return Self::ZERO };
        let mut places = Self::splat(*last);
        for (place, vector) in vectors.iter().enumerate().take(PLACES) {
            places.set(place, *vector);
        }
        places
    }

    /// The same vector at all places.
    pub fn splat(vector: Vec3) -> Self {
        let [x, y, z] = vector.to_array().map(Vec4::splat);
        Self { x, y, z }
    }

    /// The vector of a place.
    pub fn get(&self, place: usize) -> Vec3 {
        Vec3::new(self.x[place], self.y[place], self.z[place])
    }

    /// Overwrites the vector of a place.
    pub fn set(&mut self, place: usize, vector: Vec3) {
        self.x[place] = vector.x;
        self.y[place] = vector.y;
        self.z[place] = vector.z;
    }

    /// These positions in a frame.
    pub fn seen_from(&self, frame: &Frame) -> Self {
        let at = frame.origin;
        let (x, y, z) = (self.x - at.x, self.y - at.y, self.z - at.z);
        let along = |axis: Vec3| x * axis.x + y * axis.y + z * axis.z;
        let [x_axis, y_axis, z_axis] = frame.axes;
        Self { x: along(x_axis), y: along(y_axis), z: along(z_axis) }
    }

    /// Squared distances from a point.
    pub fn distances_squared(&self, from: Vec3) -> Vec4 {
        let (x, y, z) = (self.x - from.x, self.y - from.y, self.z - from.z);
        x * x + y * y + z * z
    }

    /// The sums of these vectors and others.
    pub fn plus(&self, other: &Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }

    /// These vectors, each times a number.
    pub fn scaled(&self, by: Vec4) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }

    /// A function of these vectors at some places, and zero at the others.
    pub fn map_where(&self, places: BVec4A, function: impl Fn(Vec3) -> Vec3) -> Self {
        let mut mapped = Self::ZERO;
        for place in 0..PLACES {
            if places.test(place) {
                mapped.set(place, function(self.get(place)));
            }
        }
        mapped
    }

    /// The sums of these vectors and those of others that are finite and at some places.
    pub fn plus_where(&self, places: BVec4A, other: &Self) -> Self {
        // Zero times a number is zero unless the number is infinite or none.
        let zero = other.x * 0.0 + other.y * 0.0 + other.z * 0.0;
        let places = places & zero.cmpeq(Vec4::ZERO);
        let sum = self.plus(other);
        Self {
            x: Vec4::select(places, sum.x, self.x),
            y: Vec4::select(places, sum.y, self.y),
            z: Vec4::select(places, sum.z, self.z),
        }
    }

    /// The greatest coordinates by size.
    pub fn greatest(&self) -> Vec4 {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }
}
