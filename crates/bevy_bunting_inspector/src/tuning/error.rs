//! Reasons why a tuning file cannot be written or read.

use std::path::{Path, PathBuf};

use bevy_ecs::prelude::*;

/// A tuning file cannot be written or read. Nothing in the world has changed.
#[derive(Debug, thiserror::Error)]
#[error("{}, for {entity}, at {key}: {problem}", file.display())]
pub struct TuningError {
    /// The file.
    pub file: PathBuf,
    /// The cloth.
    pub entity: Entity,
    /// Path of the value in the file, such as `cloth.bevy_bunting::LodSet.bias`; `.` is the whole file.
    pub key: String,
    /// What is wrong there.
    pub problem: TuningProblem,
}

/// What is wrong with a tuning file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TuningProblem {
    /// The entity has no `ClothMesh`.
    #[error("the entity is no cloth")]
    NoCloth,
    /// The file cannot be opened, read or written.
    #[error("{0}")]
    File(#[from] std::io::Error),
    /// The file is not as expected.
    #[error("it must have the form (cloth: {{…}}, pins: …, winds: {{…}}, resources: {{…}}): {0}")]
    Form(Box<ron::error::SpannedError>),
    /// There is no such component or resource among the parameters.
    #[error("there is no such parameter: write the name or the whole path of its type")]
    Unknown,
    /// The world has no wind of this name.
    #[error("no wind has this Name")]
    NoWind,
    /// Several winds have this name.
    #[error("several winds have this Name: give each its own")]
    SameName,
    /// The pins are an empty list.
    #[error("pins must name a vertex: leave them out to keep those that the cloth has")]
    NoPins,
    /// A pin is no vertex of the cloth: the file is that of another mesh.
    #[error("there is no vertex {vertex}, since the cloth has {vertices}: its mesh is another one")]
    NoVertex {
        /// The pin.
        vertex: u32,
        /// Number of vertices of the cloth.
        vertices: usize,
    },
    /// The world lacks the resource.
    #[error("the world has no such resource: ClothPlugins insert it")]
    NoResource,
    /// A value does not fit, or lacks a field that has no default.
    #[error("{0}")]
    Value(Box<ron::Error>),
}

/// What is wrong, at a key.
pub type Failed = (String, TuningProblem);

impl TuningError {
    pub(super) fn new(file: &Path, entity: Entity, (key, problem): Failed) -> Self {
        let key = if key.is_empty() { ".".to_owned() } else { key };
        Self { file: file.to_owned(), entity, key, problem }
    }
}
