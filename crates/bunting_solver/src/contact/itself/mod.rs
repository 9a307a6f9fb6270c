//! Contacts of a cloth with itself.
//!
//! In each substep, after all other constraints and before the contacts with colliders, pairs of features (a particle
//! and a triangle, or two edges) whose paths come near one another are found (`search.rs`; `flat.rs`, `apart.rs` and
//! `cull.rs` say what can be left out), and those nearer than the thickness are moved apart, on the side on which they
//! began (`separate.rs`, `contact.rs`). Colliders press layers together again, so where any has pushed, layers are
//! moved apart and meet the colliders once more (`rounds.rs`). Then any edges that still pass through triangles
//! return, together with these, to where they began, moved by their mean displacement (`rigid_zones.rs`, after Provot
//! 1997). So cloth that began apart ends apart. Cloth that began tangled comes apart along the gradient of the length
//! of the curves in which it intersects (`untangle.rs`, after Volino and Magnenat-Thalmann 2006).

mod apart;
mod boxes;
mod cell_groups;
mod closest;
mod cloth;
mod contact;
pub(super) mod contacts;
mod crossing;
mod cull;
pub(super) mod exchange;
mod flat;
mod lane;
pub(crate) mod mesh;
mod near;
pub(super) mod pairs;
pub(crate) mod particles;
mod patches;
pub(super) mod place;
mod rigid_zones;
pub(super) mod rounds;
pub(super) mod rules;
mod search;
mod separate;
pub(crate) mod settings;
pub(crate) mod state;
mod swept;
mod untangle;
