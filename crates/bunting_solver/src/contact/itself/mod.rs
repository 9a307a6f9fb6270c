//! Contacts of a cloth with itself.
//!
//! After the lines of a substep are solved, pairs of cells of a few triangles whose paths come near one another are found (`search.rs`;
//! `flat.rs` and `planes.rs` say which cannot touch), then in lanes pairs of their features, a particle and a triangle or two edges
//! (`pairs.rs`), and among these those nearer than the thickness (`touching.rs`). Eight contacts at a time (`contact_packs.rs`) they are
//! moved apart, on the side on which they began, in sweeps over all (`solve.rs`, `separate.rs`): once after the lines, and at the end of
//! the substep, before the contacts with colliders. Colliders press layers together again, so where any has pushed, layers are moved apart
//! and meet the colliders once more (`rounds.rs`). Then any edges that still pass through triangles return, together with these, to where
//! they began, moved by their mean displacement (`rigid_zones.rs`, after Provot 1997). So cloth that began apart ends apart. Cloth that
//! began tangled comes apart along the gradient of the length of the curves in which it intersects (`untangle.rs`, after Volino and
//! Magnenat-Thalmann 2006).

mod boxes;
mod cell_groups;
mod cell_pairs;
pub(super) mod closest;
mod cloth;
mod contact_packs;
pub(super) mod contacts;
mod crossing;
pub(super) mod exchange;
mod features;
mod flat;
mod lane;
pub(crate) mod mesh;
mod near;
mod pairs;
pub(crate) mod particles;
mod patches;
pub(super) mod place;
mod planes;
mod points;
mod rigid_zones;
pub(super) mod rounds;
pub(super) mod rules;
mod search;
mod separate;
pub(crate) mod settings;
mod solve;
pub(crate) mod state;
mod swept;
mod touching;
mod untangle;
