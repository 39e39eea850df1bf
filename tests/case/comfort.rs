//! What makes a case easy to write: presets, remarks, starting cases, explanations, faults for scripts.
//!
//! Goal: a case written with little has the numbers of one written out; every shipped case and every starting case is valid against
//! the schema that editors use; every message can be looked up.

use std::fs;
use std::io::Read as _;
use std::path::Path;

use assert_cmd::Command;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};
use serde_json::{Value, json};
use slcbeam::case::{self, Case, schema_json};
use slcbeam::error::{CaseError, Error};

fn parsed(text: &str, sets: &[&str]) -> Result<Case, Error> {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    case::parse(text, Path::new("mine.json"), Path::new(""), &sets)
}

fn faults(text: &str) -> CaseError {
    match parsed(text, &[]) {
        Err(Error::Case(fault)) => *fault,
        other => panic!("{other:?}"),
    }
}

fn resolved(text: &str, sets: &[&str]) -> Value {
    serde_json::to_value(parsed(text, sets).unwrap().resolved()).unwrap()
}

const LITTLE: &str = r#"{
  "// why": "a remark", "name": "little", "preset": "matia-gat-beam",
  "ends": {"// here": ["too"], "root": "clamped", "tip": "free"}, "time": {"end_s": 1}
}"#;

#[test]
fn a_preset_stands_for_the_numbers_of_the_paper() {
    let written_out: Value = serde_json::from_str(include_str!("../data/wiring-2.json")).unwrap();
    let little = resolved(LITTLE, &[]);
    for (section, key) in [
        ("beam", "height_m"),
        ("fluid", "viscosity_pa_s"),
        ("bladders", "permeability_m4"),
        ("tubes", "radius_m"),
    ] {
        assert_eq!(little[section][key], written_out[section][key]);
    }
    assert_eq!(little["bladders"]["coupling"], "reciprocal");
    assert!(little.get("preset").is_none(), "a resolved case has the numbers");
}

#[test]
fn what_stands_in_the_case_or_an_argument_goes_before_the_preset() {
    let longer = resolved(LITTLE, &["/beam/length_m=0.3", "/bladders/per_row=30"]);
    assert_eq!(
        (&longer["beam"]["length_m"], &longer["beam"]["height_m"]),
        (&json!(0.3), &json!(0.0216))
    );
    let dry = resolved(LITTLE, &["/fluid=null", "/bladders=null", "/tubes=null"]);
    assert!(dry.get("bladders").is_none() && dry.get("fluid").is_none());
    let wide = resolved(LITTLE, &["/tubes/radius_m=0.002", "/tubes/permeability_m4=null"]);
    assert!(wide["tubes"].get("permeability_m4").is_none(), "that of the radius");
    let wide = resolved(LITTLE, &["/tubes/radius_m=0.002"]);
    assert_eq!(
        wide["tubes"]["permeability_m4"],
        16.0 * 6.72e-13,
        "the preset's follows the radius"
    );
}

#[test]
fn a_misspelt_preset_is_one_fault() {
    let fault = faults(&LITTLE.replace("matia-gat-beam", "matia-gat-beem"));
    let told: Vec<_> = fault
        .violations
        .iter()
        .map(|v| (v.code.id(), v.nearest.as_deref()))
        .collect();
    assert_eq!(told, [("E003", Some("matia-gat-beam"))]);
}

/// A fault in a number that only the preset has is shown at the preset.
#[test]
fn what_comes_from_the_preset_is_shown_there() {
    let fault = faults(&LITTLE.replace("\"ends\"", "\"beam\": {\"height_m\": 0.001}, \"ends\""));
    let shown: Vec<_> = fault
        .violations
        .iter()
        .map(|v| &fault.text[v.span.clone().unwrap()])
        .collect();
    assert!(
        !shown.is_empty()
            && shown
                .iter()
                .all(|s| s.contains("matia-gat-beam") || s.contains("0.001")),
        "{shown:?}"
    );
}

/// What has another name elsewhere is told by the one it has here.
#[test]
fn other_names_are_known() {
    let fault = faults(&LITTLE.replace("\"clamped\"", "\"fixed\""));
    assert_eq!(fault.violations[0].hint.as_deref(), Some("it is called \"clamped\""));
    let open = "\"network\": {\"chains\": [{\"bladders\": [1, 2], \"ends\": [\"sealed\", \"open\"]}]}, \"ends\"";
    let fault = faults(&LITTLE.replacen("\"ends\"", open, 1));
    assert!(
        fault.violations[0]
            .hint
            .as_ref()
            .unwrap()
            .contains("{\"pressure_pa\": 0}")
    );
}

#[test]
fn a_comment_is_told_how_to_stand() {
    let fault = faults(&LITTLE.replace("\"name\"", "// my case\n \"name\""));
    assert!(fault.violations[0].hint.as_ref().unwrap().contains("begins with //"));
}

fn slcbeam(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("slcbeam")
        .unwrap()
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn a_starting_case_is_valid_for_editors_and_named_as_its_file() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["wiring", "actuator", "harvester", "sensor", "beam"] {
        let file = format!("my-{kind}.json");
        assert_eq!(slcbeam(folder.path(), &["new", kind, &file]).0, 0);
        let text = fs::read_to_string(folder.path().join(&file)).unwrap();
        assert_eq!(parsed(&text, &[]).unwrap().name, format!("my-{kind}"));
        assert!(text.contains("\"// "), "no remarks");
        let written: Value = serde_json::from_str(&text).unwrap();
        let beside = folder.path().join(written["$schema"].as_str().unwrap());
        let schema: Value = serde_json::from_str(&fs::read_to_string(beside).unwrap()).unwrap();
        assert!(jsonschema::is_valid(&schema, &written), "{kind}");
        let (code, _, err) = slcbeam(folder.path(), &["new", kind, &file]);
        assert!(code == 2 && err.contains("exists and is not overwritten"), "{err}");
        assert_eq!(slcbeam(folder.path(), &["new", kind, &file, "--force"]).0, 0);
    }
}

/// Goal: every section to begin with is a case whose coefficients have errors below 1e-3, and which is written with them as numbers.
#[test]
fn a_starting_section_has_coefficients() {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["honeycomb", "pneunet", "channels", "fibre"] {
        let file = format!("{kind}.json");
        assert_eq!(slcbeam(folder.path(), &["new", "section", &file, "--of", kind]).0, 0);
        let (code, _, err) = slcbeam(folder.path(), &["check", &file]);
        assert_eq!(code, 0, "{kind}: {err}");
        let (code, out, err) = slcbeam(folder.path(), &["coefficients", &file, "--json"]);
        assert_eq!(code, 0, "{kind}: {err}");
        let found: Value = serde_json::from_str(&out).unwrap();
        for key in [
            "bending_stiffness_factor",
            "area_per_moment_m2_per_n_m",
            "permeability_m4",
        ] {
            assert!(
                found[key].as_f64().unwrap() > 0.0 && found["errors"][key].as_f64().unwrap() < 1e-3,
                "{kind} {key}"
            );
        }
    }
    for kind in ["honeycomb", "fibre"] {
        let (file, numbers) = (format!("{kind}.json"), format!("{kind}-numbers.json"));
        let write = ["coefficients", &file, "--case", &numbers];
        assert_eq!(slcbeam(folder.path(), &write).0, 0);
        let (code, _, err) = slcbeam(folder.path(), &write);
        assert!(code == 2 && err.contains("--force"), "{err}");
        let own: Value = serde_json::from_str(&fs::read_to_string(folder.path().join(&numbers)).unwrap()).unwrap();
        let of_file = case::load(&folder.path().join(&file), &[]).unwrap();
        assert_eq!(
            own["beam"]["axial_stiffness_factor"],
            json!(of_file.beam.axial_stiffness_factor)
        );
        assert_eq!(own["bladders"]["lower"] == "none", kind == "fibre");
        let (code, out, err) = slcbeam(folder.path(), &["run", &numbers, "--json", "--set", "/time/end_s=0.02"]);
        assert_eq!(code, 0, "{out} {err}");
    }
    let (code, _, err) = slcbeam(folder.path(), &["new", "beam", "--of", "pneunet"]);
    assert!(code == 2 && err.contains("new section"), "{err}");
}

/// Editors are told the same as `slcbeam check`: with a preset its sections may be partial, without one they may not.
#[test]
fn the_schema_knows_presets_and_remarks() {
    let schema = schema_json();
    let valid = |text: &str| jsonschema::is_valid(&schema, &serde_json::from_str(text).unwrap());
    assert!(valid(LITTLE));
    assert!(valid(&LITTLE.replace(
        "\"ends\"",
        "\"beam\": {\"length_m\": 0.3}, \"bladders\": null, \"ends\""
    )));
    assert!(valid(
        &LITTLE.replace("\"ends\"", "\"tubes\": {\"permeability_m4\": null}, \"ends\"")
    ));
    assert!(!valid(&LITTLE.replace("\"preset\": \"matia-gat-beam\",", "")));
    assert!(!valid(&LITTLE.replace(
        "\"preset\": \"matia-gat-beam\",",
        "\"beam\": {\"length_m\": 0.3},"
    )));
    assert!(!valid(
        &LITTLE.replace("\"ends\"", "\"beam\": {\"lenght_m\": 0.3}, \"ends\"")
    ));
}

/// A case named by its file is one that can be run.
#[test]
fn a_file_with_a_space_names_a_case_without() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(slcbeam(folder.path(), &["new", "beam", "my beam.json"]).0, 0);
    assert_eq!(slcbeam(folder.path(), &["check", "my beam.json"]).0, 0);
}

#[test]
fn outputs_that_miss_the_motion_are_told() {
    let (_, out, _) = slcbeam(
        Path::new("."),
        &[
            "check",
            "cases/wiring-3.json",
            "--set",
            "/time/output_interval_s=0.025",
            "--set",
            "/time/fields_interval_s=0.025",
        ],
    );
    assert!(out.contains("W015"), "{out}");
    let (_, out, _) = slcbeam(Path::new("."), &["check", "cases/wiring-3.json"]);
    assert!(!out.contains("W015"), "{out}");
    let window = ["check", "cases/wiring-3.json", "--set", "/time/window_s=0.002"];
    let (_, out, _) = slcbeam(Path::new("."), &window);
    assert!(!out.contains("in the window"), "{out}");
}

/// A step steeper than steps can follow is refused with what to write instead.
#[test]
fn a_step_too_steep_to_follow_is_a_jump() {
    let steep =
        r#"/ends/tip={"free":{"force_x_n":{"sigmoid":{"amplitude":1,"steepness_per_s":1e12,"midpoint_s":0.1}}}}"#;
    let (code, _, err) = slcbeam(Path::new("."), &["check", "cases/wiring-3.json", "--set", steep]);
    assert!(code == 3 && err.contains("E009") && err.contains("duration 0"), "{err}");
}

/// A sine is heard wherever it acts, alone or as a term or factor.
#[test]
fn sines_in_the_network_are_heard() {
    let sine = r#"{"sine":{"amplitude":1,"frequency_hz":300}}"#;
    let port = |signal: &str| format!(r#"/network/chains/1/ends=[{{"pressure_pa":{signal}}},{{"pressure_pa":0}}]"#);
    let opening =
        r#"/network/chains/0/opening={"sum":[0.5,{"product":[0.25,{"sine":{"amplitude":1,"frequency_hz":300}}]}]}"#;
    let sets = [
        port(sine),
        port(&format!(r#"{{"sum":[3,{sine}]}}"#)),
        port(&format!(
            r#"{{"product":[{{"ramp":{{"to":9,"duration_s":1}}}},{sine}]}}"#
        )),
        opening.to_string(),
        format!(r#"/loads=[{{"force_x_n_m":{{"signal":{{"product":[2,{sine}]}}}}}}]"#),
    ];
    for set in sets {
        let (_, out, _) = slcbeam(Path::new("."), &["check", "cases/wiring-3.json", "--set", &set]);
        assert!(out.contains("W015"), "{set}: {out}");
    }
}

/// Numbers in a sentence have the digits that say something.
#[test]
fn frequencies_are_told_in_three_digits() {
    let sine = r#"/loads=[{"force_x_n_m":{"signal":{"sine":{"amplitude":1,"frequency_hz":333.33333333333331}}}}]"#;
    let (_, out, _) = slcbeam(Path::new("."), &["check", "cases/wiring-3.json", "--set", sine]);
    assert!(
        out.contains("W015") && out.contains("333 Hz") && !out.contains("333.3333"),
        "{out}"
    );
}

/// With `--json` every failure is an object on standard output, whatever the command.
#[test]
fn scripts_are_told_faults_as_json() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.json"), LITTLE.replace("end_s", "ends_s")).unwrap();
    for command in [
        "run",
        "check",
        "equilibrium",
        "modes",
        "study",
        "effects",
        "floquet",
        "periodic",
        "mapping",
    ] {
        let (code, out, err) = slcbeam(folder.path(), &[command, "bad.json", "--json"]);
        assert_eq!(code, 3, "{command}");
        let told: Value = serde_json::from_str(&out).unwrap_or_else(|e| panic!("{command}: {e}: {out}"));
        assert_eq!(told["faults"][0]["code"], "E004");
        assert_eq!(
            (&told["faults"][0]["line"], &told["faults"][0]["nearest"]),
            (&json!(3), &json!("end_s"))
        );
        assert!(err.contains("fault[E004]"), "{err}");
    }
    let (code, out, _) = slcbeam(folder.path(), &["compare", "a", "b", "--json"]);
    assert_eq!(code, 5);
    assert_eq!(serde_json::from_str::<Value>(&out).unwrap()["code"], "E050");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is written");
}

#[test]
fn shells_and_typing_errors() {
    let here = Path::new(".");
    let (code, _, err) = slcbeam(here, &["check", "cases/wirng-3.json"]);
    assert!(code == 2 && err.contains("did you mean cases/wiring-3.json?"), "{err}");
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let (code, script, _) = slcbeam(here, &["completions", shell]);
        assert!(code == 0 && script.contains("equilibrium"), "{shell}");
    }
    let (code, _, err) = slcbeam(here, &["equilibrum", "x"]);
    assert!(code == 2 && err.contains("'equilibrium'"), "{err}");
    let (code, _, err) = slcbeam(here, &["new", "harvestr"]);
    assert!(code == 2 && err.contains("'harvester'"), "{err}");
}

/// The box of a run on a terminal of so many columns, with `COLUMNS` set or not.
fn boxed(columns: u16, set: Option<&str>) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let name = ptsname(&master, vec![]).unwrap().into_string().unwrap();
    let terminal = fs::File::options().read(true).write(true).open(name).unwrap();
    let size = Winsize {
        ws_row: 40,
        ws_col: columns,
        ws_xpixel: 0,
        ws_ypixel: 0,
    };
    tcsetwinsize(&terminal, size).unwrap();
    let case = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/two-bladders.json");
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("slcbeam"));
    command.args(["run", case, "--quiet", "--out", "out"]);
    command.current_dir(&folder).env("NO_COLOR", "1");
    command
        .env_remove("COLUMNS")
        .envs(set.map(|columns| ("COLUMNS", columns)));
    let status = command.stdout(terminal.try_clone().unwrap()).status().unwrap();
    assert!(status.success());
    let (mut text, mut buffer) = (vec![], [0; 4096]);
    let mut master = fs::File::from(master);
    while !text.ends_with("╯\r\n".as_bytes()) {
        let read = master.read(&mut buffer).unwrap();
        text.extend(&buffer[..read]);
    }
    String::from_utf8(text).unwrap().lines().map(String::from).collect()
}

/// Goal: the box is as wide as the terminal, which shells do not tell in `COLUMNS`; where that is set it is believed.
#[test]
fn the_box_fits_the_terminal() {
    for (columns, set, width) in [(70, None, 70), (70, Some("90"), 90), (300, None, 100)] {
        let lines = boxed(columns, set);
        assert!(lines.len() > 5 && lines[0].starts_with('╭'), "{lines:#?}");
        assert!(
            lines.iter().all(|line| line.chars().count() == width),
            "{width}: {lines:#?}"
        );
    }
}
