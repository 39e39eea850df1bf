//! Columns of a grid on all cores.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::integrate::halt;
use crate::numerics::threads::crew;

/// What `work` makes of every number below `count`, in order; each number is taken up by whoever is free.
pub fn each<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let (next, heard) = (AtomicUsize::new(0), halt::heard());
    let done: Mutex<Vec<(usize, T)>> = Mutex::new(Vec::with_capacity(count));
    let workers = std::thread::available_parallelism()
        .map_or(1, usize::from)
        .min(count.max(1));
    crew(workers, || {
        heard.during(|| {
            loop {
                let k = next.fetch_add(1, Ordering::Relaxed);
                if k >= count {
                    break;
                }
                let made = work(k);
                if let Ok(mut done) = done.lock() {
                    done.push((k, made));
                }
            }
        });
    });
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_by_key(|(k, _)| *k);
    done.into_iter().map(|(_, made)| made).collect()
}
