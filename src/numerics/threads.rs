//! Work in several threads, up to the number that the system grants.

use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::{self, Builder, Scope, ScopedJoinHandle};

/// Length above which two threads share a loop. A thread takes about 50 us to start and end, and one thread reads
/// vectors in the last-level cache nearly as fast as two.
pub const LARGE: usize = 1 << 18;

/// Runs both functions, in parallel on more than one core. The results do not depend on that.
pub fn both<A: Send, B>(one: impl FnOnce() -> A + Send, other: impl FnOnce() -> B) -> (A, B) {
    static ALONE: OnceLock<bool> = OnceLock::new();
    if *ALONE.get_or_init(|| thread::available_parallelism().is_ok_and(|cores| cores.get() == 1)) {
        return (one(), other());
    }
    thread::scope(|scope| {
        let one = begin(scope, one);
        let other = other();
        (one.join(), other)
    })
}

/// A task started by [`begin`].
pub enum StartedTask<'scope, T> {
    /// Runs in a thread.
    Thread(ScopedJoinHandle<'scope, Option<T>>),
    /// No thread was available: [`StartedTask::join`] runs the task.
    Left(Box<dyn FnOnce() -> Option<T> + 'scope>),
}

/// Starts a task in a thread of a scope. Without an available thread, [`StartedTask::join`] runs it.
pub fn begin<'scope, T: Send + 'scope>(
    scope: &'scope Scope<'scope, '_>,
    task: impl FnOnce() -> T + Send + 'scope,
) -> StartedTask<'scope, T> {
    let task = Arc::new(Mutex::new(Some(task)));
    let take = move || {
        let task = task.lock().unwrap_or_else(PoisonError::into_inner).take();
        task.map(|task| task())
    };
    match Builder::new().spawn_scoped(scope, take.clone()) {
        Ok(thread) => StartedTask::Thread(thread),
        Err(_) => StartedTask::Left(Box::new(take)),
    }
}

impl<T> StartedTask<'_, T> {
    /// Waits for the result of the task; propagates its panic.
    pub fn join(self) -> T {
        let given = match self {
            Self::Thread(thread) => thread.join(),
            Self::Left(task) => Ok(task()),
        };
        match given {
            Ok(Some(given)) => given,
            Ok(None) => resume_unwind(Box::new("a task was begun twice")),
            Err(panic) => resume_unwind(panic),
        }
    }
}

/// True if the system currently grants a thread, for code that starts one itself.
pub fn granted() -> bool {
    Builder::new().spawn(|| ()).is_ok_and(|thread| thread.join().is_ok())
}

/// Runs `work` in up to `count` threads, or in the current thread if none is available. Returns when all have ended.
pub fn crew(count: usize, work: impl Fn() + Sync) {
    let granted = thread::scope(|scope| {
        let threads = (0..count).map_while(|_| Builder::new().spawn_scoped(scope, &work).ok());
        threads.count()
    });
    if granted == 0 && count > 0 {
        work();
    }
}
