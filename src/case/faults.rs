//! Violations as they are collected: by pointer first, placed in the text at the end.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::locate::{Node, Place, tokens};
use crate::error::{CaseError, Code, Error, Violation};

/// What a fault points at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mark {
    Value,
    Key,
}

/// All faults found so far.
#[derive(Debug, Default)]
pub struct Violations {
    list: Vec<(Violation, Mark)>,
    /// Those found after so many that nobody reads them: counted, not kept.
    more: usize,
    unknown_keys: Vec<String>,
    /// Objects in which a key is a slip of one that is known: what these lack is no fault of their own.
    slipped: HashSet<String>,
    overfull: bool,
    /// Whether [`Code::Implausible`] is no fault.
    all_plausible: bool,
    /// Values that are not what was meant, beside those with faults.
    unsound: Vec<String>,
}

impl Violations {
    /// Adds a fault in a value.
    pub fn push(&mut self, violation: Violation) {
        self.keep(violation, Mark::Value);
    }

    /// Adds the fault that a value does not go with others, unless it has one already or one of these has: then that is the cause, and
    /// limits computed from it are nonsense.
    pub fn push_beside(&mut self, parts: &[&str], violation: Violation) {
        if self.are_sound(parts) && self.are_sound(&[violation.pointer.as_str()]) {
            self.push(violation.beside(parts));
        }
    }

    /// Whether values are what was meant, as far as is known.
    pub fn are_sound(&self, parts: &[&str]) -> bool {
        let below = |found: &str| parts.iter().any(|part| is_below(found, part));
        !self.list.iter().any(|(fault, _)| below(&fault.pointer)) && !self.unsound.iter().any(|at| below(at))
    }

    /// From now on takes no value at a pointer as meant.
    pub fn doubt(&mut self, pointer: impl Into<String>) {
        self.unsound.push(pointer.into());
    }

    /// From now on takes every size as meant.
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

    /// Whether what comes now is no longer told in words.
    pub fn is_full(&self) -> bool {
        self.list.len() >= MOST
    }

    /// Adds the fault that an array has more entries than are looked at.
    pub fn push_overfull(&mut self, violation: Violation) {
        self.overfull = true;
        self.push(violation);
    }

    /// Whether there is more in the case than is looked at.
    pub fn is_overfull(&self) -> bool {
        self.overfull
    }

    /// Adds a fault in the key of a value, or in something missing from it.
    pub fn push_at_key(&mut self, violation: Violation) {
        self.keep(violation, Mark::Key);
    }

    /// Adds the fault that a key is not known.
    pub fn push_unknown_key(&mut self, violation: Violation) {
        self.unknown_keys.push(violation.pointer.clone());
        self.push_at_key(violation);
    }

    /// From now on takes what the object around a pointer lacks for what follows from the key at this pointer.
    pub fn slip(&mut self, pointer: &str) {
        let around = pointer.rsplit_once('/').map_or("", |(around, _)| around);
        self.slipped.insert(around.to_owned());
    }

    /// Whether a key was found not to be known.
    pub fn is_unknown_key(&self, pointer: &str) -> bool {
        self.unknown_keys.iter().any(|known| known == pointer)
    }

    /// Takes the members with unknown keys out of the value, so that the rest can be looked at.
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

    /// How many were found.
    pub fn count(&self) -> usize {
        self.list.len() + self.more
    }

    /// Nothing found.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Drops faults at or below the given pointers: those already have one.
    pub fn drop_below(&mut self, pointers: &[String]) {
        self.list
            .retain(|(fault, _)| !pointers.iter().any(|p| is_below(&fault.pointer, p)));
    }

    /// Whether a fault stands at or below a pointer.
    pub fn any_below(&self, pointer: &str) -> bool {
        self.list.iter().any(|(fault, _)| is_below(&fault.pointer, pointer))
    }

    /// All faults with their places, in the order of the text; of very many the first, and how many there are besides.
    pub fn placed(self, source: &Source) -> Vec<Violation> {
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

/// Violations that are told at once.
const MOST: usize = 1000;

/// Orders faults as the text does; those in `--set` arguments behind them, and what has no place last.
pub fn sort(faults: &mut [Violation]) {
    faults.sort_by_key(|fault| {
        let start = fault.span.as_ref().map_or(0, |span| span.start);
        (fault.span.is_none(), fault.set.is_some(), start)
    });
}

/// Whether `pointer` leads to what `ancestor` leads to, or into it.
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
    /// The pointer; for a value added to the end of an array, with its index.
    pub pointer: String,
    /// Bytes of the argument at which the JSON text starts.
    pub json_at: usize,
    /// The value with places in the JSON text; none when the member is removed.
    pub node: Option<Node>,
}

/// Where the parts of a case were written: in the file or on the command line. No part of what a case is: two cases with the
/// same numbers are equal wherever they were written.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// Where the text came from.
    pub path: PathBuf,
    /// The text.
    pub text: String,
    /// The text with places.
    pub file: Option<Node>,
    /// The `--set` arguments in order.
    pub sets: Vec<SetValue>,
}

impl PartialEq for Source {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Source {
    /// A text of which nothing is known yet.
    pub fn of(path: &Path, text: &str) -> Self {
        Self {
            path: path.to_owned(),
            text: text.to_owned(),
            ..Self::default()
        }
    }

    /// The error that reports faults which have their places.
    pub fn error(&self, violations: Vec<Violation>) -> Error {
        Error::Case(Box::new(CaseError {
            path: self.path.clone(),
            text: self.text.clone(),
            violations,
        }))
    }

    /// The error that reports faults found after reading, each placed by its pointer.
    pub fn fault(&self, faults: Vec<Violation>) -> Error {
        let mut violations: Vec<_> = faults.into_iter().map(|fault| self.place(fault, Mark::Value)).collect();
        sort(&mut violations);
        self.error(violations)
    }

    fn has_preset(&self) -> bool {
        self.file.as_ref().is_some_and(|node| node.place("/preset").is_some())
    }

    /// The argument that made a fault, and what of the case it set: the last that set the value, or something around it; or a value
    /// that it does not go with; or, of a section, whose shapes are faulty as a whole, something inside it.
    fn changed(&self, fault: &Violation) -> Option<(&SetValue, String)> {
        let around = |pointer: &str| self.sets.iter().rev().find(|set| is_below(pointer, &set.pointer));
        let all = std::iter::once(&fault.pointer).chain(&fault.beside);
        let found = all
            .into_iter()
            .find_map(|pointer| Some((around(pointer)?, pointer.clone())));
        found.or_else(|| {
            let inside = |set: &&SetValue| is_below(&set.pointer, &fault.pointer);
            let of_section = fault.pointer.starts_with("/section/");
            let set = self.sets.iter().rev().filter(|_| of_section).find(inside)?;
            Some((set, set.pointer.clone()))
        })
    }

    fn place(&self, fault: Violation, mark: Mark) -> Violation {
        if fault.span.is_some() {
            return fault;
        }
        let span_of = |place: Place| match (mark, place.key) {
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
            // Not in the file: an object that a `--set` argument made.
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
                    // What neither the file nor an argument has comes from the preset.
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
