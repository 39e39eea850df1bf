//! Harmonic transfer functions of steady cycles, and a beam whose valves are modulated in space and time.
//!
//! Sources: the linear response where nothing is modulated; runs in time with a small input, analysed by Fourier sums; reciprocity and
//! mirror symmetry.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::response::LinearResponse;
use slcbeam::run::response::cycle::DrivenCycle;
use slcbeam::run::stop::StopFlag;
use slcbeam::run::summary::Status;

fn checked(case: &Value) -> Case {
    case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// Harmonics -1, 0 and 1 of one output at a frequency [Hz], with steps of at most `longest` [s].
fn at(case: &Value, input: &str, output: &str, hz: f64, longest: f64) -> Vec<Complex<f64>> {
    let cycle = DrivenCycle::find(&checked(case), input, &[output.into()], &StopFlag::default()).unwrap();
    let found = cycle.linearize(longest, 1).unwrap().at(hz, 1).unwrap();
    assert!(found.residual < 1e-9, "{}", found.residual);
    found.values[0].clone()
}

/// Amplitude of exp(i 2π f t) in an output that a small cosine of unit amplitude causes, over the last seconds of a run.
fn in_time(case: &Value, output: &str, frequencies: &[f64], last: f64) -> Vec<Complex<f64>> {
    let mut memory = Memory::default();
    let outcome = dynamics::run(&checked(case), &mut memory).unwrap();
    assert_eq!(outcome.summary.status, Status::Finished);
    let (times, values) = (memory.column("t").unwrap(), memory.column(output).unwrap());
    let end = times.last().unwrap();
    let window: Vec<(f64, f64)> = times
        .iter()
        .copied()
        .zip(values)
        .filter(|(t, _)| *t > end - last + 1e-9)
        .collect();
    let of = |f: &f64| {
        let terms = window.iter().map(|(t, z)| Complex::from_polar(*z, -TAU * f * t));
        terms.sum::<Complex<f64>>() * (2.0 / window.len() as f64)
    };
    frequencies.iter().map(of).collect()
}

fn close(found: Complex<f64>, exact: Complex<f64>, tolerance: f64) {
    assert!((found - exact).norm() < tolerance * exact.norm(), "{found} for {exact}");
}

/// The beam of `metamaterial` on a coarse mesh, clamped at both ends, with points and probes at a fifth and at four fifths of its
/// length. The opening of valve k from 1 to 10 is `mean + depth sin(2π hz t - phase (k - 1))`.
fn modulated([mean, depth, hz, phase]: [f64; 4]) -> Value {
    let mut case: Value = serde_json::from_str(include_str!("../../cases/modulated-metamaterial.json")).unwrap();
    case["mesh"] = json!({"cells_per_segment": 1, "cells_per_bladder": 1});
    case["ends"]["root"] = json!("clamped");
    for k in 0..10 {
        let sine = json!({"amplitude": depth, "frequency_hz": hz, "phase_rad": -phase * k as f64});
        case["network"]["chains"][k]["opening"] = json!({"sum": [mean, {"sine": sine}]});
    }
    case
}

const LEFT: &str = "/attachments/0/force_x_n";
const RIGHT: &str = "/attachments/1/force_x_n";

/// Goal: if valves hardly move, the direct response is the frequency response and sidebands vanish, for a force and for a shaken end.
/// Tolerance: the error of the steps, which halved steps reduce 16 times.
#[test]
fn without_modulation_it_is_the_frequency_response() {
    let mut case = modulated([0.5, 1e-9, 10.0, PI / 4.0]);
    case["ends"]["root"] = json!({"clamped": {"u1_m": 0.0}});
    for input in [LEFT, "/ends/root/clamped/u1_m"] {
        let linear = LinearResponse::new(&checked(&case), input, &["right_u1".into()], None).unwrap();
        let exact = linear.solver().unwrap().at(23.0).unwrap()[0];
        let cycle = DrivenCycle::find(&checked(&case), input, &["right_u1".into()], &StopFlag::default()).unwrap();
        let [coarse, fine] = [1, 2].map(|parts| {
            let mut response = cycle.linearize(1.0 / 400.0, parts).unwrap();
            response.at(23.0, 1).unwrap().values[0].clone()
        });
        let [of_coarse, of_fine] = [&coarse, &fine].map(|h| (h[1] - exact).norm() / exact.norm());
        assert!(of_fine < 1e-4, "{of_fine}");
        assert!((13.0..19.0).contains(&(of_coarse / of_fine)), "{of_coarse} {of_fine}");
        for sideband in [fine[0], fine[2]] {
            assert!(sideband.norm() < 1e-7 * exact.norm(), "{sideband}");
        }
    }
}

/// A cantilever with length, mass and bending stiffness of one, whose root moves along it by `shaken` sin 2π 0.8 t [m]. A force
/// `force` cos 2π 0.5 t [N] acts across its tip.
fn cantilever(shaken: f64, force: f64) -> Value {
    let sine = |amplitude: f64, hz: f64, phase: f64| json!({"sine": {"amplitude": amplitude, "frequency_hz": hz, "phase_rad": phase, "ramp_cycles": 4}});
    let force = match force {
        0.0 => json!(0.0),
        _ => sine(force, 0.5, PI / 2.0),
    };
    json!({
        "name": "parametric",
        "beam": {
            "length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
            "damping": {"bending_time_s": 0.06, "axial_time_s": 0.01}
        },
        "ends": {"root": {"clamped": {"u3_m": sine(shaken, 0.8, 0.0)}}, "tip": {"free": {"force_x_n": force}}},
        "mesh": {"segments": 6, "cells_per_segment": 1},
        "solver": {"rtol": 1e-8},
        "time": {"end_s": 80.0, "output_interval_s": 0.01}
    })
}

/// Goal: a small force on a beam that is shaken along its axis, as in Mathieu's equation, causes the motion of a run at 0.5 Hz and at
/// the sidebands 1.3 and -0.3 Hz. Tolerance: errors of the run and the steps. For a small amplitude sidebands are proportional to it,
/// and the change of the direct response to its square.
#[test]
fn a_shaken_beam_answers_as_in_a_run() {
    let input = "/ends/tip/free/force_x_n";
    let found = at(&cantilever(0.1, 0.0), input, "tip_u1", 0.5, 0.01);
    let force = 1e-5;
    let run = in_time(&cantilever(0.1, force), "tip_u1", &[0.3, 0.5, 1.3], 10.0);
    close(found[0], run[0].conj() / force, 1e-4);
    close(found[1], run[1] / force, 1e-4);
    close(found[2], run[2] / force, 1e-4);
    assert!(found[0].norm() > 0.05 * found[1].norm(), "{} {}", found[0], found[1]);
    let [none, one, two] = [1e-6, 5e-3, 1e-2].map(|a| at(&cantilever(a, 0.0), input, "tip_u1", 0.5, 0.02));
    for k in [0, 2] {
        close(two[k], 2.0 * one[k], 2e-3);
    }
    close(two[1] - none[1], 4.0 * (one[1] - none[1]), 2e-3);
}

/// Source: reciprocity of the passive beam (Betti), which a modulation in phase keeps since it is symmetric in time. Goal: constant valves,
/// and valves that open together, transmit equally in both directions; a wave of openings towards the tip transmits 4 dB more to the
/// tip, in the band gap at 31.5 Hz. The mirrored structure with the wave reversed transmits as the mirrored original does, sidebands
/// included. Tolerance: rounding errors, 1e-7 also by the solution of the linear equations.
#[test]
fn a_wave_of_valves_transmits_in_one_direction() {
    let (hz, longest) = (31.5, 1.0 / 500.0);
    let both = |case: &Value| {
        [(LEFT, "right_u1"), (RIGHT, "left_u1")].map(|(input, output)| at(case, input, output, hz, longest))
    };
    let still = modulated([0.1, 0.0, 5.0, 0.0]);
    let linear = [(LEFT, "right_u1"), (RIGHT, "left_u1")].map(|(input, output)| {
        let response = LinearResponse::new(&checked(&still), input, &[output.into()], None).unwrap();
        response.solver().unwrap().at(hz).unwrap()[0]
    });
    close(linear[0], linear[1], 1e-8);
    let [right, left] = both(&modulated([0.1, 0.099, 5.0, 0.0]));
    close(right[1], left[1], 1e-8);
    let [right, left] = both(&modulated([0.1, 0.099, 5.0, PI / 4.0]));
    let ratio = 20.0 * (right[1] / left[1]).norm().log10();
    assert!((4.0..5.5).contains(&ratio), "{ratio} dB");
    // a wave of ten valves in two and a quarter lengths, so that the mirrored one does not lag
    let [right, left] = both(&modulated([0.1, 0.099, 5.0, TAU / 9.0]));
    let [reversed_right, reversed_left] = both(&modulated([0.1, 0.099, 5.0, -TAU / 9.0]));
    for (one, other) in [(right, reversed_left), (left, reversed_right)] {
        for (one, other) in one.iter().zip(&other) {
            close(*one, *other, 1e-7);
        }
    }
}

/// Goal: the response at one frequency is the motion of a run with a small force, at 31 Hz and at the sidebands 26 and 36 Hz.
/// Tolerance: errors of run and steps.
#[test]
fn modulated_valves_answer_as_in_a_run() {
    let case = modulated([0.1, 0.099, 5.0, PI / 4.0]);
    let found = at(&case, LEFT, "right_u1", 31.0, 1.0 / 1000.0);
    let mut pushed = case;
    let force = 1e-4;
    pushed["attachments"][0]["force_x_n"] =
        json!({"sine": {"amplitude": force, "frequency_hz": 31.0, "phase_rad": PI / 2.0, "ramp_cycles": 4}});
    pushed["time"] = json!({"end_s": 4.0, "output_interval_s": 1e-3});
    pushed["solver"] = json!({"rtol": 1e-7});
    let run = in_time(&pushed, "right_u1", &[26.0, 31.0, 36.0], 1.0);
    for (found, run) in found.iter().zip(run) {
        close(*found, run / force, 1e-3);
    }
}

/// Goal: the command leaves result, table, picture and page with a transfer function for each harmonic; it rejects a case without a
/// period and options that need a cycle.
#[test]
fn the_command_writes_sidebands() {
    let dir = tempfile::TempDir::new().unwrap();
    let path = |name: &str| dir.path().join(name).to_string_lossy().into_owned();
    let mut coarse = cantilever(0.1, 0.0);
    (coarse["mesh"], coarse["solver"]) = (json!({"segments": 4, "cells_per_segment": 1}), json!({"rtol": 1e-5}));
    std::fs::write(path("case.json"), coarse.to_string()).unwrap();
    let say = |case: &str, options: &[&str], out: &str| {
        let mut command = assert_cmd::Command::cargo_bin("slcbeam").unwrap();
        let band = [
            "--output", "tip_u1", "--from", "0.5", "--to", "0.6", "--points", "2", "--quiet", "--out",
        ];
        command.args(["response", case]).args(options).args(band).arg(path(out));
        command.output().unwrap()
    };
    let input = ["--input", "/ends/tip/free/force_x_n"];
    let output = say(
        &path("case.json"),
        &[&input[..], &["--about-cycle", "--harmonics", "2"]].concat(),
        "good",
    );
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(text.contains("cycle of 0.8000 Hz"), "{text}");
    let found: Value = serde_json::from_str(&std::fs::read_to_string(path("good/response.json")).unwrap()).unwrap();
    assert_eq!(found["state"], "cycle");
    assert_eq!(found["sidebands"].as_array().unwrap().len(), 4);
    let table = std::fs::read_to_string(path("good/response.csv")).unwrap();
    let samples = found["frequency_hz"].as_array().unwrap().len();
    assert!(table.contains("real tip_u1_m +2 [m/input]"), "{table}");
    assert_eq!(table.lines().count(), 1 + samples);
    for file in ["good/response.svg", "good/report.html"] {
        assert!(std::fs::metadata(path(file)).unwrap().len() > 0, "{file}");
    }
    let root = [
        "--input",
        "/ends/root/clamped/u1_m",
        "--set",
        "/ends/root={\"clamped\":{\"u1_m\":0}}",
    ];
    for (case, options, says) in [
        (
            "cases/dry-cantilever.json",
            [&root[..], &["--about-cycle"]].concat(),
            "nothing in the case varies periodically",
        ),
        (
            &path("case.json"),
            [&input[..], &["--harmonics", "2"]].concat(),
            "--about-cycle",
        ),
        (
            &path("case.json"),
            [&input[..], &["--about-cycle", "--at", "0"]].concat(),
            "cannot be used with",
        ),
    ] {
        let output = say(case, &options, "bad");
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(error.contains(says), "{error}");
    }
}
