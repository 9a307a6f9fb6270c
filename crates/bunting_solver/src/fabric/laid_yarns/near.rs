//! Finds lines near a point.

use std::collections::HashMap;

use glam::{IVec3, Vec3};

/// Least cosine of the angle between two lines, or between the normals of their triangles, that lie side by side.
/// Larger: lines beside one another on a curved mesh are not seen. Smaller: the two sides of a fold count as one.
const ALIKE: f32 = 0.8;

/// Greatest distance from the first point of a line at which its end closes a ring, in the distance at which lines end.
const RING_CLOSES: f32 = 2.5;

/// A point of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passing {
    pub at: Vec3,
    /// Unit vector along the line.
    pub direction: Vec3,
    /// Unit normal of the triangle.
    pub normal: Vec3,
    /// Length of the line before this point, m.
    pub before: f32,
    /// Length of the line to each side that this point stands for, m.
    pub reach: f32,
}

/// Points of all lines, in cubic cells.
pub(super) struct Near {
    cell: f32,
    /// Points with the number of their line.
    cells: HashMap<IVec3, Vec<(u32, Passing)>>,
    line: u32,
    /// Greatest reach of any point, m.
    reach: f32,
}

impl Near {
    /// No points; cells have sides of this length, m.
    pub fn new(cell: f32) -> Self {
        Self { cell, cells: HashMap::new(), line: 0, reach: 0.0 }
    }

    /// Points that are added from now on belong to a new line.
    pub fn begin_line(&mut self) {
        self.line += 1;
    }

    pub fn add(&mut self, passing: Passing) {
        self.reach = self.reach.max(passing.reach);
        let cell = (passing.at / self.cell).floor().as_ivec3();
        self.cells.entry(cell).or_default().push((self.line, passing));
    }

    /// Whether a line along nearly the same direction passes within a distance; of the line that was begun last, only
    /// points with less length `before` them count.
    pub fn is_near(
        &self,
        at: Vec3,
        direction: Vec3,
        normal: Vec3,
        within: f32,
        before: f32,
    ) -> bool {
        self.around(at, within.max(self.reach)).any(|(line, passing)| {
            let away = passing.at - at;
            let along = away.dot(passing.direction);
            let aside = (away - passing.direction * along).length();
            aside < within
                && along.abs() < within.max(passing.reach)
                && passing.direction.dot(direction).abs() > ALIKE
                && passing.normal.dot(normal) > ALIKE
                && (*line != self.line || passing.before < before)
        })
    }

    /// Whether the line that was begun last passes within a distance, m.
    pub fn is_own(&self, at: Vec3, within: f32) -> bool {
        self.around(at, within).any(|(line, passing)| {
            *line == self.line
                && passing.before == 0.0
                && passing.at.distance(at) < RING_CLOSES * within
        })
    }

    /// The points in the cells around a place; all points, if they are fewer than these cells, as in meshes of slivers.
    fn around(&self, at: Vec3, within: f32) -> Box<dyn Iterator<Item = &(u32, Passing)> + '_> {
        if (2.0 * within / self.cell + 2.0).powi(3) > self.cells.len() as f32 {
            return Box::new(self.cells.values().flatten());
        }
        let [low, high] =
            [-within, within].map(|reach| ((at + reach) / self.cell).floor().as_ivec3());
        let cells = (low.x..=high.x).flat_map(move |x| {
            (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| IVec3::new(x, y, z)))
        });
        Box::new(cells.filter_map(|cell| self.cells.get(&cell)).flatten())
    }
}
