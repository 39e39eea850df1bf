//! Parallel work on all cores.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::error::Result;
use crate::integrate::halt;
use crate::numerics::threads::crew;

/// Distributes the numbers of a list to `jobs` threads, and passes each result of `work` to `take`, one at a time. Ends
/// early if `work` returns `None`, or if `take` fails.
///
/// # Errors
/// The first error of `take`.
pub fn each<T: Send>(
    numbers: &[usize],
    jobs: usize,
    work: &(dyn Fn(usize) -> Option<T> + Sync),
    take: &mut (dyn FnMut(T) -> Result<()> + Send),
) -> Result<()> {
    let (next, heard) = (AtomicUsize::new(0), halt::heard());
    let taken = Mutex::new((take, Ok(())));
    crew(jobs.clamp(1, numbers.len().max(1)), || {
        heard.during(|| {
            while let Some(number) = numbers.get(next.fetch_add(1, Ordering::Relaxed)) {
                let made = work(*number);
                let mut taken = taken.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                let (take, so_far) = &mut *taken;
                let ends = made.is_none();
                match made {
                    Some(made) if so_far.is_ok() => *so_far = take(made),
                    _ => {}
                }
                if ends || so_far.is_err() {
                    next.store(numbers.len(), Ordering::Relaxed);
                }
            }
        });
    });
    taken.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).1
}

/// Returns the result of `work` for every number below `count`, in order. After a `None`, the remaining numbers are
/// omitted.
pub fn all<T: Send>(count: usize, jobs: usize, work: &(dyn Fn(usize) -> Option<T> + Sync)) -> Vec<Option<T>> {
    let numbers: Vec<usize> = (0..count).collect();
    let mut made: Vec<Option<T>> = std::iter::repeat_with(|| None).take(count).collect();
    // storing results cannot fail
    let _ = each(&numbers, jobs, &|k| Some((k, work(k)?)), &mut |(k, one)| {
        made[k] = Some(one);
        Ok(())
    });
    made
}

/// Number of cores of the machine.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
