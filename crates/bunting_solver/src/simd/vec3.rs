//! Vectors in three dimensions, one for each lane: in memory and in registers.

use core::ops::{Add, Mul, Range, Sub};

use glam::{Vec3, Vec3A};

use crate::simd::lane::{Lane, Pack};

/// One vector for each lane, in memory: x, y, z.
pub(crate) type Pack3<P> = [P; 3];

/// The same vector in every lane.
pub(crate) fn splat3<P: Pack>(value: Vec3) -> Pack3<P> {
    [P::splat(value.x), P::splat(value.y), P::splat(value.z)]
}

/// Reads the vector of one lane.
#[inline]
pub(crate) fn lane3<P: Pack>(pack: &Pack3<P>, lane: usize) -> Vec3 {
    Vec3::new(pack[0].lanes()[lane], pack[1].lanes()[lane], pack[2].lanes()[lane])
}

/// Writes the vector of one lane.
#[inline]
pub(crate) fn set_lane3<P: Pack>(pack: &mut Pack3<P>, lane: usize, value: Vec3) {
    pack[0].lanes_mut()[lane] = value.x;
    pack[1].lanes_mut()[lane] = value.y;
    pack[2].lanes_mut()[lane] = value.z;
}

/// Writes the same vector to each of a range of lanes.
pub(crate) fn fill_lanes3<P: Pack>(pack: &mut Pack3<P>, lanes: &Range<usize>, value: Vec3) {
    for (pack, value) in pack.iter_mut().zip(value.to_array()) {
        pack.lanes_mut()[lanes.clone()].fill(value);
    }
}

/// One vector for each lane, in registers.
#[derive(Clone, Copy)]
pub(crate) struct V3<L> {
    pub x: L,
    pub y: L,
    pub z: L,
}

impl<L: Lane> V3<L> {
    /// Loads three packs.
    #[inline(always)]
    pub fn load(token: L::Token, pack: &Pack3<L::Pack>) -> Self {
        Self {
            x: L::load(token, &pack[0]),
            y: L::load(token, &pack[1]),
            z: L::load(token, &pack[2]),
        }
    }

    /// The vectors with these indices, one in each lane.
    #[inline(always)]
    pub fn gather<V: Pack>(token: L::Token, vectors: &[V], at: &[u32]) -> Self {
        let [x, y, z] = L::gather(token, vectors, at);
        Self { x, y, z }
    }

    /// Overwrites the vectors with these indices, one from each lane.
    #[inline(always)]
    pub fn scatter<V: Pack>(self, token: L::Token, vectors: &mut [V], at: &[u32]) {
        L::scatter(token, [self.x, self.y, self.z], vectors, at);
    }

    /// Stores three packs.
    #[inline(always)]
    pub fn store(self, pack: &mut Pack3<L::Pack>) {
        self.x.store(&mut pack[0]);
        self.y.store(&mut pack[1]);
        self.z.store(&mut pack[2]);
    }

    /// Adds the vector to one in memory.
    #[inline(always)]
    pub fn add_to(self, token: L::Token, pack: &mut Pack3<L::Pack>) {
        (Self::load(token, pack) + self).store(pack);
    }

    /// The vector whose coordinates are all `value`, in every lane.
    #[inline(always)]
    pub fn splat(token: L::Token, value: f32) -> Self {
        let value = L::splat(token, value);
        Self { x: value, y: value, z: value }
    }

    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat3(token: L::Token, vector: Vec3A) -> Self {
        Self {
            x: L::splat(token, vector.x),
            y: L::splat(token, vector.y),
            z: L::splat(token, vector.z),
        }
    }

    /// The vector of one lane, in every lane.
    #[inline(always)]
    pub fn splat_lane(token: L::Token, pack: &Pack3<L::Pack>, lane: usize) -> Self {
        Self {
            x: L::splat(token, pack[0].lanes()[lane]),
            y: L::splat(token, pack[1].lanes()[lane]),
            z: L::splat(token, pack[2].lanes()[lane]),
        }
    }

    /// `self` where the mask is true, `other` elsewhere.
    #[inline(always)]
    pub fn or_where_not(self, mask: L::Mask, other: Self) -> Self {
        Self {
            x: self.x.or_where_not(mask, other.x),
            y: self.y.or_where_not(mask, other.y),
            z: self.z.or_where_not(mask, other.z),
        }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        (self.x * other.x).plus_product(self.y, other.y).plus_product(self.z, other.z)
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: (self.y * other.z).minus_product(self.z, other.y),
            y: (self.z * other.x).minus_product(self.x, other.z),
            z: (self.x * other.y).minus_product(self.y, other.x),
        }
    }

    /// `self` + `direction` × `scale`.
    #[inline(always)]
    pub fn plus_scaled(self, direction: Self, scale: L) -> Self {
        Self {
            x: self.x.plus_product(direction.x, scale),
            y: self.y.plus_product(direction.y, scale),
            z: self.z.plus_product(direction.z, scale),
        }
    }

    /// `self` − `direction` × `scale`.
    #[inline(always)]
    pub fn minus_scaled(self, direction: Self, scale: L) -> Self {
        Self {
            x: self.x.minus_product(direction.x, scale),
            y: self.y.minus_product(direction.y, scale),
            z: self.z.minus_product(direction.z, scale),
        }
    }
}

impl<L: Add<Output = L>> Add for V3<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<L: Sub<Output = L>> Sub for V3<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<L: Copy + Mul<Output = L>> Mul<L> for V3<L> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, scale: L) -> Self {
        Self { x: self.x * scale, y: self.y * scale, z: self.z * scale }
    }
}
