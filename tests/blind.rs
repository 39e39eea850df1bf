//! Predictions of published experiments before any comparison: docs/blind.md, `cases/blind`, `scripts/blind`.
//!
//! Goal: the committed table is complete and is that of the program. Rows that need no cell by finite elements are computed again by the
//! script; of the others the middle case is computed here. `scripts/blind` computes all.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use slcbeam::case;
use slcbeam::run::equilibrium::{self, EquilibriumOptions};
use slcbeam::run::record::Control;

const TABLE: &str = include_str!("../cases/blind/predictions.csv");

/// A row of the table.
struct Prediction {
    specimen: String,
    quantity: String,
    kpa: Option<f64>,
    /// Quantiles of 5, 50 and 95 %.
    interval: [f64; 3],
}

fn predictions() -> Vec<Prediction> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(TABLE.as_bytes());
    let names = [
        "experiment",
        "specimen",
        "quantity",
        "unit",
        "pressure_kpa",
        "low",
        "median",
        "high",
    ];
    assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>(), names);
    let read = |row: csv::StringRecord| Prediction {
        specimen: row[1].to_owned(),
        quantity: row[2].to_owned(),
        kpa: row[4].parse().ok(),
        interval: [5, 6, 7].map(|k| row[k].parse().unwrap()),
    };
    reader.records().map(|row| read(row.unwrap())).collect()
}

fn interval(specimen: &str, quantity: &str, kpa: f64) -> [f64; 3] {
    let rows = predictions();
    let of = |row: &&Prediction| row.specimen == specimen && row.quantity == quantity && row.kpa == Some(kpa);
    rows.iter().find(of).unwrap().interval
}

fn cases() -> Vec<PathBuf> {
    let all = fs::read_dir("cases/blind").unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<_> = all
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .collect();
    found.sort();
    assert_eq!(found.len(), 6);
    found
}

fn read(path: &Path, sets: &[&str]) -> case::Case {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    case::load(path, &sets).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// `slcbeam coefficients` of a blind case.
fn run(name: &str, more: &[&str]) -> Output {
    let path = format!("cases/blind/{name}.json");
    let mut program = Command::new(assert_cmd::cargo::cargo_bin!("slcbeam"));
    program.args(["coefficients", &path]).args(more).output().unwrap()
}

/// Its JSON.
fn coefficients(name: &str, more: &[&str]) -> Value {
    let done = run(name, &[&["--json"], more].concat());
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    serde_json::from_slice(&done.stdout).unwrap()
}

/// Goal: every blind case is listed with the others, states its source, and is in equilibrium under its last loads.
#[test]
fn every_blind_case_is_listed_and_has_an_equilibrium() {
    let listed = fs::read_to_string("cases/README.md").unwrap();
    for path in cases() {
        let own = read(&path, &[]);
        let stem = path.file_stem().unwrap().to_str().unwrap();
        assert_eq!(own.name, stem);
        assert!(own.about.contains("not looked at"), "{stem}");
        assert!(listed.contains(&format!("`blind/{stem}`")), "{stem}");
        let found = equilibrium::follow(&own, &EquilibriumOptions::at(own.time.end_s), &mut |_| {
            Control::Continue
        })
        .unwrap();
        assert!(found.fault.is_none(), "{stem}: {:?}", found.fault);
    }
}

/// Goal: at least 60 points with ordered intervals, all quantities at the pressures of the order: every 5 kPa and the last published one.
#[test]
fn the_table_is_complete() {
    let rows = predictions();
    assert!(rows.len() >= 60, "{}", rows.len());
    for row in &rows {
        let [low, median, high] = row.interval;
        assert!(low <= median && median <= high, "{} {}", row.specimen, row.quantity);
    }
    let published = [("cylindrical", 55, 50), ("ribbed", 32, 36), ("pleated", 62, 88)];
    for (specimen, free, blocked) in published {
        for (quantity, most) in [("angle", free), ("piston volume", free), ("tip force", blocked)] {
            let own: Vec<f64> = rows
                .iter()
                .filter(|row| row.specimen == specimen && row.quantity == quantity)
                .filter_map(|row| row.kpa)
                .collect();
            let mut wanted: Vec<f64> = (1..=most / 5).map(|k| f64::from(5 * k)).collect();
            if most % 5 > 0 {
                wanted.push(f64::from(most));
            }
            assert_eq!(own, wanted, "{specimen} {quantity}");
        }
    }
}

/// Goal: every row of the page is one of the committed table, to three digits.
#[test]
fn the_page_has_the_numbers_of_the_table() {
    let page = fs::read_to_string("docs/blind.md").unwrap();
    let rows = predictions();
    let mut count = 0;
    for line in page.lines().filter(|line| line.matches('|').count() == 7) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let Ok(low) = cells[4].parse::<f64>() else { continue };
        let quantity = cells[2].split(" [").next().unwrap();
        let kpa = cells[3].parse().ok();
        let own = rows
            .iter()
            .find(|row| row.specimen == cells[1] && row.quantity == quantity && row.kpa == kpa);
        let own = own.unwrap_or_else(|| panic!("{line}")).interval;
        for (shown, exact) in [low, cells[5].parse().unwrap(), cells[6].parse().unwrap()]
            .into_iter()
            .zip(own)
        {
            assert!((shown - exact).abs() <= 6e-3 * exact.abs(), "{line}: {exact}");
        }
        count += 1;
    }
    assert!(count > 20, "{count}");
}

/// Goal: the script recomputes its rows without cells (closed forms, runs of networks) within 2 % of their intervals, and rejects unknown names.
#[test]
fn the_committed_rows_are_recomputed() {
    let run = |names: &[&str]| {
        let done = Command::new("/usr/bin/python3")
            .arg("scripts/blind.py")
            .args(names)
            .env("SLCBEAM", assert_cmd::cargo::cargo_bin!("slcbeam"))
            .output()
            .expect("/usr/bin/python3: install it with the Debian package python3");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (done.status.success(), text(&done.stdout) + &text(&done.stderr))
    };
    let (good, said) = run(&["cylindrical", "lines"]);
    assert!(good && said.contains("rows agree"), "{said}");
    let (good, said) = run(&["ribed"]);
    assert!(
        !good && said.contains("no prediction ribed") && said.contains("ribbed"),
        "{said}"
    );
}

/// Goal: the actuators in the middle of their inputs are within their intervals, computed by the program and not by the script.
#[test]
fn middle_cases_are_within_their_intervals() {
    let law = r#"/section/material/law={"yeoh": {"second": -0.010765, "third": 0.0015213}}"#;
    let ribbed = coefficients("ribbed", &["--set", law, "--inflate", "10000,20000"]);
    for (k, kpa) in [(0, 10.0), (1, 20.0)] {
        let state = &ribbed["inflation"]["states"][k];
        let [low, _, high] = interval("ribbed", "angle", kpa);
        let angle = 13.0 * 0.0028 * state["curvature_1_m"].as_f64().unwrap();
        assert!(low < angle && angle < high, "{angle} {low} {high}");
        let [low, _, high] = interval("ribbed", "tip force", kpa);
        let force = 1.25 * state["blocked_moment_n_m"].as_f64().unwrap() / 0.043;
        assert!(low < force && force < high, "{force} {low} {high}");
    }
    let pleated = coefficients("pleated", &[]);
    let [low, _, high] = interval("pleated", "angle", 5.0);
    let angle = 10.0 * 0.0098 * 5e3 * pleated["compliance"][1][2].as_f64().unwrap();
    assert!(low < angle && angle < high, "{angle} {low} {high}");
}

/// Goal: the beam whose tip is held pushes with 1.5 M/L on a load cell if it bows freely, M the blocked moment of its section: 0.1 %.
#[test]
fn the_blocked_tip_has_the_force_of_its_moment() {
    let own = read(Path::new("cases/blind/epfl-blocked.json"), &[]);
    let path = equilibrium::follow(&own, &EquilibriumOptions::at(2.4), &mut |_| Control::Continue).unwrap();
    let columns = equilibrium::columns(&equilibrium::system(&own, 2.4).unwrap());
    let force = path.last().row[columns.iter().position(|c| c.name == "reaction_tip_x").unwrap()];
    let beam = &own.beam;
    let full = beam.young_modulus_pa * beam.width_m * beam.height_m.powi(3) / 12.0;
    let bladders = own.bladders.as_ref().unwrap();
    let curvature = bladders.area_per_moment_m2_per_n_m.opening * bladders.length_m * 7.0 / beam.length_m * 20e3;
    let moment = full * beam.bending_stiffness_factor * curvature;
    let wanted = 1.5 * moment / beam.length_m;
    println!("tip force {force:.4} N, by the moment {wanted:.4} N");
    assert!((force.abs() / wanted - 1.0).abs() < 1e-3, "{force} {wanted}");
}

/// Goal: the tube of the script is that of rubber elasticity. Neo-Hookean and without stretch, `p/mu = ln(l_a/l_b) + (l_b^-2 - l_a^-2)/2`
/// (Rivlin 1949); a closed tube at small strain stretches nothing, so it does not bend: its force is of second order in the pressure.
#[test]
fn the_tube_is_that_of_rubber_elasticity() {
    let text = "
import math, sys
sys.path.insert(0, 'scripts')
from prediction.tube import Tube
tube = Tube(1.6e-3, 6e-3, 4e-3, [(-1e-2, 1e-2, 1)], 0.03, (0.0, 0.0))
for a in (1.7e-3, 2.4e-3, 4e-3):
    b = math.sqrt(a * a + 6e-3**2 - 1.6e-3**2)
    la, lb = a / 1.6e-3, b / 6e-3
    exact = math.log(la / lb) + (lb**-2 - la**-2) / 2
    assert abs(tube.bore(a, 1.0)[0] / exact - 1) < 1e-6, (a, tube.bore(a, 1.0)[0], exact)
small, twice = (tube.bore(a, 1.0) for a in (1.601e-3, 1.602e-3))
assert abs(twice[1] / small[1] - (twice[0] / small[0]) ** 2) < 0.01, (small, twice)
";
    let done = Command::new("/usr/bin/python3").args(["-c", text]).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// Goal: `--inflate` rejects pressures and sections that it cannot follow, with the remedy; it prints a table with the limit pressure.
#[test]
fn inflation_needs_a_law_and_rising_pressures() {
    let plane = "/section/three_d=false";
    let inflate = |more: &[&str]| {
        let done = run("ribbed", &[&["--set", plane], more].concat());
        let text = String::from_utf8_lossy(&done.stdout).into_owned() + &String::from_utf8_lossy(&done.stderr);
        (done.status.code(), text)
    };
    let (code, text) = inflate(&["--inflate", "1000"]);
    assert!(code == Some(3) && text.contains("needs a law"), "{text}");
    assert!(
        text.contains("/section/material/law") && text.contains("neo_hookean"),
        "{text}"
    );
    let (code, text) = inflate(&["--inflate", "2000,1000"]);
    assert!(code == Some(2) && text.contains("rising order"), "{text}");
    for bad in ["0", "-5", "much"] {
        let (code, text) = inflate(&[&format!("--inflate={bad}")]);
        assert!(code == Some(2) && text.contains(bad), "{text}");
    }
    let law = ["--set", r#"/section/material/law="neo_hookean""#];
    let (code, text) = inflate(&[&law[..], &["--inflate", "1000,80000"]].concat());
    assert!(
        code == Some(0) && text.contains("blocked moment") && text.contains("Chambers balloon"),
        "{text}"
    );
}
