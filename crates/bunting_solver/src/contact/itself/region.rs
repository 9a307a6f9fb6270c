//! Boxes around paths, and bounds of normals, by which parts of a cloth are found not to touch.

use glam::{Vec3, Vec3A};

/// Cosine of the greatest angle between a triangle's normal and the direction about which all normals of a region lie.
/// Smaller: regions that are about to fold upon themselves are skipped. Larger: more of them are compared in vain.
const LEAST_COSINE: f32 = 0.35;

/// Boxes around some particles at the start and at the end of a substep, m. Particles move along straight lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swept {
    low: [Vec3A; 2],
    high: [Vec3A; 2],
}

impl Swept {
    pub const EMPTY: Self = Self { low: [Vec3A::INFINITY; 2], high: [Vec3A::NEG_INFINITY; 2] };

    /// The boxes of particles at given positions, widened.
    pub fn around<const COUNT: usize>(start: [Vec3; COUNT], end: [Vec3; COUNT], by: f32) -> Self {
        let mut swept = Self::EMPTY;
        start.into_iter().zip(end).for_each(|(start, end)| swept.add(start, end));
        swept.widened(by)
    }

    /// Takes in a particle.
    pub fn add(&mut self, start: Vec3, end: Vec3) {
        for (at, position) in [start, end].into_iter().enumerate() {
            self.low[at] = self.low[at].min(position.into());
            self.high[at] = self.high[at].max(position.into());
        }
    }

    pub fn merged(self, other: Self) -> Self {
        Self {
            low: [self.low[0].min(other.low[0]), self.low[1].min(other.low[1])],
            high: [self.high[0].max(other.high[0]), self.high[1].max(other.high[1])],
        }
    }

    pub fn widened(self, by: f32) -> Self {
        let by = Vec3A::splat(by);
        Self { low: self.low.map(|it| it - by), high: self.high.map(|it| it + by) }
    }

    /// Whether the particles may meet: unless the boxes are apart along an axis, on the same side at the start and at the
    /// end.
    pub fn meets(&self, other: &Self) -> bool {
        let above = |one: &Self, other: &Self| {
            one.low[0].cmpgt(other.high[0]) & one.low[1].cmpgt(other.high[1])
        };
        !(above(self, other) | above(other, self)).any()
    }
}

/// Normals of triangles, as long as twice their areas, m²: a box around their ends, and their sum.
#[derive(Clone, Copy, Debug)]
pub(super) struct Normals {
    low: Vec3A,
    high: Vec3A,
    pub sum: Vec3A,
}

impl Normals {
    pub const EMPTY: Self =
        Self { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY, sum: Vec3A::ZERO };

    pub fn add(&mut self, normal: Vec3A) {
        self.low = self.low.min(normal);
        self.high = self.high.max(normal);
        self.sum += normal;
    }

    /// Whether the whole box lies about a direction, see [`is_about`].
    pub fn are_about(&self, direction: Vec3A) -> bool {
        let [low, high, direction] = [self.low, self.high, direction].map(|it| it.to_array());
        let (mut least, mut longest) = (0.0, 0.0);
        for axis in 0..3 {
            least += (low[axis] * direction[axis]).min(high[axis] * direction[axis]);
            longest += (low[axis] * low[axis]).max(high[axis] * high[axis]);
        }
        is_within(least, longest, squared_length(direction))
    }
}

/// Whether a normal is within a right angle, less a margin, of a direction.
pub(super) fn is_about(normal: Vec3A, direction: Vec3A) -> bool {
    let (normal, direction) = (normal.to_array(), direction.to_array());
    let product = normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
    is_within(product, squared_length(normal), squared_length(direction))
}

fn squared_length([x, y, z]: [f32; 3]) -> f32 {
    x * x + y * y + z * z
}

/// Whether the cosine is greater than the least one, given a product of two vectors and the squares of their lengths.
fn is_within(product: f32, squared_one: f32, squared_other: f32) -> bool {
    product > 0.0 && product * product > LEAST_COSINE * LEAST_COSINE * squared_one * squared_other
}

/// Triangles that are connected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Box around their paths, widened by half of the thickness.
    pub around: Swept,
    /// Their normals at the end of the substep.
    pub normals: Normals,
}

impl Region {
    pub const EMPTY: Self = Self { around: Swept::EMPTY, normals: Normals::EMPTY };
}
