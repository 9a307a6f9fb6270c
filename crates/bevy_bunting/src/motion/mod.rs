//! The motion of a cloth's frame: attachments, the poses of their targets, teleports.

pub mod anchor_hold;
pub mod anchor_pins;
pub mod anchor_poses;
pub mod attached_vertices;
pub mod attachment;
mod border;
mod bring;
pub mod follow;
pub mod follow_anchors;
pub mod frame;
pub(crate) mod held_group;
pub mod inertia;
pub mod lead;
pub mod lost_target;
pub mod observation_times;
pub mod observe;
pub mod place;
pub mod plugin;
pub mod pose;
pub mod report_idle;
mod report_inertia;
pub mod scale;
pub mod shift;
pub mod take_up;
pub mod teleport;
pub mod track;
