//! Memory on the heap, counted by the allocator.

use std::alloc::System;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

/// The system's allocator with counters of bytes, for every binary that uses the lab.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Number of times that `work` allocates memory or moves it to a larger place. Other threads must not allocate at that time.
pub fn allocations_of(work: impl FnOnce()) -> usize {
    let region = Region::new(ALLOCATOR);
    work();
    let change = region.change();
    change.allocations + change.reallocations
}

/// Bytes that the program holds on the heap.
#[must_use]
pub fn in_use() -> usize {
    let stats = ALLOCATOR.stats();
    stats.bytes_allocated.saturating_sub(stats.bytes_deallocated)
}

/// Returns the value made by `make`, and the bytes that the value holds on the heap: those allocated and not
/// freed meanwhile. Other threads must not allocate at that time.
pub fn held_by<Value>(make: impl FnOnce() -> Value) -> (Value, usize) {
    let region = Region::new(ALLOCATOR);
    let value = make();
    let change = region.change();
    (value, change.bytes_allocated.saturating_sub(change.bytes_deallocated))
}
