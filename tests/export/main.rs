//! `slcbeam export`: what ParaView and spreadsheets are given is what `fields.npz` holds, number for number.

mod fmu;
mod piece;
mod structures;
mod surfaces;

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use slcbeam::output::export::instants;
use slcbeam::output::reading;
use tempfile::TempDir;

fn slcbeam(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::cargo_bin("slcbeam").unwrap().args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// A short run of a shipped case; its folder.
fn run(case: &str, dir: &Path, sets: &[&str]) {
    let path = format!("cases/{case}.json");
    let mut arguments = vec!["run", &path, "--quiet", "--out", dir.to_str().unwrap()];
    for set in sets {
        arguments.extend(["--set", set]);
    }
    let (code, _, told) = slcbeam(&arguments);
    assert_eq!(code, Some(0), "{told}");
}

fn export(dir: &Path, more: &[&str]) -> String {
    let mut arguments = vec!["export", dir.to_str().unwrap()];
    arguments.extend(more);
    let (code, said, told) = slcbeam(&arguments);
    assert_eq!(code, Some(0), "{told}");
    said
}

/// Eleven instants of wiring-3, in which pressure, both rows and both networks differ.
const SHORT: [&str; 3] = [
    "/time/end_s=0.02",
    "/time/window_s=0.01",
    "/time/fields_interval_s=0.002",
];

#[test]
fn tables_hold_the_fields_number_for_number() {
    let dir = TempDir::new().unwrap();
    run("wiring-3", dir.path(), &SHORT);
    export(dir.path(), &["--format", "csv"]);
    let from = reading::read(dir.path()).unwrap();
    for field in &from.fields {
        let text = fs::read_to_string(dir.path().join(format!("csv/{}.csv", field.name))).unwrap();
        let mut lines = text.lines();
        let heading: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!((heading.len(), heading[0]), (field.len + 1, "t [s]"));
        match field.name.as_str() {
            "pressure_pa" => assert_eq!(
                heading[1..4],
                ["bladder=1 s=0.0115 m", "bladder=1 s=0.0345 m", "bladder=2 s=0.0115 m"]
            ),
            "normal_force_n" => assert_eq!(heading[1], "theta=0.00125 m"),
            "u1_m" => assert_eq!((heading[1], heading[41]), ("theta=0 m", "theta=0.1 m")),
            _ => {}
        }
        let rows: Vec<Vec<f64>> = lines
            .map(|l| l.split(',').map(|x| x.parse().unwrap()).collect())
            .collect();
        assert_eq!(rows.len(), from.field_times.len());
        for (k, row) in rows.iter().enumerate() {
            assert_eq!(
                (row[0], &row[1..]),
                (from.field_times[k], field.row(k)),
                "{}",
                field.name
            );
        }
    }
}

#[test]
fn instants_are_chosen_by_time_and_number() {
    let times: Vec<f64> = (0..=10).map(|k| 0.1 * f64::from(k)).collect();
    let choose = |list: Option<&str>, every| instants::choose(&times, list, every);
    assert_eq!(choose(None, 1).unwrap().len(), 11);
    assert_eq!(choose(None, 4).unwrap(), [0, 4, 8]);
    assert_eq!(choose(Some("0.52,0.1:0.3"), 1).unwrap(), [1, 2, 3, 5]);
    assert_eq!(choose(Some("0:1"), 5).unwrap(), [0, 5, 10]);
    // 0.1 * 3 is a little more than 0.3: the range still holds it.
    assert_eq!(choose(Some("0.3:0.3"), 1).unwrap(), [3]);
    for bad in ["2", "0.3:0.1", "0.31:0.32", "x", "", "nan", "0.1:"] {
        let told = choose(Some(bad), 1).unwrap_err();
        println!("{told}");
        assert_eq!(told.exit_code(), 2);
        assert!(told.to_string().contains("from 0 s to 1 s"), "{told}");
    }
}

#[test]
fn what_cannot_be_exported_is_refused_with_a_reason() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().to_str().unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert_eq!(code, Some(2));
    assert!(told.contains("no case.json"), "{told}");
    run("two-bladders", dir.path(), &["/time/end_s=0.001"]);
    fs::remove_file(dir.path().join("fields.npz")).unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert!(code == Some(2) && told.contains("no fields.npz"), "{told}");
    fs::create_dir(dir.path().join("fields.part")).unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert!(code == Some(2) && told.contains("--resume"), "{told}");
    fs::write(dir.path().join("fields.npz"), "no archive").unwrap();
    let (code, _, told) = slcbeam(&["export", path]);
    assert!(code == Some(5) && told.contains("fields.npz"), "{told}");
}

/// A second run into the folder takes the exports of the first away, and nothing that is not an export.
#[test]
fn exports_do_not_outlive_their_result() {
    let dir = TempDir::new().unwrap();
    let short = ["/time/end_s=0.001"];
    run("two-bladders", dir.path(), &short);
    export(dir.path(), &[]);
    assert!(dir.path().join("csv/u1_m.csv").exists() && dir.path().join("vtk/two-bladders.pvd").exists());
    fs::write(dir.path().join("csv/notes.txt"), "mine").unwrap();
    run("two-bladders", dir.path(), &short);
    assert!(dir.path().join("csv/notes.txt").exists() && !dir.path().join("vtk").exists());

    // Elsewhere, and told as JSON.
    let other = TempDir::new().unwrap();
    let said = export(
        dir.path(),
        &["--json", "--format", "vtk", "--out", other.path().to_str().unwrap()],
    );
    let told: serde_json::Value = serde_json::from_str(&said).unwrap();
    let files = fs::read_dir(other.path().join("vtk")).unwrap().count();
    assert_eq!(told["formats"]["vtk"]["files"], files);
    assert!(!dir.path().join("vtk").exists());
    // A thinner film leaves none of the frames of the first behind.
    let thin = [
        "--format",
        "vtk",
        "--times",
        "0",
        "--out",
        other.path().to_str().unwrap(),
    ];
    export(dir.path(), &thin);
    assert_eq!(fs::read_dir(other.path().join("vtk")).unwrap().count(), 5);
}
