//! Cases made faulty by changing the text of good ones. Each test binary uses some of this.
#![allow(dead_code)]

use std::path::Path;

use slcbeam::case;
use slcbeam::error::{CaseError, Error};

/// Cases with every number written out, so that each can be made wrong.
pub const WIRING: &str = include_str!("../data/wiring-2.json");
pub const TOUR: &str = include_str!("../data/network-tour.json");

pub fn fault_of(text: &str) -> CaseError {
    match case::parse(text, Path::new("bad.json"), Path::new("cases"), &[]) {
        Err(Error::Case(fault)) => *fault,
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("taken for valid:\n{text}"),
    }
}

pub fn replaced(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    })
}

/// The only fault: its pointer, the marked text, and what is said.
pub fn only(text: &str) -> (String, String, String) {
    let fault = fault_of(text);
    let [violation] = fault.violations.as_slice() else {
        panic!("{}", case::render(&fault, false, 100))
    };
    let span = violation.span.clone().unwrap();
    (
        violation.pointer.clone(),
        fault.text[span].to_owned(),
        violation.what.clone(),
    )
}

pub fn one(changes: &[(&str, &str)]) -> (String, String, String) {
    only(&replaced(WIRING, changes))
}

#[track_caller]
pub fn assert_fault((pointer, marked, what): (String, String, String), at: &str, mark: &str, says: &str) {
    assert_eq!((pointer.as_str(), marked.as_str()), (at, mark), "{what}");
    assert!(what.contains(says), "{what}");
}
