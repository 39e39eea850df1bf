//! Persistent evaluations: a search looks up each evaluation before it computes it, and stores it once computed.
//!
//! A deterministic search is resumed by reading its evaluations; no other state is stored.

use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::error::{Error, Result};

/// An evaluation as a line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JournalEvaluation {
    /// Identity of the evaluation, as JSON.
    pub key: String,
    /// Its value.
    pub value: Value,
}

/// Stores an evaluation.
pub type Write = Box<dyn FnMut(&JournalEvaluation) -> Result<()> + Send>;

/// Evaluations of one search, shared by its threads. Without a journal, each is computed.
#[derive(Clone, Default)]
pub struct Evaluations {
    shared: Arc<Mutex<Shared>>,
    scope: String,
}

#[derive(Default)]
struct Shared {
    known: HashMap<String, Value>,
    write: Option<Write>,
    counts: Counts,
    fault: Option<Error>,
}

/// Origins of the evaluations so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Read from the journal.
    pub read: usize,
    /// Computed and stored.
    pub stored: usize,
}

impl fmt::Debug for Evaluations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Evaluations({:?})", self.scope)
    }
}

impl Evaluations {
    /// Begins a journal with the evaluations of an interrupted search and a function that stores further ones.
    pub fn begin(&self, known: impl IntoIterator<Item = JournalEvaluation>, write: Write) {
        let mut shared = self.shared();
        shared.known = known.into_iter().map(|one| (one.key, one.value)).collect();
        shared.write = Some(write);
    }

    /// The same journal for a part of the search, with separate keys.
    pub fn scoped(&self, scope: &str) -> Self {
        let shared = Arc::clone(&self.shared);
        let scope = format!("{}{scope} ", self.scope);
        Self { shared, scope }
    }

    /// Origins of the evaluations so far.
    pub fn counts(&self) -> Counts {
        self.shared().counts
    }

    /// Takes the first write error, after which nothing is stored.
    pub fn fault(&self) -> Option<Error> {
        self.shared().fault.take()
    }

    /// Reads or computes the value of a key. Values computed while `stop` is true are not stored.
    pub fn get<T: Serialize + DeserializeOwned + PartialEq>(
        &self,
        key: &impl Serialize,
        stop: &dyn Fn() -> bool,
        compute: impl FnOnce() -> T,
    ) -> T {
        let key = self.key(key);
        self.find(&key).unwrap_or_else(|| {
            let value = compute();
            self.store(key, &value, stop);
            value
        })
    }

    /// Reads or computes the value of a key by a function that may fail. Errors are not stored.
    ///
    /// # Errors
    /// Those of `compute`.
    pub fn try_get<T: Serialize + DeserializeOwned + PartialEq>(
        &self,
        key: &impl Serialize,
        stop: &dyn Fn() -> bool,
        compute: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let key = self.key(key);
        if let Some(found) = self.find(&key) {
            return Ok(found);
        }
        let value = compute()?;
        self.store(key, &value, stop);
        Ok(value)
    }

    fn shared(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn key(&self, key: &impl Serialize) -> String {
        format!("{}{}", self.scope, serde_json::to_string(key).unwrap_or_default())
    }

    fn find<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        let mut shared = self.shared();
        let found = T::deserialize(shared.known.get(key)?).ok()?;
        shared.counts.read += 1;
        Some(found)
    }

    /// Stores a value if it is not null and JSON reproduces it exactly; JSON has no infinity.
    fn store<T: Serialize + DeserializeOwned + PartialEq>(&self, key: String, value: &T, stop: &dyn Fn() -> bool) {
        if self.shared().write.is_none() || stop() {
            return;
        }
        let Ok(written) = serde_json::to_value(value) else {
            return;
        };
        if written.is_null() || T::deserialize(&written).ok().as_ref() != Some(value) {
            return;
        }
        let one = JournalEvaluation { key, value: written };
        let mut shared = self.shared();
        let Some(write) = &mut shared.write else { return };
        match write(&one) {
            Ok(()) => shared.counts.stored += 1,
            Err(fault) => {
                shared.write = None;
                shared.fault = Some(fault);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn never() -> bool {
        false
    }

    /// Goal: values are read back bit for bit; null values, values that JSON cannot represent and interrupted ones are computed again.
    #[test]
    fn values_come_back_bit_for_bit() {
        let rows: Arc<Mutex<Vec<JournalEvaluation>>> = Arc::default();
        let kept = Arc::clone(&rows);
        let first = Evaluations::default();
        let write: Write = Box::new(move |one: &JournalEvaluation| {
            kept.lock().unwrap_or_else(PoisonError::into_inner).push(one.clone());
            Ok(())
        });
        first.begin([], write);
        let numbers = vec![0.1 + 0.2, -0.0, 5e-324, f64::MAX, 1.0 / 3.0];
        let asked = |all: &Evaluations, of: &Vec<f64>| all.get(&("x", 1.1), &never, || of.clone());
        asked(&first, &numbers);
        first.get(&"nothing", &never, || None::<f64>);
        first.get(&"infinite", &never, || f64::INFINITY);
        first.get(&"cut", &|| true, || 1.0);
        first.scoped("finer").get(&("x", 1.1), &never, || 2.0);
        assert!(
            first
                .try_get(&"fault", &never, || Err::<f64, _>(Error::Usage("no".into())))
                .is_err()
        );
        let rows = rows.lock().unwrap_or_else(PoisonError::into_inner).clone();
        assert_eq!((rows.len(), first.counts()), (2, Counts { read: 0, stored: 2 }));
        let text: Vec<String> = rows.iter().map(|row| serde_json::to_string(row).unwrap()).collect();
        let again: Vec<JournalEvaluation> = text.iter().map(|row| serde_json::from_str(row).unwrap()).collect();
        let second = Evaluations::default();
        second.begin(again, Box::new(|_| Ok(())));
        let found = asked(&second, &vec![]);
        let bits = |all: &[f64]| all.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&found), bits(&numbers));
        assert_eq!(second.scoped("finer").get(&("x", 1.1), &never, || 0.0), 2.0);
        assert_eq!(second.counts(), Counts { read: 2, stored: 0 });
    }
}
