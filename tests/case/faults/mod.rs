//! Files that are no cases, and structure that is wrong: every fault is told, once, where it is.

mod causes;

use std::path::Path;
use std::time::{Duration, Instant};

use crate::faulty::{WIRING, assert_fault, fault_of, one, replaced};
use slcbeam::case;
use slcbeam::error::{Code, Error};

#[test]
fn a_wrong_key_names_the_nearest() {
    let fault = fault_of(&replaced(WIRING, &[("\"viscosity_pa_s\"", "\"viscousity_pa_s\"")]));
    insta::assert_snapshot!(case::render(&fault, false, 100), @r#"
    fault[E004]: unknown key "viscousity_pa_s"
     --> bad.json:9:36 at /fluid/viscousity_pa_s
    9 |   "fluid": {"density_kg_m3": 1000, "viscousity_pa_s": 8.68e-4},
      |                                    ^^^^^^^^^^^^^^^^^
      = allowed: preset, temperature_c, density_kg_m3, viscosity_pa_s, kind, bulk_modulus_pa,
                 gas_fraction, polytropic_exponent, ambient_pressure_pa
      = nearest: did you mean "viscosity_pa_s"?

    1 fault in bad.json
    more about the first: slcbeam explain E004
    "#);
}

/// Goal: a wrong key below the name of a form is told with the nearest as any other is, however few keys the form has. Before, it was
/// taken for a form that is not known, or for "2 keys where one names the form".
#[test]
fn a_wrong_key_in_a_form_names_the_nearest() {
    let tank = |inner: &str| {
        format!(r#", "accumulators": [{{"at": {{"junction": "a"}}, "kind": {{"tank": {inner}}}}}], "junctions": ["a"]"#)
    };
    let cases = [
        (tank(r#"{"volume_m": 1e-5}"#), "/network/accumulators/0/kind/tank/volume_m", "volume_m3"),
        (tank(r#"{"volume_m": 1e-5, "gas": 1}"#), "/network/accumulators/0/kind/tank/volume_m", "volume_m3"),
        (
            r#", "ports": [{"at": {"bladder": 1, "end": "inlet"}, "pressure_pa": {"polynomial": {"coeficients": [1]}}}]"#.into(),
            "/network/ports/0/pressure_pa/polynomial/coeficients",
            "coefficients",
        ),
        (
            r#", "tubes": [{"from": {"bladder": 1, "end": "inlet"}, "to": {"bladder": 2, "end": "inlet"}, "cross_section": {"circle": {"radius": 1e-3}}}]"#
                .into(),
            "/network/tubes/0/cross_section/circle/radius",
            "radius_m",
        ),
    ];
    for (more, pointer, nearest) in cases {
        let mut text: serde_json::Value = serde_json::from_str(WIRING).unwrap();
        let more: serde_json::Value = serde_json::from_str(&format!("{{{}}}", &more[2..])).unwrap();
        for (key, value) in more.as_object().unwrap() {
            text["network"][key] = value.clone();
        }
        let fault = fault_of(&text.to_string());
        let found = fault.violations.iter().find(|v| v.pointer == pointer);
        let found = found.unwrap_or_else(|| panic!("{}", case::render(&fault, false, 100)));
        assert!(found.what.starts_with("unknown key"), "{}", found.what);
        assert_eq!(found.nearest.as_deref(), Some(nearest));
    }
}

/// Goal: a key that a preset brings too is offered for a misspelt one; a key with another unit is told with its number in that of the case.
#[test]
fn a_wrong_key_beside_a_preset_and_with_another_unit_is_offered() {
    let case = |inner: &str| {
        format!(
            r#"{{"name": "a", "preset": "matia-gat-beam", "ends": {{"root": "clamped", "tip": "free"}}, "time": {{"end_s": 1}}, {inner}}}"#
        )
    };
    for (inner, nearest, hint) in [
        (r#""beam": {"lenght_m": 0.2}"#, "length_m", None),
        (
            r#""beam": {"width_mm": 30}"#,
            "width_m",
            Some(r#"write "width_m": 0.03, which is 30 mm"#),
        ),
        (
            r#""beam": {"lenght_cm": 7}"#,
            "length_m",
            Some(r#"write "length_m": 0.07, which is 7 cm"#),
        ),
        (
            r#""beam": {"young_modulus_MPa": 2}"#,
            "young_modulus_pa",
            Some(r#"write "young_modulus_pa": 2e6, which is 2 MPa"#),
        ),
        (
            r#""fluid": {"viscosity_mpa_s": 5}"#,
            "viscosity_pa_s",
            Some(r#"write "viscosity_pa_s": 0.005, which is 5 mPa s"#),
        ),
        (
            r#""beam": {"width_mm": [1]}"#,
            "width_m",
            Some("numbers there are 0.001 times those in mm"),
        ),
        (r#""loads": [{"gravity": {"z_mm_s2": 9810}}]"#, "z_m_s2", None),
        // what is called otherwise, or has no fixed factor
        (
            r#""loads": [{"gravity": {"x_g": 2}}]"#,
            "x_m_s2",
            Some(r#"write "x_m_s2": 19.6133, which is 2 g"#),
        ),
        (
            r#""fluid": {"viscosity_cp": 300}"#,
            "viscosity_pa_s",
            Some(r#"write "viscosity_pa_s": 0.3, which is 300 cP"#),
        ),
        (
            r#""fluid": {"viscosity_cst": 300}"#,
            "viscosity_pa_s",
            Some("cSt is a unit of kinematic viscosity: multiply by 1e-6 and density_kg_m3 to obtain Pa s"),
        ),
        (
            r#""loads": [{"force_x_n_m": {"signal": {"sine": {"amplitude": 1, "omega": 62.83185307179586}}}}]"#,
            "frequency_hz",
            Some(r#"write "frequency_hz": 10, which is 62.83185307179586 rad/s"#),
        ),
    ] {
        let fault = fault_of(&case(inner));
        let [found] = fault.violations.as_slice() else {
            panic!("{}", case::render(&fault, false, 100))
        };
        assert_eq!(
            (found.nearest.as_deref(), found.hint.as_deref()),
            (Some(nearest), hint),
            "{inner}"
        );
    }
}

/// Goal: what is wrong with a number is told of the number, not of a text; what stands in an array that has fewer places is told of the array.
#[test]
fn remedies_are_of_what_is_wrong() {
    let set = |set: &str| {
        let error = case::parse(WIRING, Path::new("good.json"), Path::new("cases"), &[set.into()]).expect_err(set);
        error.to_string()
    };
    for (given, said) in [
        (
            "/fluid/viscosity_pa_s=0.5Pas",
            "`0.5Pas` is not a JSON value; 0.5Pas is 0.5 here: --set '/fluid/viscosity_pa_s=0.5'",
        ),
        (
            "/fluid/viscosity_pa_s=0,5",
            "write decimals with a point: --set '/fluid/viscosity_pa_s=0.5'",
        ),
        ("/name=mine", "a text needs double quotes"),
        (
            "/network/chains/2/ends/0/pressure_pa=0",
            "/network/chains is an array of 2 entries, indices 0 to 1; `2` is not an index of it. /network/chains/- adds an entry",
        ),
    ] {
        let found = set(given);
        assert!(found.contains(said), "{found}");
    }
    let hint = |text: &str, name: &str| match case::parse(text, Path::new(name), Path::new(""), &[]) {
        // what is missing besides stands before it
        Err(Error::Case(fault)) => {
            let found = fault.violations.iter().find(|found| found.code == Code::Text);
            let found = found.expect("a fault of the text");
            (found.what.clone(), found.hint.clone().unwrap_or_default())
        }
        other => panic!("{:?}", other.err()),
    };
    assert_eq!(
        hint(r#"{"time": {"end_s": 0,3}}"#, "a.json").1,
        "write 0.3, with a decimal point"
    );
    assert!(
        hint(r#"{"time": {"end_s": 3s}}"#, "a.json")
            .1
            .contains("3s is 3 here: write the number alone")
    );
    let (what, remedy) = hint("# of a pump\nt_s,p_kpa\n0,1\n", "pump.csv");
    assert!(
        what.contains("seems to be a table") && remedy.contains("slcbeam fit CASE.json DATA.csv"),
        "{what}"
    );
    let folder = case::load(Path::new("cases"), &[]).expect_err("a folder").to_string();
    assert!(folder.contains("it is a folder"), "{folder}");
}

/// Goal: a comma that is missing is told behind the value after which it belongs, not in the line below.
#[test]
fn a_missing_comma_is_told_where_it_belongs() {
    let text = "{\"name\": \"a\",\n \"time\": {\"end_s\": 1 \n\n  \"window_s\": [1 2]}}";
    let place = |text: &str, after: &str| {
        let fault = fault_of(text);
        let [found] = fault.violations.as_slice() else {
            panic!("{}", case::render(&fault, false, 100))
        };
        assert!(found.what.starts_with("a comma is missing before"), "{}", found.what);
        let at = text.find(after).unwrap() + after.len();
        assert_eq!(found.span, Some(at..at));
    };
    place(text, "\"end_s\": 1");
    place(&text.replace("1 \n", "1,\n"), "[1");
}

/// Goal: a time that is none is one fault, not also that whatever lies within the run is longer than it.
#[test]
fn a_time_that_is_none_is_told_once() {
    for (from, to, at) in [
        ("\"end_s\": 0.5", "\"end_s\": -1", "/time/end_s"),
        ("\"end_s\": 0.5", "\"end_s\": 0", "/time/end_s"),
        (
            "\"output_interval_s\": 5e-4",
            "\"output_interval_s\": 0",
            "/time/output_interval_s",
        ),
        (
            "\"fields_interval_s\": 0.001",
            "\"fields_interval_s\": -0.001",
            "/time/fields_interval_s",
        ),
    ] {
        assert_eq!(one(&[(from, to)]).0, at);
    }
}

#[test]
fn numbers_out_of_range() {
    let at = "/fluid/viscosity_pa_s";
    assert_fault(one(&[("8.68e-4", "-8.68e-4")]), at, "-8.68e-4", "out of range");
    assert_fault(one(&[("8.68e-4", "NaN")]), at, "NaN", "not a finite number");
    assert_fault(one(&[("8.68e-4", "-Infinity")]), at, "-Infinity", "not a finite number");
    assert_fault(one(&[("8.68e-4", "1e999")]), at, "1e999", "not a finite number");
    assert_fault(one(&[("8.68e-4", "\"8.68e-4\"")]), at, "\"8.68e-4\"", "found the text");
    assert_fault(
        one(&[("\"per_row\": 10", "\"per_row\": 10.5")]),
        "/bladders/per_row",
        "10.5",
        "not a whole number",
    );
}

#[test]
fn all_faults_at_once_in_the_order_of_the_text() {
    let fault = fault_of(&replaced(
        WIRING,
        &[
            ("\"length_m\": 0.1,", "\"lenght_m\": 0.1,"),
            ("8.68e-4", "-1"),
            ("\"permeability_m4\": 1.55e-12", "\"permeability_m4\": NaN"),
            ("4, 5, 6", "4, 4, 6"),
            (
                "\"tip\": \"free\"",
                "\"tip\": {\"conditions\": {\"u1_m\": 0, \"force_x_n\": 1, \"slope_rad\": 0}}",
            ),
            ("\"formulation\": \"published\"", "\"formulation\": \"publishd\""),
            ("\"end_s\": 0.5", "\"end_s\": \"0.5\""),
        ],
    ));
    let pointers: Vec<&str> = fault.violations.iter().map(|v| v.pointer.as_str()).collect();
    let wanted = [
        "/beam/lenght_m",
        "/fluid/viscosity_pa_s",
        "/bladders/permeability_m4",
        "/ends/tip/conditions",
        "/ends/tip/conditions/force_x_n",
        "/formulation",
        "/time/end_s",
    ];
    assert!(wanted.iter().all(|pointer| pointers.contains(pointer)), "{pointers:?}");
    assert!(
        fault
            .violations
            .windows(2)
            .all(|w| w[0].span.as_ref().unwrap().start <= w[1].span.as_ref().unwrap().start)
    );
}

#[test]
fn a_key_given_twice() {
    let twice = "\"density_kg_m3\": 1000, \"density_kg_m3\": 1";
    let (pointer, marked, what) = one(&[("\"density_kg_m3\": 1000", twice)]);
    assert_eq!(
        (pointer.as_str(), marked.as_str()),
        ("/fluid/density_kg_m3", "\"density_kg_m3\"")
    );
    assert!(what.contains("given twice, first in line 9"), "{what}");
}

#[test]
fn a_truncated_file_says_where_it_breaks_off() {
    let end = WIRING.trim_end().len();
    for length in (1..end).filter(|length| WIRING.is_char_boundary(*length)) {
        let fault = fault_of(&WIRING[..length]);
        assert_eq!(fault.violations.len(), 1, "{length}");
    }
    let fault = fault_of(&WIRING[..WIRING.find("\"chains\"").unwrap()]);
    insta::assert_snapshot!(case::render(&fault, false, 100), @r#"
    fault[E001]: the text ends inside the object that opens in line 18: expected a key
      --> bad.json:18:15 at /network
    18 |   "network": {
       |               ^
       = hint: the file is cut off, or a closing bracket or quote is missing

    1 fault in bad.json
    more about the first: slcbeam explain E001
    "#);
}

#[test]
fn garbage_ends_at_once_with_one_short_message() {
    const MANY: usize = 10_000_000;
    let garbage = [
        "x".repeat(MANY),
        "[".repeat(MANY),
        "{\"a\":".repeat(MANY / 5),
        format!("\"{}", "é".repeat(MANY / 2)),
        "\u{1}".repeat(MANY),
        "1".repeat(MANY),
    ];
    for text in garbage {
        let start = Instant::now();
        let fault = fault_of(&text);
        let message = case::render(&fault, true, 100);
        assert_eq!(fault.violations.len().min(2), 1, "{message}");
        assert!(message.len() < 2000);
        assert!(start.elapsed() < Duration::from_secs(5));
    }
}

#[test]
fn files_that_are_not_text() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.json");
    let first = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        match case::load(&path, &[]) {
            Err(Error::Case(fault)) => {
                assert_eq!(fault.violations.len(), 1);
                fault.violations[0].clone()
            }
            other => panic!("{other:?}"),
        }
    };
    assert!(
        first(b"{\"name\": \"\xff\"}")
            .what
            .contains("byte 10 of the file is not UTF-8")
    );
    assert!(first(b"\xff\xfe{\0").hint.unwrap().contains("UTF-16"));
    assert!(
        first(format!("\u{feff}{WIRING}").as_bytes())
            .what
            .contains("byte order mark")
    );
    assert!(first(b"").what.contains("empty"));
    let large = std::fs::File::create(&path).unwrap();
    large.set_len(65 << 20).unwrap();
    let Err(Error::Case(fault)) = case::load(&path, &[]) else {
        panic!("taken for a case")
    };
    assert_eq!(
        fault.violations[0].allowed.as_deref(),
        Some("case files of up to 64 MB")
    );
}

#[test]
fn a_fault_of_an_argument_is_shown_in_the_argument() {
    let sets = ["/fluid/viscosity_pa_s=-1".to_owned(), "/slover/rtol=1e-3".to_owned()];
    let Err(Error::Case(fault)) = case::parse(WIRING, Path::new("w.json"), Path::new("cases"), &sets) else {
        panic!()
    };
    insta::assert_snapshot!(case::render(&fault, false, 100), @r#"
    fault[E004]: unknown key "slover"
     --> --set at /slover
    1 | /slover/rtol=1e-3
      | ^^^^^^^^^^^^
      = allowed: $schema, name, about, preset, section, beam, fluid, bladders, spans, beams, joints,
                 tubes, network, loads, attachments, foundation, contacts, beam_contacts, surroundings,
                 rotating_frame, ends, start, formulation, plausibility, effects, effects_tolerance,
                 mesh, time, solver, companion, probes, step_response
      = nearest: did you mean "solver"?

    fault[E006]: -1 is out of range
     --> --set at /fluid/viscosity_pa_s
    1 | /fluid/viscosity_pa_s=-1
      |                       ^^
      = allowed: numbers greater than 0

    2 faults in w.json
    more about the first: slcbeam explain E004
    "#);
}
