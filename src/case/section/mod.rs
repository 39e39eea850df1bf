//! Coefficients of a case whose section is given by its geometry.

use serde_json::{Value, json};
use serde_path_to_error::Segment;
use slcbeam_section::error::Error;
use slcbeam_section::input::Section;

use super::faults::{SetValue, Violations, is_below};
use super::origins::Origin;
use super::presets::Preset;
use super::schema::{Span, SpanRows, segments_of_pitch};
use super::{computed, parameter, sets};
use crate::error::{Code, Violation};

mod file;
mod in_span;
mod neutral_axis;
mod unit_cell;

pub use file::{SectionFile, parse};
pub(super) use file::{is_one, no_case};
pub(super) use in_span::SpanSections;
pub(super) use unit_cell::rows;

/// Key of the section in a case.
const KEY: &str = "section";
/// Pointer of the section in a case.
const AT: &str = "/section";
/// Pointer of the energy at finite strain.
const ENERGY: &str = "/bladders/strain_energy";
/// Pointer of the lower row.
const LOWER: &str = "/bladders/lower";
/// Pointer of the neutral axis.
const AXIS: &str = "/beam/neutral_axis_m";
/// Pointer of the number of bladders per row.
const PER_ROW: &str = "/bladders/per_row";
/// Pointer of the same number in the case of a result.
const SEGMENTS: &str = "/mesh/segments";
/// Largest relative difference of a size that is given twice.
const ROUND_OFF: f64 = 1e-9;

/// Values that a case may repeat beside its section, but not change.
pub(super) const SIZES: [&str; 7] = [
    "/beam/height_m",
    "/beam/width_m",
    "/beam/young_modulus_pa",
    "/beam/density_kg_m3",
    "/bladders/length_m",
    "/bladders/width_m",
    "/bladders/height_m",
];

/// Faults of a section at a pointer.
fn violations(error: Error, at: &str) -> Vec<Violation> {
    match error {
        Error::Section(faults) => faults
            .into_iter()
            .map(|fault| Violation::new(Code::Range, format!("{at}{}", fault.place), fault.what))
            .collect(),
        other => vec![Violation::new(Code::Range, at, other.to_string())],
    }
}

/// Values that a section adds to its case.
#[derive(Debug)]
pub(super) struct SectionValues {
    /// Dimensions, material and coefficients in the form of a case. If the section cannot be computed, those of a preset, so that the rest
    /// of the case can be checked.
    pub values: Value,
    /// True for values from the cell in three dimensions.
    three_d: bool,
    stands_in: bool,
    faults: Vec<Violation>,
}

/// Returns the values of the section of a case, if it has one.
pub(super) fn computed_values(case: &Value) -> Option<SectionValues> {
    let given = case.get(KEY).filter(|given| given.is_object())?;
    let found = read(given, AT).map_err(|violation| vec![*violation]);
    let found = found.and_then(|section| Ok((values(case, &section)?, section.three_d)));
    Some(match found {
        Ok((values, three_d)) => SectionValues {
            faults: contradictions(case, &values, "")
                .into_iter()
                .chain(other_lower_row(case, &values))
                .collect(),
            values,
            three_d,
            stands_in: false,
        },
        Err(faults) => SectionValues {
            values: stand_in(case),
            three_d: false,
            stands_in: true,
            faults,
        },
    })
}

/// True if arguments change a section of a case, or a length that determines the number of bladders.
pub(super) fn changes(sets: &[SetValue]) -> bool {
    sets.iter().any(|set| {
        let at = &set.pointer;
        is_below(at, AT) || is_below("/beam/length_m", at) || in_span::changes(at)
    })
}

/// Removes the values that a case, from the file of a result, has from its sections: a changed section or length supplies new ones.
pub(super) fn release(case: &mut Value, file: &Value) {
    SpanSections::new(file).release(case, file);
    if !case.get(KEY).is_some_and(Value::is_object) {
        return;
    }
    let Some(brought) = computed_values(file).filter(|brought| !brought.stands_in) else {
        return;
    };
    let mut pointers = vec![PER_ROW.to_owned()];
    parameter::numbers(&brought.values, String::new(), &mut pointers);
    let same = |pointer: &str| {
        file.pointer(pointer)
            .filter(|given| case.pointer(pointer) == Some(*given))
    };
    let of_section = |pointer: &String| same(pointer).is_some_and(|given| brought.gives(pointer, given));
    let mut released: Vec<String> = pointers.into_iter().filter(of_section).collect();
    if released.iter().any(|p| p == PER_ROW) && same(SEGMENTS) == file.pointer(PER_ROW) {
        released.push(SEGMENTS.into());
    }
    if same(LOWER).is_some_and(|given| brought.values.pointer(LOWER) == Some(given)) {
        released.push(LOWER.into());
    }
    let energy = file
        .get(KEY)
        .and_then(|section| computed::strain_energy(&read(section, AT).ok()?).ok()?);
    if energy.is_some_and(|energy| same(ENERGY) == Some(&computed::written(&energy))) {
        released.push(ENERGY.into());
    }
    released.iter().for_each(|pointer| sets::remove(case, pointer));
}

impl SectionValues {
    /// True if the values are those of a preset.
    pub(super) fn stands_in(&self) -> bool {
        self.stands_in
    }

    /// Marks preset values in a case `own` as doubtful, so that nothing is compared with them.
    pub(super) fn doubt(&self, own: &Value, faults: &mut Violations) {
        if self.stands_in {
            // the number of bladders is valid, because it follows from the pitch
            let pitched = !self.faults.iter().any(|fault| is_below(&fault.pointer, PITCH));
            let doubted = self.in_place(own).into_iter();
            let doubted = doubted.filter(|pointer| pointer != PER_ROW || !pitched);
            doubted.for_each(|pointer| faults.doubt(pointer));
        }
    }

    /// Pointers of the values that a case `own` does not give itself.
    fn in_place(&self, own: &Value) -> Vec<String> {
        let mut at = vec![];
        parameter::numbers(&self.values, String::new(), &mut at);
        at.retain(|pointer| own.pointer(pointer).is_none());
        at
    }

    /// True if a number of the case at a pointer is the section's, as in the case of a result.
    pub(super) fn gives(&self, pointer: &str, number: &Value) -> bool {
        let own = self.values.pointer(pointer).and_then(Value::as_f64);
        let pair = own.zip(number.as_f64());
        !self.stands_in && pair.is_some_and(|(own, given)| (given / own - 1.0).abs() <= ROUND_OFF)
    }

    /// Origin of the values.
    pub(super) fn origin(&self) -> Origin {
        Origin::Section { three_d: self.three_d }
    }

    /// Reports the faults of the section of a case `own`, and drops those of preset values. Faults that the schema has found in the section
    /// take precedence.
    pub(super) fn report(&self, own: &Value, faults: &mut Violations) {
        if self.stands_in {
            let mut at = self.in_place(own);
            at.push("/bladders".into());
            faults.drop_below(&at);
            if faults.any_below(AT) {
                return;
            }
        }
        self.faults.iter().for_each(|violation| faults.push(violation.clone()));
    }
}

/// Dimensions and material of a case or of one of its spans, at a pointer, that differ from those of its section.
fn contradictions(given: &Value, values: &Value, at: &str) -> Vec<Violation> {
    let number = |of: &Value, pointer: &str| of.pointer(pointer).and_then(Value::as_f64);
    let contradictions = SIZES.into_iter().filter_map(|pointer| {
        let (given, own) = (given.pointer(pointer)?, number(values, pointer)?);
        let hint = "leave it out: the section defines it, and its coefficients are computed for that value";
        let fault = |what: String| {
            let fault = Violation::new(
                Code::Range,
                format!("{at}{pointer}"),
                format!("{what}, but the section has {own}"),
            );
            fault.allowed(own.to_string()).hint(hint)
        };
        match given {
            Value::Number(_) => {
                let given = given.as_f64()?;
                ((given / own - 1.0).abs() > ROUND_OFF).then(|| fault(given.to_string()))
            }
            Value::Object(_) if !at.is_empty() => Some(fault("a function of the place".to_owned())),
            _ => None,
        }
    });
    let axis = given.pointer(AXIS).filter(|given| {
        let own = number(values, AXIS).unwrap_or(0.0);
        let differs = |given: f64| (given - own).abs() > ROUND_OFF * own.abs();
        given.as_f64().map_or(given.is_object(), differs)
    });
    let axis = axis.map(|given| {
        let what = format!("{given}, which is not the neutral axis of the section");
        let fault = Violation::new(Code::Range, format!("{at}{AXIS}"), what);
        fault.hint("leave it out; reference_axis_m moves the line of ends and loads")
    });
    contradictions.chain(axis).collect()
}

/// Fault of a lower row of a case that is not that of its section.
fn other_lower_row(case: &Value, values: &Value) -> Option<Violation> {
    let mirrored = json!("mirrored");
    let own = values.pointer(LOWER).unwrap_or(&mirrored);
    let given = case.pointer(LOWER);
    given.filter(|given| *given != own && values.get("bladders").is_some())?;
    let fault = Violation::new(Code::Range, LOWER, "the section defines the lower row");
    Some(fault.hint("leave it out; change /section/bladders/lower"))
}

/// Reads a section at a pointer of its file.
fn read(value: &Value, at: &str) -> std::result::Result<Section, Box<Violation>> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().iter().filter_map(|segment| match segment {
            Segment::Map { key } => Some(key.clone()),
            Segment::Seq { index } => Some(index.to_string()),
            _ => None,
        });
        let pointer = std::iter::once(at.to_owned()).chain(path).collect::<Vec<_>>().join("/");
        Box::new(Violation::new(Code::Kind, pointer, error.inner().to_string()))
    })
}

/// Removes the sections from a case.
pub(super) fn remove(case: &mut Value) {
    let remove = |from: &mut Value| from.as_object_mut().map(|from| from.shift_remove(KEY));
    remove(case);
    let spans = case.get_mut("spans").and_then(Value::as_array_mut);
    spans.into_iter().flatten().for_each(|span| {
        remove(span);
    });
}

/// Values of a preset that replace those of a section.
fn stand_in(case: &Value) -> Value {
    let mut preset = Preset::MatiaGatBeam.values();
    if let Some(beam) = preset["beam"].as_object_mut() {
        beam.shift_remove("length_m");
    }
    let pitch = case.pointer(PITCH).and_then(Value::as_f64);
    let number = pitch
        .filter(|pitch| *pitch > 0.0)
        .and_then(|pitch| per_row(case, pitch).ok());
    preset["bladders"]["per_row"] = number.into();
    json!({"beam": preset["beam"], "bladders": preset["bladders"]})
}

/// Values that a case takes from its section.
fn values(case: &Value, section: &Section) -> std::result::Result<Value, Vec<Violation>> {
    let (mut values, mut faults) = unit_cell::values(section, AT)?;
    let fault = |place: &str, what: String| Violation::new(Code::Range, format!("{AT}{place}"), what);
    if unit_cell::rows(section) == SpanRows::Lower {
        let what = "only the lower row has bladders".to_owned();
        faults.push(fault("/bladders/upper", what).hint("turn the section over: describe the row as the upper one"));
    } else if values.get("bladders").is_some() {
        // an energy that the case gives, as that of a result does, or omits by null is not computed
        let given = |energy: &Value| energy.is_null() || energy.get("coefficients_n").is_some();
        if !case.pointer(ENERGY).is_some_and(given) {
            let energy = computed::strain_energy(section).map_err(|error| violations(error, AT))?;
            energy
                .iter()
                .for_each(|energy| values["bladders"]["strain_energy"] = computed::written(energy));
        }
        match per_row(case, section.pitch_m) {
            Ok(number) => values["bladders"]["per_row"] = number.into(),
            Err(what) => {
                let fault = match case.pointer(PER_ROW) {
                    Some(_) => Violation::new(Code::Range, PER_ROW, what).beside(&["/beam/length_m", PITCH]),
                    None => fault("/pitch_m", what).beside(&["/beam/length_m"]),
                };
                faults.push(fault.hint("/beam/length_m is a whole number of pitches"));
            }
        }
    }
    if faults.is_empty() { Ok(values) } else { Err(faults) }
}

/// Pointer of the length of a cell.
const PITCH: &str = "/section/pitch_m";

/// Number of segments, of which those without a number of their own have this pitch [m].
fn per_row(case: &Value, pitch: f64) -> std::result::Result<u64, String> {
    let Some(length) = case.pointer("/beam/length_m").and_then(Value::as_f64) else {
        return Ok(1000);
    };
    let given = case.pointer(PER_ROW).and_then(Value::as_f64);
    segments_of_pitch(&Span::outlines(case), length, given, pitch)
}
