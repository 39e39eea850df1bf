//! Requests to stop a computation early, from a program in which it is embedded. A request applies only to the threads of that
//! computation.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Reason reported by work that was interrupted.
pub const INTERRUPTED: &str = "interrupted";

thread_local! {
    static HEARD: RefCell<ObservedStop> = const { RefCell::new(ObservedStop(None)) };
}

/// A stop request: its source, and whether it has stopped any work.
#[derive(Clone, Debug, Default)]
pub struct StopRequest {
    raised: Arc<AtomicBool>,
    seen: Arc<AtomicBool>,
    answered: Arc<AtomicBool>,
    /// Number of threads that are now completing work that must not be cut.
    completing: Arc<AtomicUsize>,
    /// True if this thread does part of the work of another one, which waits for it.
    helps: bool,
}

/// Stop request that a thread observes, to be passed to the threads it starts.
#[derive(Clone, Debug, Default)]
pub struct ObservedStop(Option<StopRequest>);

impl StopRequest {
    /// Creates a request that is raised by this flag.
    pub fn by(raised: &Arc<AtomicBool>) -> Self {
        Self {
            raised: Arc::clone(raised),
            ..Self::default()
        }
    }

    /// True if work has ended because of the request.
    pub fn was_seen(&self) -> bool {
        self.seen.load(Ordering::Relaxed)
    }

    /// True if the thread that started the work ends it, or if work that must not be cut is being completed.
    pub fn is_answered(&self) -> bool {
        self.answered.load(Ordering::Relaxed) || self.completing.load(Ordering::Relaxed) > 0
    }

    fn see(&self) {
        self.seen.store(true, Ordering::Relaxed);
        if !self.helps {
            self.answered.store(true, Ordering::Relaxed);
        }
    }

    /// Makes this thread observe the request from now on.
    pub fn listen(&self) {
        HEARD.replace(ObservedStop(Some(self.clone())));
    }
}

impl ObservedStop {
    /// Runs `work` as part of the work of the observing thread; it observes the same request.
    pub fn during<T>(&self, work: impl FnOnce() -> T) -> T {
        let mut heard = self.clone();
        if let Some(halt) = &mut heard.0 {
            halt.helps = true;
        }
        let before = HEARD.replace(heard);
        let done = work();
        HEARD.replace(before);
        done
    }
}

/// Returns the request that this thread observes.
pub fn heard() -> ObservedStop {
    HEARD.with_borrow(ObservedStop::clone)
}

/// Stops observing requests in this thread.
pub fn deaf() {
    HEARD.take();
}

/// Records that work ends because of the request.
pub fn see() {
    HEARD.with_borrow(|heard| {
        if let Some(halt) = &heard.0 {
            halt.see();
        }
    });
}

/// Completes work that must not be cut, such as writing the files of a result.
pub fn complete<T>(work: impl FnOnce() -> T) -> T {
    let completing = heard().0.map(|halt| halt.completing);
    if let Some(count) = &completing {
        count.fetch_add(1, Ordering::Relaxed);
    }
    let done = work();
    if let Some(count) = &completing {
        count.fetch_sub(1, Ordering::Relaxed);
    }
    done
}

/// True if the flag is raised; records that the caller ends its work.
pub fn raised(flag: &AtomicBool) -> bool {
    let raised = flag.load(Ordering::Relaxed);
    if raised {
        see();
    }
    raised
}

/// True if the computation must end; records that the caller ends its work.
pub fn asked() -> bool {
    HEARD.with_borrow(|heard| {
        let halt = heard.0.as_ref().filter(|halt| halt.raised.load(Ordering::Relaxed));
        halt.inspect(|halt| halt.see()).is_some()
    })
}
