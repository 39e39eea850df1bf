//! `--uncertain`: what uncertain numbers leave open of the figures of every command that has some.

use std::fs;
use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::say;

const CASE: &str = "cases/two-bladders.json";
const SHORT: [&str; 4] = ["--set", "/time/end_s=0.0005", "--set", "/mesh/cells_per_segment=4"];
const MODULUS: &str = "/beam/young_modulus_pa=normal:2e6:1e5";

fn path(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).display().to_string()
}

fn told(out: &str) -> Value {
    let text = fs::read_to_string(format!("{out}/uncertainty.json")).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}

/// What a file of a result holds.
fn held(out: &str, name: &str) -> Value {
    let text = fs::read_to_string(format!("{out}/{name}")).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}

fn number(value: &Value, pointer: &str) -> f64 {
    value
        .pointer(pointer)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("no {pointer} in {value}"))
}

/// Goal: the tip of a beam under a small load goes as 1/E, so that 5 % of E are 5 % of it to first order and, by the exact variance of
/// 1/(1 + 0.05 ξ), ξ normal, 1 % more by samples; and a load beside it that is uniform within ± 10 % adds 0.1/√3 in squares.
#[test]
fn a_cantilever_spreads_as_its_closed_form_does() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "out");
    let load = "/loads/0/force_x_n_m/signal/sigmoid/amplitude=uniform:0.9:1.1";
    let set = [
        "--set",
        "/loads/0/force_x_n_m/signal/sigmoid/amplitude=1",
        "--set",
        "/mesh/cells_per_segment=1",
    ];
    let asked = [
        "--uncertain",
        MODULUS,
        "--uncertain",
        load,
        "--samples",
        "128",
        "--indices",
        "--quiet",
        "--out",
        &out,
    ];
    let said = say(&[&["equilibrium", "cases/bend-dry.json"], &set[..], &asked].concat());
    assert_eq!(said.code, 0, "{}", said.err);
    let found = told(&out);
    let tip = &found["figures"]["tip_u1_m"];
    let value = number(tip, "/value");
    let first = (0.05_f64.powi(2) + 0.01 / 3.0).sqrt();
    assert!(
        (number(tip, "/first_order/sd") / value - first).abs() < 1e-4 * first,
        "{tip}"
    );
    // E(1/x^2) - E(1/x)^2 of x = 1 + 0.05 ξ: 0.05^2 (1 + 8 0.05^2), and the product of both
    let inverse: f64 = 0.0025 * (1.0 + 8.0 * 0.0025);
    let exact = (inverse + (1.0 + inverse + 0.005) * 0.01 / 3.0).sqrt();
    assert!(
        (number(tip, "/sd") / value - exact).abs() < 0.02 * exact,
        "{exact} {tip}"
    );
    let share = 0.0025 / (first * first);
    assert!((number(tip, "/first_order/shares/0") - share).abs() < 1e-3);
    assert!((number(tip, "/indices/0/total") - share).abs() < 0.05, "{tip}");
    assert!(number(tip, "/numerical_error") > 0.0);
    assert!(number(tip, "/low") < value && value < number(tip, "/high"));
    assert!(
        said.out.contains("tip_u1_m") && said.out.contains("by 256 samples (seed 1)"),
        "{}",
        said.out
    );
    let page = fs::read_to_string(format!("{out}/report.html")).expect("a page");
    assert!(page.contains("\"uncertainty\":"));
}

/// Goal: every command that has figures tells how far they spread, the same however many samples are computed at once.
#[test]
fn every_command_with_figures_tells_its_spread() {
    let dir = TempDir::new().expect("a folder");
    let harvester = "cases/harvester-parallel-uniform.json";
    let coarse = ["--set", "/mesh/cells_per_segment=1"];
    let shaken = [
        "--set",
        "/mesh/cells_per_segment=1",
        "--set",
        "/mesh/cells_per_bladder=1",
        "--set",
        "/solver/rtol=1e-3",
    ];
    let valve = "/network/permeability_factor=uniform:0.9:1.1";
    for (command, case, sets, input, figure, place) in [
        ("run", CASE, &SHORT[..], MODULUS, "tip_u1_m.max_abs", "summary.json"),
        ("equilibrium", CASE, &SHORT[..], MODULUS, "tip_u3_m", "equilibrium.json"),
        ("modes", CASE, &SHORT[..], MODULUS, "mode_1.frequency_hz", "modes.json"),
        (
            "periodic",
            harvester,
            &coarse[..],
            valve,
            "harvested_power_w.mean",
            "cycle.json",
        ),
        (
            "floquet",
            "cases/valves-open.json",
            &shaken[..],
            valve,
            "mode_1.growth_per_s",
            "floquet.json",
        ),
    ] {
        let at_once = if command == "run" { &["1", "2"][..] } else { &["2"] };
        let texts: Vec<String> = at_once
            .iter()
            .map(|jobs| {
                let out = path(&dir, &format!("{command}-{jobs}"));
                let asked = [
                    "--uncertain",
                    input,
                    "--samples",
                    "16",
                    "--jobs",
                    jobs,
                    "--quiet",
                    "--out",
                    &out,
                ];
                let said = say(&[&[command, case], sets, &asked].concat());
                assert_eq!(said.code, 0, "{command}: {}", said.err);
                assert!(said.out.contains(figure), "{command}: {}", said.out);
                let one = &told(&out)["figures"][figure];
                assert!(
                    number(one, "/sd") > 0.0 && number(one, "/samples") == 16.0,
                    "{command}: {one}"
                );
                // a mean power has the error of its energy
                assert!(command != "periodic" || number(one, "/numerical_error") > 0.0, "{one}");
                let (sd, error) = (number(one, "/first_order/sd"), number(one, "/sd_error"));
                assert!((number(one, "/sd") - sd).abs() < 4.0 * error, "{command}: {one}");
                let own = held(&out, place);
                let band = match command {
                    "modes" => &own["modes"][0]["bands"]["frequency_hz"],
                    _ => &own["bands"][figure],
                };
                for key in ["value", "numerical_error", "sd", "low", "high", "samples"] {
                    assert_eq!(band[key], one[key], "{command}: {key}");
                }
                let page = fs::read_to_string(format!("{out}/report.html")).expect("a page");
                let shown = match command {
                    "modes" => "95 % of samples: frequency [Hz]",
                    "floquet" => "95 % of samples: growth [1/s]",
                    _ => "\"band\":\"95 % of samples: ",
                };
                assert!(page.contains(shown), "{command}: {shown}");
                fs::read_to_string(format!("{out}/uncertainty.json")).expect("a file")
            })
            .collect();
        assert!(texts.iter().all(|text| *text == texts[0]), "{command}");
    }
    // a cycle's run has them too
    let (cycle, run) = (path(&dir, "periodic-2"), path(&dir, "run-2"));
    assert_eq!(
        held(&cycle, "summary.json")["bands"],
        held(&cycle, "cycle.json")["bands"]
    );
    let said = say(&["report", &run]);
    assert_eq!(said.code, 0, "{}", said.err);
    // a later result in the same folder does not keep what was told of another
    let out = path(&dir, "run-1");
    assert_eq!(
        say(&[&["run", CASE, "--quiet", "--out", &out], &SHORT[..]].concat()).code,
        0
    );
    assert!(!dir.path().join("run-1/uncertainty.json").exists());
    assert_eq!(held(&out, "summary.json")["bands"], Value::Null);
}

/// Goal: what makes no sense is refused before anything is computed or written.
#[test]
fn what_makes_no_sense_is_refused() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "out");
    let negative = "/beam/young_modulus_pa=normal:2e6:1e6";
    for (arguments, code, word) in [
        (
            vec!["run", CASE, "--uncertain", "/beam/young_modulus_pa=1e6,2e6"],
            2,
            "expected a distribution",
        ),
        (
            vec!["run", CASE, "--uncertain", "/beam/young_modulus_pa"],
            2,
            "--uncertain '/beam",
        ),
        (
            vec!["run", CASE, "--uncertain", "/beam/young_modulus=normal:2e6:1e5"],
            3,
            "young_modulus_pa",
        ),
        (
            vec!["run", CASE, "--uncertain", negative],
            3,
            "the distribution extends beyond the range of the model",
        ),
        // the option that was typed is pointed at
        (
            vec!["run", CASE, "--uncertain", negative],
            3,
            "--> --uncertain at /beam/young_modulus_pa",
        ),
        (
            vec!["run", CASE, "--uncertain", MODULUS, "--samples", "4"],
            2,
            "--samples 4: expected from 16",
        ),
        (
            vec!["run", CASE, "--uncertain", MODULUS, "--jobs", "0"],
            2,
            "--jobs 0: from 1",
        ),
        (
            vec!["run", CASE, "--uncertain", MODULUS, "--accuracy", "0.01"],
            2,
            "cannot be combined with --accuracy or --resume",
        ),
        (vec!["run", CASE, "--samples", "64"], 2, "--uncertain"),
        (
            vec!["equilibrium", CASE, "--uncertain", MODULUS, "--at", "0"],
            2,
            "loads at the end",
        ),
        (vec!["modes", CASE, "--uncertain", MODULUS, "--near", "10"], 2, "--near"),
        // where it does not belong, what to do instead is told
        (
            vec!["floquet", CASE, "--uncertain", MODULUS, "--map", "frequency,amplitude"],
            2,
            "slcbeam floquet CASE --set",
        ),
        (
            vec!["optimize", CASE, "--uncertain", MODULUS],
            2,
            "optimum-case.json --uncertain",
        ),
        (
            vec!["fit", CASE, "--uncertain", MODULUS],
            2,
            "fitted-case.json --uncertain",
        ),
        (vec!["sweep", CASE, "--uncertain=/a=normal:1:1"], 2, "--design sobol:64"),
        (
            vec!["compare", CASE, "--uncertain", MODULUS],
            2,
            "periodic and floquet, not of compare",
        ),
        (
            vec![
                "periodic",
                CASE,
                "--uncertain",
                MODULUS,
                "--sweep",
                "/beam/length_m=1:2:3",
            ],
            2,
            "not to --sweep",
        ),
    ] {
        let said = say(&[&arguments[..], &["--out", &out]].concat());
        assert!(
            said.code == code && said.err.contains(word),
            "{arguments:?}: {} {}",
            said.code,
            said.err
        );
        assert!(!dir.path().join("out").exists(), "{arguments:?}");
    }
}

/// A case on standard input is read once.
#[test]
fn a_case_on_standard_input_is_refused() {
    let dir = TempDir::new().expect("a folder");
    let out = path(&dir, "out");
    let output = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args(["run", "-", "--uncertain", MODULUS, "--out", &out])
        .stdin(fs::File::open(CASE).expect("a case"))
        .output()
        .expect("a program");
    let err = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{err}");
    assert!(err.contains("name its file in place of -"), "{err}");
    assert!(!dir.path().join("out").exists());
}
