//! Charts of meshes that are closed around an axis, as cylinders are.
//!
//! Such a mesh has a seam in the plane, with the same particles on both of its sides. Their two places are one period
//! apart. The chart then has each particle once, within one period along its second axis; triangles near the ends of
//! the period are repeated beyond them. A grid over one period has its first row once more as its last row, and both
//! are joined (`constraints/background.rs`).

use std::collections::BTreeMap;

use glam::Vec2;

use super::chart::Chart;

/// Greatest difference between the periods of two particles, in cells. Larger: spirals and cones count as cylinders.
const ALIKE: f32 = 0.25;

/// Least period, in cells. Smaller: the repeated triangles overlap one another.
const LEAST_PERIOD: f32 = 8.0;

/// Width of the strip beyond the ends of the period in which triangles are repeated, in cells, or as much wider as the coarsest
/// triangles are. Smaller: nodes at the ends are fitted to the particles on one side.
const REPEATED: f32 = 3.0;

/// Most periods that a triangle may lie away from its own. Smaller: triangles across the seam are lost, as each of
/// their corners may have been laid on either side.
const MOST_TURNS: i32 = 2;

impl Chart {
    /// The chart with its seam closed, if it has one around an axis.
    pub(super) fn closed(self) -> Self {
        let spacing = self.spacing();
        let Some(period) = self.period(spacing) else { return self };
        if period.abs().min_element() > ALIKE * spacing {
            return self;
        }
        // Rows run along the axis.
        if period.x.abs() > period.y.abs() {
            return self.turned().wrapped(period.perp(), spacing);
        }
        self.wrapped(period, spacing)
    }

    /// From the first to the second place of the particles that have two; none unless these are alike.
    fn period(&self, spacing: f32) -> Option<Vec2> {
        let mut first = vec![None; self.particle_count()];
        let mut periods: Vec<Vec2> = Vec::new();
        for (&at, &particle) in self.positions.iter().zip(&self.particles) {
            let from = *first[particle as usize].get_or_insert(at);
            if from != at {
                let away = at - from;
                let is_opposite = periods.first().is_some_and(|first| first.dot(away) < 0.0);
                periods.push(if is_opposite { -away } else { away });
            }
        }
        let mean = periods.iter().sum::<Vec2>() / periods.len() as f32;
        let is_alike = periods.iter().all(|period| period.distance(mean) < ALIKE * spacing);
        (is_alike && mean.length() > LEAST_PERIOD * spacing).then_some(mean)
    }

    fn particle_count(&self) -> usize {
        self.particles.iter().max().map_or(0, |&last| last as usize + 1)
    }

    /// The chart turned by a quarter.
    fn turned(mut self) -> Self {
        let height = self.extent.y;
        self.positions.iter_mut().for_each(|at| *at = Vec2::new(height - at.y, at.x));
        self.extent = Vec2::new(self.extent.y, self.extent.x);
        self.warp_cos2 = 1.0 - self.warp_cos2;
        self
    }

    /// The chart with a period along its second axis, and triangles repeated beyond its ends.
    fn wrapped(mut self, period: Vec2, spacing: f32) -> Self {
        let length = period.y.abs();
        // A period that is not quite along the axis is sheared onto it.
        self.positions.iter_mut().for_each(|at| at.x -= at.y * period.x / period.y);
        let coarsest = self.coarseness(spacing).into_iter().fold(1.0, f32::max);
        // Of several places of a particle the first one.
        let mut own = vec![Vec2::ZERO; self.particle_count()];
        for (at, &particle) in self.positions.iter().zip(&self.particles).rev() {
            own[particle as usize] = Vec2::new(at.x, at.y.rem_euclid(length));
        }
        let low = own.iter().map(|at| at.x).fold(f32::INFINITY, f32::min);
        let high = own.iter().map(|at| at.x).fold(f32::NEG_INFINITY, f32::max);
        own.iter_mut().for_each(|at| at.x -= low);
        let mut wrapped = Self {
            positions: own.clone(),
            particles: (0..own.len() as u32).collect(),
            triangles: Vec::new(),
            of_mesh: Vec::new(),
            own_places: own.len(),
            is_closed: true,
            extent: Vec2::new(high - low, length),
            ..self
        };
        // Other places by their particles and the periods that they lie away from the particles' own.
        let mut repeated: BTreeMap<(u32, i32), u32> = BTreeMap::new();
        let mut place = |particle: u32, turns: i32| {
            if turns == 0 {
                return particle;
            }
            *repeated.entry((particle, turns)).or_insert_with(|| {
                let at = own[particle as usize] + Vec2::Y * (turns as f32 * length);
                wrapped.positions.push(at);
                wrapped.particles.push(particle);
                wrapped.positions.len() as u32 - 1
            })
        };
        let beyond = REPEATED * spacing * coarsest;
        for (corners, &of_mesh) in self.triangles.iter().zip(&self.of_mesh) {
            let particles = corners.map(|corner| self.particles[corner as usize]);
            let turns = [0, 1, 2].map(|at| {
                let laid = self.positions[corners[at] as usize].y;
                ((laid - own[particles[at] as usize].y) / length).round() as i32
            });
            for by in -MOST_TURNS..=MOST_TURNS {
                let turns = turns.map(|of| of - turns[0] + by);
                let heights =
                    [0, 1, 2].map(|at| own[particles[at] as usize].y + turns[at] as f32 * length);
                if heights.iter().any(|&y| y > -beyond)
                    && heights.iter().any(|&y| y < length + beyond)
                {
                    let places = [0, 1, 2].map(|at| place(particles[at], turns[at]));
                    wrapped.triangles.push(places);
                    wrapped.of_mesh.push(of_mesh);
                }
            }
        }
        wrapped
    }
}
