//! The place of a link in a batch.

/// Where the target and the compliance of a link are.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkPlace {
    pub target: u32,
    pub class: u32,
    pub lane: u8,
}
