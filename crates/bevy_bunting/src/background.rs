//! Work on another thread, on platforms that have threads.

use core::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use bevy_tasks::{AsyncComputeTaskPool, Task, block_on};

type Work<T> = Box<dyn FnOnce() -> T + Send>;

/// Work whose result is taken in a tick that follows from the amount of work, not from the machine's speed:
/// so it is the same tick on every machine.
pub(crate) struct Background<T> {
    /// The work; none once a thread has begun it.
    work: Arc<Mutex<Option<Work<T>>>>,
    /// Task that does the work. None in browsers, which have no threads. Its result is none if another thread
    /// took the work first.
    task: Option<Task<Option<T>>>,
}

impl<T: Send + 'static> Background<T> {
    /// Starts work on another thread, queued behind all earlier work.
    pub fn begin(work: impl FnOnce() -> T + Send + 'static) -> Self {
        let work: Arc<Mutex<Option<Work<T>>>> = Arc::new(Mutex::new(Some(Box::new(work))));
        let pool = AsyncComputeTaskPool::try_get().filter(|_| !cfg!(target_arch = "wasm32"));
        let task = pool.map(|pool| {
            let work = Arc::clone(&work);
            pool.spawn(async move { take(&work).map(|work| work()) })
        });
        Self { work, task }
    }

    /// Whether the result is ready, or no thread will make it, so that [`take`](Self::take) does not wait for one.
    pub fn is_done(&self) -> bool {
        self.task.as_ref().is_none_or(Task::is_finished)
    }

    /// Returns the result. Work that no thread has begun is done on this thread, since the others may be busy for
    /// long.
    pub fn take(self) -> T {
        let done = match take(&self.work) {
            Some(work) => Some(work()),
            None => self.task.and_then(block_on),
        };
        done.expect("work that has begun ends")
    }
}

fn take<T>(work: &Mutex<Option<Work<T>>>) -> Option<Work<T>> {
    work.lock().unwrap_or_else(PoisonError::into_inner).take()
}

impl<T> fmt::Debug for Background<T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Background").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::time::Duration;

    use bevy_tasks::TaskPoolBuilder;

    use super::*;

    /// Time after which the long work gives up waiting, so that the test fails and does not hang.
    const LONGEST: Duration = Duration::from_secs(10);

    #[test]
    fn queued_work_runs_on_the_thread_that_takes_its_result() {
        AsyncComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(1).build());
        let (go, long) = mpsc::channel::<u32>();
        let long = Background::begin(move || long.recv_timeout(LONGEST));
        let short = Background::begin(|| 2);
        assert_eq!(short.take(), 2);
        go.send(1).expect("it waits");
        assert_eq!(long.take(), Ok(1));
    }
}
