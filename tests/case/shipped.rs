//! The cases that ship, the schema, and what the command line puts into a case.

use std::path::{Path, PathBuf};

use serde_json::json;
use slcbeam::case::schema::{Case, MaxOrder};
use slcbeam::case::{self, LineColumns, Rotation, Translation, meanings, rewrite};
use slcbeam::error::Error;
use slcbeam::functions;

fn shipped() -> Vec<PathBuf> {
    let entries = std::fs::read_dir("cases").unwrap().map(|entry| entry.unwrap().path());
    let json = entries.filter(|path| path.extension().is_some_and(|e| e == "json") && !path.ends_with("schema.json"));
    let mut paths: Vec<_> = json.collect();
    paths.sort();
    assert!(paths.len() >= 20);
    paths
}

fn load(path: &Path, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    match case::load(path, &sets) {
        Ok(case) => case,
        Err(Error::Case(fault)) => panic!("{}", case::render(&fault, false, 100)),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn every_shipped_case_is_valid_and_named_as_its_file() {
    for path in shipped() {
        let case = load(&path, &[]);
        assert_eq!(
            Some(case.name.as_str()),
            path.file_stem().and_then(|stem| stem.to_str())
        );
        assert!(!case.about.is_empty());
    }
}

#[test]
fn every_shipped_case_fits_the_schema() {
    let schema: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string("cases/schema.json").unwrap()).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    for path in shipped() {
        let value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        if let Err(error) = validator.validate(&value) {
            panic!("{}: {error} at {}", path.display(), error.instance_path());
        }
        let resolved = serde_json::from_str(&load(&path, &[]).resolved_json()).unwrap();
        assert!(validator.is_valid(&resolved), "{} as resolved", path.display());
    }
}

/// Regenerate with `slcbeam schema > cases/schema.json`.
#[test]
fn the_committed_schema_is_the_generated_one() {
    let committed = std::fs::read_to_string("cases/schema.json").unwrap();
    assert_eq!(committed.trim_end(), format!("{:#}", case::schema_json()));
}

#[test]
fn the_readme_of_the_cases_names_each() {
    let readme = std::fs::read_to_string("cases/README.md").unwrap();
    for path in shipped() {
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        assert!(
            readme.contains(&format!("`{name}`")),
            "{name} is not in cases/README.md"
        );
    }
}

#[test]
fn a_resolved_case_reads_back_as_itself_and_needs_no_other_file() {
    for path in shipped() {
        let resolved = load(&path, &[]).resolved();
        let text = resolved.resolved_json();
        let again = case::parse(&text, Path::new("case.json"), Path::new("/nowhere"), &[]).unwrap();
        // the spans of a structure follow from its beams
        assert_eq!(again.resolved(), resolved);
    }
}

#[test]
fn defaults_are_filled_in() {
    let case = load(Path::new("cases/two-bladders.json"), &[]).resolved();
    assert_eq!(case.solver.max_order, MaxOrder::Auto);
    assert_eq!(case.mesh.segments, Some(1));
    assert_eq!(case.time.window_s, Some(2e-4));
    let value: serde_json::Value = serde_json::from_str(&case.resolved_json()).unwrap();
    for pointer in [
        "/solver/rtol",
        "/beam/damping/drag_n_s_m2",
        "/network/permeability_factor",
        "/effects",
        "/loads",
    ] {
        assert!(value.pointer(pointer).is_some(), "{pointer}");
    }
}

#[test]
fn values_from_the_command_line_win() {
    let path = Path::new("cases/valves-open.json");
    let sets = [
        "/solver/rtol=1e-7",
        "/network/permeability_factor=0.5",
        "/bladders/coupling=\"reciprocal\"",
        "/network/chains/0/ends/1={\"pressure_pa\": 10}",
        "/loads/-={\"gravity\": {\"x_m_s2\": 9.81}}",
        "/time/window_s=null",
    ];
    let case = load(path, &sets);
    assert_eq!(case.solver.rtol, 1e-7);
    assert_eq!(case.network.unwrap().permeability_factor, 0.5);
    assert_eq!(case.loads.len(), 1);
    assert_eq!(case.time.window_s, None);
}

#[test]
fn arguments_that_make_no_sense_are_usage_errors() {
    let path = Path::new("cases/valves-open.json");
    let arguments = [
        ("/name", "expected POINTER=JSON"),
        ("name=1", "starts with `/`"),
        ("/name=foo", "'/name=\"foo\"'"),
        ("/solver/rtol=NaN", "not a finite number"),
        ("/ends/tip/free/force_x_n=1", "/ends/tip is \"free\""),
        ("/network/chains/7/opening=1", "array of 1"),
    ];
    for (argument, wanted) in arguments {
        let error = case::load(path, &[argument.to_owned()]).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{argument}");
        assert!(error.to_string().contains(wanted), "{argument}: {error}");
    }
    assert_eq!(
        case::load(Path::new("cases/no-such.json"), &[])
            .unwrap_err()
            .exit_code(),
        2
    );
}

#[test]
fn names_of_ends_stand_for_their_conditions() {
    let read = |json: &str| serde_json::from_str::<slcbeam::case::schema::End>(json).unwrap();
    let free = read("\"free\"").resolve();
    assert!(matches!(
        (free.transverse, free.rotation, free.axial),
        (Translation::Force(_), Rotation::Moment(_), Translation::Force(_))
    ));
    let pinned = read("{\"pinned\": {\"moment_n_m\": 2}}").resolve();
    assert!(matches!(pinned.transverse, Translation::Displacement(_)));
    assert_eq!(pinned.rotation, Rotation::Moment(functions::Signal::constant(2.0)));
    let guided = read("\"guided\"").resolve();
    assert!(matches!(
        (guided.transverse, guided.rotation, guided.axial),
        (Translation::Force(_), Rotation::Slope(_), Translation::Displacement(_))
    ));
    let sliding = read("{\"guided\": {\"force_z_n\": 1}}").resolve();
    assert_eq!(sliding.axial, Translation::Force(functions::Signal::constant(1.0)));
    let follower = read("{\"free\": {\"follower_shear_n\": 3}}")
        .resolve()
        .follower
        .unwrap();
    assert_eq!(
        (follower.normal, follower.shear),
        (functions::Signal::constant(0.0), functions::Signal::constant(3.0))
    );
    for text in ["\"free\"", "\"guided\"", "{\"clamped\":{\"u3_m\":1.0}}"] {
        assert_eq!(serde_json::to_string(&read(text)).unwrap(), text);
    }
    assert!(serde_json::from_str::<slcbeam::case::schema::End>("{\"clamped\": {\"force_x_n\": 1}}").is_err());
}

/// The paper's beam as `docs/exact-results.md` section 4 gives it, in every case of a figure.
#[test]
fn the_cases_of_the_figures_share_the_papers_beam() {
    let of_figure = |case: &&Case| case.about.starts_with("Fig.");
    let cases: Vec<Case> = shipped().iter().map(|path| load(path, &[])).collect();
    assert_eq!(cases.iter().filter(of_figure).count(), 15);
    for case in cases.iter().filter(of_figure) {
        let beam = &case.beam;
        assert_eq!((beam.length_m, beam.height_m, beam.width_m), (0.1, 0.0216, 0.05));
        assert_eq!(
            (beam.axial_stiffness_factor, beam.bending_stiffness_factor),
            (0.53, 0.60)
        );
        assert_eq!(case.formulation, slcbeam::case::schema::Formulation::Published);
    }
}

#[test]
fn a_value_is_replaced_or_added_and_nothing_else_changes() {
    let off = json!({"asymmetry": "off", "flow": "on"});
    let new = r#""effects": {"asymmetry": "off", "flow": "on"}"#;
    let cases = [
        (
            "{\n  \"a\": 1,\n\t\"b\":  [1,\n 2]\n}\n",
            format!("{{\n  \"a\": 1,\n\t\"b\":  [1,\n 2],\n\t{new}\n}}\n"),
        ),
        ("{\r\n  \"a\": 1\r\n}", format!("{{\r\n  \"a\": 1,\r\n  {new}\r\n}}")),
        (
            "{\"a\": {\"effects\": 2}}",
            format!("{{\"a\": {{\"effects\": 2}}, {new}}}"),
        ),
        (
            "{\"effects\": {\"flow\": [ ]} , \"ä\": 1e5}",
            format!("{{{new} , \"ä\": 1e5}}"),
        ),
        ("{ }", format!("{{ {new}}}")),
    ];
    for (before, after) in cases {
        assert_eq!(rewrite(before, "effects", &off).as_deref(), Some(&*after));
    }
    assert_eq!(rewrite("[1]", "effects", &off), None);
}

/// Goal: an editor explains every key and word; what is measured says in which unit.
#[test]
fn every_key_says_what_it_means() {
    let silent: Vec<String> = meanings()
        .into_iter()
        .filter(|m| m.meaning.len() < 4)
        .map(|m| m.place)
        .collect();
    assert!(silent.is_empty(), "no meaning: {silent:?}");
    let suffixes = ["_m", "_s", "_pa", "_hz", "_rad", "_m4", "_kg_m3", "_m2_per_pa"];
    let unitless: Vec<String> = meanings()
        .into_iter()
        .filter(|m| suffixes.iter().any(|s| m.name.ends_with(s)) && !m.meaning.contains('['))
        .map(|m| format!("{}: {}", m.place, m.meaning))
        .collect();
    assert!(unitless.is_empty(), "no unit: {unitless:#?}");
}

/// Goal: an editor has an example for every object, a description for every key and a title for every alternative, of which one alone holds; the
/// examples are what they are examples of. (`StrainEnergy` is written by `slcbeam coefficients`, not by people.)
#[test]
fn the_schema_has_words_for_everything() {
    let schema = case::schema_json();
    let definitions = schema["$defs"].as_object().unwrap();
    let mut silent = vec![];
    for (name, definition) in definitions {
        words_of(definition, name, &mut silent);
        if name.trim_end_matches("OverPreset") == "StrainEnergy" {
            continue;
        }
        // an object among alternatives has one of its own, which is valid there and nowhere else
        for branch in definition["oneOf"].as_array().into_iter().flatten() {
            let title = branch["title"].as_str().unwrap_or_default();
            if branch["properties"].is_null() {
                continue;
            }
            let own = json!({"oneOf": [branch], "$defs": definitions});
            let valid = |example| jsonschema::is_valid(&own, example);
            if !branch["examples"].get(0).is_some_and(valid) {
                silent.push(format!("{name}, {title}: a valid example"));
            }
        }
        let Some(example) = definition["examples"].get(0) else {
            silent.push(format!("{name}: an example"));
            continue;
        };
        let own = json!({"$ref": format!("#/$defs/{name}"), "$defs": definitions});
        if let Err(error) = jsonschema::validator_for(&own).unwrap().validate(example) {
            silent.push(format!("{name}: a valid example: {error}"));
        }
    }
    for choice in ["then", "else"] {
        words_of(&schema[choice], choice, &mut silent);
    }
    assert!(silent.is_empty(), "{silent:#?}");
    let whole = schema["examples"][0].to_string();
    case::parse(&whole, Path::new("example.json"), Path::new(""), &[]).expect("a case");
    assert!(jsonschema::is_valid(&schema, &schema["examples"][0]));
}

fn words_of(part: &serde_json::Value, place: &str, silent: &mut Vec<String>) {
    for (key, inner) in part["properties"].as_object().into_iter().flatten() {
        if inner["description"].as_str().is_none_or(|text| text.len() < 4) {
            silent.push(format!("{place}/{key}: a description"));
        }
        words_of(inner, &format!("{place}/{key}"), silent);
    }
    if part.get("anyOf").is_some() {
        silent.push(format!("{place}: one alternative alone"));
    }
    for (k, branch) in part["oneOf"].as_array().into_iter().flatten().enumerate() {
        if branch["title"].as_str().is_none() {
            silent.push(format!("{place}: a title of alternative {k}"));
        }
        words_of(branch, &format!("{place}/{k}"), silent);
    }
}

/// Goal: in whatever order bytes are asked for, each has its line and column.
#[test]
fn places_do_not_depend_on_what_was_asked_before() {
    let text = "ab\nä\n\nlast";
    let mut places = LineColumns::new(text);
    let all: Vec<_> = [0, 1, 3, 5, 7, 8, 100, 3, 6, 4]
        .map(|at| places.line_and_column(at))
        .into();
    let wanted = [
        (1, 1),
        (1, 2),
        (2, 1),
        (2, 2),
        (4, 1),
        (4, 2),
        (4, 5),
        (2, 1),
        (3, 1),
        (2, 1),
    ];
    assert_eq!(all, wanted);
}
