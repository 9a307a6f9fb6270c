//! The stitches of a seam.

use core::ops::Range;

use bunting_solver::Stitch;

/// The stitches of a seam at a level, from its beginning to its end, and where each is, as a part of the seam's length.
#[derive(Clone, Debug, Default)]
pub(crate) struct SeamStitches {
    pub stitches: Vec<Stitch>,
    pub parts: Vec<f32>,
}

impl SeamStitches {
    /// The stitches that are closed, among all from the first of the seam on, where a part of its length is.
    pub fn closed(&self, first: usize, part: f32) -> Range<usize> {
        let count = if part > 0.0 { self.parts.partition_point(|at| *at <= part) } else { 0 };
        first..first + count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zip_closes_the_stitches_up_to_its_slider() {
        let parts = vec![0.0, 0.25, 0.5, 0.75, 1.0];
        let stitches = vec![Stitch::to_particle(0, 1); 5];
        let seam = SeamStitches { stitches, parts };
        for (part, count) in [(0.0, 0), (0.1, 1), (0.5, 3), (0.6, 3), (1.0, 5)] {
            assert_eq!(seam.closed(10, part), 10..10 + count, "{part}");
        }
    }
}
