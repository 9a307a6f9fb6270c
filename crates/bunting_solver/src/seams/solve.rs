//! Stitches, solved one after another, each at once with the lines that end there.

use glam::{Mat3, Vec3};

use crate::constants::LEAST_LENGTH;
use crate::seams::closing::{Limit, Moment};
use crate::seams::line::Response;
use crate::seams::plan::{Seams, Sewn};
use crate::seams::state::Sewing;
use crate::seams::stitch::Lacing;

/// Part of the mobility of a stitch's particles without lines that is added to that with lines, so that lines which are taut on both
/// sides have a response. Smaller: rounding moves such particles. Larger: the load of long lines takes more passes.
const RIDGE: f32 = 1e-3;

/// Number of times that stitches are closed by their own particles. Fewer: particles that several stitches share stay apart.
const CLOSING_SWEEPS: usize = 8;

/// The stitches that are closed, each with how far it may be apart.
pub(super) type Limits = Vec<(usize, Limit)>;

impl Seams {
    /// The stitches that are closed in a substep.
    pub(super) fn limits(&self, sewing: &Sewing, lacings: &[Lacing], moment: Moment) -> Limits {
        let of_lacing = |lacing: &Lacing| {
            let range = lacing.stitches.start..lacing.stitches.end.min(self.stitches.len());
            let limit = |index: usize| {
                let gap = gap(&sewing.start, &self.stitches[index]).length();
                (index, lacing.limit(gap, moment))
            };
            range.map(limit).collect::<Limits>()
        };
        lacings.iter().flat_map(of_lacing).collect()
    }

    /// Solves stitches with their lines.
    pub(super) fn solve(&self, sewing: &mut Sewing, limits: &Limits) {
        for sweep in 0..self.sweeps {
            in_turn(limits, sweep, |index, limit| {
                self.solve_stitch(sewing, &self.stitches[index], limit);
            });
        }
    }

    /// Closes stitches by their own particles alone.
    pub(super) fn close(&self, sewing: &mut Sewing, limits: &Limits) {
        for sweep in 0..CLOSING_SWEEPS {
            in_turn(limits, sweep, |index, limit| close(sewing, &self.stitches[index], limit));
        }
    }

    fn solve_stitch(&self, sewing: &mut Sewing, stitch: &Sewn, limit: Limit) {
        let mut gap = Vec3::ZERO;
        let mut mobility = Mat3::ZERO;
        let mut alone = 0.0;
        for end in &stitch.ends {
            let response = match end.line {
                Some(line) => sewing.eliminate(self, &self.lines[line as usize]),
                None => sewing.response_alone(end.at as usize),
            };
            gap += end.weight * (sewing.at[end.at as usize] + response.free);
            mobility += response.mobility() * (end.weight * end.weight);
            alone += end.weight * end.weight * response.inverse_mass;
        }
        if alone == 0.0 {
            return;
        }
        mobility += Mat3::from_diagonal(Vec3::splat(RIDGE * alone));
        let impulse = impulse(gap, mobility, limit);
        for end in &stitch.ends {
            let of_end = end.weight * impulse;
            match end.line {
                Some(line) => sewing.substitute(self, &self.lines[line as usize], of_end),
                None => {
                    let at = end.at as usize;
                    sewing.at[at] += sewing.inverse_mass[at] * of_end;
                }
            }
        }
    }
}

impl Response {
    fn mobility(&self) -> Mat3 {
        let Self { inverse_mass, along, held, .. } = *self;
        let of_line = Mat3::from_cols(along * along.x, along * along.y, along * along.z);
        (Mat3::IDENTITY - of_line * held) * inverse_mass
    }
}

impl Limit {
    /// Whether a gap of a length (m) needs no impulse.
    fn is_kept(self, length: f32) -> bool {
        length <= LEAST_LENGTH || (length <= self.length && !self.is_drawn)
    }
}

/// The impulse that closes a gap (m) to a limit. A lace acts along the gap alone.
fn impulse(gap: Vec3, mobility: Mat3, limit: Limit) -> Vec3 {
    if limit.length <= 0.0 {
        return mobility.inverse() * -gap;
    }
    let length = gap.length();
    if limit.is_kept(length) {
        return Vec3::ZERO;
    }
    let along = gap * (1.0 / length);
    along * ((limit.length - length) / along.dot(mobility * along))
}

/// Closes a stitch by its own particles.
fn close(sewing: &mut Sewing, stitch: &Sewn, limit: Limit) {
    let gap = gap(&sewing.at, stitch);
    let length = gap.length();
    let mobility: f32 = stitch
        .ends
        .iter()
        .map(|end| end.weight * end.weight * sewing.inverse_mass[end.at as usize])
        .sum();
    if limit.is_kept(length) || mobility == 0.0 {
        return;
    }
    let impulse = gap * ((limit.length / length - 1.0) / mobility);
    for end in &stitch.ends {
        let at = end.at as usize;
        sewing.at[at] += impulse * (end.weight * sewing.inverse_mass[at]);
    }
}

/// How far the two sides of a stitch are apart, m.
fn gap(at: &[Vec3], stitch: &Sewn) -> Vec3 {
    let mut gap = Vec3::ZERO;
    for end in &stitch.ends {
        gap += end.weight * at[end.at as usize];
    }
    gap
}

/// Visits stitches in one order in even sweeps, and in the other in odd ones.
fn in_turn(limits: &Limits, sweep: usize, mut solve: impl FnMut(usize, Limit)) {
    for place in 0..limits.len() {
        let at = if sweep.is_multiple_of(2) { place } else { limits.len() - 1 - place };
        let (index, limit) = limits[at];
        solve(index, limit);
    }
}
