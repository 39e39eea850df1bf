//! Work shared by threads, as many of them as pay and as the system grants.

use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::{self, Builder, Scope, ScopedJoinHandle};

/// Numbers from which on two threads share a loop: a thread takes some 50 us to begin and end, and vectors that the last cache holds are read by one thread
/// nearly as fast as by two.
pub const LARGE: usize = 1 << 18;

/// Does both, at the same time where the machine can: what they give is the same.
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

/// A task that [`begin`] has begun.
pub enum Begun<'scope, T> {
    /// In a thread.
    Thread(ScopedJoinHandle<'scope, Option<T>>),
    /// The system grants no thread: whoever waits for the task does it.
    Left(Box<dyn FnOnce() -> Option<T> + 'scope>),
}

/// Begins a task in a thread of a scope; where the system grants none, [`Begun::join`] does it.
pub fn begin<'scope, T: Send + 'scope>(
    scope: &'scope Scope<'scope, '_>,
    task: impl FnOnce() -> T + Send + 'scope,
) -> Begun<'scope, T> {
    let task = Arc::new(Mutex::new(Some(task)));
    let take = move || {
        let task = task.lock().unwrap_or_else(PoisonError::into_inner).take();
        task.map(|task| task())
    };
    match Builder::new().spawn_scoped(scope, take.clone()) {
        Ok(thread) => Begun::Thread(thread),
        Err(_) => Begun::Left(Box::new(take)),
    }
}

impl<T> Begun<'_, T> {
    /// Waits for the result of the task; its panic goes on here.
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

/// True if the system grants a thread now: for what begins one by itself.
pub fn granted() -> bool {
    Builder::new().spawn(|| ()).is_ok_and(|thread| thread.join().is_ok())
}

/// Does the same work in up to `count` threads, fewer where the system grants fewer, in this one where it grants none. Returns when all
/// have ended.
pub fn crew(count: usize, work: impl Fn() + Sync) {
    let granted = thread::scope(|scope| {
        let threads = (0..count).map_while(|_| Builder::new().spawn_scoped(scope, &work).ok());
        threads.count()
    });
    if granted == 0 && count > 0 {
        work();
    }
}
