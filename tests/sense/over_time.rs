//! Loads that change while pressures are measured.

use std::fs;

use nalgebra::{DMatrix, DVector};
use slcbeam::numerics::bayesian_least_squares::second_differences;
use slcbeam::numerics::rng::Rng;
use slcbeam::study::sense::basis::{self, Basis};
use slcbeam::study::sense::estimate::{EstimateOptions, ForwardModel, Smoothing, estimate};
use slcbeam::study::sense::in_time::{InTime, Knots};
use slcbeam::study::sense::pressures_at_rest::probed;
use tempfile::TempDir;

use crate::command::{file, found, number, sense};
use crate::common::{QUICK, normal_number, sensor};
use crate::coverage::{linear, shares, within};

/// A force on the tip that swings up within a fifth of a second: [N] at an instant [s].
fn force(t: f64) -> f64 {
    let s = (t / 0.2).min(1.0);
    0.2 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s) * (std::f64::consts::TAU * 6.0 * t).sin()
}

/// The same, as a case has it.
const FORCE: &str =
    r#"/ends/tip={"free": {"force_x_n": {"sine": {"amplitude": 0.2, "frequency_hz": 6, "ramp_cycles": 1.2}}}}"#;
/// Gauges of three bladders.
const PROBES: &str = r#"/probes=[{"name": "a", "at": 0.05}, {"name": "b", "at": 0.35}, {"name": "c", "at": 0.65}]"#;

/// When it ends.
const END: &str = "/time/end_s=0.4";

/// Pressures of a run under the force, every tenth row, with noise of a deviation [Pa].
fn measured(dir: &TempDir, noise: f64) -> String {
    let out = dir.path().join("run");
    let mut command = assert_cmd::Command::cargo_bin("slcbeam").unwrap();
    command
        .args(["run", "cases/tour-sensor.json", "--quiet", "--out"])
        .arg(&out);
    for set in QUICK.iter().chain(&[FORCE, PROBES, END]) {
        command.args(["--set", set]);
    }
    assert!(command.output().unwrap().status.success());
    let text = fs::read_to_string(out.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let headings: Vec<&str> = lines.next().unwrap().split(',').collect();
    let kept: Vec<usize> = (0..headings.len())
        .filter(|k| headings[*k] == "t [s]" || headings[*k].contains("pressure_upper"))
        .collect();
    let mut chance = Rng::new(31, 0);
    let mut table = kept.iter().map(|k| headings[*k]).collect::<Vec<_>>().join(",") + "\n";
    for line in lines.step_by(10) {
        let cells: Vec<&str> = line.split(',').collect();
        let of = |k: &usize| match headings[*k] {
            "t [s]" => cells[*k].to_owned(),
            _ => format!(
                "{}",
                cells[*k].parse::<f64>().unwrap() + noise * normal_number(&mut chance)
            ),
        };
        table += &(kept.iter().map(of).collect::<Vec<_>>().join(",") + "\n");
    }
    file(dir, &table)
}

/// A force comes back out of the pressures of three bladders, resonance of the beam included: within its band, where each row by itself as at rest
/// gives another force.
#[test]
fn a_force_over_time_comes_back_out_of_its_pressures() {
    let dir = tempfile::tempdir().unwrap();
    let path = measured(&dir, 20.0);
    let more = [
        &*path,
        "--load",
        "tip-force",
        "--noise",
        "20",
        "--set",
        PROBES,
        "--set",
        END,
    ];
    let at_rest = found(&dir, &more);
    let all = found(&dir, &[&more[..], &["--dynamic", "--knots", "33"]].concat());
    let off = |all: &serde_json::Value| {
        let rows = all["rows"].as_array().unwrap();
        let one = |row: &serde_json::Value| {
            let told = &row["amplitudes"][0];
            (number(&told["value"]) - force(number(&row["t_s"]))) / number(&told["sd"])
        };
        rows.iter().map(one).collect::<Vec<f64>>()
    };
    let errors = off(&all);
    let inside = errors.iter().filter(|error| error.abs() < 1.96).count();
    assert!(
        inside * 10 > errors.len() * 9,
        "{inside} of {}: {errors:?}",
        errors.len()
    );
    assert!(errors.iter().all(|error| error.abs() < 4.5), "{errors:?}");
    // most of what a static beam would need is inertia: at rest the force is told wrongly by many standard errors
    assert!(off(&at_rest).iter().any(|error| error.abs() > 10.0));
    assert_eq!(all["warnings"], serde_json::json!([]), "{}", all["warnings"]);
    let (chi, freedom) = (number(&all["noise"]["chi_square"]), number(&all["noise"]["freedom"]));
    assert!(
        (chi / freedom - 1.0).abs() < 5.0 * (2.0 / freedom).sqrt(),
        "{chi} on {freedom}"
    );
    assert_eq!(all["over_time"]["knots"], 33);
    let told = number(&all["over_time"]["told"][0]);
    assert!((5.0..30.0).contains(&told), "{told}");
    // with knots so far apart that the pressures tell them all, nothing shows whether there are enough
    let said = found(&dir, &[&more[..], &["--dynamic", "--knots", "12"]].concat())["warnings"].to_string();
    assert!(said.contains("W036 tip_force"), "{said}");
    // with knots too far apart for the force, what is left is no noise; whether that is known or not
    let few = [
        path.as_str(),
        "--load",
        "tip-force",
        "--set",
        PROBES,
        "--dynamic",
        "--knots",
        "5",
    ];
    let said = found(&dir, &few)["warnings"].to_string();
    assert!(said.contains("correlated in time"), "{said}");
}

/// Bands of 95 % hold the truth at a knot in 93 to 97 % of 400 trials, all knots together: loads drawn from what is known, whose weight is the one the
/// data speak for.
#[test]
fn bands_over_time_hold_the_load() {
    let case = sensor(&[]);
    let amplitudes = basis::amplitudes(&case, &[Basis::TipForce]).unwrap();
    let (probed, names) = probed(&case).unwrap();
    let names: Vec<String> = [0, 3, 6].iter().map(|k| names[*k].clone()).collect();
    let count = 13;
    let knots = Knots::new(count, 0.4);
    let instants: Vec<f64> = (0..=40).map(|k| 0.01 * f64::from(k)).collect();
    let mut model = InTime::new(&probed, names, &amplitudes, &knots, &instants, &|| false).unwrap();
    let jacobian: DMatrix<f64> = model.at(&vec![0.0; count]).unwrap().1;
    let differences = second_differences(count);
    let mut chance = Rng::new(32, 0);
    let held = shares(400, &mut |_| {
        let mut truth = DVector::zeros(count);
        truth[0] = 0.1 * normal_number(&mut chance);
        truth[1] = truth[0] + 0.05 * normal_number(&mut chance);
        for k in 2..count {
            truth[k] = 2.0 * truth[k - 1] - truth[k - 2] + 0.05 * normal_number(&mut chance);
        }
        let exact = &jacobian * &truth;
        let data = exact
            .iter()
            .map(|p| Some(p + 20.0 * normal_number(&mut chance)))
            .collect();
        let ask = EstimateOptions {
            differences: &differences,
            smoothing: Smoothing::Likelihood,
            noise_known: true,
        };
        within(
            &estimate(&mut [linear(&jacobian, data, 20.0)], &ask).unwrap(),
            truth.as_slice(),
        )
    });
    let mean = held.iter().sum::<f64>() / held.len() as f64;
    assert!((0.93..=0.97).contains(&mean), "{mean}: {held:?}");
}

/// The pressures of splines through values at knots are those of a run under the same curve, and derivatives are those of differences.
#[test]
fn derivatives_by_values_at_knots_are_those_of_differences() {
    let case = sensor(&["/solver/rtol=1e-8"]);
    let amplitudes = basis::amplitudes(&case, &[Basis::TipForce, Basis::Uniform]).unwrap();
    let (probed, names) = probed(&case).unwrap();
    let knots = Knots::new(5, 0.1);
    let instants = [0.02, 0.06, 0.1];
    let mut model = InTime::new(&probed, names[..2].to_vec(), &amplitudes, &knots, &instants, &|| false).unwrap();
    let at: Vec<f64> = (0..10).map(|k| 0.08 * f64::from(k) - 0.3).collect();
    let jacobian = model.at(&at).unwrap().1;
    let size = jacobian.amax();
    for k in [0, 3, 6] {
        let mut go = |by: f64| {
            let mut there = at.clone();
            there[k] += by;
            model.at(&there).unwrap().0
        };
        let difference = (go(1e-2) - go(-1e-2)) / 2e-2;
        let off = (difference - jacobian.column(k)).amax();
        assert!(off < 1e-4 * size, "{k}: {off} of {size}");
    }
}

/// What cannot be followed is refused before anything is computed, in words.
#[test]
fn what_cannot_be_followed_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let rows = |last: &str| format!("t_s,pressure_1_pa\n0,1\n0.1,1\n0.15,1\n0.2,1\n{last},1\n");
    let cases: [(String, &[&str], &str); 8] = [
        ("pressure_1_pa\n1\n1\n1\n1\n1\n".into(), &[], "have no times"),
        ("t_s,pressure_1_pa\n0,1\n0.1,2\n".into(), &[], "2 instants: too few"),
        (rows("0.7"), &[], "--set /time/end_s=0.7"),
        (
            rows("0.3"),
            &["--smoothing", "5"],
            "a number applies to a profile at rest only",
        ),
        (rows("0.3"), &["--at", "0.2"], "cannot be used with"),
        (rows("0.3"), &["--load", "tip-force", "--knots", "6"], "at most 5 knots"),
        (rows("0.3"), &["--load", "profile:150"], "150 loads are too many"),
        (
            rows("0.3"),
            &["--load", "profile:10", "--knots", "50"],
            "at most 40 knots",
        ),
    ];
    for (text, more, words) in cases {
        let path = file(&dir, &text);
        let said = sense(&dir, &[&[&*path, "--dynamic", "--noise", "1"], more].concat());
        assert_eq!(said.code, 2, "{text}: {}", said.err);
        assert!(said.err.contains(words), "{text}: {}", said.err);
        assert!(!dir.path().join("out/sense.json").exists());
    }
}
