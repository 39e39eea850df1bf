//! Collection of violations: first located by pointer, at the end placed in the text.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::locate::{JsonNode, JsonPlace, tokens};
use crate::error::{CaseError, Code, Error, Violation};

/// Part of a member at which a fault is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mark {
    Value,
    Key,
}

/// All faults found so far.
#[derive(Debug, Default)]
pub struct Violations {
    list: Vec<(Violation, Mark)>,
    /// Number of faults beyond the limit; these are counted, not stored.
    more: usize,
    unknown_keys: Vec<String>,
    /// Objects with a misspelled key; keys that these objects lack are not faults of their own.
    slipped: HashSet<String>,
    overfull: bool,
    /// True if [`Code::Implausible`] is not a fault.
    all_plausible: bool,
    /// Pointers of doubtful values, in addition to those with faults.
    unsound: Vec<String>,
}

impl Violations {
    /// Adds a fault in a value.
    pub fn push(&mut self, violation: Violation) {
        self.keep(violation, Mark::Value);
    }

    /// Adds the fault that a value contradicts other values, unless the value or one of the others already has a fault. That fault is then
    /// the cause, and limits computed from it are meaningless.
    pub fn push_beside(&mut self, parts: &[&str], violation: Violation) {
        if self.are_sound(parts) && self.are_sound(&[violation.pointer.as_str()]) {
            self.push(violation.beside(parts));
        }
    }

    /// True if no value at or below the pointers has a fault or is doubtful.
    pub fn are_sound(&self, parts: &[&str]) -> bool {
        let below = |found: &str| parts.iter().any(|part| is_below(found, part));
        !self.list.iter().any(|(fault, _)| below(&fault.pointer)) && !self.unsound.iter().any(|at| below(at))
    }

    /// Marks the value at a pointer as doubtful.
    pub fn doubt(&mut self, pointer: impl Into<String>) {
        self.unsound.push(pointer.into());
    }

    /// From now on, accepts every size as plausible.
    pub fn take_as_meant(&mut self) {
        self.all_plausible = true;
    }

    fn keep(&mut self, violation: Violation, mark: Mark) {
        if self.all_plausible && violation.code == Code::Implausible {
            return;
        }
        if self.is_full() {
            self.more += 1;
        } else {
            self.list.push((violation, mark));
        }
    }

    /// Adds the faults of a part of the case at their pointers in the whole; those without one are left out.
    pub fn take_in(&mut self, part: Self, whole: impl Fn(&str) -> Option<String>) {
        for (fault, mark) in part.list {
            if let Some(pointer) = whole(&fault.pointer) {
                self.keep(Violation { pointer, ..fault }, mark);
            }
        }
    }

    /// Replaces the pointers of faults for which `new` gives another one.
    pub fn rename(&mut self, new: impl Fn(&str) -> Option<String>) {
        for (fault, _) in &mut self.list {
            if let Some(pointer) = new(&fault.pointer) {
                fault.pointer = pointer;
            }
        }
    }

    /// True if further faults are counted, not stored.
    pub fn is_full(&self) -> bool {
        self.list.len() >= MOST
    }

    /// Adds the fault that the case has more entries than are checked.
    pub fn push_overfull(&mut self, violation: Violation) {
        self.overfull = true;
        self.push(violation);
    }

    /// True if the case has more entries than are checked.
    pub fn is_overfull(&self) -> bool {
        self.overfull
    }

    /// Adds a fault in the key of a value, or in something missing from it.
    pub fn push_at_key(&mut self, violation: Violation) {
        self.keep(violation, Mark::Key);
    }

    /// Adds the fault of an unknown key.
    pub fn push_unknown_key(&mut self, violation: Violation) {
        self.unknown_keys.push(violation.pointer.clone());
        self.push_at_key(violation);
    }

    /// Records a misspelled key: keys that its object lacks are attributed to it.
    pub fn slip(&mut self, pointer: &str) {
        let around = pointer.rsplit_once('/').map_or("", |(around, _)| around);
        self.slipped.insert(around.to_owned());
    }

    /// True if a key was found to be unknown.
    pub fn is_unknown_key(&self, pointer: &str) -> bool {
        self.unknown_keys.iter().any(|known| known == pointer)
    }

    /// Removes the members with unknown keys from a value, so that the rest can be checked.
    pub fn remove_unknown_keys(&self, value: &mut Value) {
        let mut by_parent: HashMap<&str, HashSet<String>> = HashMap::new();
        for pointer in &self.unknown_keys {
            if let (Some((parent, _)), Some(key)) = (pointer.rsplit_once('/'), tokens(pointer).last()) {
                by_parent.entry(parent).or_default().insert(key);
            }
        }
        for (parent, keys) in by_parent {
            if let Some(Value::Object(members)) = value.pointer_mut(parent) {
                members.retain(|key, _| !keys.contains(key));
            }
        }
    }

    /// Number of faults found.
    pub fn count(&self) -> usize {
        self.list.len() + self.more
    }

    /// True if no fault was found.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// First fault.
    pub fn first(&self) -> Option<&Violation> {
        self.list.first().map(|(fault, _)| fault)
    }

    /// Drops faults at or below the given pointers, which already have a fault.
    pub fn drop_below(&mut self, pointers: &[String]) {
        self.list
            .retain(|(fault, _)| !pointers.iter().any(|p| is_below(&fault.pointer, p)));
    }

    /// Adds a fault unless another one has the same cause in its text.
    pub fn push_once(&mut self, cause: &str, violation: Violation) {
        if !self.list.iter().any(|(fault, _)| fault.what.contains(cause)) {
            self.push(violation);
        }
    }

    /// True if a fault is at or below a pointer.
    pub fn any_below(&self, pointer: &str) -> bool {
        self.list.iter().any(|(fault, _)| is_below(&fault.pointer, pointer))
    }

    /// Returns all faults with their places, in the order of the text. Of very many, returns the first ones and the number of the others.
    pub fn placed(self, source: &CaseSource) -> Vec<Violation> {
        let more = self.more;
        let slipped = self.slipped;
        let follows = |fault: &Violation, mark: Mark| mark == Mark::Value && slipped.contains(&fault.pointer);
        let mut placed: Vec<_> = self
            .list
            .into_iter()
            .filter(|(fault, mark)| !follows(fault, *mark))
            .map(|(fault, mark)| source.place(fault, mark))
            .collect();
        sort(&mut placed);
        placed.dedup();
        if more > 0 {
            let code = placed.last().map_or(Code::Text, |last| last.code);
            placed.push(Violation::new(code, "", format!("and {more} more faults")));
        }
        placed
    }
}

/// Largest number of violations reported at once.
const MOST: usize = 1000;

/// Sorts faults in the order of the text, then those in `--set` arguments, then those without a place.
pub fn sort(faults: &mut [Violation]) {
    faults.sort_by_key(|fault| {
        let start = fault.span.as_ref().map_or(0, |span| span.start);
        (fault.span.is_none(), fault.set.is_some(), start)
    });
}

/// True if `pointer` equals `ancestor` or is below it.
pub fn is_below(pointer: &str, ancestor: &str) -> bool {
    pointer
        .strip_prefix(ancestor)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// A value set on the command line.
#[derive(Clone, Debug)]
pub struct SetValue {
    /// The argument, `POINTER=JSON`.
    pub argument: String,
    /// The pointer; with its index for a value appended to an array.
    pub pointer: String,
    /// Byte offset of the JSON text in the argument.
    pub json_at: usize,
    /// The value with places in the JSON text; none if the argument removes the member.
    pub node: Option<JsonNode>,
}

/// Places where the parts of a case were written: in the file or on the command line. They are not part of the case: two cases with the
/// same numbers are equal wherever they were written.
#[derive(Clone, Debug, Default)]
pub struct CaseSource {
    /// Path of the text.
    pub path: PathBuf,
    /// The text.
    pub text: String,
    /// The parsed text with places.
    pub file: Option<JsonNode>,
    /// The `--set` arguments in order.
    pub sets: Vec<SetValue>,
}

impl PartialEq for CaseSource {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl CaseSource {
    /// Creates a source from an unparsed text.
    pub fn new(path: &Path, text: &str) -> Self {
        Self {
            path: path.to_owned(),
            text: text.to_owned(),
            ..Self::default()
        }
    }

    /// Creates the error that reports already placed faults.
    pub fn error(&self, violations: Vec<Violation>) -> Error {
        Error::Case(Box::new(CaseError {
            path: self.path.clone(),
            text: self.text.clone(),
            violations,
        }))
    }

    /// Creates the error that reports faults found after reading, each placed by its pointer.
    pub fn fault(&self, faults: Vec<Violation>) -> Error {
        let mut violations: Vec<_> = faults.into_iter().map(|fault| self.place(fault, Mark::Value)).collect();
        sort(&mut violations);
        self.error(violations)
    }

    fn has_preset(&self) -> bool {
        self.file.as_ref().is_some_and(|node| node.place("/preset").is_some())
    }

    /// Returns the `--set` argument that caused a fault, and the pointer of the value that it set. Candidates, in this order: the last
    /// argument at or above the value, one at or above a value that the fault compares with, and, for a section, one inside it.
    fn changed(&self, fault: &Violation) -> Option<(&SetValue, String)> {
        let around = |pointer: &str| self.sets.iter().rev().find(|set| is_below(pointer, &set.pointer));
        let all = std::iter::once(&fault.pointer).chain(&fault.beside);
        let found = all
            .into_iter()
            .find_map(|pointer| Some((around(pointer)?, pointer.clone())));
        found.or_else(|| {
            let inside = |set: &&SetValue| is_below(&set.pointer, &fault.pointer);
            let of_section = fault.pointer.starts_with("/section/") || fault.pointer.starts_with("/spans/");
            let set = self.sets.iter().rev().filter(|_| of_section).find(inside)?;
            Some((set, set.pointer.clone()))
        })
    }

    fn place(&self, fault: Violation, mark: Mark) -> Violation {
        if fault.span.is_some() {
            return fault;
        }
        let span_of = |place: JsonPlace| match (mark, place.key) {
            (Mark::Key, Some(key)) => key,
            // An object or array is shown by its opening bracket only.
            (Mark::Key, None) => place.value.start..place.value.start + 1,
            (Mark::Value, _) => place.value,
        };
        if let Some((set, pointer)) = self.changed(&fault) {
            let inner = set
                .node
                .as_ref()
                .and_then(|node| node.place(pointer.get(set.pointer.len()..)?));
            let span = match inner {
                Some(place) if pointer != set.pointer || mark == Mark::Value => {
                    let span = span_of(place);
                    set.json_at + span.start..set.json_at + span.end
                }
                _ => 0..set.json_at.saturating_sub(1),
            };
            return Violation {
                set: Some(set.argument.clone()),
                span: Some(span),
                ..fault
            };
        }
        let mut pointer = fault.pointer.as_str();
        loop {
            let from_preset = pointer.is_empty() && fault.pointer.len() > 1 && self.has_preset();
            if let Some(place) = self
                .file
                .as_ref()
                .and_then(|node| node.place(pointer))
                .filter(|_| !from_preset)
            {
                let exact = pointer == fault.pointer;
                let span = if exact {
                    span_of(place)
                } else {
                    place.key.unwrap_or(place.value)
                };
                return Violation {
                    span: Some(span),
                    ..fault
                };
            }
            // Not in the file: an object that a `--set` argument created.
            if let Some(set) = self.sets.iter().rev().find(|set| is_below(&set.pointer, pointer)) {
                let span = Some(0..set.json_at.saturating_sub(1));
                return Violation {
                    set: Some(set.argument.clone()),
                    span,
                    ..fault
                };
            }
            match pointer.rfind('/') {
                Some(end) => pointer = &pointer[..end],
                None => {
                    // A value in neither the file nor an argument is from the preset.
                    let preset = self.file.as_ref().and_then(|node| node.place("/preset"));
                    return Violation {
                        span: Some(preset.map_or(0..0, |p| p.value)),
                        ..fault
                    };
                }
            }
        }
    }
}
