//! Every tolerance of the step, with its unit and what breaks when it is changed.

/// Standard gravity, m/s²: the default of a scene, and the measure of static bounds wherever the scene's
/// gravity points.
pub(crate) const GRAVITY: f32 = 9.81;

/// Lengths below this are none, m. Smaller: a collapsed link divides by nothing. Larger: fine meshes
/// lose their finest links.
pub(crate) const LEAST_LENGTH: f32 = 1e-9;

/// Squares of doubled areas below this are no triangle, m⁴. Smaller: the square of it, which the air
/// divides by, is no longer a number. Larger: fine meshes feel no wind.
pub(crate) const LEAST_AREA_SQUARED: f32 = 1e-18;

/// Part of its trace that is added to a cloth's inertia tensor, so that a line or a point has an
/// inverse. Smaller: a line's spin is noise. Larger: internal damping slows the rigid spin.
pub(crate) const INERTIA_RIDGE: f32 = 1e-6;

/// Distance that every particle keeps from a collider, m. Smaller: a cloth at rest on a shape
/// crosses its surface in each substep and sticks as if it had been hit.
pub(crate) const LEAST_CLEARANCE: f32 = 1e-4;

/// Compliance that the stiffest link has, as a part of its particles' own. Smaller: a straight
/// inextensible yarn between two pins has no solution and divides by nothing. Larger: inextensible
/// cloth stretches.
pub(crate) const LEAST_LINK_COMPLIANCE: f32 = 1e-6;

/// Compliance above which a constraint might as well not be there, 1/m² and 1/m⁴. Larger: multipliers
/// are denormal numbers, and slow.
pub(crate) const GREATEST_COMPLIANCE: f32 = 1e14;
