//! Reasons why a cloth, or what acts on it, cannot be simulated or shown as asked.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{FabricError, RegionError};

use crate::cloth::weights::WeightsError;
use crate::seams::error::SeamError;
use crate::skeleton::skin::SkinError;

/// Reason why a cloth is not simulated or shown as asked, or why what should act on cloth does not; the message says what to
/// do. Other cloths are not affected.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ClothError {
    /// No fabric can be built from the mesh, or its attachment names vertices that it does not have. The cloth keeps its last
    /// valid fabrics; a cloth that never had any is not simulated until its `ClothMesh`, its `Attachment` or its `LodSet`
    /// changes.
    #[error("the mesh of cloth {entity} cannot be simulated: {source}")]
    Mesh {
        /// The cloth.
        entity: Entity,
        /// Defect of the mesh, with the vertex, edge or triangle that has it.
        source: FabricError,
    },
    /// The weights of the mesh cannot be used. The cloth keeps its last valid fabrics; a cloth that never had any is not
    /// simulated until its `ClothMesh` changes.
    #[error("the weights of cloth {entity} cannot be used: {source}")]
    Weights {
        /// The cloth.
        entity: Entity,
        /// Defect of the weights.
        source: WeightsError,
    },
    /// A region of the [`ClothRegions`](crate::ClothRegions) cannot be used. The cloth keeps its last valid fabrics; a cloth that never
    /// had any is not simulated until its `ClothRegions` or its `ClothMesh` change.
    #[error("region {region} of the ClothRegions of cloth {entity} cannot be used: {source}")]
    Region {
        /// The cloth.
        entity: Entity,
        /// Index of the region.
        region: usize,
        /// Defect of the region.
        source: RegionError,
    },
    /// The material cannot be simulated. The cloth keeps its last valid material; a cloth that never had one
    /// is not simulated until its material changes.
    #[error("the material of cloth {entity} cannot be simulated: {source}")]
    Material {
        /// The cloth.
        entity: Entity,
        /// Defect of the material.
        source: FabricError,
    },
    /// The [`LodSet`](crate::LodSet) is invalid: its distances (m) must be finite, positive and ascending, an
    /// automatic choice needs at least one level, the hysteresis must lie within 0 to 1, and the bias must be
    /// positive. The cloth keeps its last valid `LodSet`; a cloth that never had one is not simulated until its
    /// `LodSet` changes.
    #[error(
        "the LodSet of cloth {entity} must have finite, positive, ascending distances or, if automatic, at least one level; a hysteresis from 0 to 1; and a positive bias"
    )]
    Levels {
        /// The cloth.
        entity: Entity,
    },
    /// The level that the `LodSet` is pinned to does not exist. The cloth keeps its last valid `LodSet`; a cloth that never
    /// had one is not simulated until its `LodSet` changes.
    #[error(
        "cloth {entity} is pinned to level {level}, but has {levels}: pin a lower level, or give more levels"
    )]
    PinnedLevel {
        /// The cloth.
        entity: Entity,
        /// The level that it is pinned to.
        level: usize,
        /// Number of levels.
        levels: usize,
    },
    /// The attachment holds no vertex. The cloth keeps its last valid attachment; a cloth that never had one is not simulated
    /// until its `Attachment`, its `ClothMesh` or its `LodSet` changes.
    #[error(
        "the attachment of cloth {entity} holds no vertex: choose vertices that the mesh has; an edge or a corner of a mesh without uv has none"
    )]
    NoVertices {
        /// The cloth.
        entity: Entity,
    },
    /// The target of the attachment does not exist or has no `Transform`. The cloth goes on hanging where it was, with the
    /// vertices that it was held by, until the target has a `Transform` or its `Attachment` changes; a cloth that never had
    /// a target is not simulated until then.
    #[error(
        "cloth {entity} is attached to {target}, which does not exist or has no Transform: spawn it first"
    )]
    MissingTarget {
        /// The cloth.
        entity: Entity,
        /// The target of its attachment.
        target: Entity,
    },
    /// A scale on the way to the cloth is zero or not finite. The cloth keeps its last valid fabrics; a cloth that never had
    /// any is not simulated until its `ClothMesh`, its `Attachment` or its `LodSet` changes.
    #[error(
        "cloth {entity} cannot have its scale: give its Transform, those above it and the offset of its Attachment scales that are finite and not zero"
    )]
    Scale {
        /// The cloth.
        entity: Entity,
    },
    /// The scale of what the cloth follows has changed as no cloth can follow while it is simulated: by another factor in another
    /// direction, to a mirror image, or to less than a hundredth or more than a hundred times. The cloth keeps its size.
    #[error(
        "cloth {entity} cannot follow the change of scale to {scale}: change it by one positive factor in all directions or, where the scale is its own, insert the ClothMesh again, which makes the cloth anew"
    )]
    ScaleChange {
        /// The cloth.
        entity: Entity,
        /// Scale in the world of the cloth, or of the target of its attachment.
        scale: Vec3,
    },
    /// Two cloths with a `ClothCollision` that come near have grown by different factors. They pass through one another. It is
    /// reported once for each cloth.
    #[error(
        "cloths {entity} and {other} have grown by different factors and cannot touch: scale them alike, or insert their ClothMesh again once they have their sizes, which makes them anew"
    )]
    CollisionScale {
        /// The cloth.
        entity: Entity,
        /// The other cloth.
        other: Entity,
    },
    /// The pose that the cloth should follow is not finite. The cloth keeps its last finite pose.
    #[error(
        "the transform that cloth {entity} follows is not finite: check the systems that write it"
    )]
    Pose {
        /// The cloth.
        entity: Entity,
    },
    /// The [`WindInfluence`](crate::WindInfluence) is not finite, or negative. It counts as 1.
    #[error("the WindInfluence of cloth {entity} must be finite and not negative")]
    Influence {
        /// The cloth.
        entity: Entity,
    },
    /// The thickness of the [`ClothCollision`](crate::ClothCollision) is not finite and greater than zero. The cloth passes
    /// through other cloths.
    #[error(
        "the thickness of the ClothCollision of cloth {entity} must be finite and greater than zero"
    )]
    Collision {
        /// The cloth.
        entity: Entity,
    },
    /// A part of the [`ClothInertia`](crate::ClothInertia) is not within 0 to 1, or a limit is negative. The cloth feels
    /// everything.
    #[error(
        "the parts of the ClothInertia of cloth {entity} must lie within 0 to 1, and its limits must not be negative"
    )]
    Inertia {
        /// The cloth.
        entity: Entity,
    },
    /// A number of an [`Anchor`](crate::Anchor) is not finite, or not positive where it must be, or its rail has no point.
    /// The anchor does not hold.
    #[error(
        "anchor {anchor} of cloth {entity} needs a positive stiffness, or a rail with points and a positive ring mass; its greatest force, breaking force and friction must not be negative"
    )]
    Anchor {
        /// The cloth.
        entity: Entity,
        /// Index of the anchor.
        anchor: usize,
    },
    /// A number of a [`ClothGrab`](crate::ClothGrab) of this cloth is not finite, or not positive where it must be, or there is
    /// no such cloth. Nothing is held.
    #[error(
        "the grab by {hand} needs a cloth, not {entity}, a positive stiffness, a finite place and a greatest force that is not negative"
    )]
    Grab {
        /// The cloth.
        entity: Entity,
        /// The entity that grabs.
        hand: Entity,
    },
    /// The [`ClothAcceleration`](crate::ClothAcceleration) is not finite. It counts as zero.
    #[error("the ClothAcceleration of cloth {entity} must be finite")]
    Acceleration {
        /// The cloth.
        entity: Entity,
    },
    /// A [`ClothImpulse`](crate::ClothImpulse) for this cloth is not finite, has a radius that is not positive, or would
    /// make a velocity that is not finite. It is left out.
    #[error("an impulse on cloth {entity} must be finite, with a positive radius")]
    Impulse {
        /// The cloth.
        entity: Entity,
    },
    /// The [`ClothSkin`](crate::ClothSkin) or the [`SkinLimits`](crate::SkinLimits) cannot be used. The cloth keeps the last
    /// valid ones; a cloth that never had any, or whose mesh has another number of vertices by now, is simulated without
    /// them until they or its `ClothMesh` change.
    #[error("the skin of cloth {entity} cannot be used: {source}")]
    Skin {
        /// The cloth.
        entity: Entity,
        /// Defect of the skin.
        source: SkinError,
    },
    /// A joint of the [`ClothSkin`](crate::ClothSkin) does not exist, or has no finite `Transform`. Reported once; the joint
    /// stays where it was in the cloth's frame, or in its bind pose if it never existed.
    #[error(
        "joint {joint} of cloth {entity} does not exist or has no finite Transform: spawn it, or name another in the ClothSkin"
    )]
    MissingJoint {
        /// The cloth.
        entity: Entity,
        /// The joint.
        joint: Entity,
    },
    /// An [`Attachment`](crate::Attachment) is on an entity that is no cloth. It holds nothing until the entity gets a
    /// `ClothMesh`.
    #[error(
        "the Attachment of {entity} holds nothing: the entity has no ClothMesh; give it one, or make one of its Mesh3d by ClothFromMesh"
    )]
    NoMesh {
        /// The entity with the attachment.
        entity: Entity,
    },
    /// The triangles of a mesh that could be wound alike are not: those on both sides of an edge face opposite sides. The cloth
    /// keeps its last valid fabrics; a cloth that never had any is not simulated until its `ClothMesh` changes.
    #[error(
        "the triangles on both sides of the edge from vertex {a} to {b} of cloth {entity} face opposite sides: wind them alike, or call ClothMesh::repaired, or set ClothFromMesh::repair"
    )]
    Winding {
        /// The cloth.
        entity: Entity,
        /// One end of the edge, a vertex of the `ClothMesh`.
        a: u32,
        /// The other end.
        b: u32,
    },
    /// A [`WindRegion`](crate::WindRegion) is on an entity without a [`WindField`](crate::WindField). It bounds nothing until
    /// the entity gets one.
    #[error(
        "the WindRegion of {entity} bounds no wind: give the entity the WindField that blows in it"
    )]
    NoField {
        /// The entity with the region.
        entity: Entity,
    },
    /// A number of a wind cannot be. The wind does not blow until the number changes.
    #[error(
        "the {component} of {entity} does not blow with a {name} of {value}: give a finite number{}",
        .rule.words()
    )]
    Wind {
        /// The entity with the wind.
        entity: Entity,
        /// Name of the component.
        component: &'static str,
        /// Name of its field.
        name: &'static str,
        /// Value of the field.
        value: f32,
        /// What the number must be besides finite.
        rule: NumberRule,
    },
    /// A number of a [`ClothPressure`](crate::ClothPressure) cannot be. The cloth has no air inside until it changes.
    #[error(
        "the ClothPressure of cloth {entity} cannot have a {name} of {value}: give a finite number{}",
        .rule.words()
    )]
    Pressure {
        /// The cloth.
        entity: Entity,
        /// Name of the field.
        name: &'static str,
        /// Value of the field.
        value: f32,
        /// What the number must be besides finite.
        rule: NumberRule,
    },
    /// The [`ClothPressure`](crate::ClothPressure) of a cloth whose mesh is open is `Sealed`. The cloth has no air inside until the
    /// pressure or the mesh changes.
    #[error(
        "air cannot be sealed in cloth {entity}, whose mesh has openings of {area} m²: close the mesh, or give it ClothPressure::Constant, or ClothPressure::CANOPY if wind shall fill it"
    )]
    OpenPressure {
        /// The cloth.
        entity: Entity,
        /// Area of the openings, as the length of the sum of all triangles' areas as vectors, m².
        area: f32,
    },
    /// A seam of [`ClothSeams`](crate::ClothSeams) cannot be sewn. It is open until its component changes; the other seams are sewn.
    #[error("seam {seam} of cloth {entity} cannot be sewn: {source}")]
    Seam {
        /// The cloth.
        entity: Entity,
        /// Index of the seam.
        seam: usize,
        /// Defect of the seam.
        source: SeamError,
    },
    /// The margin, the friction or a length of the shape of a [`ClothCollider`](crate::ClothCollider) cannot be. No cloth feels
    /// it until it changes.
    #[error(
        "no cloth feels the ClothCollider of {entity}: its {name} cannot be {value}; give finite numbers, and lengths that are not negative"
    )]
    Collider {
        /// The entity with the collider.
        entity: Entity,
        /// What is wrong.
        name: &'static str,
        /// Its value.
        value: f32,
    },
    /// The entity of a [`ClothCollider`](crate::ClothCollider) has a scale that its shape cannot have: one of zero, or one that
    /// mirrors a hull or a heightfield. The collider keeps its last size.
    #[error(
        "the ClothCollider of {entity} cannot have the scale {scale}: give the entity a scale that is finite, not zero and not mirrored, or insert ScaleInShape and give the shape its size in metres"
    )]
    ColliderScale {
        /// The entity with the collider.
        entity: Entity,
        /// Its scale in the world.
        scale: Vec3,
    },
    /// The cloth's `Mesh3d` is kept in the render world only. The cloth is simulated, but its mesh is not
    /// written until its `Mesh3d` is replaced.
    #[cfg(feature = "render")]
    #[error(
        "the mesh of cloth {entity} is not kept in the main world and cannot be written: make it with RenderAssetUsages::default(), or leave out the Mesh3d"
    )]
    MeshUnwritable {
        /// The cloth.
        entity: Entity,
    },
    /// The cloth's `Mesh3d` does not have the vertices of its `ClothMesh`. The cloth is simulated, but its
    /// mesh is not written until its `Mesh3d` is replaced.
    #[cfg(feature = "render")]
    #[error(
        "the mesh of cloth {entity} has {given} vertices, its ClothMesh {expected}: give both the same vertices, or leave out the Mesh3d"
    )]
    MeshVertices {
        /// The cloth.
        entity: Entity,
        /// Vertices of the `Mesh3d`.
        given: usize,
        /// Vertices of the `ClothMesh`.
        expected: usize,
    },
    /// The mesh of a [`ClothFromMesh`](crate::ClothFromMesh) is kept in the render world only. No cloth is made
    /// until its `Mesh3d` or `ClothFromMesh` changes.
    #[cfg(feature = "render")]
    #[error(
        "no cloth can be made of the mesh of {entity}, which is not kept in the main world: make or load it with RenderAssetUsages::default()"
    )]
    MeshUnreadable {
        /// The entity with the mesh.
        entity: Entity,
    },
    /// The mesh of a [`ClothFromMesh`](crate::ClothFromMesh) failed to load. No cloth is made until its `Mesh3d`
    /// or `ClothFromMesh` changes.
    #[cfg(feature = "render")]
    #[error(
        "no cloth can be made of the mesh of {entity}, which failed to load: Bevy's error before this one names the file"
    )]
    MeshNotLoaded {
        /// The entity with the mesh.
        entity: Entity,
    },
    /// The mesh of a [`ClothFromMesh`](crate::ClothFromMesh) lacks the values that its weights are read from. No
    /// cloth is made until its `Mesh3d` or `ClothFromMesh` changes.
    #[cfg(feature = "render")]
    #[error(
        "the mesh of {entity} lacks {key}, which its ClothFromMesh names: paint the mesh; an attribute of your own must be registered at Bevy's GltfPlugin, with this name and the format Float32"
    )]
    NotPainted {
        /// The entity with the mesh.
        entity: Entity,
        /// Name of the attribute, as in `MeshVertexAttribute::name`.
        key: &'static str,
    },
    /// A [`ClothFromMesh`](crate::ClothFromMesh) names the painted vertices of more anchors than the entity has, or it has no
    /// [`Attachment`](crate::Attachment). No cloth is made until its `Mesh3d` or `ClothFromMesh` changes.
    #[cfg(feature = "render")]
    #[error(
        "the ClothFromMesh of {entity} names {painted} lists of held vertices, and its Attachment with its anchors holds {holders}: add an Attachment or anchors"
    )]
    PaintedNotHeld {
        /// The entity with the mesh.
        entity: Entity,
        /// Number of painted lists.
        painted: usize,
        /// Number of lists that the attachment and its anchors hold; 0 without an attachment.
        holders: usize,
    },
    /// A position became infinite or not a number. The cloth was reset to its rest shape.
    #[error(
        "cloth {entity} diverged and was reset to its rest shape: give it more substeps, or a softer material"
    )]
    Diverged {
        /// The cloth.
        entity: Entity,
    },
}

/// What a number must be besides finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberRule {
    /// Nothing else.
    Finite,
    /// Zero or greater.
    NotNegative,
    /// Greater than zero.
    Positive,
}

impl NumberRule {
    /// Whether a number is as it must be.
    pub(crate) fn allows(self, number: f32) -> bool {
        number.is_finite()
            && match self {
                Self::Finite => true,
                Self::NotNegative => number >= 0.0,
                Self::Positive => number > 0.0,
            }
    }

    /// The rule after the words "a finite number".
    fn words(self) -> &'static str {
        match self {
            Self::Finite => "",
            Self::NotNegative => " that is not negative",
            Self::Positive => " greater than zero",
        }
    }
}
