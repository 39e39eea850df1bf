//! The coefficients of a case that gives its section by its geometry.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use serde_json::{Value, json};
use serde_path_to_error::Segment;
use slcbeam_section::coefficients::{Coefficients, Options};
use slcbeam_section::error::Error;
use slcbeam_section::input::Section;

use super::faults::{Source, Violations};
use super::presets::Preset;
use super::schema_json;
use crate::error::{Code, Result, Violation};

/// Where it stands in a case.
const KEY: &str = "section";
/// Difference of the rows, and coupling of force and curvature, that the model's two alike rows may leave out.
const ALIKE: f64 = 1e-3;
/// Error of a coefficient above which it is not taken.
const COARSE: f64 = 0.02;
/// The same of a cell in three dimensions, whose meshes are coarser; the plane one leaves out more.
const COARSE_IN_SPACE: f64 = 0.06;
/// Where the number of bladders stands.
const PER_ROW: &str = "/bladders/per_row";
/// Sections whose coefficients are kept, for cases that are read again and again.
const KEPT: usize = 16;

/// Relative difference of a size that is given twice.
const ROUND_OFF: f64 = 1e-9;

static KNOWN: Mutex<Vec<(Section, Coefficients)>> = Mutex::new(vec![]);

/// The coefficients of a section, computed once; [`slcbeam_section`] says how, with errors.
///
/// # Errors
/// Every rule that it breaks with its place in the section, or why its cell has no solution.
pub fn coefficients(section: &Section) -> std::result::Result<Coefficients, Vec<Violation>> {
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, found)) = known().iter().find(|(of, _)| of == section) {
        return Ok(found.clone());
    }
    let found = section.coefficients(&Options::default()).map_err(|error| match error {
        Error::Section(faults) => faults
            .into_iter()
            .map(|fault| Violation::new(Code::Range, fault.place, fault.what))
            .collect(),
        other => vec![Violation::new(Code::Range, "", other.to_string())],
    })?;
    let mut known = known();
    known.truncate(KEPT - 1);
    known.insert(0, (section.clone(), found.clone()));
    Ok(found)
}

/// Puts the numbers of `/section` where a case has them; what stands there already stays.
///
/// Where the section cannot be computed the numbers of a preset stand in, so that the rest of the case can be looked at.
pub(super) fn apply(case: &mut Value, faults: &mut Violations) -> Filled {
    let Some(given) = case.get(KEY).filter(|given| given.is_object()) else {
        return Filled::default();
    };
    let mut told = vec![];
    let numbers = match read(given, &format!("/{KEY}")).map(|section| numbers(case, &section)) {
        Ok(Ok(numbers)) => numbers,
        Ok(Err(violations)) => {
            told.extend(
                violations
                    .into_iter()
                    .map(|violation| match violation.pointer.as_str() {
                        PER_ROW => violation,
                        place => Violation {
                            pointer: format!("/{KEY}{place}"),
                            ..violation
                        },
                    }),
            );
            stand_in()
        }
        Err(violation) => {
            told.push(*violation);
            stand_in()
        }
    };
    let stands_in = !told.is_empty();
    let mut all = vec![];
    for (pointer, number) in numbers {
        if put(case, pointer, &number) {
            all.push(pointer.to_owned());
        } else if SIZES.contains(&pointer)
            && let (Some(given), Some(own)) = (case.pointer(pointer).and_then(Value::as_f64), number.as_f64())
            && (given / own - 1.0).abs() > ROUND_OFF
            && !stands_in
        {
            let what = format!("{given} beside the section's {own}");
            let hint = "leave it out: the section has it, and its coefficients belong to that";
            let fault = Violation::new(Code::Range, pointer, what);
            faults.push(fault.allowed(own.to_string()).hint(hint));
        }
    }
    Filled { pointers: all, told }
}

/// What a section gave a case.
#[derive(Default)]
pub(super) struct Filled {
    /// Where numbers were put.
    pub pointers: Vec<String>,
    /// What is wrong with the section; the numbers are those of a preset then.
    told: Vec<Violation>,
}

impl Filled {
    /// Tells what is wrong with the section, and nothing of numbers that stand in; what the schema has found in the section comes first.
    pub(super) fn tell(self, faults: &mut Violations) {
        if self.told.is_empty() {
            return;
        }
        let mut at = self.pointers;
        at.push("/bladders".into());
        faults.drop_below(&at);
        if !faults.any_below(&format!("/{KEY}")) {
            self.told.into_iter().for_each(|violation| faults.push(violation));
        }
    }
}

/// A section as it is written, at a pointer of its file.
fn read(value: &Value, at: &str) -> std::result::Result<Section, Box<Violation>> {
    serde_path_to_error::deserialize(without_remarks(value)).map_err(|error| {
        let path = error.path().iter().filter_map(|segment| match segment {
            Segment::Map { key } => Some(key.clone()),
            Segment::Seq { index } => Some(index.to_string()),
            _ => None,
        });
        let pointer = std::iter::once(at.to_owned()).chain(path).collect::<Vec<_>>().join("/");
        Box::new(Violation::new(Code::Kind, pointer, error.inner().to_string()))
    })
}

/// Takes the section away, whose numbers stand in the case.
pub(super) fn remove(case: &mut Value) {
    if let Some(case) = case.as_object_mut() {
        case.shift_remove(KEY);
    }
}

fn without_remarks(value: &Value) -> Value {
    match value {
        Value::Object(members) => members
            .iter()
            .filter(|(key, _)| !key.starts_with("//"))
            .map(|(key, member)| (key.clone(), without_remarks(member)))
            .collect(),
        Value::Array(items) => items.iter().map(without_remarks).collect(),
        other => other.clone(),
    }
}

/// Whether a number was put where nothing stood.
fn put(case: &mut Value, pointer: &str, number: &Value) -> bool {
    let mut at = case;
    for key in pointer.split('/').skip(1) {
        if at.is_null() {
            *at = json!({});
        }
        let Some(object) = at.as_object_mut() else {
            return false;
        };
        at = object.entry(key).or_insert(Value::Null);
    }
    let absent = at.is_null();
    if absent {
        *at = number.clone();
    }
    absent
}

type Numbers = Vec<(&'static str, Value)>;

fn stand_in() -> Numbers {
    let preset = Preset::MatiaGatBeam.values();
    let all = POINTERS.into_iter().chain(["/bladders/per_row"]);
    all.filter_map(|pointer| Some((pointer, preset.pointer(pointer)?.clone())))
        .collect()
}

/// What a case may say again but not otherwise.
pub(super) const SIZES: [&str; 7] = [
    "/beam/height_m",
    "/beam/width_m",
    "/beam/young_modulus_pa",
    "/beam/density_kg_m3",
    "/bladders/length_m",
    "/bladders/width_m",
    "/bladders/height_m",
];

const POINTERS: [&str; 15] = [
    "/beam/height_m",
    "/beam/width_m",
    "/beam/young_modulus_pa",
    "/beam/density_kg_m3",
    "/beam/axial_stiffness_factor",
    "/beam/bending_stiffness_factor",
    "/bladders/length_m",
    "/bladders/width_m",
    "/bladders/height_m",
    "/bladders/permeability_m4",
    "/bladders/area_per_pressure_m2_per_pa",
    "/bladders/area_per_moment_m2_per_n_m/opening",
    "/bladders/area_per_moment_m2_per_n_m/closing",
    "/bladders/area_per_force_m2_per_n/tension",
    "/bladders/area_per_force_m2_per_n/compression",
];

/// What a case takes of a section: the size along the beam of a bladder and the height of a rectangle as large, so that volumes and
/// masses are right.
fn numbers(case: &Value, section: &Section) -> std::result::Result<Numbers, Vec<Violation>> {
    let found = coefficients(section)?;
    let (c, e) = (&found.numbers, &found.errors);
    let worst = [
        ("axial_stiffness_factor", e.axial_stiffness_factor),
        ("bending_stiffness_factor", e.bending_stiffness_factor),
        ("area_per_pressure_m2_per_pa", e.area_per_pressure_m2_per_pa),
        ("area_per_moment_m2_per_n_m", e.area_per_moment_m2_per_n_m),
        ("area_per_force_m2_per_n", e.area_per_force_m2_per_n),
        ("permeability_m4", e.permeability_m4),
    ];
    let fault = |pointer: &str, what: String| Violation::new(Code::Range, pointer, what);
    let most = if section.three_d { COARSE_IN_SPACE } else { COARSE };
    let coarse = worst.into_iter().filter(|(_, error)| *error > most);
    let mut faults: Vec<Violation> = coarse
        .map(|(name, error)| {
            fault("", format!("{name} is known to {:.1} % only", 100.0 * error))
                .allowed(format!("{:.0} %", 100.0 * most))
        })
        .collect();
    let solid = section.height_m * section.width_m - c.fluid_volume_per_length_m2;
    let beam = [
        section.height_m,
        section.width_m,
        section.material.young_modulus_pa,
        match section.regions.is_empty() {
            true => section.material.density_kg_m3,
            false => c.solid_mass_kg_per_m / solid,
        },
        c.axial_stiffness_factor,
        c.bending_stiffness_factor,
    ];
    if c.force_curvature_coupling.abs() > ALIKE {
        let what = format!(
            "a normal force bends this section (coupling {:.1e})",
            c.force_curvature_coupling
        );
        let place = if section.regions.is_empty() {
            "/bladders/lower"
        } else {
            "/regions"
        };
        faults.push(
            fault(place, what)
                .allowed("halves that mirror each other")
                .hint(ONE_ROW),
        );
    }
    let mut all: Numbers = POINTERS.into_iter().zip(beam.map(Value::from)).collect();
    match (&c.upper, &c.lower) {
        (None, None) => {}
        (Some(upper), Some(lower)) => {
            let differs = (lower.area_per_moment_m2_per_n_m / upper.area_per_moment_m2_per_n_m - 1.0).abs() > ALIKE;
            if differs && faults.is_empty() {
                let what = "the rows are not alike".to_owned();
                faults.push(fault("/bladders/lower", what).allowed("\"mirrored\"").hint(ONE_ROW));
            }
            let along = section.bladders.along();
            let bladders = [
                section.bladders.length_m,
                along,
                upper.area_m2 / along,
                c.permeability_m4,
                c.area_per_pressure_m2_per_pa,
                c.area_per_moment_m2_per_n_m,
                c.area_per_moment_m2_per_n_m,
                c.area_per_force_m2_per_n,
                c.area_per_force_m2_per_n,
            ];
            all.extend(POINTERS.into_iter().skip(beam.len()).zip(bladders.map(Value::from)));
            match per_row(case, section.pitch_m) {
                Ok(number) => all.push(("/bladders/per_row", number.into())),
                Err(what) => {
                    let given = case.pointer(PER_ROW).is_some();
                    let place = if given { PER_ROW } else { "/pitch_m" };
                    faults.push(fault(place, what).hint("/beam/length_m is a whole number of pitches"));
                }
            }
        }
        _ if faults.is_empty() => faults.push(fault("/bladders", "only one row has bladders".into()).hint(ONE_ROW)),
        _ => {}
    }
    if faults.is_empty() { Ok(all) } else { Err(faults) }
}

const ONE_ROW: &str = "a case has two rows alike; `slcbeam coefficients` has the numbers of any section";

/// How many bladders a row has.
fn per_row(case: &Value, pitch: f64) -> std::result::Result<u64, String> {
    let Some(length) = case.pointer("/beam/length_m").and_then(Value::as_f64) else {
        return Ok(1000);
    };
    let count = (length / pitch).round().max(1.0);
    let given = case.pointer("/bladders/per_row").and_then(Value::as_f64);
    match given.unwrap_or(count) {
        number if (number * pitch - length).abs() <= 1e-6 * length => Ok(count as u64),
        number => Err(format!(
            "{number} bladders of {pitch} m are {} m of a beam of {length} m",
            number * pitch
        )),
    }
}

/// Reads a section from the text of a file that is one, or of a case that has one.
///
/// # Errors
/// [`crate::error::Error::Case`] with every fault and its place.
pub fn parse(text: &str, path: &Path, sets: &[String]) -> Result<Section> {
    let source = Source::of(path, text);
    let (file, violations) = super::parse::parse(text);
    let Some(file) = file.filter(|_| violations.is_empty()) else {
        return Err(source.error(violations));
    };
    let mut value = file.to_value();
    let source = Source {
        sets: super::sets::apply(&mut value, sets)?,
        file: Some(file),
        ..source
    };
    let of_case = value.get(KEY).is_some();
    if !of_case && value.get("ends").is_some() {
        let what = "this case has no section: its coefficients are given, or those of its preset";
        return Err(source.error(vec![Violation::new(Code::Missing, "", what)]));
    }
    let (schema, at) = schema_json::section(of_case);
    let mut faults = Violations::default();
    super::validate::validate(&value, &schema, &mut faults);
    match value.pointer(at).map(|section| read(section, at)) {
        Some(Ok(section)) if faults.is_empty() => {
            for fault in section.faults() {
                faults.push(Violation::new(Code::Range, format!("{at}{}", fault.place), fault.what));
            }
            if faults.is_empty() {
                return Ok(section);
            }
        }
        Some(Err(violation)) if !faults.any_below(at) => faults.push(*violation),
        _ => {}
    }
    Err(source.error(faults.placed(&source)))
}
