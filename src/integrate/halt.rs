//! A request to end soon with what there is, of whoever has something computed inside another program. It belongs to the threads of that
//! computation; others know nothing of it.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Why work ended that was asked to.
pub const INTERRUPTED: &str = "interrupted";

thread_local! {
    static HEARD: RefCell<Heard> = const { RefCell::new(Heard(None)) };
}

/// Where a request comes from, and whether it made anything end.
#[derive(Clone, Debug, Default)]
pub struct Halt {
    raised: Arc<AtomicBool>,
    seen: Arc<AtomicBool>,
    answered: Arc<AtomicBool>,
    /// Threads that complete something now.
    completing: Arc<AtomicUsize>,
    /// True if this thread does a part of the work of another one, which waits for it.
    helps: bool,
}

/// What a thread listens to, for the threads that it begins.
#[derive(Clone, Debug, Default)]
pub struct Heard(Option<Halt>);

impl Halt {
    /// A request by raising this flag.
    pub fn by(raised: &Arc<AtomicBool>) -> Self {
        Self {
            raised: Arc::clone(raised),
            ..Self::default()
        }
    }

    /// Whether something ended for it.
    pub fn was_seen(&self) -> bool {
        self.seen.load(Ordering::Relaxed)
    }

    /// True if the thread that has begun the work ends it, or something is completed that is not to be cut.
    pub fn is_answered(&self) -> bool {
        self.answered.load(Ordering::Relaxed) || self.completing.load(Ordering::Relaxed) > 0
    }

    fn see(&self) {
        self.seen.store(true, Ordering::Relaxed);
        if !self.helps {
            self.answered.store(true, Ordering::Relaxed);
        }
    }

    /// This thread listens to it from now on.
    pub fn listen(&self) {
        HEARD.replace(Heard(Some(self.clone())));
    }
}

impl Heard {
    /// Does a part of the work of the thread that has listened so far: the part listens to the same.
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

/// What this thread listens to.
pub fn heard() -> Heard {
    HEARD.with_borrow(Heard::clone)
}

/// This thread listens no more.
pub fn deaf() {
    HEARD.take();
}

/// Something ends for the request.
pub fn see() {
    HEARD.with_borrow(|heard| {
        if let Some(halt) = &heard.0 {
            halt.see();
        }
    });
}

/// Completes something that is not to be cut, such as the files of a result.
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

/// Whether a flag is up; whoever asks is taken to end then.
pub fn raised(flag: &AtomicBool) -> bool {
    let raised = flag.load(Ordering::Relaxed);
    if raised {
        see();
    }
    raised
}

/// Whether a computation is to end; it is taken to do so.
pub fn asked() -> bool {
    HEARD.with_borrow(|heard| {
        let halt = heard.0.as_ref().filter(|halt| halt.raised.load(Ordering::Relaxed));
        halt.inspect(|halt| halt.see()).is_some()
    })
}
