//! A section in a file of its own, or in that of a case.

use std::path::Path;

use serde_json::Value;
use slcbeam_section::coefficients::Coefficients;
use slcbeam_section::error::Error;
use slcbeam_section::finite::StrainEnergy;
use slcbeam_section::finite::inflation::Inflation;
use slcbeam_section::input::Section;
use slcbeam_section::three::Spatial;

use super::{AT, KEY, read, violations};
use crate::case::faults::{CaseSource, Violations};
use crate::case::{computed, parse as json, schema_json, sets, validate};
use crate::error::{Code, Result, Violation};

/// A section read from a file.
#[derive(Debug)]
pub struct SectionFile {
    /// The section.
    pub section: Section,
    source: CaseSource,
    at: String,
}

impl SectionFile {
    /// Coefficients of the section.
    ///
    /// # Errors
    /// [`crate::error::Error::Case`] with every rule that it violates, or the reason why its cell has no solution.
    pub fn coefficients(&self) -> Result<Coefficients> {
        self.solved(computed::coefficients(&self.section))
    }

    /// Energy of the section at finite strain, if its material has a law.
    ///
    /// # Errors
    /// As [`Self::coefficients`].
    pub fn strain_energy(&self) -> Result<Option<StrainEnergy>> {
        self.solved(computed::strain_energy(&self.section))
    }

    /// Growths of the section at finite strain under pressures of the upper row [Pa].
    ///
    /// # Errors
    /// As [`Self::coefficients`], and a material without law.
    pub fn inflation(&self, pressures: &[f64]) -> Result<Inflation> {
        let found = self.solved(self.section.inflate(pressures))?;
        found.ok_or_else(|| {
            let what = "--inflate needs a law of the material at finite strain";
            let fault = Violation::new(Code::Missing, format!("{}/material/law", self.at), what);
            self.source.fault(vec![fault.allowed(
                "\"neo_hookean\", {\"mooney_rivlin\": ..}, {\"yeoh\": ..}, or a preset of a material that has a law",
            )])
        })
    }

    /// Compliance of the section by the cell in three dimensions.
    ///
    /// # Errors
    /// As [`Self::coefficients`].
    pub fn three_dimensional(&self) -> Result<Spatial> {
        self.solved(self.section.three_dimensional())
    }

    /// Values of `beam` and `bladders` in a case whose beam has a length [m].
    ///
    /// # Errors
    /// As [`Self::coefficients`].
    pub fn values(&self, length: f64) -> Result<Value> {
        let case = serde_json::json!({"beam": {"length_m": length}});
        super::values(&case, &self.section).map_err(|faults| self.source.fault(faults))
    }

    fn solved<T>(&self, found: std::result::Result<T, Error>) -> Result<T> {
        found.map_err(|error| self.source.fault(violations(error, &self.at)))
    }
}

/// Reads a section from the text of its own file, or of a case that has one; with the number of a span, that of the span.
///
/// # Errors
/// [`crate::error::Error::Case`] with the unreadable parts.
pub fn parse(text: &str, path: &Path, sets: &[String], span: Option<usize>) -> Result<SectionFile> {
    let source = CaseSource::new(path, text);
    let (file, violations) = json::parse(text);
    let Some(file) = file.filter(|_| violations.is_empty()) else {
        return Err(source.error(violations));
    };
    let mut value = file.to_value();
    let source = CaseSource {
        sets: sets::apply(&mut value, sets)?,
        file: Some(file),
        ..source
    };
    let of_case = value.get(KEY).is_some();
    let at = match span {
        Some(span) => format!("/spans/{span}/{KEY}"),
        None if of_case => AT.to_owned(),
        None => String::new(),
    };
    if value.pointer(&at).is_none() || (at.is_empty() && value.get("ends").is_some()) {
        return Err(source.fault(vec![without_section(&value, span)]));
    }
    let schema = schema_json::section(of_case, span.is_some());
    let mut faults = Violations::default();
    validate::validate(&value, &value, &schema, &mut faults);
    match value.pointer(&at).map(|section| read(section, &at)) {
        Some(Ok(section)) if faults.is_empty() => return Ok(SectionFile { section, source, at }),
        Some(Err(violation)) if !faults.any_below(&at) => faults.push(*violation),
        _ => {}
    }
    Err(source.error(faults.placed(&source)))
}

/// Fault of a case without section, or of a span without section.
fn without_section(case: &Value, span: Option<usize>) -> Violation {
    let spans = case.get("spans").and_then(Value::as_array);
    let own = spans
        .into_iter()
        .flatten()
        .enumerate()
        .filter(|(_, span)| span.get(KEY).is_some());
    let own: Vec<String> = own.map(|(k, _)| k.to_string()).collect();
    let own = (!own.is_empty()).then(|| own.join(", "));
    match (span, own) {
        (Some(span), own) => {
            let fault = Violation::new(Code::Missing, "/spans", format!("span {span} has no section"));
            let allowed = own.map_or_else(|| "no span has a section".to_owned(), |own| format!("--span {own}"));
            fault.allowed(allowed)
        }
        (None, Some(own)) => {
            let fault = Violation::new(Code::Missing, "", "this case has sections in spans only");
            fault.hint(format!("--span N computes that of a span: {own}"))
        }
        (None, None) => {
            let what = "this case has no section: it gives its coefficients directly or by a preset";
            let hint = "slcbeam check prints its coefficients; slcbeam new section writes a section";
            Violation::new(Code::Missing, "", what).hint(hint)
        }
    }
}

/// True if the value of a file is a section on its own, and not a case.
pub(in crate::case) fn is_one(value: &Value) -> bool {
    let has = |key: &str| value.get(key).is_some();
    let rows = ["/bladders/upper", "/bladders/lower"];
    let of_case = ["beam", "ends", "time", "preset", KEY].into_iter().any(has);
    !of_case && (has("pitch_m") || rows.iter().any(|row| value.pointer(row).is_some()))
}

/// Fault of a file that is a section, not a case.
pub(in crate::case) fn no_case() -> Violation {
    let hint = "`slcbeam coefficients` computes its coefficients; a case contains it under \"section\", beside beam, \
                ends and time";
    Violation::new(Code::Missing, "", "this is a section by its geometry, not a case").hint(hint)
}
