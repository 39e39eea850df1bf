//! Loading of a case: from a file to a checked case.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::Value;

use super::faults::{CaseSource, SetValue, Violations, sort};
use super::origins::Origins;
use super::presets::Preset;
use super::scaling::{CoefficientSizes, LAWS, Sizes, may_change_sizes};
use super::schema::Case;
use super::wording::nearest;
use super::{
    check, counts, fluids, parse as json, presets, reading, schema_json, section, sets, structure, tables, validate,
};
use crate::error::{Code, Error, Result, Violation};

/// Largest case file [bytes].
const LARGEST: u64 = 64 << 20;

/// Path that stands for standard input.
const STANDARD_INPUT: &str = "-";

/// Reads all bytes, but at most one more than a case may have.
fn bounded(from: impl Read) -> std::io::Result<Vec<u8>> {
    let mut bytes = vec![];
    from.take(LARGEST + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads and checks a case file; `sets` are `POINTER=JSON` arguments.
///
/// # Errors
/// [`Error::Usage`] if the file cannot be read or an argument is invalid, [`Error::Case`] with all faults.
pub fn load(path: &Path, sets: &[String]) -> Result<Case> {
    parse(&text(path)?, path, path.parent().unwrap_or(Path::new("")), sets)
}

/// Text of a file, or of standard input for the path `-`.
///
/// # Errors
/// [`Error::Usage`] if it cannot be read, [`Error::Case`] if it is too large or not UTF-8.
pub fn text(path: &Path) -> Result<String> {
    let unreadable = |e| {
        let meant =
            nearest_file(path, ".json").map_or_else(String::new, |name| format!("; did you mean {}?", name.display()));
        Error::Usage(format!("cannot read {}: {e}{meant}", path.display()))
    };
    let bytes = if path == Path::new(STANDARD_INPUT) {
        let bytes = bounded(std::io::stdin().lock()).map_err(unreadable)?;
        (bytes.len() as u64 <= LARGEST).then_some(bytes)
    } else {
        let there = std::fs::metadata(path).map_err(unreadable)?;
        if !there.is_file() {
            let what = match (there.is_dir(), path.join("case.json")) {
                (true, own) if own.is_file() => format!("it is a folder; its case is {}", own.display()),
                (true, _) => "it is a folder".into(),
                (false, _) => "it is not a regular file; use - for a case on standard input".into(),
            };
            return Err(unreadable(std::io::Error::new(std::io::ErrorKind::InvalidInput, what)));
        }
        reading::bytes(path, LARGEST).map_err(unreadable)?
    };
    let Some(bytes) = bytes else {
        let what = "the case is larger than 64 MB";
        let fault = Violation::new(Code::Text, "", what).allowed("case files of up to 64 MB");
        return Err(CaseSource::new(path, "").error(vec![fault]));
    };
    String::from_utf8(bytes).map_err(|e| not_utf8(path, e.as_bytes(), e.utf8_error().valid_up_to()))
}

/// File with this ending in the same folder, whose name is the most similar.
pub(super) fn nearest_file(path: &Path, ending: &str) -> Option<PathBuf> {
    let folder = path
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(ending))
        .collect();
    let meant = nearest(path.file_name()?.to_str()?, names.iter().map(String::as_str))?;
    Some(path.with_file_name(meant))
}

/// Reads and checks a case from text. `base` is the folder of the files that it names. A coefficient of the file belongs to the modulus and
/// dimensions of the file. A coefficient given by an argument belongs to those after all arguments.
///
/// # Errors
/// As [`load`].
pub fn parse(text: &str, path: &Path, base: &Path, sets: &[String]) -> Result<Case> {
    parse_varied(text, path, base, sets, &[])
}

/// Reads and checks a case from text, with further arguments `varied` after `sets`. The coefficients given by `sets` are scaled to the
/// dimensions after `varied`.
///
/// # Errors
/// As [`load`].
pub fn parse_varied(text: &str, path: &Path, base: &Path, sets: &[String], varied: &[String]) -> Result<Case> {
    let source = CaseSource::new(path, text);
    let (file, mut violations) = json::parse(text);
    let Some(file) = file else {
        let table = path
            .extension()
            .is_some_and(|x| ["csv", "tsv", "txt", "dat"].iter().any(|y| x.eq_ignore_ascii_case(y)));
        return Err(source.error(match table {
            true => vec![
                Violation::new(
                    Code::Text,
                    "",
                    "this seems to be a table, not a case; a case is a JSON object",
                )
                .hint(
                    "give a table after the case or the result: slcbeam fit CASE.json DATA.csv, slcbeam compare RUN \
                     DATA.csv",
                ),
            ],
            false => violations,
        }));
    };
    let mut value = file.to_value();
    if let Some(fault) = result(&value, path) {
        return Err(source.error(vec![fault]));
    }
    if section::is_one(&value) {
        return Err(source.error(vec![section::no_case()]));
    }
    let (sets, steps) = steps(&mut value, &file.to_value(), [sets, varied])?;
    let source = CaseSource {
        sets,
        file: Some(file),
        ..source
    };
    let own = value.clone();
    let Filled {
        whole: mut value,
        section,
        spans,
        fluid,
    } = Filled::new(value, &source.sets);
    let mut given = given(&own, &value, section.as_ref(), &steps);
    given.scale(&mut value);
    // Invalid numbers have their fault already; `null` replaces them.
    let invalid = violations.iter().map(|v| v.pointer.clone());
    let invalid: Vec<String> = invalid
        .filter(|p| value.pointer(p).is_some_and(Value::is_null))
        .collect();

    let mut faults = Violations::default();
    invalid.iter().for_each(|pointer| faults.doubt(pointer));
    section.iter().for_each(|section| section.doubt(&own, &mut faults));
    spans.doubt(&mut faults);
    validate::validate(&value, &own, &schema_json::CASE, &mut faults);
    faults.drop_below(&invalid);
    if own.get("beams").is_some() {
        let unknown = structure::unknown_bladders(&value);
        let pointers: Vec<String> = unknown.iter().map(|fault| fault.pointer.clone()).collect();
        faults.drop_below(&pointers);
        unknown.into_iter().for_each(|fault| faults.push(fault));
        // they repeat those of beams
        faults.drop_below(&["/spans".to_owned()]);
        if own.get("spans").is_some() {
            let fault = Violation::new(Code::Together, "/spans", "spans of a case with several beams");
            faults.push_at_key(fault.hint("give them in the beam that they belong to: /beams/0/spans"));
        }
    }
    // `null` from the command line removes an optional value.
    let cleared = source.sets.iter().map(|set| set.pointer.clone());
    let cleared: Vec<String> = cleared
        .filter(|p| value.pointer(p).is_some_and(Value::is_null) && !faults.is_unknown_key(p))
        .collect();
    faults.drop_below(&cleared);
    cleared.iter().for_each(|pointer| sets::remove(&mut value, pointer));
    if section.as_ref().is_some_and(section::SectionValues::stands_in) {
        section::remove(&mut value);
    }
    spans.report(&mut faults);
    let case = match value.is_object() {
        true => build(value.clone(), base, &mut faults, violations.is_empty()),
        false => None,
    };
    section.iter().for_each(|section| section.report(&own, &mut faults));
    match &fluid {
        Some(fluid) => fluid.report(&mut faults),
        None => fluids::report_unnamed(&own, &mut faults),
    }
    let case = case.map(|case| Case {
        origins: Origins::new(
            &own,
            &value,
            &source.sets,
            case.preset,
            (section.as_ref(), &spans),
            given,
        ),
        ..case
    });
    violations.extend(faults.placed(&source));
    match case {
        Some(case) if violations.is_empty() => Ok(Case {
            source: Arc::new(source),
            ..case
        }),
        _ => {
            sort(&mut violations);
            Err(source.error(violations))
        }
    }
}

/// A case with the values of its sections, its fluid and its preset.
struct Filled {
    whole: Value,
    section: Option<section::SectionValues>,
    spans: section::SpanSections,
    fluid: Option<fluids::FluidValues>,
}

impl Filled {
    fn new(own: Value, sets: &[SetValue]) -> Self {
        let mut whole = own;
        structure::fill(&mut whole);
        let spans = section::SpanSections::new(&whole);
        spans.outline(&mut whole);
        let (section, fluid) = (section::computed_values(&whole), fluids::preset_values(&whole));
        let brought = [section.as_ref().map(|s| &s.values), fluid.as_ref().map(|f| &f.values)];
        presets::apply(&mut whole, sets, brought.into_iter().flatten().cloned());
        spans.fill(&mut whole);
        Self {
            whole,
            section,
            spans,
            fluid,
        }
    }
}

/// Pointers of arguments applied together, and the dimensions of the case after them; none if these are the final dimensions.
struct Step {
    pointers: Vec<String>,
    sizes: Option<Option<Sizes>>,
}

/// Applies groups of arguments to a case, one after the other. Returns all arguments, and the steps, of which the first is the plain file.
fn steps(value: &mut Value, file: &Value, groups: [&[String]; 2]) -> Result<(Vec<SetValue>, Vec<Step>)> {
    let mut all: Vec<SetValue> = vec![];
    let mut steps = vec![Step {
        pointers: vec![],
        sizes: None,
    }];
    for group in groups.into_iter().filter(|group| !group.is_empty()) {
        if let Some(before) = steps.last_mut()
            && group.iter().any(|set| may_change_sizes(set))
        {
            before.sizes = Some(Sizes::from_case(&Filled::new(value.clone(), &all).whole));
        }
        let sets = sets::apply(value, group)?;
        if section::changes(&sets) {
            section::release(value, file);
        }
        let pointers = sets
            .iter()
            .filter(|set| set.node.is_some())
            .map(|set| set.pointer.clone());
        steps.push(Step {
            pointers: pointers.collect(),
            sizes: None,
        });
        all.extend(sets);
    }
    // a step without dimensions of its own has those of the next
    for k in (1..steps.len()).rev() {
        let next = steps[k].sizes;
        let before = &mut steps[k - 1].sizes;
        *before = before.or(next);
    }
    Ok((all, steps))
}

/// Dimensions to which the coefficients of a case `own` belong; `whole` includes the values of its section and its preset.
fn given(own: &Value, whole: &Value, section: Option<&section::SectionValues>, steps: &[Step]) -> CoefficientSizes {
    let mut given = CoefficientSizes::default();
    let now = Sizes::from_case(whole);
    let all = LAWS.iter().map(|law| law.pointer);
    for (k, step) in steps.iter().enumerate() {
        let sizes = step.sizes.unwrap_or(now);
        match k {
            0 => given.note(all.clone(), sizes),
            _ => given.note(step.pointers.iter().map(String::as_str), sizes),
        }
    }
    let of_section = |pointer: &str| {
        let brought = section.filter(|section| section.values.pointer(pointer).is_some());
        brought.is_some_and(|section| own.pointer(pointer).is_none_or(|own| section.gives(pointer, own)))
    };
    let preset = own
        .get("preset")
        .and_then(|_| Sizes::from_case(&Preset::MatiaGatBeam.values()));
    for pointer in all {
        match whole.pointer(pointer) {
            None => given.note([pointer].into_iter(), None),
            Some(_) if of_section(pointer) => given.note([pointer].into_iter(), now),
            Some(_) if own.pointer(pointer).is_none() => given.note([pointer].into_iter(), preset),
            Some(_) => {}
        }
    }
    given
}

/// Fault of a file that is a result: it names the program that wrote it.
fn result(value: &Value, path: &Path) -> Option<Violation> {
    if value.get("provenance")?.get("program").is_none() || value.get("ends").is_some() {
        return None;
    }
    let fault = Violation::new(Code::Text, "", "this is a result, not a case");
    let own = path.with_file_name("case.json");
    Some(match own.is_file() {
        true => fault.hint(format!("its case is {}", own.display())),
        false => {
            fault.hint("a case has \"ends\", \"time\" and a beam or a preset; `slcbeam new` writes a starting case")
        }
    })
}

/// Returns the case, with its rules checked as far as its structure allows. Unknown keys are removed. If a section is unreadable, the rules
/// of the other sections are still checked, so that one run reports all faults.
fn build(mut value: Value, base: &Path, faults: &mut Violations, sound: bool) -> Option<Case> {
    faults.remove_unknown_keys(&mut value);
    if !faults.is_overfull() {
        counts::check(&value, faults);
    }
    if faults.is_overfull() {
        return None;
    }
    tables::resolve(&mut value, base, "", faults);
    match serde_json::from_value(value.clone()) {
        Ok(case) => {
            check::check(&case, &[], faults);
            Some(case)
        }
        Err(e) => {
            if sound && faults.is_empty() {
                faults.push(Violation::new(Code::Text, "", format!("not a case: {e}")));
            }
            let (case, broken) = readable_part(&value)?;
            check::check(&case, &broken, faults);
            None
        }
    }
}

/// The case with its readable sections and the others from an empty case, and the names of the others.
fn readable_part(value: &Value) -> Option<(Case, Vec<String>)> {
    let empty = serde_json::json!({
        "name": "empty",
        "beam": { "length_m": 0.1, "height_m": 0.02, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950 },
        "ends": { "root": "free", "tip": "free" },
        "time": { "end_s": 1 }
    });
    let given = value.as_object()?;
    let with = |case: &Value, section: &str| {
        let mut case = case.clone();
        case[section] = given[section].clone();
        case
    };
    let reads = |section: &&String| serde_json::from_value::<Case>(with(&empty, section)).is_ok();
    let (sound, mut broken): (Vec<_>, Vec<_>) = given.keys().partition(reads);
    let missing = empty
        .as_object()?
        .keys()
        .filter(|section| !given.contains_key(*section));
    broken.extend(missing);
    let part = sound
        .into_iter()
        .fold(empty.clone(), |case, section| with(&case, section));
    Some((
        serde_json::from_value(part).ok()?,
        broken.into_iter().cloned().collect(),
    ))
}

fn not_utf8(path: &Path, bytes: &[u8], valid: usize) -> Error {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(valid + 200)]).into_owned();
    let end = text[valid..].chars().next().map_or(valid, |c| valid + c.len_utf8());
    let hint = match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "the file is UTF-16; save it as UTF-8",
        _ => "save it as UTF-8",
    };
    let what = format!("byte {valid} of the file is not UTF-8 text");
    let violation = Violation {
        span: Some(valid..end),
        ..Violation::new(Code::Text, "", what).hint(hint)
    };
    CaseSource::new(path, &text).error(vec![violation])
}
