//! Tests of the solver through its public types, in one binary.

mod acting;
mod cloth_group;
mod common;
mod contact;
mod curved;
mod free;
mod guides;
mod hard;
mod holds;
mod lanes;
mod levels;
mod local_wind;
mod meshes;
mod mixed;
mod moving_frames;
mod moving_pins;
mod physics;
mod points;
mod pressure;
mod regions;
mod resampled;
mod rest_on_edges;
mod self_contact;
mod single_cloth;
mod strain_limit;
mod yarns;
