//! Independent pieces of work on all cores.

use std::{
    num::NonZero,
    panic,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

/// Results of `work` for each item, in the order of the items. Threads, one for each core, take items from a
/// common queue, so that a long item delays only its own thread.
///
/// # Panics
///
/// When `work` does.
pub fn map<Item: Sync, Output: Send>(
    items: &[Item],
    work: impl Fn(&Item) -> Output + Sync,
) -> Vec<Output> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(items.len());
    let next = AtomicUsize::new(0);
    let take_items = || {
        let mut outputs = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return outputs };
            outputs.push((index, work(item)));
        }
    };
    let mut outputs: Vec<(usize, Output)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(take_items)).collect();
        let join = |worker: thread::ScopedJoinHandle<'_, Vec<_>>| {
            worker.join().unwrap_or_else(|panic| panic::resume_unwind(panic))
        };
        workers.into_iter().flat_map(join).collect()
    });
    outputs.sort_unstable_by_key(|(index, _)| *index);
    outputs.into_iter().map(|(_, output)| output).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_are_in_the_order_of_the_items() {
        let items: Vec<u32> = (0..100).rev().collect();
        let slow_first = |item: &u32| {
            thread::sleep(std::time::Duration::from_micros(u64::from(*item)));
            *item
        };
        assert_eq!(map(&items, slow_first), items);
        assert!(map(&[], slow_first).is_empty());
    }

    #[test]
    #[should_panic(expected = "this item")]
    fn a_panic_reaches_the_caller() {
        map(&[1, 2, 3], |item| assert_ne!(*item, 2, "this item"));
    }
}
