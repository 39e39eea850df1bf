//! Bounds that a thread found last: every model of a case needs those of the same signals, and a search may take a millisecond.

use std::cell::RefCell;
use std::thread::LocalKey;

use super::Signal;

/// Most results that are kept.
const MOST: usize = 32;

/// Results by signal and times, the latest at the end.
pub struct Memo<T>(RefCell<Vec<(Signal, [f64; 2], T)>>);

impl<T: Clone> Memo<T> {
    pub const fn new() -> Self {
        Self(RefCell::new(vec![]))
    }
}

/// The result for a signal and two numbers, found anew unless it is kept.
pub fn found<T: Clone>(memo: &'static LocalKey<Memo<T>>, signal: &Signal, by: [f64; 2], find: impl FnOnce() -> T) -> T {
    let is_same = |(other, numbers, _): &(Signal, [f64; 2], T)| *numbers == by && other == signal;
    let kept = memo.with(|memo| memo.0.borrow().iter().find(|one| is_same(one)).map(|one| one.2.clone()));
    kept.unwrap_or_else(|| {
        let result = find();
        memo.with(|memo| {
            let mut all = memo.0.borrow_mut();
            if all.len() == MOST {
                all.remove(0);
            }
            all.push((signal.clone(), by, result.clone()));
        });
        result
    })
}
