//! Packs of floats, the registers that hold them, and the instructions that kernels are compiled for.

pub(crate) mod constant;
pub(crate) mod lane;
pub(crate) mod level;
pub(crate) mod registers;
pub(crate) mod sum;
pub(crate) mod transpose;
pub(crate) mod vec3;
