//! Cases from JSON values, and runs of them to the end.

use std::path::Path;

use serde_json::Value;
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

/// A case that is expected to be sound.
pub fn parse(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// What a run to the end records.
pub fn finished(case: &Value) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let summary = dynamics::run(&parse(case), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}: {case}", summary.reason);
    (memory, summary)
}
