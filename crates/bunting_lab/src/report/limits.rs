//! Limitations of the project, listed beside its figures.

/// Limitations that a reader of the figures should know.
pub const LIMITS: [&str; 13] = [
    "Collision of cloths with one another.",
    "Two-way coupling: cloth does not push back on what it touches or hangs from.",
    "Features of shapes: particles are tested, not the triangles between them, so sharp edges and corners \
     of a shape can poke through between particles.",
    "Continuous contact with shapes that deform.",
    "Several targets: a cloth is attached to one entity.",
    "Compliant or sliding attachments; pins are exact and fixed on the cloth.",
    "Skinning: cloth that follows the bones of a character.",
    "Tearing.",
    "Plasticity: a fold leaves no crease.",
    "Curved rest shapes with their own bending on grids; they are flat.",
    "Local wind: a field is the same everywhere but for its gusts, and nothing shelters a cloth from it.",
    "Air that cloth moves: the wind knows nothing of the cloth.",
    "Exact stretch on irregular meshes that are curved at rest: their chains are short and need more substeps than a \
     grid's.",
];
