//! A request to end soon with what there is, of whoever has something computed inside another program. It belongs to the threads of that
//! computation; others know nothing of it.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    static HEARD: RefCell<Heard> = const { RefCell::new(Heard(None)) };
}

/// Where a request comes from, and whether it made anything end.
#[derive(Clone, Debug, Default)]
pub struct Halt {
    raised: Arc<AtomicBool>,
    seen: Arc<AtomicBool>,
    /// Whether computations look for it by themselves.
    everywhere: bool,
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

    /// This thread listens to it from now on.
    pub fn listen(&self) {
        HEARD.replace(Heard(Some(self.clone())));
    }
}

impl Heard {
    /// This thread listens to the same.
    pub fn listen(&self) {
        HEARD.replace(self.clone());
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

/// The computations of this thread look for the request by themselves from now on.
pub fn everywhere() {
    HEARD.with_borrow_mut(|heard| {
        if let Some(halt) = &mut heard.0 {
            halt.everywhere = true;
        }
    });
}

/// Something ends for the request.
pub fn see() {
    HEARD.with_borrow(|heard| {
        if let Some(halt) = &heard.0 {
            halt.seen.store(true, Ordering::Relaxed);
        }
    });
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
    let asked = HEARD.with_borrow(|heard| {
        let everywhere = heard.0.as_ref().filter(|halt| halt.everywhere);
        everywhere.is_some_and(|halt| halt.raised.load(Ordering::Relaxed))
    });
    if asked {
        see();
    }
    asked
}
