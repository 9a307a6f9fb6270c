//! How far a region of the texture covers a sample.

use glam::{Vec2, Vec3};

use super::kites::Sample;
use super::region::RegionShape;

impl RegionShape {
    /// Weight of a region of the texture in a sample, from 0 to 1; none of other regions.
    pub(super) fn at(&self, sample: &Sample) -> Option<f32> {
        match self {
            Self::UvBox { from, to } => Some(in_box(sample, from.min(*to), from.max(*to))),
            Self::UvLine { from, to, width } => Some(on_line(sample, [*from, *to], *width)),
            Self::Image { columns, weights } => Some(in_image(sample.uv, *columns, weights)),
            Self::Vertices(_) | Self::Depth(_) => None,
        }
    }
}

/// The part of an interval of a length around a place that lies between two ends.
fn overlap(place: f32, length: f32, [low, high]: [f32; 2]) -> f32 {
    let (first, last) = (place - 0.5 * length, place + 0.5 * length);
    if low <= first && last <= high {
        return 1.0;
    }
    ((last.min(high) - first.max(low)) / length.max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
}

fn in_box(sample: &Sample, low: Vec2, high: Vec2) -> f32 {
    let [one, other] = sample.uv_steps.map(Vec2::abs);
    let size = one + other;
    overlap(sample.uv.x, size.x, [low.x, high.x]) * overlap(sample.uv.y, size.y, [low.y, high.y])
}

fn on_line(sample: &Sample, ends: [Vec2; 2], width: f32) -> f32 {
    let Sample { uv, uv_steps: [one, other], steps } = sample;
    let turn = one.perp_dot(*other);
    if turn == 0.0 {
        return 0.0;
    }
    // Vectors of the texture, laid onto the cloth around the sample, m.
    let [from, to]: [Vec3; 2] = ends.map(|end| {
        let away = end - *uv;
        let parts = [away.perp_dot(*other) / turn, one.perp_dot(away) / turn];
        steps[0] * parts[0] + steps[1] * parts[1]
    });
    let size = steps[0].cross(steps[1]).length().sqrt();
    let (along, length) = (to - from).normalize_and_length();
    let place = -from.dot(along);
    let away = (from + along * place).length();
    overlap(place, size, [0.0, length]) * overlap(away, size, [-0.5 * width, 0.5 * width])
}

/// The weight of an image at texture coordinates, interpolated between the middles of its pixels.
fn in_image(uv: Vec2, columns: u32, weights: &[f32]) -> f32 {
    let rows = weights.len() as u32 / columns;
    let size = Vec2::new(columns as f32, rows as f32);
    let at = (uv - uv.floor()) * size - 0.5;
    let pixel = at.floor();
    let part = at - pixel;
    let weight = |right: u32, down: u32| {
        // The one before the first is the last.
        let column = (pixel.x as i64 + i64::from(right)).rem_euclid(i64::from(columns));
        let row = (pixel.y as i64 + i64::from(down)).rem_euclid(i64::from(rows));
        weights[(row * i64::from(columns) + column) as usize]
    };
    let mix = |from: f32, to: f32, part: f32| from * (1.0 - part) + to * part;
    let upper = mix(weight(0, 0), weight(1, 0), part.x);
    mix(upper, mix(weight(0, 1), weight(1, 1), part.x), part.y)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::{in_image, overlap};

    #[test]
    fn an_interval_is_covered_in_part() {
        assert_eq!(overlap(0.5, 0.2, [0.0, 1.0]), 1.0);
        assert_eq!(overlap(1.5, 0.2, [0.0, 1.0]), 0.0);
        assert!((overlap(1.0, 0.2, [0.0, 1.0]) - 0.5).abs() < 1e-6);
        assert!((overlap(0.5, 1.0, [0.4, 0.5]) - 0.1).abs() < 1e-6);
    }

    #[test]
    fn an_image_is_interpolated_and_repeats() {
        let weights = [0.0, 1.0, 0.5, 0.25];
        let at = |u: f32, v: f32| in_image(Vec2::new(u, v), 2, &weights);
        let middles = [at(0.25, 0.25), at(0.75, 0.25), at(0.25, 0.75), at(0.75, 0.75)];
        assert_eq!(middles, weights);
        assert_eq!(at(0.5, 0.25), 0.5);
        assert_eq!(at(1.25, -0.75), 0.0);
        assert_eq!(at(0.0, 0.25), 0.5);
    }
}
