//! Names in results: whatever a file holds is explained.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::thread;

use serde_json::Value;

use super::text::slcbeam;

/// Goal: every heading of a table and every key of a file that commands leave is explained.
#[test]
fn names_in_results_are_explained() {
    let folder = tempfile::tempdir().expect("a folder");
    let short = ["--set", "/time/end_s=0.01", "--set", "/time/window_s=0.005", "--quiet"];
    let jobs: [(&str, &[&str]); 3] = [
        ("run", &[&["cases/wiring-2.json"], &short[..]].concat()),
        ("equilibrium", &["cases/syringe-finger.json", "--at", "1"]),
        (
            "modes",
            &[
                "cases/few-cells.json",
                "--count",
                "3",
                "--uncertain",
                "/beam/young_modulus_pa=normal:2e6:1e5",
                "--samples",
                "16",
                "--indices",
            ],
        ),
    ];
    let mut names = BTreeSet::new();
    for (command, words) in jobs {
        let dir = folder.path().join(command);
        let out = dir.to_str().expect("text");
        let (code, _, err) = slcbeam(Path::new("."), &[&[command], words, &["--out", out]].concat());
        assert!(code == 0, "{command}: {err}");
        for entry in fs::read_dir(&dir).expect("the folder") {
            let path = entry.expect("a file").path();
            let text = fs::read_to_string(&path).unwrap_or_default();
            match path.extension().and_then(|end| end.to_str()) {
                Some("csv") => names.extend(headings(&text)),
                Some("json") if !path.ends_with("case.json") => {
                    keys(&serde_json::from_str(&text).expect("JSON"), &mut names);
                }
                _ => {}
            }
        }
    }
    assert!(names.len() > 250, "{}", names.len());
    let names: Vec<String> = names.into_iter().collect();
    let unknown = |part: &[String]| -> Vec<String> {
        let asked = |name: &&String| slcbeam(Path::new("."), &["explain", name]).0 != 0;
        part.iter().filter(asked).cloned().collect()
    };
    let unknown: Vec<String> = thread::scope(|scope| {
        let parts: Vec<_> = names.chunks(names.len().div_ceil(2)).collect();
        let asked: Vec<_> = parts
            .into_iter()
            .map(|part| scope.spawn(move || unknown(part)))
            .collect();
        asked.into_iter().flat_map(|one| one.join().expect("answers")).collect()
    });
    assert!(unknown.is_empty(), "not explained: {}", unknown.join(", "));
}

/// Goal: words, letters and figures as people type them lead somewhere.
#[test]
fn words_as_they_are_typed_are_explained() {
    for (asked, word) in [
        ("mu", "μ (symbol): "),
        ("rho", "ρ_s (symbol): "),
        ("Young's modulus", "young_modulus_pa"),
        ("natural frequency", "slcbeam modes"),
        ("bending stiffness", "bending_stiffness_factor"),
        ("buckling", "slcbeam equilibrium"),
        ("multiplier", "slcbeam floquet"),
        ("torque", "moment_x_n"),
        ("pressure drop", "tube_resistance_pa_s_m3"),
        ("f_u", "forcing frequency times fluid time [1], a characteristic number"),
        (
            "slowest_time_of_network_2_s",
            "longest time constant of pressure equalization in a network [s]",
        ),
        ("tip_u1_m.max_abs", "max_abs (result): the largest magnitude"),
        (
            "bladder__1_pressure",
            "of bladder -3 it is bladder__3_pressure [Pa], see docs/names.md",
        ),
    ] {
        let (code, said, err) = slcbeam(Path::new("."), &["explain", asked]);
        assert!(code == 0 && said.contains(word), "{asked}: {said}{err}");
    }
}

/// Names of columns, without units.
fn headings(text: &str) -> Vec<String> {
    let line = text.lines().next().unwrap_or_default();
    let names = line.split(',').map(|name| name.split(" [").next().unwrap_or(name));
    names.map(str::to_owned).collect()
}

fn keys(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) => {
            for (key, inner) in object {
                // pointers are those of the case
                if !key.starts_with('/') {
                    names.insert(key.clone());
                }
                keys(inner, names);
            }
        }
        Value::Array(all) => {
            if let Some(first) = all.first() {
                keys(first, names);
            }
        }
        _ => {}
    }
}
