//! Sections of spans: the values that a span has from its own unit cell, the refused combinations, and cases of results.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::inherited;
use slcbeam::case::spans::segments;
use slcbeam::case::{self, Case, Origin};
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::Status;

const CASE: &str = include_str!("../../cases/section-actuator.json");

/// The shipped actuator of 80 mm, with a plane cell, both rows pumped from bladder 1 to `bladders`.
fn actuator(bladders: i64, spans: &Value) -> Value {
    let mut case: Value = serde_json::from_str(CASE).unwrap();
    case["section"]["three_d"] = json!(false);
    case["spans"] = spans.clone();
    case["companion"] = json!("off");
    case["time"] = json!({"end_s": 0.1, "output_interval_s": 0.01});
    for (row, sign) in [1, -1].into_iter().enumerate() {
        case["network"]["chains"][row]["bladders"] = (1..=bladders).map(|k| sign * k).collect();
    }
    case
}

/// A lower section with smaller bladders every 5 mm.
fn small() -> Value {
    json!({
        "height_m": 0.016, "width_m": 0.018, "pitch_m": 0.005,
        "material": {"young_modulus_pa": 5e5, "poisson_ratio": 0.49, "density_kg_m3": 1070.0},
        "bladders": {"length_m": 0.014, "upper": {"center_m": 0.004, "shape": {"circle": {"radius_m": 0.002}}}, "lower": "mirrored"}
    })
}

/// The actuator with five bladders of the case in each row, and eight of the small section.
fn two_sections() -> Value {
    actuator(13, &json!([{"length_m": 0.04}, {"section": small()}]))
}

fn read(case: &Value, sets: &[&str]) -> slcbeam::error::Result<Case> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    case::parse(&case.to_string(), Path::new("mine.json"), Path::new(""), &sets)
}

/// Pointers of all faults.
fn refused(case: &Value, sets: &[&str]) -> Vec<String> {
    match read(case, sets) {
        Err(Error::Case(fault)) => fault.violations.iter().map(|v| v.pointer.clone()).collect(),
        other => panic!("{sets:?}: {other:?}"),
    }
}

fn run(case: &Value) -> Memory {
    let mut memory = Memory::default();
    let summary = dynamics::run(&read(case, &[]).unwrap(), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    memory
}

fn column(memory: &Memory, name: &str) -> Vec<f64> {
    memory.column(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// Runs `slcbeam coefficients` with a section or a case.
fn coefficients(input: &Value, arguments: &[&str]) -> std::process::Output {
    let mut command = assert_cmd::Command::cargo_bin("slcbeam").unwrap();
    command.args(["coefficients", "-"]).args(arguments);
    command.write_stdin(input.to_string()).output().unwrap()
}

/// Numbers that `slcbeam coefficients --case` writes for a section, in the form of a span.
fn copied(section: &Value, segments: usize) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.json");
    assert!(
        coefficients(section, &["--case", path.to_str().unwrap()])
            .status
            .success()
    );
    let mut case: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let rows = match case["bladders"].get("lower") {
        None => "both",
        Some(_) => "upper",
    };
    for (part, keys) in [
        ("beam", &["length_m"][..]),
        ("bladders", &["length_m", "per_row", "lower"]),
    ] {
        let part = case[part].as_object_mut().unwrap();
        keys.iter().for_each(|key| {
            part.shift_remove(*key);
        });
    }
    json!({"segments": segments, "rows": rows, "beam": case["beam"], "bladders": case["bladders"]})
}

/// Goal: a span has the numbers of its own unit cell, also its number of segments; a case with these numbers in place of the section has
/// the same run to the last bit; the origin of each coefficient is the section, and plane cells with short bladders give W022.
#[test]
fn a_span_has_the_numbers_of_its_section() {
    let inline = two_sections();
    let case = read(&inline, &[]).unwrap();
    assert_eq!(
        (case.spans[1].segments, case.bladders.as_ref().unwrap().per_row),
        (Some(8), 13)
    );
    let numbers = actuator(13, &json!([{"length_m": 0.04}, copied(&small(), 8)]));
    assert_eq!(segments(&case), segments(&read(&numbers, &[]).unwrap()));
    assert_eq!(run(&inline).rows, run(&numbers).rows);
    for key in [
        "beam/bending_stiffness_factor",
        "bladders/permeability_m4",
        "bladders/area_per_moment_m2_per_n_m/opening",
    ] {
        let origin = case.origins.get(&format!("/spans/1/{key}"));
        assert_eq!(origin, Some(Origin::Section { three_d: false }), "{key}");
    }
    let warnings = inherited::warnings(&case);
    let plane: Vec<_> = warnings.iter().filter(|warning| warning.starts_with("W022")).collect();
    assert!(
        plane.len() == 1 && plane[0].contains("/section, /spans/1/section"),
        "{warnings:?}"
    );
    assert!(
        warnings.iter().all(|warning| !warning.starts_with("W017")),
        "{warnings:?}"
    );
    let printed = coefficients(&inline, &["--json", "--span", "1"]);
    assert_eq!(printed.stdout, coefficients(&small(), &["--json"]).stdout);
    let absent = coefficients(&inline, &["--span", "0"]);
    assert!(String::from_utf8_lossy(&absent.stderr).contains("span 0 has no section"));
    let mut null = inline.clone();
    null["spans"][1]["beam"] = json!(null);
    null["spans"][1]["bladders"] = json!({"height_m": null});
    assert_eq!(segments(&read(&null, &[]).unwrap()), segments(&case));
    // a coefficient of the span has priority
    let measured = read(
        &inline,
        &["/spans/1/beam={\"bending_stiffness_factor\": 0.5, \"height_m\": 0.016}"],
    )
    .unwrap();
    assert_eq!(segments(&measured)[12].beam.bending_stiffness_factor, 0.5);
    let origin = |key: &str| measured.origins.get(&format!("/spans/1/beam/{key}"));
    assert_eq!(origin("bending_stiffness_factor"), Some(Origin::Set));
    assert_eq!(
        origin("axial_stiffness_factor"),
        Some(Origin::Section { three_d: false })
    );
}

/// Goal: a span with the section of the case is the uniform beam. Tolerance: rounding of the lengths of segments.
#[test]
fn a_span_with_the_section_of_the_case_is_the_uniform_beam() {
    let uniform = actuator(10, &json!([]));
    let same = actuator(10, &json!([{"length_m": 0.032, "section": uniform["section"]}, {}]));
    let [a, b] = [uniform, same].map(|case| column(&run(&case), "tip_u1"));
    let largest = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(largest > 1e-5);
    assert!(
        a.iter().zip(&b).all(|(x, y)| (x - y).abs() <= 1e-12 * largest),
        "{a:?} {b:?}"
    );
}

/// Goal: all spans may have sections; then no pitch is that of the case, and the section of the case gives sizes of tubes and bladders only.
#[test]
fn all_spans_may_have_sections_of_their_own() {
    let spans = json!([{"length_m": 0.04, "section": small()}, {"section": small(), "segments": 8}]);
    let case = read(&actuator(16, &spans), &[]).unwrap();
    assert_eq!(
        case.spans.iter().map(|span| span.segments).collect::<Vec<_>>(),
        [Some(8), Some(8)]
    );
    let time = slcbeam::case::parameter::Parameter::find(&case, "/beam/damping/bending_time_s").unwrap();
    assert_eq!(segments(&time.changed(&case, 0.003).unwrap()).len(), 16);
    let mut own = actuator(16, &json!([]));
    own["section"] = small();
    let mut whole = segments(&case);
    whole.dedup();
    assert_eq!(whole.len(), 1);
    assert_eq!(
        whole[0].beam.bending_stiffness_factor,
        read(&own, &[]).unwrap().beam.bending_stiffness_factor
    );
}

/// Goal: rows follow a section with one row, the upper or the lower one, with its neutral axis; turned over, the beam moves as its mirror
/// image.
#[test]
fn rows_follow_a_section_with_one_row() {
    let with = |row: usize| {
        let mut section = small();
        let bladder = section["bladders"]["upper"].clone();
        let mut lower = bladder.clone();
        lower["center_m"] = json!(-0.004);
        section["bladders"]["upper"] = [bladder, json!("none")][row].clone();
        section["bladders"]["lower"] = [json!("none"), lower][row].clone();
        let mut case = actuator(13, &json!([{"length_m": 0.04}, {"section": section}]));
        case["network"]["chains"] = json!([{"bladders": (6..=13).map(|k| [k, -k][row]).collect::<Vec<i64>>(),
            "ends": [{"pressure_pa": {"ramp": {"to": 10000, "duration_s": 0.05}}}, "sealed"]}]);
        case
    };
    let cases = [0, 1].map(|row| read(&with(row), &[]).unwrap());
    let last = cases.each_ref().map(|case| segments(case).pop().unwrap());
    assert_eq!([last[0].rows, last[1].rows], [[true, false], [false, true]]);
    let axes = last.each_ref().map(|one| one.beam.neutral_axis_m);
    assert!(
        axes[0] < -1e-5 && (axes[0] + axes[1]).abs() < 1e-6 * axes[1],
        "{axes:?}"
    );
    let [up, down] = [0, 1].map(|row| column(&run(&with(row)), "tip_u1"));
    let largest = up.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let apart = up.iter().zip(&down).map(|(x, y)| (x + y).abs()).fold(0.0, f64::max);
    assert!(largest > 1e-5 && apart < 1e-6 * largest, "{apart:.1e} of {largest:.1e}");
}

/// Goal: a section without bladders gives stiffness, density and neutral axis, also in a dry beam, whatever its pitch; a mass factor of
/// the case is not that of the span.
#[test]
fn a_section_without_bladders_stiffens_a_span() {
    let mut layered = small();
    layered["bladders"] = json!({"length_m": 0.014, "upper": "none", "lower": "none"});
    layered["pitch_m"] = json!(0.007);
    layered["regions"] = json!([{"shape": {"layer": {"high_m": [-0.008, -0.006]}},
        "material": {"young_modulus_pa": 5e6, "poisson_ratio": 0.4, "density_kg_m3": 2140.0}}]);
    let case = read(
        &actuator(5, &json!([{"length_m": 0.04}, {"length_m": 0.04, "section": layered}])),
        &[],
    )
    .unwrap();
    let last = segments(&case).pop().unwrap();
    assert_eq!((last.rows, case.spans[1].segments), ([false; 2], None));
    // the stiff eighth lies between 6 and 8 mm below mid-height: z_n = Σ E A z/Σ E A
    let exact = 5e6 * 2.0 * -7.0 / (5e6 * 2.0 + 5e5 * 14.0) + 5e5 * 14.0 / (5e6 * 2.0 + 5e5 * 14.0);
    assert!(
        (last.beam.neutral_axis_m * 1e3 / exact - 1.0).abs() < 0.02,
        "{} {exact}",
        last.beam.neutral_axis_m
    );
    assert!((last.beam.density_kg_m3 / (1.125 * 1070.0) - 1.0).abs() < 1e-9);
    let dry = json!({"name": "dry", "beam": {"length_m": 0.1, "height_m": 0.016, "width_m": 0.018, "young_modulus_pa": 5e5,
            "density_kg_m3": 1070, "mass_factor": 1.3},
        "spans": [{"length_m": 0.05, "section": layered}, {}],
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1}});
    let beam = segments(&read(&dry, &[]).unwrap())[0].beam.clone();
    assert_eq!(
        (beam.bending_stiffness_factor, beam.shear_stiffness_n),
        (last.beam.bending_stiffness_factor, None)
    );
    assert!((beam.mass_factor.unwrap() - 1.0).abs() < 1e-9);
    let wet = json!([{"length_m": 0.05, "section": small()}, {}]);
    let mut wet = json!({"spans": wet});
    for (key, value) in dry.as_object().unwrap().iter().filter(|(key, _)| *key != "spans") {
        wet[key] = value.clone();
    }
    assert_eq!(refused(&wet, &["/mesh/segments=20"]), ["/spans/0/section/bladders"]);
}

/// Goal: a section that does not fit its span or its case is refused at its place, alone.
#[test]
fn sections_that_do_not_fit_are_refused() {
    let case = two_sections();
    let lower = r#"/spans/1/section/bladders/lower={"center_m": -0.004, "shape": {"circle": {"radius_m": 0.0015}}}"#;
    for (set, place) in [
        ("/spans/1/section/pitch_m=0.0045", "/spans/1"),
        ("/spans/1/segments=7", "/spans/1/segments"),
        ("/spans/1/rows=\"upper\"", "/spans/1/rows"),
        ("/spans/1/rows=\"none\"", "/spans/1/rows"),
        ("/spans/1/beam={\"height_m\": 0.02}", "/spans/1/beam/height_m"),
        (
            "/spans/1/beam={\"height_m\": {\"linear\": [0.016, 0.02]}}",
            "/spans/1/beam/height_m",
        ),
        (
            "/spans/1/beam={\"neutral_axis_m\": 0.001}",
            "/spans/1/beam/neutral_axis_m",
        ),
        ("/spans/1/bladders={\"width_m\": 0.003}", "/spans/1/bladders/width_m"),
        (
            "/spans/1/section/bladders/length_m=0.012",
            "/spans/1/section/bladders/length_m",
        ),
        (
            "/spans/1/section/material/law=\"neo_hookean\"",
            "/spans/1/section/material",
        ),
        (
            "/spans/1/section/material/poisson_ratio=0.5",
            "/spans/1/section/material/poisson_ratio",
        ),
        ("/spans/1/section/heigth_m=0.02", "/spans/1/section/heigth_m"),
        ("/spans/1/section=3", "/spans/1/section"),
        ("/section/material/poisson_ratio=0.5", "/section/material/poisson_ratio"),
        (lower, "/spans/1/section/bladders/lower"),
    ] {
        assert_eq!(refused(&case, &[set]), [place], "{set}");
    }
    let Err(Error::Case(fault)) = read(&case, &["/spans/1/section/pitch_m=0.0045"]) else {
        panic!("the pitch is accepted")
    };
    assert_eq!(
        fault.violations[0].allowed.as_deref(),
        Some("multiples of 0.0045 m; nearest 0.036 or 0.0405")
    );
    let one_row = ["/section/bladders/lower=\"none\"", "/network/chains/1=null"];
    assert_eq!(refused(&case, &one_row), ["/spans/1/section/bladders/lower"]);
    let linear = read(&case, &["/spans/1/section/material/law=\"linear\""]).unwrap();
    assert_eq!(segments(&linear), segments(&read(&case, &[]).unwrap()));
}

/// Goal: at finite strain, spans with bladders have the section of the case or none of their own.
#[test]
fn finite_strain_belongs_to_the_section_of_the_case() {
    let mut case = two_sections();
    case["section"]["material"]["law"] = json!("neo_hookean");
    assert_eq!(refused(&case, &[]), ["/spans/1/section"]);
    let mut same = actuator(10, &json!([]));
    same["section"]["material"]["law"] = json!("neo_hookean");
    same["spans"] = json!([{"length_m": 0.04, "section": same["section"]}, {}]);
    let read = read(&same, &[]).unwrap();
    assert!(read.bladders.unwrap().strain_energy.is_some());
}

/// Goal: the case of a result reads back as the same case; a changed section, pitch or coefficient changes it as the case that it came
/// from; without the section the numbers remain; numbers of the section have no derivatives.
#[test]
fn the_case_of_a_result_keeps_the_sections_of_spans() {
    let written = two_sections();
    let case = read(&written, &[]).unwrap();
    let text = case.resolved_json();
    let result: Value = serde_json::from_str(&text).unwrap();
    let again = read(&result, &[]).unwrap();
    assert_eq!(again.resolved_json(), text);
    assert_eq!(again.origins.describe(), case.origins.describe());
    for sets in [
        &["/spans/1/section/height_m=0.017"][..],
        &[
            "/spans/1/section/pitch_m=0.008",
            "/network=null",
            "/network={\"chains\": []}",
        ],
        &[
            "/spans/0/length_m=0.048",
            "/spans/1/section/pitch_m=0.004",
            "/spans/1/section/bladders/upper/shape/circle/radius_m=0.0015",
        ],
        &["/spans/1/beam/bending_stiffness_factor=0.5"],
        &["/section/height_m=0.021"],
    ] {
        let [from_result, from_case] = [&result, &written].map(|case| match read(case, sets) {
            Ok(case) => case.resolved_json(),
            Err(error) => format!("{error:?}"),
        });
        assert!(from_case.starts_with('{'), "{from_case}");
        assert_eq!(from_result, from_case, "{sets:?}");
    }
    let numbers = read(&result, &["/spans/1/section=null"]).unwrap();
    assert_eq!(segments(&numbers), segments(&case));
    let find = |pointer: &str| slcbeam::case::parameter::Parameter::find(&case, pointer);
    for pointer in [
        "/spans/1/section/height_m",
        "/spans/1/beam/height_m",
        "/spans/1/length_m",
    ] {
        assert!(find(pointer).unwrap_err().to_string().contains("section"), "{pointer}");
    }
    let factor = find("/spans/1/beam/bending_stiffness_factor").unwrap();
    let softer = factor.changed(&case, 0.7).unwrap();
    let (before, after) = (segments(&case), segments(&softer));
    assert_eq!(before[..5], after[..5]);
    assert_eq!(
        (after[12].beam.bending_stiffness_factor, &after[12].bladders),
        (0.7, &before[12].bladders)
    );
}

/// Goal: lengths that change the pitch of a section, in their span or in the rest of the beam, are refused as parameters.
#[test]
fn lengths_that_change_the_pitch_of_a_section_are_refused() {
    let mut full = small();
    full["bladders"] = json!({"length_m": 0.014, "upper": "none", "lower": "none"});
    let ends = json!([{"length_m": 0.04}, {"length_m": 0.02, "segments": 1, "section": full}, {"segments": 1, "rows": "none"}]);
    for (case, pointer, section) in [
        (two_sections(), "/spans/0/length_m", "/section"),
        (two_sections(), "/beam/length_m", "/spans/1/section"),
        (actuator(10, &json!([])), "/beam/length_m", "/section"),
        (actuator(5, &ends), "/spans/0/length_m", "/section"),
        (actuator(5, &ends), "/spans/1/length_m", ""),
    ] {
        let found = slcbeam::case::parameter::Parameter::find(&read(&case, &[]).unwrap(), pointer);
        let text = found.map_or_else(|error| error.to_string(), |_| String::new());
        let part = format!("coefficients of {section} are computed; use `slcbeam sweep --vary`");
        assert_eq!(text.contains(&part), !section.is_empty(), "{pointer}: {text}");
        assert_eq!(text.is_empty(), section.is_empty(), "{pointer}: {text}");
    }
}
