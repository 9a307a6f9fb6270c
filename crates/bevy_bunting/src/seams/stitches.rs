//! The stitches of seams at a level.

use bunting_solver::Stitch;

use crate::cloth::mesh::ClothMesh;
use crate::fabric::levels::ClothLevels;
use crate::seams::error::SeamError;
use crate::seams::particles::{OnRun, along};
use crate::seams::seam::Seam;
use crate::seams::seam_stitches::SeamStitches;

/// Part of the way between two particles below which a stitch goes to one of them: rounding.
const AT_PARTICLE: f32 = 1e-3;

/// The stitches of a seam at a level.
pub(super) fn stitches_of(
    seam: &Seam,
    mesh: &ClothMesh,
    levels: &ClothLevels,
    level: usize,
) -> Result<SeamStitches, SeamError> {
    let side = |side: usize| {
        let found = along(levels, level, &seam.sides[side].vertices(mesh)?)?;
        if found.is_empty() { Err(SeamError::Empty { side }) } else { Ok(in_parts(found)) }
    };
    let (one, mut other) = (side(0)?, side(1)?);
    if seam.reversed {
        other.reverse();
        other.iter_mut().for_each(|(_, part)| *part = 1.0 - *part);
    }
    let is_one_finer = one.len() >= other.len();
    let (finer, coarser) = if is_one_finer { (&one, &other) } else { (&other, &one) };
    let mut all = SeamStitches::default();
    for (index, &(particle, part)) in finer.iter().enumerate() {
        let stitch = if finer.len() == coarser.len() {
            Stitch::to_particle(particle, coarser[index].0)
        } else {
            between(particle, part, coarser)
        };
        // Sides that have an end in common are together there.
        if !stitch.onto.contains(&particle) {
            all.stitches.push(stitch);
            all.parts.push(part);
        }
    }
    Ok(all)
}

/// Particles with the places where they are, from 0 at the first one to 1 at the last one.
fn in_parts(mut run: Vec<OnRun>) -> Vec<OnRun> {
    let (Some(&(_, start)), Some(&(_, end))) = (run.first(), run.last()) else { return run };
    let length = (end - start).max(f32::MIN_POSITIVE);
    run.iter_mut().for_each(|(_, at)| *at = (*at - start) / length);
    run
}

/// A stitch to where a part of a run is.
fn between(particle: u32, part: f32, run: &[OnRun]) -> Stitch {
    let after = run.partition_point(|(_, at)| *at < part).min(run.len() - 1);
    let (before, after) = (run[after.saturating_sub(1)], run[after]);
    let within = (part - before.1) / (after.1 - before.1).max(f32::MIN_POSITIVE);
    if before.0 == after.0 || within <= AT_PARTICLE {
        Stitch::to_particle(particle, before.0)
    } else if within >= 1.0 - AT_PARTICLE {
        Stitch::to_particle(particle, after.0)
    } else {
        Stitch { particle, onto: [before.0, after.0], part: within }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stitch_goes_between_the_particles_around_its_place() {
        let run = [(7, 0.0), (8, 0.25), (9, 1.0)];
        assert_eq!(between(1, 0.0, &run), Stitch::to_particle(1, 7));
        assert_eq!(between(1, 1.0, &run), Stitch::to_particle(1, 9));
        assert_eq!(between(1, 0.25, &run), Stitch::to_particle(1, 8));
        assert_eq!(between(1, 0.625, &run), Stitch { particle: 1, onto: [8, 9], part: 0.5 });
        assert_eq!(between(1, 0.5, &run[..1]), Stitch::to_particle(1, 7));
    }
}
