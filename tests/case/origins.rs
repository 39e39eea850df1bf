//! Coefficients of a preset: what they belong to, where they come from, and that a number set to its own value changes nothing.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::model::{Model, audit, characteristic};

const LITTLE: &str = r#"{
  "name": "little", "preset": "matia-gat-beam", "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1}
}"#;

fn parsed(text: &str, base: &Path, sets: &[String]) -> slcbeam::error::Result<Case> {
    case::parse(text, Path::new("mine.json"), base, sets)
}

fn little(sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    parsed(LITTLE, Path::new(""), &sets).expect("a case")
}

fn warnings(case: &Case) -> Vec<String> {
    let model = Model::new(case).unwrap();
    let mut all = audit::warnings(case, &model, &characteristic::numbers(case, &model));
    all.retain(|w| w.starts_with("W017"));
    all
}

pub fn shipped() -> Vec<PathBuf> {
    let files = |folder: &str| fs::read_dir(folder).expect("cases").map(|f| f.expect("a file").path());
    let mut all: Vec<PathBuf> = files("cases").chain(files("cases/hard")).collect();
    all.retain(|p| p.extension().is_some_and(|e| e == "json") && !p.ends_with("schema.json"));
    all.sort();
    assert!(all.len() > 45, "{}", all.len());
    all
}

pub fn numbers(value: &Value, at: String, all: &mut Vec<(String, String)>) {
    match value {
        Value::Object(members) => members
            .iter()
            .filter(|(key, _)| !key.starts_with("//"))
            .for_each(|(key, v)| numbers(v, format!("{at}/{key}"), all)),
        Value::Array(items) => {
            let each = items.iter().enumerate();
            each.for_each(|(k, v)| numbers(v, format!("{at}/{k}"), all));
        }
        Value::Number(number) => all.push((at, number.to_string())),
        _ => {}
    }
}

/// Goal: `--set` of a number to its own value leaves the resolved case as it is, for every number of every shipped case, as the
/// file has it and as the resolved case has it. Numbers of one array longer than eight are looked at in steps; those of tables
/// in files of their own cannot be set.
#[test]
fn a_number_set_to_its_own_value_changes_nothing() {
    let mut looked_at = 0;
    for path in shipped() {
        let (text, base) = (fs::read_to_string(&path).expect("text"), path.parent().expect("folder"));
        let whole = parsed(&text, base, &[]).expect("valid").resolved_json();
        let (mut own, mut resolved) = (vec![], vec![]);
        let file: Value = serde_json::from_str(&text).expect("JSON");
        numbers(&file, String::new(), &mut own);
        numbers(
            &serde_json::from_str(&whole).expect("JSON"),
            String::new(),
            &mut resolved,
        );
        let in_file = |p: &str| {
            p.rsplit_once('/')
                .is_some_and(|(array, k)| k.parse::<usize>().is_ok() && file.pointer(array).is_none())
        };
        resolved.retain(|(p, _)| !in_file(p));
        // in the case of a result they are those of all beams together
        let of_all = ["/beam/length_m", "/bladders/per_row", "/mesh/segments"];
        resolved.retain(|(p, _)| file.get("beams").is_none() || !of_all.contains(&p.as_str()));
        let late = |p: &str| {
            p.rsplit('/')
                .next()
                .and_then(|k| k.parse::<usize>().ok())
                .is_some_and(|k| k > 8 && k % 7 != 0)
        };
        for (pointer, value) in own.iter().chain(&resolved).filter(|(p, _)| !late(p)) {
            let set = format!("{pointer}={value}");
            let again =
                parsed(&text, base, std::slice::from_ref(&set)).unwrap_or_else(|e| panic!("{path:?} {set}: {e}"));
            assert!(again.resolved_json() == whole, "{path:?} {set}");
            looked_at += 1;
        }
    }
    assert!(looked_at > 2000, "{looked_at}");
}

/// Goal: coefficients follow sizes that change the shape of the section by laws that are not exact then, and the case says so, and which. The
/// modulus, the radius of tubes and sizes in proportion change no shape.
#[test]
fn changed_sizes_with_coefficients_of_the_preset_warn() {
    assert_eq!(warnings(&little(&[])), [""; 0]);
    // longer by more segments, other density or viscosity, its own value: the same section
    for same in [
        &["/beam/length_m=0.3", "/bladders/per_row=30"][..],
        &["/beam/density_kg_m3=1100", "/fluid/viscosity_pa_s=0.3"],
        &[
            "/bladders/height_m=0.0078",
            "/tubes/radius_m=0.001",
            "/beam/young_modulus_pa=2e6",
        ],
        &["/beam/young_modulus_pa=1e6"],
        &["/tubes/radius_m=0.002"],
        &TWICE,
    ] {
        assert_eq!(warnings(&little(same)), [""; 0], "{same:?}");
    }
    let told = |sets: &[&str], names: &[&str], not: &[&str]| {
        let all = warnings(&little(sets)).join("\n");
        names
            .iter()
            .for_each(|n| assert!(all.contains(n), "{sets:?}: {n} is missing: {all}"));
        not.iter()
            .for_each(|n| assert!(!all.contains(n), "{sets:?}: {n} is needless: {all}"));
    };
    let areas = ["area_per_pressure", "area_per_moment", "area_per_force"];
    let all = [
        &areas[..],
        &[
            "axial_stiffness_factor",
            "bending_stiffness_factor",
            "bladders/permeability_m4",
        ],
    ]
    .concat();
    told(&["/bladders/height_m=0.009"], &all, &["tubes"]);
    told(
        &["/bladders/width_m=0.007"],
        &[&all[..], &["7.8 x 7.8 mm", "7.8 x 7 mm", "null"]].concat(),
        &["tubes"],
    );
    told(&["/beam/height_m=0.03"], &all[..5], &["permeability"]);
    told(
        &["/beam/width_m=0.06"],
        &["area_per_moment", "area_per_force"],
        &["area_per_pressure", "permeability"],
    );
    told(&["/beam/length_m=0.2"], &all[..5], &["permeability"]);
}

/// Everything twice as large.
const TWICE: [&str; 7] = [
    "/beam/length_m=0.2",
    "/beam/height_m=0.0432",
    "/beam/width_m=0.1",
    "/bladders/height_m=0.0156",
    "/bladders/width_m=0.0156",
    "/bladders/length_m=0.092",
    "/tubes/radius_m=0.002",
];

/// Goal: beside what is inherited stands what these sizes would give, as `slcbeam coefficients` has it: for a silicone actuator of 18 x 20 mm
/// half as much again per unit of moment. Nothing is told of a beam without bladders; sizes of which no cell can be made are.
#[test]
fn inherited_coefficients_stand_beside_those_of_a_cell() {
    let actuator = [
        "/beam={\"length_m\": 0.08, \"height_m\": 0.02, \"width_m\": 0.018, \"young_modulus_pa\": 5e5}",
        "/bladders/width_m=0.0056",
        "/bladders/height_m=0.0056",
        "/bladders/length_m=0.014",
    ];
    let all = warnings(&little(&actuator));
    let side = 0.0056;
    let section = json!({
        "height_m": 0.02, "width_m": 0.018, "pitch_m": 0.008,
        "material": {"young_modulus_pa": 5e5, "poisson_ratio": 0.49, "density_kg_m3": 950},
        "bladders": {"length_m": 0.014, "lower": "mirrored", "upper": {"center_m": side / 2.0 + (0.01 - side) / 3.0,
            "shape": {"rounded_rectangle": {"along_m": side, "high_m": side, "fillet_m": side * 2.5 / 7.8}}}}
    });
    let file = tempfile::NamedTempFile::new().expect("a file");
    fs::write(file.path(), section.to_string()).expect("written");
    let path = file.path().to_str().expect("a path");
    let done = assert_cmd::Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args(["coefficients", path, "--json"])
        .output()
        .expect("started");
    let found: Value = serde_json::from_slice(&done.stdout).expect("JSON");
    let after = |text: &str, mark: &str| -> f64 {
        let rest = text.split(mark).nth(1).unwrap_or_else(|| panic!("{mark}: {text}"));
        let number = rest.trim_start().split([' ', ',']).next().expect("a number");
        number.parse().unwrap_or_else(|_| panic!("{mark}: {number}"))
    };
    for (mark, key) in [
        ("gives axial_stiffness_factor ", "axial_stiffness_factor"),
        (" area_per_pressure_m2_per_pa ", "area_per_pressure_m2_per_pa"),
        ("area_per_moment_m2_per_n_m/opening ", "area_per_moment_m2_per_n_m"),
        ("area_per_force_m2_per_n/tension ", "area_per_force_m2_per_n"),
    ] {
        let (told, own) = (
            after(&all[0].replace("/bladders/", ""), mark),
            found[key].as_f64().expect("a number"),
        );
        assert!((told / own - 1.0).abs() < 6e-3, "{mark}: {told} {own}");
    }
    assert!(
        all[0].contains("Poisson's ratio of 0.49") && all[0].contains("instead of 2.51e-5"),
        "{}",
        all[0]
    );
    // a smaller square has the permeability of its size
    assert_eq!(all.len(), 1, "{all:?}");
    let dry = little(&["/fluid=null", "/bladders=null", "/tubes=null", "/beam/height_m=0.03"]);
    let told = warnings(&dry).join("");
    assert!(!told.is_empty() && !told.contains("instead of"), "{told}");
    // as wide as the pitch: no wall is left between neighbours
    let none = warnings(&little(&["/bladders/width_m=0.01"])).join("");
    assert!(
        none.contains("is not available for comparison: /bladders/upper: reaches 0.005 m"),
        "{none}"
    );
}

/// Goal: what is given, or left to be computed, is not another beam's.
#[test]
fn coefficients_of_its_own_do_not_warn() {
    assert_eq!(
        warnings(&little(&["/tubes/radius_m=0.002", "/tubes/permeability_m4=null"])),
        [""; 0]
    );
    assert_eq!(
        warnings(&little(&["/tubes/radius_m=0.002", "/tubes/permeability_m4=1e-12"])),
        [""; 0]
    );
    let case = little(&["/bladders/cross_section={\"circle\": {\"radius_m\": 0.003}}"]);
    assert_eq!(case.bladders.expect("bladders").permeability_m4, None);
    // without a preset null says the same as nothing
    let text = LITTLE.replace("\"ends\"", "\"tubes\": {\"permeability_m4\": null}, \"ends\"");
    let whole: Value =
        serde_json::from_str(&parsed(&text, Path::new(""), &[]).expect("a case").resolved_json()).expect("JSON");
    let mut written = whole.clone();
    written["tubes"]["permeability_m4"] = Value::Null;
    assert_eq!(
        parsed(&written.to_string(), Path::new(""), &[])
            .expect("a case")
            .resolved_json(),
        format!("{whole:#}\n")
    );
}

/// Goal: every coefficient says where it comes from.
#[test]
fn every_coefficient_has_an_origin() {
    let text = LITTLE.replace(
        "\"ends\"",
        "\"beam\": {\"bending_stiffness_factor\": 0.7}, \"tubes\": {\"permeability_m4\": null}, \"ends\"",
    );
    let sets = ["/bladders/area_per_moment_m2_per_n_m={\"opening\": 1e-6, \"closing\": 2e-6}".to_owned()];
    let words = parsed(&text, Path::new(""), &sets).expect("a case").origins.describe();
    for (pointer, origin) in [
        ("/beam/axial_stiffness_factor", "preset matia-gat-beam"),
        ("/beam/bending_stiffness_factor", "case"),
        ("/beam/mass_factor", "computed from bladders and fluid"),
        ("/bladders/permeability_m4", "preset matia-gat-beam"),
        ("/bladders/area_per_moment_m2_per_n_m/closing", "--set"),
        ("/tubes/permeability_m4", "computed from radius_m"),
    ] {
        assert_eq!(
            words.get(pointer).map(String::as_str),
            Some(origin),
            "{pointer}: {words:?}"
        );
    }
    let dry = little(&["/fluid=null", "/bladders=null", "/tubes=null"])
        .origins
        .describe();
    assert!(dry.keys().all(|k| k.starts_with("/beam/")), "{dry:?}");
    let resolved = little(&[]).resolved_json();
    let again = parsed(&resolved, Path::new(""), &[]).expect("a case");
    assert_eq!(again, little(&[]).resolved(), "origins are no part of a case");
    let words = again.origins.describe();
    assert!(
        words.get("/bladders/permeability_m4").is_some_and(|w| w == "case"),
        "{words:?}"
    );
}

/// Goal: shipped cases have the coefficients of their beams.
#[test]
fn shipped_cases_inherit_nothing_of_another_beam() {
    for path in shipped() {
        let (text, base) = (fs::read_to_string(&path).expect("text"), path.parent().expect("folder"));
        let told = case::inherited::warnings(&parsed(&text, base, &[]).expect("valid"));
        assert!(told.is_empty(), "{path:?}: {told:?}");
    }
}

/// Goal: a derivative by a size is the difference of two `--set`. The sealed beam of two bladders under an end moment: width
/// enters through the mass, the room and the coefficients, which follow. Central differences of
/// 1e-3 leave 1e-6 of a smooth function; both runs are at rtol 1e-8.
#[test]
fn derivatives_by_sizes_agree_with_set() {
    let text = json!({
        "name": "pair", "preset": "matia-gat-beam",
        "bladders": {"per_row": 1, "width_m": 0.0078, "coupling": "reciprocal"},
        "network": {"tubes": [{"from": {"bladder": 1, "end": "outlet"}, "to": {"bladder": -1, "end": "inlet"}}]},
        "ends": {"root": "clamped", "tip": {"free": {"force_x_n": {"ramp": {"to": 0.01, "duration_s": 0.01}}}}},
        "effects": "full", "mesh": {"cells_per_segment": 4},
        "time": {"end_s": 0.02}, "solver": {"rtol": 1e-8}
    })
    .to_string();
    let tip = |sets: &[String], parameters: &[&str]| {
        let case = parsed(&text, Path::new(""), sets).expect("a case");
        let parameters: Vec<_> = parameters
            .iter()
            .map(|p| slcbeam::case::parameter::Parameter::find(&case, p).expect("a number"))
            .collect();
        let mut memory = slcbeam::run::record::Memory::default();
        let outcome = slcbeam::run::dynamics::run_with(&case, System::new(&case).unwrap(), &parameters, &mut memory)
            .expect("a run");
        outcome.summary
    };
    for (pointer, value) in [("/bladders/width_m", 0.0078), ("/tubes/radius_m", 0.001)] {
        let figure = |v: f64| {
            tip(&[format!("{pointer}={v:e}")], &[]).quantities["tip_u1_m"]
                .last
                .expect("a figure")
        };
        let difference = (figure(1.001 * value) - figure(0.999 * value)) / (0.002 * value);
        let told = tip(&[], &[pointer]);
        let exact = told.sensitivities[pointer].quantities["tip_u1_m"]
            .last
            .expect("a derivative");
        let size = told.quantities["tip_u1_m"].last.expect("a figure") / value;
        println!("{pointer}: {exact:e}, by differences {difference:e}, of {size:e}");
        assert!(
            (exact - difference).abs() < 1e-4 * size.abs(),
            "{pointer}: {exact:e} {difference:e} {size:e}"
        );
    }
}
