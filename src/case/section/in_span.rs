//! Values of spans whose section is given by its geometry.

use serde_json::{Value, json};
use slcbeam_section::input::Section;

use super::{KEY, ROUND_OFF, contradictions, read, unit_cell};
use crate::case::faults::{Violations, is_below};
use crate::case::numbers::rounded;
use crate::case::origins::Origin;
use crate::case::presets::Preset;
use crate::case::schema::{Span, SpanRows, whole_pitches};
use crate::case::{parameter, sets};
use crate::error::numbers::counted;
use crate::error::{Code, Violation};

/// Largest number of segments that a case may have.
const MOST: u64 = 1_000_000;

/// Values that the spans of a case have from sections of their own.
#[derive(Debug, Default)]
pub(in crate::case) struct SpanSections {
    known: Vec<SpanSection>,
    /// True if rows and numbers of segments of all sections are known and agree with those that the spans give.
    fitting: bool,
}

/// Values that a span has from its section.
#[derive(Debug)]
struct SpanSection {
    /// Pointer of the span.
    at: String,
    section: Section,
    /// Rows, number of segments, sizes, material and coefficients in the form of a span; without these last three if the section cannot be
    /// computed.
    values: Value,
    /// True if rows and number of segments agree with those that the span gives.
    fitting: bool,
    faults: Vec<Violation>,
}

/// True if a changed value at a pointer changes a section of a span, or the number of its segments.
pub(super) fn changes(pointer: &str) -> bool {
    let key = pointer.strip_prefix("/spans/").map(|rest| rest.split('/').nth(1));
    is_below("/spans", pointer) || key.is_some_and(|key| key.is_none_or(is_structural))
}

/// True for the keys of a span that determine its section and its number of segments.
fn is_structural(key: &str) -> bool {
    [KEY, "length_m", "segments"].contains(&key)
}

impl SpanSections {
    /// Values of the spans of a case. Unreadable sections have faults by the schema.
    pub fn new(case: &Value) -> Self {
        let spans = case.get("spans").and_then(Value::as_array);
        let given = spans.into_iter().flatten().enumerate();
        let given: Vec<_> = given.filter_map(|(k, span)| Some((k, span, span.get(KEY)?))).collect();
        let readable = given
            .iter()
            .filter_map(|(k, span, section)| Some((*k, *span, read(section, "").ok()?)));
        let lengths = if given.is_empty() { vec![] } else { lengths(case) };
        let length = |k: usize| lengths.get(k).copied().flatten();
        let known = readable.map(|(k, span, section)| SpanSection::new(span, k, section, length(k)));
        let known: Vec<_> = known.collect();
        let fitting = known.len() == given.len() && known.iter().all(|one| one.fitting);
        Self { known, fitting }
    }

    /// Marks the number of bladders of a case as doubtful if sections do not determine it.
    pub fn doubt(&self, faults: &mut Violations) {
        if !self.fitting {
            faults.doubt(super::PER_ROW);
        }
    }

    /// Adds rows and numbers of segments, on which the number of bladders depends.
    pub fn outline(&self, case: &mut Value) {
        for one in &self.known {
            let outline = ["rows", "segments"].map(|key| (key.to_owned(), one.values[key].clone()));
            let outline = outline.into_iter().filter(|(_, value)| !value.is_null());
            if let Some(span) = case.pointer_mut(&one.at) {
                add(span, Value::Object(outline.collect()));
            }
        }
    }

    /// Adds the values that the spans of a complete case do not give.
    pub fn fill(&self, case: &mut Value) {
        for one in &self.known {
            let mut values = one.complete(case);
            let has = |pointer: &str| {
                let number = case.pointer(pointer).and_then(Value::as_f64);
                number.is_some_and(|number| number != 0.0)
            };
            // a value that the case does not have is not the span's either
            for pointer in ["/beam/shear_stiffness_n", "/beam/mass_factor"] {
                if !has(pointer) {
                    sets::remove(&mut values, pointer);
                }
            }
            for pointer in [super::AXIS, OTHER_PRESSURE] {
                if values.pointer(pointer) == Some(&json!(0.0)) && !has(pointer) {
                    sets::remove(&mut values, pointer);
                }
            }
            if let Some(span) = case.pointer_mut(&one.at) {
                add(span, values);
            }
        }
    }

    /// Removes the values that a case, from the file of a result, has from the sections of this file.
    pub fn release(&self, case: &mut Value, file: &Value) {
        for one in &self.known {
            let values = one.complete(file);
            let mut pointers = vec!["/rows".to_owned(), "/segments".to_owned()];
            parameter::numbers(&values, String::new(), &mut pointers);
            for pointer in pointers {
                let at = format!("{}{pointer}", one.at);
                let given = file.pointer(&at).filter(|given| case.pointer(&at) == Some(*given));
                if case.pointer(&format!("{}/{KEY}", one.at)).is_some()
                    && given.is_some_and(|given| agree(given, values.pointer(&pointer)))
                {
                    sets::remove(case, &at);
                }
            }
        }
    }

    /// Reports the faults of the sections. Faults that the schema has found in a section take precedence.
    pub fn report(&self, faults: &mut Violations) {
        for one in &self.known {
            if !faults.any_below(&format!("{}/{KEY}", one.at)) {
                one.faults.iter().for_each(|fault| faults.push(fault.clone()));
            }
        }
    }

    /// Origins of the coefficients at some pointers within the spans of a complete case, of which `own` gives a part.
    pub fn origins(&self, own: &Value, whole: &Value, pointers: &[&str]) -> Vec<(String, Origin)> {
        let mut all = vec![];
        for one in &self.known {
            let (values, three_d) = (one.complete(whole), one.section.three_d);
            for pointer in pointers {
                let at = format!("{}{pointer}", one.at);
                let Some(value) = whole.pointer(&at).and(values.pointer(pointer)) else {
                    continue;
                };
                let given = own
                    .pointer(&at)
                    .filter(|given| !given.is_null() && !agree(given, Some(value)));
                all.push((at, given.map_or(Origin::Section { three_d }, |_| Origin::Case)));
            }
        }
        all
    }
}

/// Adds to `value` the members of `other` that it lacks or that are `null` there.
fn add(value: &mut Value, other: Value) {
    match (value, other) {
        (Value::Object(own), Value::Object(other)) => {
            for (key, other) in other {
                add(own.entry(key).or_insert(Value::Null), other);
            }
        }
        (value, other) if value.is_null() => *value = other,
        _ => {}
    }
}

/// Pointer of the area per pressure of the other row.
const OTHER_PRESSURE: &str = "/bladders/area_per_other_pressure_m2_per_pa";

/// True for the same value but for rounding.
fn agree(given: &Value, own: Option<&Value>) -> bool {
    let number = |of: &Value| of.as_f64();
    match number(given).zip(own.and_then(number)) {
        Some((given, own)) => (given - own).abs() <= ROUND_OFF * own.abs(),
        None => Some(given) == own,
    }
}

impl SpanSection {
    fn new(span: &Value, k: usize, section: Section, length: Option<f64>) -> Self {
        let at = format!("/spans/{k}");
        let own = format!("{at}/{KEY}");
        let (mut values, mut faults) = match of_span(&section, &own) {
            Ok((values, mut faults)) => {
                faults.extend(contradictions(span, &values, &at));
                (values, faults)
            }
            Err(faults) => (json!({}), faults),
        };
        let rows = unit_cell::rows(&section);
        values["rows"] = json!(rows);
        let mut misfits: Vec<Violation> = other_rows(span, &values["rows"], &at).into_iter().collect();
        let bladders = rows != SpanRows::None;
        if bladders && let Some(length) = length.filter(|length| *length > 0.0 && section.pitch_m > 0.0) {
            let found = whole_pitches(length, section.pitch_m);
            let (Ok(count) | Err(count)) = found;
            if count <= MOST {
                values["segments"] = count.into();
            }
            misfits.extend(misfit(span, length, section.pitch_m, found, &at));
        }
        let fitting = misfits.is_empty() && (!bladders || values["segments"].is_u64());
        // the pitch of an invalid section may be the cause
        if faults.iter().all(|fault| !is_below(&fault.pointer, &own)) {
            faults.extend(misfits);
        }
        Self {
            at,
            section,
            values,
            fitting,
            faults,
        }
    }

    /// Values with those that depend on the fluid of a case.
    fn complete(&self, case: &Value) -> Value {
        let mut values = self.values.clone();
        let density = case.pointer("/fluid/density_kg_m3").and_then(Value::as_f64);
        if let Some(factor) = unit_cell::mass_factor(&self.section, &values, density.unwrap_or(0.0)) {
            values["beam"]["mass_factor"] = factor.into();
        }
        values
    }
}

/// Values of a section at a pointer in the form of a span, and the faults of inaccurate ones. Values that vanish are written out, because
/// a span without them has those of the case.
fn of_span(section: &Section, at: &str) -> Result<(Value, Vec<Violation>), Vec<Violation>> {
    let (mut values, mut faults) = unit_cell::values(section, at)?;
    add(&mut values, json!({"beam": {"neutral_axis_m": 0.0}}));
    if let Some(bladders) = values.get_mut("bladders").and_then(Value::as_object_mut) {
        // the length of bladders is that of the case
        bladders.shift_remove("length_m");
        if bladders.shift_remove("lower").is_some_and(|lower| lower.is_object()) {
            let what = "a section of a span with rows that are not mirror images";
            let fault = Violation::new(Code::Together, format!("{at}/bladders/lower"), what);
            let fault =
                fault.allowed("\"mirrored\", or \"none\" for one of the rows, in regions that are mirrored too");
            faults.push(fault.hint("the values of a span are those of both rows; only /section may have unlike rows"));
        }
    }
    if unit_cell::rows(section) == SpanRows::Both {
        add(
            &mut values,
            json!({"bladders": {"area_per_other_pressure_m2_per_pa": 0.0}}),
        );
    }
    Ok((values, faults))
}

/// Length of each span of a case [m], if its lengths are readable.
fn lengths(case: &Value) -> Vec<Option<f64>> {
    let spans = Span::outlines(case);
    let preset = || case.get("preset").map(|_| Preset::MatiaGatBeam.values());
    let own = case.pointer("/beam/length_m").and_then(Value::as_f64);
    let total = own.or_else(|| preset()?.pointer("/beam/length_m")?.as_f64());
    match total {
        Some(total) => Span::lengths(&spans, total).into_iter().map(Some).collect(),
        None => spans.iter().map(|span| span.length_m).collect(),
    }
}

/// Fault of a span at a pointer that gives other rows than its section has.
fn other_rows(span: &Value, rows: &Value, at: &str) -> Option<Violation> {
    let given = span.get("rows").filter(|given| given.is_string() && *given != rows)?;
    let what = format!("{given}, but the section has bladders in {rows}");
    let fault = Violation::new(Code::Together, format!("{at}/rows"), what).allowed(rows.to_string());
    Some(fault.hint("leave it out: the section defines the rows"))
}

/// Fault of a span at a pointer whose length or number of segments is not that of whole pitches.
fn misfit(span: &Value, length: f64, pitch: f64, found: Result<u64, u64>, at: &str) -> Option<Violation> {
    let count = match found {
        Ok(count) => count,
        Err(_) => {
            let below = (length / pitch).floor();
            let nearest = [below, below + 1.0]
                .map(|count| count * pitch)
                .into_iter()
                .filter(|length| *length > 0.0);
            let nearest: Vec<String> = nearest.map(|length| rounded(length).to_string()).collect();
            let what = format!(
                "{} m is not a whole number of pitches of the section, {pitch} m",
                rounded(length)
            );
            let pointer = match span.get("length_m") {
                Some(_) => format!("{at}/length_m"),
                None => at.to_owned(),
            };
            let fault = Violation::new(Code::Geometry, pointer, what);
            let fault = fault.allowed(format!("multiples of {pitch} m; nearest {}", nearest.join(" or ")));
            let fault = fault.beside(&[&format!("{at}/section/pitch_m"), "/beam/length_m"]);
            return Some(fault.hint(format!("change the length of the span, or {at}/section/pitch_m")));
        }
    };
    let given = span
        .get("segments")
        .and_then(Value::as_u64)
        .filter(|given| *given != count)?;
    let what = format!(
        "{}, but {} m are {} of the section",
        counted(given, "segment"),
        rounded(length),
        counted(count, "pitch")
    );
    let fault = Violation::new(Code::Geometry, format!("{at}/segments"), what).allowed(count.to_string());
    Some(fault.hint("leave it out: the pitch of the section defines it"))
}
