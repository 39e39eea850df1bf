//! Oscillations that `slcbeam modes` selects and their numbers.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::cli::modes;

/// Goal: oscillating modes are numbered from slow to fast, as in sweeps, even if one is strongly damped.
#[test]
fn modes_are_numbered_by_frequency() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("m");
    let (code, said, _) = modes(&[
        "cases/tour-harvester.json",
        "--count",
        "8",
        "--json",
        "--out",
        out.to_str().unwrap(),
    ]);
    let json: Value = serde_json::from_str(&said).unwrap();
    let all = json["modes"].as_array().unwrap();
    let frequencies: Vec<f64> = all.iter().filter_map(|mode| mode["frequency_hz"].as_f64()).collect();
    assert!(code == 0 && frequencies.len() > 4, "{said}");
    assert!(frequencies.is_sorted(), "{frequencies:?}");
    // sorted by the distance from zero, their order differs
    let size = |mode: &Value| {
        mode["growth_per_s"]
            .as_f64()
            .unwrap()
            .hypot(mode["angular_frequency_per_s"].as_f64().unwrap())
    };
    let sizes: Vec<f64> = all
        .iter()
        .filter(|mode| mode["frequency_hz"].is_number())
        .map(size)
        .collect();
    assert!(!sizes.is_sorted(), "{sizes:?}");
}

/// Goal: without a kind, oscillations beyond many decays are listed: as many as requested, the lowest ones for every count, and all of
/// a case that has fewer. Source: all eigenvalues, of which the longest list contains every oscillation.
#[test]
fn the_lowest_oscillations_are_listed_for_every_count() {
    let dir = TempDir::new().unwrap();
    let found = |case: &str, cells: &str, count: &str| {
        let (out, set) = (dir.path().join(count), format!("/mesh/cells_per_bladder={cells}"));
        let options = [
            "--set",
            &set,
            "--set",
            "/mesh/cells_per_segment=1",
            "--count",
            count,
            "--quiet",
            "--out",
            out.to_str().unwrap(),
        ];
        let (code, said, error) = modes(&[&[case][..], &options].concat());
        assert_eq!(code, 0, "{error}");
        let text = fs::read_to_string(out.join("modes.json")).unwrap();
        fs::remove_dir_all(&out).unwrap();
        let json: Value = serde_json::from_str(&text).unwrap();
        let of = |mode: &Value| mode["frequency_hz"].as_f64();
        (
            json["modes"]
                .as_array()
                .unwrap()
                .iter()
                .filter_map(of)
                .collect::<Vec<f64>>(),
            said,
        )
    };
    for (case, cells) in [("cases/fibre-bender.json", "1"), ("cases/tapered-finger.json", "2")] {
        let (all, said) = found(case, cells, "300");
        assert!(said.contains("oscillations in all") && all.len() > 8, "{said}");
        for count in [1, 3, 8] {
            let (listed, said) = found(case, cells, &count.to_string());
            assert_eq!(listed.len(), count, "{said}");
            let same = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() < 1e-6;
            assert!(listed.iter().zip(&all).all(same), "{listed:?} {all:?}");
        }
    }
}

/// Goal: a beam with material damping on many cells, whose overdamped vibrations have nearly equal rates, lists its oscillations, and a
/// warning states that others are not listed. Source: the same beam on a fourth of the cells, with all eigenvalues computed.
#[test]
fn oscillations_beside_a_cluster_are_found() {
    let dir = TempDir::new().unwrap();
    let found = |cells: &str| {
        let (out, set) = (dir.path().join(cells), format!("/mesh/cells_per_segment={cells}"));
        let case = ["cases/tour-beam.json", "--set", &set, "--json", "--quiet"];
        let (code, said, error) =
            modes(&[&case[..], &["--kind", "oscillation", "--out", out.to_str().unwrap()]].concat());
        assert_eq!(code, 0, "{error}");
        let json: Value = serde_json::from_str(&said).unwrap();
        let of = |mode: &Value| mode["frequency_hz"].as_f64();
        let all: Vec<f64> = json["modes"].as_array().unwrap().iter().filter_map(of).collect();
        (all, json["warnings"].to_string())
    };
    let ((coarse, few), (fine, many)) = (found("1"), found("16"));
    assert!(many.contains("W025") && !few.contains("W025"), "{many} {few}");
    assert!(fine.len() >= 5 && coarse.len() >= 5, "{coarse:?} {fine:?}");
    for (a, b) in coarse.iter().zip(&fine).take(3) {
        assert!((a / b - 1.0).abs() < 0.05, "{coarse:?} {fine:?}");
    }
}
