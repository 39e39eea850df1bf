//! Derivatives of frequency responses by numbers of the case, [E98]: of the response at a frequency and of its peaks.

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::case::Case;
use slcbeam::case::parameter::{Parameter, STEPS};
use slcbeam::run::response::sensitivity::EquationSlopes;
use slcbeam::study::analysis::{self, AnalysisKind, AnalysisRequest, ResponseAnalysis};
use slcbeam::study::response::derivatives::{at_frequencies, differentiate};
use slcbeam::study::response::{BandResponse, Request, respond_on_mesh};

use super::cli::run;
use super::common::{across, checked};

/// Length 1 m, EI 1 N m^2, 1 kg/m, bending damped by `time` seconds, shaken at the root.
pub fn shaken(cells: usize, modulus: f64, time: f64) -> Case {
    checked(&json!({
        "name": "shaken",
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": modulus, "density_kg_m3": 1e4,
                 "damping": {"bending_time_s": time}},
        "ends": {"root": {"clamped": {"u1_m": 0.0}}, "tip": "free"},
        "effects": {"rotary_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1, "order": 4},
        "time": {"end_s": 1.0}
    }))
}

/// The paper's bladders joined across by tubes, damped by their flow and by the solid.
pub fn wet() -> Value {
    let mut case = across(4, 0.05, 4e-6);
    case["beam"]["damping"] = json!({"bending_time_s": 4e-4});
    case["ends"]["root"] = json!({"clamped": {"u1_m": 0.0}});
    case["effects"] = json!({"tube_inertia": "on", "unsteady_friction": "off", "bladder_inertia": "off"});
    case["mesh"]["cells_per_segment"] = json!(2);
    case
}

fn request(input: &str, outputs: &[&str], at: Option<f64>, band: [f64; 2]) -> Request {
    Request {
        input: input.into(),
        outputs: outputs.iter().map(|name| (*name).into()).collect(),
        at,
        band,
        points: 100,
    }
}

fn found(case: &Case, request: &Request) -> BandResponse {
    respond_on_mesh(case, request, request.compute(case).unwrap()).unwrap()
}

const ROOT: &str = "/ends/root/clamped/u1_m";

/// Source: with L^4 = -m s^2 l^4/(EI (1 + τ s)) the tip moves by (cos L + cosh L)/(1 + cos L cosh L) times the root. Goal: derivatives by
/// modulus and damping time are those of the closed form, to 1e-6 of the response on meshes of fourth order.
#[test]
fn a_damped_cantilever_has_the_derivatives_of_its_closed_form() {
    let (modulus, time) = (1.2e9, 2e-3);
    let exact = |hz: f64, modulus: f64, time: f64| {
        let s = Complex::new(0.0, std::f64::consts::TAU * hz);
        let l = (-s * s / ((1.0 + s * time) * (modulus / 1.2e9))).powf(0.25);
        (l.cos() + l.cosh()) / (1.0 + l.cos() * l.cosh())
    };
    for hz in [0.3, 0.5, 2.0, 3.3, 9.0] {
        for (pointer, value) in [
            ("/beam/young_modulus_pa", modulus),
            ("/beam/damping/bending_time_s", time),
        ] {
            let of = |value: f64| match pointer {
                "/beam/young_modulus_pa" => exact(hz, value, time),
                _ => exact(hz, modulus, value),
            };
            let expected: Complex<f64> = STEPS
                .iter()
                .map(|(step, weight)| of(value * (1.0 + 1e-4 * step)) * *weight / 1e-4)
                .sum();
            // more cells have larger rounding errors, which matter at low frequencies
            let cells = if hz < 3.0 { [24, 48] } else { [64, 128] };
            let [coarse, fine] = cells.map(|cells| {
                let case = shaken(cells, modulus, time);
                let request = request(ROOT, &["tip_u1"], None, [0.1, 1.0]);
                let response = request.compute(&case).unwrap();
                let parameter = Parameter::find(&case, pointer).unwrap();
                let slopes = [EquationSlopes::new(&case, None, &response, &parameter).unwrap()];
                let jets = at_frequencies(&response, &[hz], &slopes).unwrap();
                jets[0][0].slopes[0][0] * value
            });
            let limit = fine + (fine - coarse) / 15.0;
            let size = expected.norm().max(exact(hz, modulus, time).norm());
            let apart = (limit - expected).norm() / size;
            assert!(apart < 1e-6, "{hz} Hz, {pointer}: {limit} for {expected}, {apart:e}");
        }
    }
}

/// Source: the whole command with the number changed. Goal: derivatives of frequency, amplitude and damping ratio of every peak, and of the
/// response at two frequencies, agree with its differences to 1e-6, about the start and about an equilibrium under load.
#[test]
fn peaks_move_as_differences_of_the_command_say() {
    let mut bent = wet();
    bent["ends"]["tip"] = json!({"free": {"force_x_n": 0.3}});
    let frequencies = [7.0, 40.0];
    for (case, input, outputs, at, pointer) in [
        (
            wet(),
            ROOT,
            ["tip_u1_m", "bladder_1_pressure_pa"],
            None,
            "/tubes/radius_m",
        ),
        (
            wet(),
            ROOT,
            ["tip_u1_m", "reaction_root_x_N"],
            None,
            "/fluid/viscosity_pa_s",
        ),
        (
            bent,
            "/ends/tip/free/force_x_n",
            ["tip_angle_rad", "tip_u1_m"],
            Some(0.0),
            "/ends/tip/free/force_x_n",
        ),
    ] {
        let case = checked(&case);
        let request = request(input, &outputs, at, [4.0, 90.0]);
        let own = found(&case, &request);
        let parameter = Parameter::find(&case, pointer).unwrap();
        let slopes = &differentiate(&case, at, &own, &frequencies, std::slice::from_ref(&parameter)).unwrap()[0];
        let changed = STEPS.map(|(steps, weight)| {
            let case = parameter
                .changed(&case, parameter.value * (1.0 + 1e-3 * steps))
                .unwrap();
            (found(&case, &request), weight / 1e-3)
        });
        let close = |what: &str, slope: f64, of: &dyn Fn(&BandResponse) -> f64| {
            let difference: f64 = changed.iter().map(|(found, weight)| weight * of(found)).sum();
            let size = of(&own).abs();
            let apart = (slope * parameter.value - difference).abs();
            assert!(
                apart < 1e-6 * size,
                "{pointer}, {what}: {:e} for {difference:e} of {size:e}",
                slope * parameter.value
            );
        };
        let mut peaks = 0;
        for (place, output) in outputs.iter().enumerate() {
            for (k, slope) in slopes.peaks[place].iter().enumerate() {
                peaks += 1;
                let peak = |found: &BandResponse| found.curves[place].peaks[k];
                let what = |figure: &str| format!("{output} peak {k} {figure}");
                close(&what("frequency"), slope.frequency_hz, &|all| peak(all).frequency_hz);
                close(&what("amplitude"), slope.amplitude, &|all| peak(all).value.norm());
                close(&what("damping"), slope.damping_ratio.unwrap(), &|all| {
                    peak(all).damping_ratio().unwrap()
                });
            }
            for (k, hz) in frequencies.iter().enumerate() {
                let value = |found: &BandResponse| found.response.solver().unwrap().at(*hz).unwrap()[place];
                let slope = slopes.values[place][k];
                let phase = |all: &BandResponse| (value(all) / value(&own)).arg();
                let relative = slope / value(&own);
                close(&format!("{output} {hz} Hz"), relative.re * value(&own).norm(), &|all| {
                    value(all).norm()
                });
                let difference: f64 = changed.iter().map(|(found, weight)| weight * phase(found)).sum();
                assert!(
                    (relative.im * parameter.value - difference).abs() < 1e-6,
                    "{output} {hz} Hz"
                );
            }
        }
        assert!(peaks >= 4, "{peaks} peaks");
    }
}

/// Goal: figures of designs have the names that are known before, the errors of their meshes, and derivatives that agree with differences
/// of the figures to 1e-6, also of a phase.
#[test]
fn responses_of_designs_have_names_errors_and_derivatives() {
    let what = AnalysisKind::Response(ResponseAnalysis {
        input: ROOT.into(),
        outputs: vec!["tip_u1".into(), "bladder_2_pressure".into()],
        band: [4.0, 90.0],
        frequencies: vec![12.5, 40.0],
    });
    let case = checked(&wet());
    let figures = |case: &Case, meshes: bool| {
        let ask = AnalysisRequest {
            what: &what,
            accuracy: None,
            from: None,
            meshes,
            waves: false,
        };
        analysis::found(case, ask, &|| false, &|_| unreachable!("no run is needed")).unwrap()
    };
    let own = figures(&case, true);
    let names = what.analysis().names(&case).unwrap();
    let known = |name: &str| names.iter().any(|own| own == name);
    let pointer = "/bladders/length_m";
    let parameter = Parameter::find(&case, pointer).unwrap();
    let (plain, slopes) = what
        .analysis()
        .derivatives(&case, std::slice::from_ref(&parameter), None, &|| false)
        .unwrap();
    let changed = STEPS.map(|(steps, weight)| {
        let case = parameter
            .changed(&case, parameter.value * (1.0 + 1e-3 * steps))
            .unwrap();
        (figures(&case, false), weight / 1e-3)
    });
    let mut checked = 0;
    for (name, value) in &own.figures {
        if let Some(of) = name.strip_suffix(".error") {
            assert!(known(of) && (0.0..0.5).contains(value), "{name}: {value}");
        } else if name != "stable" {
            assert!(known(name) && plain.figure(name) == Some(*value), "{name}");
            let slope = slopes[name][0] * parameter.value;
            let all = changed.iter();
            let difference: f64 = all.map(|(found, weight)| weight * found.figure(name).unwrap()).sum();
            assert!(
                (slope - difference).abs() < 1e-6 * value.abs().max(slope.abs()),
                "{name}: {slope:e} for {difference:e}"
            );
            checked += 1;
        }
    }
    assert!(
        checked >= 3 * 3 + 2 * 4 && own.figure("stable") == Some(1.0),
        "{checked}"
    );
}

/// Goal: the command prints and stores values and derivatives, and the spread by an uncertain number; a sweep continues with the same
/// response only, and its script contains the response.
#[test]
fn responses_are_differentiated_by_the_command() {
    let dir = tempfile::TempDir::new().unwrap();
    let path = |name: &str| dir.path().join(name).display().to_string();
    let case = path("case.json");
    std::fs::write(&case, wet().to_string()).unwrap();
    let way = [
        "--input",
        ROOT,
        "--output",
        "tip_u1",
        "--to",
        "60",
        "--frequency",
        "12.5",
    ];
    let young = "/beam/young_modulus_pa";
    let out = path("out");
    let uncertain = format!("{young}=normal:2e6:2e4");
    let more = [
        "--uncertain",
        &uncertain,
        "--samples",
        "16",
        "--sensitivity",
        young,
        "--quiet",
        "--out",
        &out,
    ];
    let (code, said, _) = run(&[&["response", &case], &way[..], &more].concat());
    assert!(
        code == 0 && said.contains("for 1 % of /beam/young_modulus_pa") && said.contains("12.50000"),
        "{said}"
    );
    let read =
        |name: &str| -> Value { serde_json::from_slice(&std::fs::read(format!("{out}/{name}")).unwrap()).unwrap() };
    let found = read("response.json");
    let slopes = &found["sensitivities"][young]["outputs"]["tip_u1_m"];
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    // derivatives of amplitude and phase are those of the parts
    let (value, slope) = (&found["at"][0], &slopes["at"][0]);
    let [h, dh] = [value, slope].map(|one| Complex::new(number(&one["real"]), number(&one["imag"])));
    assert!((number(&slope["amplitude"]) / number(&value["amplitude"]) / (dh / h).re - 1.0).abs() < 1e-12);
    assert!((number(&slope["phase_deg"]).to_radians() / (dh / h).im - 1.0).abs() < 1e-12);
    // the deviation of the frequency by that of the modulus, to first order and by samples
    let spread = &read("uncertainty.json")["figures"]["tip_u1_m.peak_1.frequency_hz"];
    let first = number(&slopes["peaks"][0]["frequency_hz"]).abs() * 2e4;
    assert!(
        (number(&spread["first_order"]["sd"]) / first - 1.0).abs() < 1e-9,
        "{spread}"
    );
    assert!((number(&spread["sd"]) / first - 1.0).abs() < 0.2, "{spread}");
    let designs = path("designs");
    let sweep = [
        "sweep",
        &case,
        "--command",
        "response",
        "--vary",
        "/fluid/viscosity_pa_s=0.05,0.06",
        "--quiet",
        "--out",
        &designs,
    ];
    assert_eq!(run(&[&sweep[..], &way].concat()).0, 0);
    let other = ["--input", ROOT, "--output", "tip_angle"];
    let (code, _, told) = run(&[&sweep[..], &other].concat());
    assert!(
        code == 2 && told.contains("response --input") && told.contains("contains another sweep"),
        "{told}"
    );
    let (_, script, _) = run(&[&sweep[..], &way, &["--script", "parallel"]].concat());
    assert!(script.contains(
        "--command response --input /ends/root/clamped/u1_m --output tip_u1 --from 1 --to 60 --frequency 12.5"
    ));
}
