//! Loops shared by two threads where that pays.

use std::sync::OnceLock;
use std::thread;

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
        let one = scope.spawn(one);
        let other = other();
        match one.join() {
            Ok(one) => (one, other),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}
