//! What rows tell.

use std::fs;
use std::path::Path;

use serde_json::Value;
use slcbeam::output::npz::Npz;
use slcbeam::results::sweep::{Sweep, SweepPlan};
use slcbeam::results::{self, ResultFile};
use tempfile::TempDir;

use super::common::{AREA, CASE, SHORT, json, path, rows, say, swept, well};

/// Source: summaries of single runs. Goal: a row has every figure of the summary of the same case, bit for bit, with its error.
#[test]
fn a_row_is_what_the_run_tells() {
    let dir = TempDir::new().expect("a folder");
    let (out, alone) = (path(&dir, "sweep"), path(&dir, "alone"));
    let vary = format!("{AREA}=log:1e-10:1e-9:3");
    well(&swept(&out, &["--vary", &vary]));
    let rows = rows(&out);
    assert_eq!(rows.len(), 3);
    let set = format!("{AREA}={}", rows[1][AREA]);
    well(&say(&[
        &["run", CASE, "--quiet", "--out", &alone, "--set", &set],
        &SHORT[..],
    ]
    .concat()));
    let summary = json(&alone, "summary.json");
    let mut compared = 0;
    for (name, quantity) in summary["quantities"].as_object().expect("quantities") {
        for (figure, value) in quantity.as_object().expect("figures") {
            let there: f64 = rows[1][&format!("{name}.{figure}")].parse().expect("a number");
            assert_eq!(Some(there), value.as_f64(), "{name}.{figure}");
            compared += 1;
        }
    }
    assert!(compared > 20, "{compared}");
    let errors = summary["errors"]["tip_u3_m"].as_object().expect("errors");
    let largest = errors.values().filter_map(Value::as_f64).fold(0.0, f64::max);
    let size = summary["quantities"]["tip_u3_m"]["max_abs"].as_f64().expect("a size");
    let error: f64 = rows[1]["tip_u3_m.error"].parse().expect("an error");
    assert!((error * size / largest - 1.0).abs() < 1e-12, "{error} {largest} {size}");
    assert_eq!(rows[1]["steps"], summary["solver"]["steps"].to_string());
    // plan and table are told apart by their formats, and read back
    let read = |name: &str| fs::read_to_string(Path::new(&out).join(name)).expect("a file");
    let plan = results::read::<SweepPlan>(&read("plan.json")).expect("a plan");
    let found = results::read::<Sweep>(&read("sweep.json")).expect("a table");
    assert_eq!(
        (plan.head.format, found.head.format),
        (Some(SweepPlan::FORMAT), Some(Sweep::FORMAT))
    );
    assert_eq!(found.result.plan, plan.result);
    // the arrays are the table's
    let mut npz = Npz::open(&Path::new(&out).join("sweep.npz")).expect("arrays");
    let told = json(&out, "sweep.json");
    assert_eq!(
        (&told["complete"], &told["rows"], &told["statuses"]["finished"]),
        (&true.into(), &3.into(), &3.into())
    );
    for column in told["columns"].as_array().expect("columns") {
        let (Some(name), Some(array)) = (column["name"].as_str(), column["array"].as_str()) else {
            continue;
        };
        if ["status", "case"].contains(&name) {
            continue;
        }
        let values = npz.read(array).expect("an array");
        for (row, value) in rows.iter().zip(values) {
            assert_eq!(
                row[name].parse::<f64>().unwrap_or(f64::NAN).to_bits(),
                value.to_bits(),
                "{name}"
            );
        }
    }
}

/// Goal: figures of the other commands are those that the commands tell.
#[test]
fn other_commands_tell_their_figures() {
    let dir = TempDir::new().expect("a folder");
    let vary = format!("{AREA}=2e-10,4e-10");
    for (what, file, names) in [
        ("equilibrium", "equilibrium.json", ["tip_u3_m", "max_pressure_pa"]),
        ("modes", "modes.json", ["mode_1.frequency_hz", "mode_1.damping_ratio"]),
    ] {
        let (out, alone) = (path(&dir, what), path(&dir, &format!("{what}-alone")));
        well(&swept(&out, &["--vary", &vary, "--command", what]));
        let set = format!("{AREA}=4e-10");
        well(&say(&[
            &[what, CASE, "--quiet", "--out", &alone, "--set", &set],
            &SHORT[..],
        ]
        .concat()));
        let (rows, told) = (rows(&out), json(&alone, file));
        for name in names {
            let there = match what {
                "equilibrium" => told["quantities"][name].as_f64(),
                _ => {
                    let modes = told["modes"].as_array().expect("modes").iter();
                    let swinging = modes.filter(|mode| mode["frequency_hz"].is_number());
                    let hz = |mode: &&Value| mode["frequency_hz"].as_f64().expect("a frequency");
                    let lowest = swinging.min_by(|a, b| hz(a).total_cmp(&hz(b))).expect("one swings");
                    lowest[name.trim_start_matches("mode_1.")].as_f64()
                }
            };
            assert_eq!(rows[1][name].parse().ok(), there, "{name}");
        }
        assert_eq!(rows[1]["stable"], "1");
        // what the command warns of the row warns of; the bladders are filled, so that modes are about a state that moves
        let code = |warning: &Value| warning.as_str().expect("a text")[..4].to_string();
        let warned = told["warnings"].as_array().expect("warnings").iter().map(code);
        let (row, alone): (Vec<_>, Vec<_>) = (rows[1]["warnings"].split(' ').collect(), warned.collect());
        assert_eq!(alone.contains(&"W013".to_string()), what == "modes", "{alone:?}");
        assert!(what != "modes" || row.contains(&"W013"), "{row:?}");
        // of the modes that it tells
        let worst = rows[1]
            .iter()
            .filter(|(name, _)| name.starts_with("mode_") && name.ends_with(".error"))
            .filter_map(|(_, error)| error.parse::<f64>().ok())
            .fold(0.0, f64::max);
        assert!(
            what != "modes" || row.contains(&"W021") == (worst > 0.05),
            "{row:?}, {worst}"
        );
        let error = if what == "modes" {
            "mode_1.frequency_hz.error"
        } else {
            "max_pressure_pa.error"
        };
        assert!(rows[1][error].parse::<f64>().expect("an error") < 0.1);
    }
}

/// Goal: a design that does not reach the accuracy that was asked for says so in its row and in the words at the end, one that does has no
/// reason.
#[test]
fn an_accuracy_that_is_not_reached_is_told() {
    let dir = TempDir::new().expect("a folder");
    let vary = format!("{AREA}=2e-10");
    for (command, accuracy, reached) in [("equilibrium", "0.3", true), ("modes", "1e-6", false)] {
        let out = path(&dir, command);
        let said = swept(&out, &["--vary", &vary, "--command", command, "--accuracy", accuracy]);
        well(&said);
        let row = &rows(&out)[0];
        assert_eq!(row["accuracy_reached"], if reached { "1" } else { "0" }, "{row:?}");
        assert_eq!(row["warnings"].contains("W012"), !reached, "{row:?}");
        assert_eq!(row["reason"].starts_with("W012 accuracy 1e-6"), !reached, "{row:?}");
        assert_eq!(
            said.out.contains("1 design does not reach the accuracy"),
            !reached,
            "{}",
            said.out
        );
    }
}

/// Goal: a cycle tells harvested energy, mean power and efficiency with how far their balance is open.
#[test]
fn cycles_tell_what_is_harvested() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "cycles");
    let more = [
        "--quiet",
        "--lean",
        "--out",
        &out,
        "--set",
        "/mesh/cells_per_segment=1",
        "--set",
        "/mesh/cells_per_bladder=1",
        "--vary",
        "/network/permeability_factor=0.5,1",
        "--command",
        "periodic",
        "--no-mesh-errors",
    ];
    well(&say(
        &[&["sweep", "cases/harvester-parallel-uniform.json"], &more[..]].concat()
    ));
    for row in rows(&out) {
        let number = |name: &str| row[name].parse::<f64>().expect("a number");
        let (energy, period) = (number("harvested_energy_j.window"), number("period_s"));
        assert_eq!(number("harvested_power_w.mean"), energy / period);
        assert!(energy > 0.0 && number("harvested_energy_j.window_error") >= 0.0);
        let efficiency = number("efficiency.window");
        assert!(
            (efficiency / (energy / number("input_energy_j.window")) - 1.0).abs() < 0.01,
            "{efficiency}"
        );
        assert!(
            !row.contains_key("harvested_energy_j.window.error"),
            "no meshes were asked for"
        );
    }
}

/// Goal: the error of a mean power is that of its energy, relative to it.
#[test]
fn mean_powers_have_the_errors_of_their_energies() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "powers");
    let asked = "sweep cases/harvester-parallel-uniform.json --quiet --lean --command periodic --vary /network/permeability_factor=1 \
                 --set /mesh/cells_per_segment=1 --set /mesh/cells_per_bladder=1 --out";
    let asked: Vec<&str> = asked.split_whitespace().chain([out.as_str()]).collect();
    well(&say(&asked));
    for row in rows(&out) {
        for (power, energy) in [
            ("harvested_power_w.mean.error", "harvested_energy_j.window.error"),
            ("input_power_w.mean.error", "input_energy_j.window.error"),
        ] {
            assert!(row[energy].parse::<f64>().is_ok_and(|error| error > 0.0), "{row:?}");
            assert_eq!(row[power], row[energy]);
        }
    }
}

/// Goal: what fails while it is computed is a row with its reason, and the others are there.
#[test]
fn failures_are_rows() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "out");
    well(&swept(&out, &["--vary", "/solver/max_steps=5,100000"]));
    let rows = rows(&out);
    assert_eq!(
        (rows[0]["status"].as_str(), rows[1]["status"].as_str()),
        ("failed", "finished")
    );
    assert!(rows[0]["reason"].contains("steps"), "{}", rows[0]["reason"]);
    // whole numbers may be written as others
    let whole = path(&dir, "whole");
    well(&swept(&whole, &["--vary", "/solver/max_steps=1e5,2e5"]));
    let none = path(&dir, "none");
    let said = swept(&none, &["--vary", "/solver/max_steps=5,6"]);
    assert_eq!(said.code, 4, "{}", said.err);
    assert!(
        said.out.contains("design 0 (/solver/max_steps = 5): failed: "),
        "{}",
        said.out
    );
}

/// Goal: a table of designs, several cases, kept cases and folders.
#[test]
fn tables_cases_and_folders() {
    let dir = TempDir::new().expect("a folder");
    let (out, list) = (path(&dir, "out"), path(&dir, "designs.csv"));
    fs::write(
        &list,
        format!("{AREA},/effects/tube_inertia\n2e-10,off\n3e-10,\"\"\"on\"\"\"\n"),
    )
    .expect("written");
    well(&swept(&out, &["--designs", &list, "--keep-cases", "--keep-folders"]));
    let found = rows(&out);
    assert_eq!(
        (found[1][AREA].as_str(), found[1]["/effects/tube_inertia"].as_str()),
        ("3e-10", "on")
    );
    // asked for later, they are kept all the same
    let later = path(&dir, "later");
    well(&swept(&later, &["--designs", &list]));
    assert!(!Path::new(&later).join("cases").exists());
    well(&swept(&later, &["--designs", &list, "--keep-cases"]));
    let text = |out: &str| fs::read(Path::new(out).join("cases/00000.json")).expect("a case");
    assert_eq!(text(&later), text(&out));
    // a kept case is the design, in a folder of its own and by itself
    let (kept, alone) = (format!("{out}/cases/00001.json"), path(&dir, "alone"));
    well(&say(&["run", &kept, "--quiet", "--lean", "--out", &alone]));
    let inside = format!("{out}/designs/00001");
    for quantity in ["tip_u3_m", "max_pressure_pa"] {
        let last = json(&alone, "summary.json")["quantities"][quantity]["final"].as_f64();
        assert_eq!(
            json(&inside, "summary.json")["quantities"][quantity]["final"].as_f64(),
            last
        );
        assert_eq!(found[1][&format!("{quantity}.final")].parse().ok(), last);
    }
    let several = path(&dir, "several");
    let coarse = [
        "--set",
        "/mesh/cells_per_segment=1",
        "--set",
        "/time/end_s=0.01",
        "--set",
        "/time/window_s=0.01",
    ];
    let cases = [
        "sweep",
        "cases/wiring-1.json",
        "cases/wiring-2.json",
        "--vary",
        "/network/permeability_factor=0.5,1",
    ];
    well(&say(&[&cases[..], &coarse, &["--out", &several, "--quiet"]].concat()));
    let names: Vec<String> = rows(&several).iter().map(|row| row["case"].clone()).collect();
    assert_eq!(names, ["wiring-1", "wiring-1", "wiring-2", "wiring-2"]);
    let page = fs::read_to_string(Path::new(&several).join("report.html")).expect("a page");
    assert!(Path::new(&several).join("sweep.svg").exists());
    assert!(page.contains("4 designs went through") && page.contains("/network/permeability_factor"));
}

/// Goal: six modes that swing, the lowest, where few of the slowest do.
#[test]
fn the_lowest_six_that_swing_are_found() {
    let dir = TempDir::new().expect("a folder");
    let (out, all) = (path(&dir, "out"), path(&dir, "all"));
    let case = "cases/bend-sheared.json";
    let asked = ["--vary", "/solver/rtol=1e-4", "--command", "modes", "--no-mesh-errors"];
    well(&say(&[
        &["sweep", case, "--quiet", "--lean", "--out", &out],
        &asked[..],
    ]
    .concat()));
    well(&say(&["modes", case, "--count", "60", "--quiet", "--out", &all]));
    let found = json(&all, "modes.json");
    let modes = found["modes"].as_array().expect("modes");
    let mut frequencies: Vec<f64> = modes.iter().filter_map(|mode| mode["frequency_hz"].as_f64()).collect();
    frequencies.sort_by(f64::total_cmp);
    let row = &rows(&out)[0];
    for (k, frequency) in frequencies.iter().take(6).enumerate() {
        let told: f64 = row[&format!("mode_{}.frequency_hz", k + 1)].parse().expect("a number");
        assert!((told - frequency).abs() < 1e-6 * frequency, "{k}: {told} {frequency}");
    }
}

/// Goal: no zeros as figures of a run that failed before its first instant.
#[test]
fn what_never_began_has_no_figures() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "never");
    let vary = ["--vary", "/beam/young_modulus_pa=1e5,8e8"];
    say(&[
        &[
            "sweep",
            "cases/elastica.json",
            "--quiet",
            "--lean",
            "--set",
            "/time/end_s=0.004",
            "--out",
            &out,
        ],
        &vary[..],
    ]
    .concat());
    let row = &rows(&out)[0];
    assert_eq!(
        (row["status"].as_str(), row["tip_u1_m.final"].as_str()),
        ("failed", ""),
        "{row:?}"
    );
}
