//! How far stitches may be apart in a substep.

use crate::seams::stitch::Lacing;

/// Speed at which a stitch that is apart though its lacing is closed comes together, m/s, as of a zip's teeth behind its slider.
/// Smaller: seams that a contact has opened stay open. Larger: cloth that is zipped is jerked.
const CLOSING_SPEED: f32 = 1.0;

/// A substep of a tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// Length of the substep, s.
    pub step: f32,
    /// Time from the start of the tick to that of the substep, s.
    pub passed: f32,
}

/// How far the two sides of a stitch may be apart at the end of a substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limit {
    /// m.
    pub length: f32,
    /// Whether they are drawn together, and come no nearer, either: what the sides of a sheet that buckles have of speed would
    /// carry them farther.
    pub is_drawn: bool,
}

impl Lacing {
    /// The limit of a stitch, given how far its sides are apart at the start of the substep, m: the gap becomes shorter evenly in the
    /// time that is left.
    pub(super) fn limit(&self, gap: f32, moment: Moment) -> Limit {
        let Moment { step, passed } = moment;
        let left = self.closing - passed;
        let excess = gap - self.length;
        let next = if left > step {
            self.length + excess * (1.0 - step / left)
        } else if self.closing > 0.0 && left > 0.0 {
            self.length
        } else {
            gap - CLOSING_SPEED * step
        };
        Limit { length: next.max(self.length), is_drawn: next > self.length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// s.
    const STEP: f32 = 0.01;

    #[test]
    fn a_gap_closes_evenly_in_the_time_that_is_left() {
        let mut gap = 0.5_f32;
        let lacing = |tick: u16| Lacing {
            length: 0.1,
            closing: 1.0 - 2.0 * STEP * f32::from(tick),
            ..Lacing::closed(0..1)
        };
        for tick in 0..50 {
            for substep in 0..2_u8 {
                let before = gap;
                let passed = STEP * f32::from(substep);
                gap = lacing(tick).limit(gap, Moment { step: STEP, passed }).length;
                assert!((before - gap - 0.004).abs() < 1e-4, "{before} m, then {gap} m");
            }
        }
        assert!((gap - 0.1).abs() < 1e-4, "{gap} m");
    }

    #[test]
    fn a_closed_lacing_draws_at_its_speed_and_never_beyond_its_length() {
        let lacing = Lacing { length: 0.1, ..Lacing::closed(0..1) };
        let moment = Moment { step: STEP, passed: 0.0 };
        for (gap, length, is_drawn) in [(0.5, 0.49, true), (0.105, 0.1, false), (0.02, 0.1, false)]
        {
            let found = lacing.limit(gap, moment);
            assert!((found.length - length).abs() < 1e-6, "{found:?}");
            assert_eq!(found.is_drawn, is_drawn, "{gap} m");
        }
    }
}
