//! Tolerances that several files of the solver share, each with its unit and what breaks when it is changed.

/// Standard gravity, m/s²: the default of a cloth, and the gravity assumed in static bounds.
pub(crate) const GRAVITY: f32 = 9.81;

/// Lengths below this count as zero, m. Smaller: a collapsed link divides by zero. Larger: the shortest links of
/// fine meshes resist nothing.
pub(crate) const LEAST_LENGTH: f32 = 1e-9;

/// Squares of doubled areas below this count as collapsed triangles, m⁴. Smaller: the square of this value,
/// by which the air divides, underflows. Larger: fine meshes feel no wind.
pub(crate) const LEAST_AREA_SQUARED: f32 = 1e-18;

/// Part of the trace of a cloth's inertia tensor that is added to its diagonal, so that the tensor of a line or a
/// point has an inverse. Smaller: the spin of a line is noise. Larger: internal damping slows the rigid spin.
pub(crate) const INERTIA_RIDGE: f32 = 1e-6;

/// Least distance of particles from a collider, m. Smaller: a cloth at rest on a shape crosses its surface in
/// each substep and sticks as if the shape had overtaken it. Larger: thin cloth floats.
pub(crate) const LEAST_CLEARANCE: f32 = 1e-4;

/// Least compliance of a link, as a part of the inverse mass of its particles. Smaller: the system of a straight
/// inextensible chain between two pins is singular. Larger: inextensible cloth stretches.
pub(crate) const LEAST_LINK_COMPLIANCE: f32 = 1e-6;

/// Greatest compliance of a constraint, 1/m² and 1/m⁴; with it a constraint has no effect. Larger: multipliers
/// are denormal numbers, which are slow.
pub(crate) const GREATEST_COMPLIANCE: f32 = 1e14;

/// Effective length β of a substep in units of its length, of the mean of BDF2 and BDF3 in equal substeps (`step/bdf.rs`).
pub(crate) const BETA: f32 = 0.6;

/// The length L of cloth without pins where substeps are chosen, in links: ¾ β²/ε, so that links of cloth that lies on a floor are
/// strained by at most ε = 0.1 by contacts (`step/effort.rs`). Smaller: strips that are pulled hard over a shape slip too
/// early. Larger: cloth that falls freely takes more substeps without need.
pub(crate) const FREE_LENGTH: f32 = 0.75 * BETA * BETA / 0.1;
