//! Stop request for work in progress.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::integrate::halt;

pub use crate::integrate::halt::INTERRUPTED;

/// A flag that requests work to stop, checked by the work; without a flag there is never a request.
#[derive(Clone, Debug, Default)]
pub struct StopFlag(Option<Arc<AtomicBool>>);

impl StopFlag {
    /// Creates a stop request from a flag.
    pub fn by(flag: Arc<AtomicBool>) -> Self {
        Self(Some(flag))
    }

    /// True if the flag is raised. The work is then expected to end.
    pub fn raised(&self) -> bool {
        self.0.as_ref().is_some_and(|flag| halt::raised(flag))
    }
}
