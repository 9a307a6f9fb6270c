//! A sheet on a slope: it slips from tan α = μ on, with g (sin α − μ cos α), and rests below.

use glam::Vec3;

use super::{
    rig::{GRAVITY, Trial, cotton, floor, sheet, threshold},
    row::Row,
};

/// Distance over which a sheet counts as slipping, m.
const SLIPPED: f32 = 2e-3;

/// A sheet on a slope whose angle has this tangent.
fn on_slope(friction: f32, tangent: f32) -> Trial {
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let gravity = GRAVITY * cosine * Vec3::new(tangent, 0.0, -1.0);
    let mut sheet = Trial::new(&sheet(17, 17, 1.0, 1.0), cotton(friction), gravity);
    sheet.touch([floor(friction)]);
    sheet
}

pub(super) fn rows(quick: bool) -> Vec<Row> {
    let frictions = if quick { &[0.5][..] } else { &[0.2, 0.5, 1.0] };
    let of = |&friction: &f32| [slip(friction), slide(friction), creep(friction)];
    frictions.iter().flat_map(of).collect()
}

/// Row of the slope from which on a sheet slips.
fn slip(friction: f32) -> Row {
    let (tangent, us) = threshold(0.8 * friction, 1.2 * friction, |tangent| {
        let mut sheet = on_slope(friction, tangent);
        let start = sheet.centre();
        sheet.run(1.0);
        ((sheet.centre() - start).x > SLIPPED, sheet.us())
    });
    let error = (tangent / friction - 1.0).abs();
    Row::new(
        format!("slip on a slope, μ = {friction}"),
        "error of tan α, of one",
        error.into(),
        0.02,
        us,
    )
}

/// Row of the acceleration of a sheet that slides.
fn slide(friction: f32) -> Row {
    let tangent = 1.5 * friction;
    let mut sheet = on_slope(friction, tangent);
    let start = sheet.centre();
    sheet.run(1.0);
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let expected = 0.5 * GRAVITY * cosine * (tangent - friction);
    let error = ((sheet.centre() - start).x / expected - 1.0).abs();
    Row::new(
        format!("slide down a slope, μ = {friction}"),
        "error of the way, of one",
        error.into(),
        0.02,
        sheet.us(),
    )
}

/// Row of the speed at which a sheet creeps on a slope of 0.9 μ.
fn creep(friction: f32) -> Row {
    /// s.
    const SECONDS: f32 = 10.0;
    let mut sheet = on_slope(friction, 0.9 * friction);
    sheet.run(1.0);
    let before = sheet.positions();
    sheet.run(SECONDS);
    let after = sheet.positions();
    let moved = after.iter().zip(&before).map(|(now, then)| now.distance(*then));
    let speed = moved.fold(0.0, f32::max) / SECONDS;
    Row::new(
        format!("creep on a slope of 0.9 μ, μ = {friction}"),
        "greatest mean speed, m/s",
        speed.into(),
        1e-4,
        sheet.us(),
    )
}
