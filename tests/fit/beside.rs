//! A run over measured data.

use crate::common::*;

const SETS: [&str; 4] = [
    "--set",
    "/mesh/cells_per_segment=4",
    "--set",
    "/probes=[{\"name\": \"p\", \"at\": 0.5}]",
];

/// Goal: data that are the run itself, moved by a hundredth of their largest value, are off by that much in every norm.
#[test]
fn norms_are_those_of_what_was_added() {
    let dir = tempfile::tempdir().expect("a folder");
    let out = path(&dir, "run");
    well(&[&["run", "cases/two-bladders.json", "--out", &out, "--quiet"], &SETS[..]].concat());
    let history = std::fs::read_to_string(dir.path().join("run/history.csv")).expect("a history");
    let mut reader = csv::Reader::from_reader(history.as_bytes());
    let names = reader.headers().expect("headings").clone();
    let place = |name: &str| names.iter().position(|own| own == name).expect(name);
    let (t, p) = (place("t [s]"), place("p_pressure_upper [Pa]"));
    let mut text = String::from("t [ms],first [kPa]\n");
    for record in reader.records().step_by(50) {
        let record = record.expect("a row");
        let value = |k: usize| record[k].parse::<f64>().expect("a number");
        text += &format!("{},{}\n", 1e3 * value(t), 1e-3 * (value(p) - 10.0));
    }
    let data = file(&dir, "data.csv", &text);
    let picture = path(&dir, "over.svg");
    let asked = [
        "compare",
        &out,
        &data,
        "--match",
        "first=pressure@bladder 1",
        "--out",
        &picture,
    ];
    let said = well(&[&asked[..], &["--json"]].concat());
    let found: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    let column = &found["columns"][0];
    // 1000 Pa at the start, of which the data have 990
    for (key, wanted) in [
        ("rms", 10.0),
        ("max", 10.0),
        ("bias", 10.0),
        ("rms_relative", 10.0 / 990.0),
    ] {
        let got = number(&column[key]);
        assert!((got / wanted - 1.0).abs() < 1e-6, "{key}: {got}, wanted {wanted}");
    }
    assert!(std::fs::read_to_string(&picture).is_ok_and(|text| text.starts_with("<svg")));
    assert!(well(&asked).contains("p_pressure_upper_pa") || well(&asked).contains("p_pressure_upper over first"));

    let refused = |data: &str, more: &[&str], words: &str| {
        let said = say(&[&["compare", &out, data], more].concat());
        let plain = said.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            (2..=3).contains(&said.code) && plain.contains(words),
            "{}: {plain}",
            said.code
        );
    };
    refused(&data, &[], "data are compared with --match");
    refused(
        &data,
        &["--match", "first=u1@0.25"],
        "the run has no record at 0.25 of the length",
    );
    let late = file(&dir, "late.csv", "t_s,u_mm\n0,1\n3,1\n");
    refused(
        &late,
        &["--match", "u_mm=tip_u1"],
        "3 s is outside the run (0 s to 0.002 s)",
    );
    refused(&late, &["--match", "u_mm=max_pressure"], "the column u_mm is in mm");
}
