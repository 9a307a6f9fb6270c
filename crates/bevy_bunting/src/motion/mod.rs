//! What carries a cloth: attachments, and the motion of their targets.

pub mod attachment;
pub mod follow;
pub mod frame;
pub mod pose;
pub mod take_up;
pub mod teleport;
