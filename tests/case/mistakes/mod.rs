//! Mistakes that people make, each with its place and what to do about it.

mod table;

use std::path::Path;

use crate::program::say;
use slcbeam::case;
use slcbeam::error::{CaseError, Error, Violation};
use table::{GOOD, OF_TEXT, PUMP};

fn read(text: &str, sets: &[&str]) -> Result<(), Error> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    case::parse(text, Path::new("good.json"), Path::new("cases"), &sets).map(|_| ())
}

/// All that is told besides what is wrong.
fn remedy(found: &Violation) -> String {
    let parts = [&found.nearest, &found.hint, &found.allowed];
    let parts: Vec<&str> = parts.into_iter().flatten().map(String::as_str).collect();
    parts.join("; ")
}

/// The fault of a case with one change; it has no other.
fn fault(from: &str, to: &str) -> (CaseError, Violation) {
    assert!(GOOD.contains(from), "{from}");
    match read(&GOOD.replacen(from, to, 1), &[]) {
        Err(Error::Case(fault)) => {
            let [found] = &fault.violations[..] else {
                panic!("{to}: {}", case::render(&fault, false, 100))
            };
            let found = found.clone();
            (*fault, found)
        }
        other => panic!("{to}: {other:?}"),
    }
}

/// Goal: each is caught, alone, where it is, with what to do.
#[test]
fn mistakes_in_a_case_are_told_where_they_are_with_a_remedy() {
    read(GOOD, &[]).expect("a good case");
    for (from, to, pointer, mark, said) in OF_TEXT {
        let (fault, found) = fault(from, to);
        let span = found.span.clone().expect("a place");
        assert_eq!(found.pointer, pointer, "{to}: {}", found.what);
        match mark.strip_prefix('|') {
            Some(before) => {
                assert!(
                    span.is_empty() && fault.text[..span.start].ends_with(before),
                    "{to}: {span:?}"
                );
            }
            None => {
                assert_eq!(&fault.text[span.clone()], mark, "{to}: {}", found.what);
                let change = GOOD.find(from).expect("a change");
                assert!((change..change + to.len()).contains(&span.start), "{to}: {span:?}");
            }
        }
        assert!(
            remedy(&found).contains(said),
            "{to}: {}; {}",
            found.what,
            remedy(&found)
        );
    }
}

/// Goal: the same of what is set on the command line; a number there is never offered without its unit.
#[test]
fn mistakes_in_an_argument_are_told_with_a_remedy() {
    for (set, said) in [
        (
            format!("{PUMP}=60kPa"),
            format!("60kPa is 60000 here: --set '{PUMP}=60000'"),
        ),
        (format!("{PUMP}=60 000"), format!("--set '{PUMP}=60000'")),
        (
            format!("{PUMP}=60 mm"),
            "mm is a unit of another quantity; the number here is in Pa".into(),
        ),
        (format!("{PUMP}=1/2"), "write 0.5".into()),
        (
            "/beam/young_modulus_pa=2MPa".into(),
            "2MPa is 2e6 here: --set '/beam/young_modulus_pa=2e6'".into(),
        ),
        (
            "/time/end_s=500ms".into(),
            "500ms is 0.5 here: --set '/time/end_s=0.5'".into(),
        ),
        (
            "/beam/length_m=10cm".into(),
            "10cm is 0.1 here: --set '/beam/length_m=0.1'".into(),
        ),
        ("/bladders/per_row=True".into(), "write true, in small letters".into()),
        (
            "length_m=0.2".into(),
            "a JSON pointer starts with `/`: /beam/length_m".into(),
        ),
        (
            "/loads/2/gravity/x_m_s2=1".into(),
            "/loads is an array of 2 entries, indices 0 to 1; `2` is not an index of it. /loads/- adds an entry".into(),
        ),
        ("/loads/2={\"gravity\": {}}".into(), "/loads/- adds an entry".into()),
    ] {
        match read(GOOD, &[&set]) {
            Err(Error::Usage(what)) => assert!(what.contains(&said), "{set}: {what}"),
            other => panic!("{set}: {other:?}"),
        }
    }
    read(GOOD, &["/loads/-/gravity/x_m_s2=1"]).expect("one more");
    let Err(Error::Case(fault)) = read(GOOD, &[&format!("{PUMP}=\"60 kPa\"")]) else {
        panic!()
    };
    assert!(remedy(&fault.violations[0]).contains("60 kPa is 60000 here"));
}

/// Goal: the same of options of commands, and of files and folders of another kind than is wanted.
#[test]
fn mistakes_on_the_command_line_are_told_with_a_remedy() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = |name: &str| dir.path().join(name).display().to_string();
    let case = path("dry.json");
    let dry = r#"{"name": "dry", "beam": {"length_m": 0.1, "height_m": 0.004, "width_m": 0.02, "young_modulus_pa": 2e6, "density_kg_m3": 1000},
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 0.01}}"#;
    std::fs::write(&case, dry).expect("a case");
    let (modes, run) = (path("modes"), path("run"));
    for arguments in [
        // short for --out; a percentage and a unit are what they say
        [
            "modes",
            &case,
            "-o",
            &modes,
            "--quiet",
            "--at",
            "5ms",
            "--accuracy",
            "10%",
        ]
        .as_slice(),
        &["run", &case, "-o", &run, "--quiet", "--lean"],
    ] {
        let said = say(arguments);
        assert_eq!(said.code, 0, "{arguments:?}: {}", said.err);
    }
    let summary = format!("{run}/summary.json");
    let modulus = "/beam/young_modulus_pa";
    for (arguments, told) in [
        (
            vec!["sweep", &case, "--vary", "/beam/young_modulus_pa=2MPa,3MPa"],
            "2MPa is 2e6 here, 3MPa is 3e6 here: --vary '/beam/young_modulus_pa=2e6,3e6'",
        ),
        (
            vec![
                "optimize",
                &case,
                "--maximize",
                "tip_u1_m",
                "--vary",
                "/beam/length_m=10cm:20cm",
            ],
            "--vary '/beam/length_m=0.1:0.2'",
        ),
        (
            vec!["run", &case, "--uncertain", "/beam/length_m=normal:10cm:1mm"],
            "--uncertain '/beam/length_m=normal:0.1:0.001'",
        ),
        (vec!["sweep", &case, "--vary", "young_modulus_pa=1e6,2e6"], modulus),
        (vec!["modes", &case, "--count", "2.5"], "expected a whole number"),
        (
            vec!["run", &case, "--accuracy", "1mm"],
            "expected a number such as 0.01, or 1%",
        ),
        (vec!["compare", &run, &modes], "contains the result of `slcbeam modes`"),
        (
            vec!["compare", &run, &case],
            "is a file (perhaps a case), not a result folder",
        ),
        (vec!["report", &case], "is a file (perhaps a case), not a result folder"),
        (vec!["export", &modes], "contains the result of `slcbeam modes`"),
        (vec!["check", &summary], "this is a result, not a case"),
    ] {
        let said = say(&arguments);
        assert!(said.code != 0 && said.err.contains(told), "{arguments:?}: {}", said.err);
    }
    // what may be meant is told, not refused
    for (set, told) in [
        (
            "/beam/damping={\"bending_time_s\": 2}",
            "longer than the period of the first bending mode",
        ),
        ("/loads=[{\"gravity\": {\"x_m_s2\": 150}}]", "is this in mm/s^2?"),
        ("/ends/root=\"free\"", "no support holds the beam along"),
    ] {
        let said = say(&["check", &case, "--set", set]);
        assert!(
            said.code == 0 && said.out.contains(told) && said.out.contains("W031"),
            "{set}: {} {}",
            said.out,
            said.err
        );
        let said = say(&["check", &case, "--set", set, "--set", "/plausibility=\"off\""]);
        assert!(!said.out.contains(told), "{set}");
    }
    let pad = "cases/tour-actuator.json";
    let clamped = |what: &str| format!("/ends/root={{\"clamped\": {{{what}}}}}");
    let sine = "\"u1_m\": {\"sine\": {\"amplitude\": 0.001, \"frequency_hz\": 3, \"phase_rad\": 90}}";
    for (set, told) in [
        (
            "/network/chains/0/ends/0/pressure_pa=161325".to_string(),
            "seems to be absolute, 60000 Pa above",
        ),
        (clamped("\"slope_rad\": 90"), "is this in degrees?"),
        (clamped(sine), "is this in degrees?"),
        (
            "/bladders/area_per_pressure_m2_per_pa=1e-7".into(),
            "3290 times the section of a bladder",
        ),
        ("/fluid/density_kg_m3=1".into(), "lighter than any liquid"),
    ] {
        let said = say(&["check", pad, "--set", &set]);
        assert!(
            said.out.contains("W031") && said.out.contains(told),
            "{set}: {}",
            said.out
        );
    }
    assert!(!say(&["check", pad]).out.contains("W031"));
    let wiring = dir.path().join("wiring.json").display().to_string();
    assert_eq!(say(&["new", "wiring", &wiring]).code, 0);
    let said = say(&["check", &wiring]);
    assert!(said.code == 0 && !said.out.contains("W037"), "{}", said.out);
}
