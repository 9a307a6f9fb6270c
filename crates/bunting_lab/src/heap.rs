//! Memory on the heap, counted by the allocator itself.

use std::alloc::System;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

/// The system's allocator with counters of bytes, for every binary that uses the lab.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// What `make` returns, and the bytes that it asked the allocator for and has not given back: what the
/// value holds on the heap. Other threads must not allocate meanwhile.
pub fn held_by<Value>(make: impl FnOnce() -> Value) -> (Value, usize) {
    let region = Region::new(ALLOCATOR);
    let value = make();
    let change = region.change();
    (value, change.bytes_allocated.saturating_sub(change.bytes_deallocated))
}
