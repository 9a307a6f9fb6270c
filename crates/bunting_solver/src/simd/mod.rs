//! Vectors of lanes: the only code that knows how wide they are.

pub(crate) mod lane;
pub(crate) mod level;
pub(crate) mod reduce;
pub(crate) mod vec3;
