//! What asks work to end soon.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::integrate::halt;

pub use crate::integrate::halt::INTERRUPTED;

/// A flag that somebody may raise, to whom work listens on its way; nobody where there is none.
#[derive(Clone, Debug, Default)]
pub struct Stop(Option<Arc<AtomicBool>>);

impl Stop {
    /// Asked by a flag.
    pub fn by(flag: Arc<AtomicBool>) -> Self {
        Self(Some(flag))
    }

    /// Whether it is raised; work is taken to end then.
    pub fn raised(&self) -> bool {
        self.0.as_ref().is_some_and(|flag| halt::raised(flag))
    }
}
