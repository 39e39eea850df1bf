//! Formats of what is written, held to their numbers.
//!
//! Goal: a checkpoint of another shape has another number, since a build that reads one must find all of it; a summary keeps
//! every key of its format, and may have more. `tests/data/formats/NAME-FORMAT.txt` lists the keys of one run. Where a test asks for
//! another number: raise it, then `KEEP_FORMATS=1 cargo test --release --test formats` writes the list of the new one.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;
use slcbeam::case::{self, parameter::Parameter};
use slcbeam::discrete::System;
use slcbeam::output::folder::{CHECKPOINT, SUMMARY};
use slcbeam::output::kind::FolderKind;
use slcbeam::output::{FolderRecorder, Labels, ResultFolder};
use slcbeam::results::verify::VerifiedRow;
use slcbeam::results::{self, Provenance, ResultFile, run::Summary};
use slcbeam::run::{dynamics, record::Control, summary::Status};

/// A wet beam, derivatives, a probe and step responses, a history with an envelope, checkpoints.
const SETS: [&str; 9] = [
    "/time/checkpoint_interval_s=0.01",
    "/time/end_s=0.04",
    "/time/window_s=0.01",
    "/time/history=\"window\"",
    "/solver/rtol=1e-4",
    "/mesh/cells_per_segment=2",
    "/mesh/cells_per_bladder=1",
    "/probes=[{\"name\": \"middle\", \"at\": 0.5}]",
    "/step_response={}",
];

/// A line a value, each once: its keys, `[]` for places in a list, and what it is.
fn shape(value: &Value, place: &str, all: &mut BTreeSet<String>) {
    let kind = match value {
        Value::Object(entries) => {
            entries
                .iter()
                .for_each(|(key, value)| shape(value, &format!("{place} / {key}"), all));
            "object"
        }
        Value::Array(entries) => {
            entries
                .iter()
                .for_each(|value| shape(value, &format!("{place} / []"), all));
            "list"
        }
        Value::String(_) => "text",
        Value::Number(_) => "number",
        Value::Bool(_) => "yes or no",
        Value::Null => "nothing",
    };
    all.insert(format!("{place}: {kind}"));
}

/// The list of a format, or the one that is asked to be kept.
fn kept(name: &str, format: u64, now: &BTreeSet<String>) -> BTreeSet<String> {
    let path = Path::new("tests/data/formats").join(format!("{name}-{format}.txt"));
    if std::env::var_os("KEEP_FORMATS").is_some() && !path.exists() {
        let text: String = now.iter().map(|line| format!("{line}\n")).collect();
        fs::write(&path, text).expect("written");
    }
    let text =
        fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}; see the top of {}", path.display(), file!()));
    text.lines().map(String::from).collect()
}

#[test]
fn what_is_written_has_the_shape_of_its_format() {
    let sets = SETS.map(String::from);
    let case = case::load("cases/wiring-2.json".as_ref(), &sets).expect("a case");
    let by = Parameter::find(&case, "/beam/young_modulus_pa").expect("a number");
    let dir = tempfile::tempdir().expect("a folder");
    let labels = Labels {
        case_name: case.name.clone(),
        case: case.written(),
        frequency_hz: None,
        bladders: Default::default(),
    };
    // Stopped, so that the checkpoint stays.
    let hook = |progress: &slcbeam::run::record::Progress| match progress.t > 0.035 {
        true => Control::Stop("enough".into()),
        false => Control::Continue,
    };
    let folder = ResultFolder::claim(dir.path(), FolderKind::Run, false).expect("claimed");
    let mut recorder = FolderRecorder::new(folder, labels, Box::new(hook));
    let outcome =
        dynamics::run_with(&case, System::new(&case).expect("a system"), &[by], &mut recorder).expect("a run");
    assert_eq!(outcome.summary.status, Status::Stopped);
    recorder
        .finish(&outcome.summary)
        .expect("finished")
        .close()
        .expect("closed");

    let text = fs::read_to_string(dir.path().join(CHECKPOINT)).expect("a checkpoint");
    let mut now = BTreeSet::new();
    let mut lines = text
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).expect("JSON"));
    let (heading, body) = (lines.next().expect("a heading"), lines.next().expect("a body"));
    shape(&heading, "heading", &mut now);
    shape(&body, "checkpoint", &mut now);
    let before = kept("checkpoint", heading["format"].as_u64().expect("a number"), &now);
    let changed: Vec<_> = before.symmetric_difference(&now).collect();
    assert!(
        changed.is_empty(),
        "raise FORMAT of src/output/checkpoint.rs: {changed:#?}"
    );

    let text = fs::read_to_string(dir.path().join(SUMMARY)).expect("a summary");
    let mut now = BTreeSet::new();
    shape(&serde_json::from_str(&text).expect("JSON"), "summary", &mut now);
    let before = kept("summary", Summary::FORMAT.into(), &now);
    let gone: Vec<_> = before
        .difference(&now)
        .filter(|line| !line.contains("/ commit"))
        .collect();
    assert!(
        gone.is_empty(),
        "raise FORMAT of Summary in src/results/run.rs: {gone:#?}"
    );
    assert_eq!(
        results::read::<Summary>(&text).expect("read").result.status,
        Status::Stopped
    );
}

/// Source: a row as it is printed. Goal: what is missing, of another kind or of a later version is told with its place; what
/// an earlier version wrote is read.
#[test]
fn what_is_missing_is_told_with_its_place() {
    let figure = r#"{"quantity": "x", "computed": 1, "exact": null, "error": 0, "error_is": "relative", "tolerance": 1, "passed": true}"#;
    let row = |more: &str, figure: &str| {
        format!(
            r#"{{{more} "name": "n", "source": "s", "goal": "g", "tolerance_reason": "r", "passed": true, "figures": [{figure}]}}"#
        )
    };
    let why = |text: String| results::read::<VerifiedRow>(&text).expect_err("a fault").to_string();
    let found = results::read::<VerifiedRow>(&row("", figure)).expect("read");
    assert!(found.head.format.is_none() && found.head.describe().contains("no format number"));
    assert!(found.result.figures.expect("figures")[0].exact.is_nan());
    let missing = why(row(r#""format": 1,"#, &figure.replace(r#""exact": null, "#, "")));
    assert!(missing.starts_with("/figures/0: missing field `exact`"), "{missing}");
    let other = why(row("", &figure.replace("relative", "relativ")));
    assert!(
        other.starts_with("/figures/0/error_is: unknown variant") && other.contains("no format number"),
        "{other}"
    );
    let later = why(row(r#""format": 7,"#, figure));
    assert!(later.contains("format 7 of a later version"), "{later}");
    assert!(why("{".into()).contains("EOF"));
}

/// Goal: what is written is read back, and says what made it.
#[test]
fn what_is_written_says_what_made_it() {
    let row = VerifiedRow::default();
    let found = results::read::<VerifiedRow>(&results::text(&row)).expect("read");
    assert_eq!((found.result, found.head.format), (row, Some(VerifiedRow::FORMAT)));
    assert_eq!(found.head.provenance, Some(Provenance::new(None)));
    assert!(
        found.head.describe().contains("SUNDIALS 6."),
        "{}",
        found.head.describe()
    );
}
