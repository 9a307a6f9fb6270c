//! Contacts of several cloths with one another.
//!
//! Cloths that may touch are a group. In each substep their positions are taken out of their lanes into a common frame
//! along the world's axes, and all their layers are kept apart by the code for a cloth and itself (`../itself/`): separated,
//! then each cloth meets its colliders, then rigid zones return. Layers of a single cloth of the group are kept apart in
//! the same way, if it keeps them apart at all.

pub(crate) mod group;
pub(crate) mod lane;
pub(crate) mod member;
mod rules;
