//! Sources: exact solutions at frequencies between those of the fits; the nonlinear program at small amplitude; closed forms.
//! Goal: a reduced model has the error that it states, the modes that its outputs show, and no growth of its own.
//! Tolerance: the stated error; 5e-4 of the largest change in time, of which frequencies above the band have a part.

use nalgebra::{Complex, DMatrix};
use serde_json::{Value, json};
use slcbeam::case::Case;
use slcbeam::run::response::LinearResponse;
use slcbeam::run::response::self_test::SelfTest;
use slcbeam::run::response::state_space::{ModelReduction, StateSpace};
use slcbeam::study::response::reduced::reduce;
use slcbeam::study::response::{Request, poles, respond};

use super::common::{across, chains, checked};

fn shipped(name: &str) -> Value {
    let file = std::fs::read_to_string(format!("cases/{name}.json")).unwrap();
    serde_json::from_str(&file).unwrap()
}

fn response(case: &Case, input: &str, outputs: &[&str]) -> LinearResponse {
    let outputs: Vec<String> = outputs.iter().map(|name| (*name).into()).collect();
    LinearResponse::new(case, input, &outputs, None).unwrap()
}

fn reduced(case: &Case, response: &LinearResponse, band: [f64; 2], error: f64) -> (StateSpace, ModelReduction) {
    let mut found = poles(case, None, response, band).unwrap();
    let model = reduce(response, band, &mut found, error).unwrap();
    let reduction = model.reduction.unwrap();
    (model, reduction)
}

/// `s^k [C (s - A)⁻¹ B + D]`.
fn transfer(model: &StateSpace, hz: f64) -> Vec<Complex<f64>> {
    let n = model.b.len();
    let s = Complex::new(0.0, std::f64::consts::TAU * hz);
    let mut matrix = DMatrix::from_fn(n, n, |i, j| Complex::from(-model.a[i][j]));
    (0..n).for_each(|k| matrix[(k, k)] += s);
    let b = DMatrix::from_fn(n, 1, |i, _| Complex::from(model.b[i]));
    let x = matrix.lu().solve(&b).unwrap();
    let value = |(c, d): (&Vec<f64>, &f64)| c.iter().zip(x.iter()).map(|(c, x)| x * *c).sum::<Complex<f64>>() + *d;
    let all = model.c.iter().zip(&model.d).map(value);
    all.map(|value| value * s.powi(model.input_rate as i32)).collect()
}

/// Largest error at frequencies that no grid has, relative to the amplitude, or to its median.
fn error(model: &StateSpace, response: &LinearResponse, [from, to]: [f64; 2]) -> f64 {
    let mut solver = response.solver().unwrap();
    let hz: Vec<f64> = (0..150)
        .map(|k| from * (to / from).powf((f64::from(k) + 0.37) / 150.0))
        .collect();
    let exact: Vec<_> = hz.iter().map(|hz| solver.at(*hz).unwrap()).collect();
    let mut largest = 0.0_f64;
    for p in 0..model.c.len() {
        let mut sizes: Vec<f64> = exact.iter().map(|all| all[p].norm()).collect();
        sizes.sort_by(f64::total_cmp);
        for (hz, exact) in hz.iter().zip(&exact) {
            let apart = (transfer(model, *hz)[p] - exact[p]).norm();
            largest = largest.max(apart / exact[p].norm().max(sizes[75]));
        }
    }
    largest
}

/// Source: 831 states of the whole model. Goal: at most 20 states; the static gain; both modes of the band, 12.5 and 68.4 Hz; no growth.
#[test]
fn a_model_of_the_actuator_has_few_states() {
    let case = checked(&shipped("tour-actuator"));
    let response = response(&case, "/network/chains/0/ends/0/pressure_pa", &["tip_u1"]);
    let band = [0.01, 200.0];
    let (model, reduction) = reduced(&case, &response, band, 1e-3);
    assert!(model.b.len() <= 20 && reduction.error <= 1e-3, "{reduction:?}");
    let found = error(&model, &response, band);
    assert!(found <= 1.2 * reduction.error, "{found} for {reduction:?}");
    assert!(reduction.static_gain && reduction.modes == [2, 2], "{reduction:?}");
    let slow = response.solver().unwrap().at(3e-6).unwrap()[0].re;
    let gain = transfer(&model, 1e-9)[0].re;
    assert!((gain - slow).abs() < 1e-8 * slow.abs(), "{gain} for {slow}");
    for pole in poles(&case, None, &response, band).unwrap().poles {
        let there = |k: &usize| model.a[*k][*k] == pole.s.re && model.a[*k].contains(&pole.s.im);
        assert!((0..model.b.len()).any(|k| there(&k)), "{pole:?}");
    }
    let poles = DMatrix::from_fn(model.b.len(), model.b.len(), |i, j| model.a[i][j]).complex_eigenvalues();
    assert!(poles.iter().all(|pole| pole.re < 0.0), "{poles}");
    assert_eq!((model.x0.iter().any(|x| *x != 0.0), model.u0), (false, 0.0));
}

/// Goal: the stated error, of inputs whose rates act, of several outputs, of peaks with a damping ratio of 1e-5.
#[test]
fn reduced_models_have_the_stated_error() {
    let sealed = json!(["sealed", {"volume_m3": 0.0}]);
    let volume = json!({
        "name": "volume", "preset": "matia-gat-beam", "bladders": {"per_row": 3, "coupling": "reciprocal"},
        "network": {"chains": [{"bladders": [1, 2, 3, -1, -2, -3], "ends": sealed}]},
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.0}
    });
    for (case, input, outputs, rate) in [
        (
            shipped("wiring-3"),
            "/ends/root/clamped/u3_m",
            vec!["tip_u3", "tip_u1"],
            2,
        ),
        (shipped("shake-wet"), "/ends/root/clamped/u1_m", vec!["tip_u1"], 2),
        (
            volume,
            "/network/chains/0/ends/1/volume_m3",
            vec!["bladder_1_pressure", "tip_u1"],
            1,
        ),
    ] {
        let case = checked(&case);
        let response = response(&case, input, &outputs);
        let band = [0.1, 120.0];
        let (model, reduction) = reduced(&case, &response, band, 1e-4);
        assert_eq!(model.input_rate, rate, "{input}");
        let found = error(&model, &response, band);
        assert!(
            found <= 1.2 * reduction.error && reduction.error <= 1e-4,
            "{input}: {found} for {reduction:?}"
        );
        let rest = model.x0.len() - model.input_rate;
        assert!(
            model.x0[..rest].iter().all(|x| *x == 0.0) && model.states[rest] == input,
            "{:?}",
            model.states
        );
    }
}

/// Source: [E96]. Goal: every value of a response differs from the exact one by less than its error; a few solutions suffice.
#[test]
fn a_response_has_the_stated_error() {
    for (name, input, output) in [
        ("wiring-3", "/ends/root/clamped/u3_m", "tip_u1"),
        ("tour-actuator", "/network/chains/0/ends/0/pressure_pa", "tip_u1"),
    ] {
        let case = checked(&shipped(name));
        let request = Request {
            input: input.into(),
            outputs: vec![output.into()],
            at: None,
            band: [1.0, 200.0],
            points: 200,
        };
        let found = respond(&case, &request, request.compute(&case).unwrap()).unwrap();
        assert!(
            found.solved < 130 && found.frequencies.len() > 200,
            "{} solved",
            found.solved
        );
        let mut solver = found.response.solver().unwrap();
        let curve = &found.curves[0];
        for (k, hz) in found.frequencies.iter().enumerate().filter(|(k, _)| k % 5 == 0) {
            let apart = (curve.values[k] - solver.at(*hz).unwrap()[0]).norm();
            assert!(
                apart <= curve.errors[k],
                "{name} {hz} Hz: {apart} above {}",
                curve.errors[k]
            );
        }
    }
}

/// Source: the nonlinear equations, whose input changes a little. Goal: models with an input of any rate, reduced or not, follow them; a
/// gain that is wrong by 2 % is found.
#[test]
fn a_model_follows_the_nonlinear_equations() {
    let mut pressed = shipped("tour-actuator");
    pressed["network"]["chains"][0]["ends"][0] = json!({"pressure_pa": 100.0});
    let mut pushed = across(2, 0.5, 3e-6);
    pushed["beam"]["damping"] = json!({"bending_time_s": 1e-3});
    pushed["ends"]["tip"] = json!({"free": {"force_x_n": 0.01}});
    pushed["start"] = json!({"equilibrium": {"loads_at_s": 0}});
    let mut turned = pushed.clone();
    turned["ends"]["tip"] = json!({"free": {"moment_n_m": 0.0}});
    let mut shaken = pushed.clone();
    shaken["ends"] = json!({"root": {"clamped": {"u1_m": 0.0}}, "tip": "free"});
    let mut filled = chains(2, 0.5, 3e-6);
    filled["beam"]["damping"] = json!({"bending_time_s": 1e-3});
    filled["network"]["chains"][0]["ends"][0] = json!({"volume_m3": 0.0});
    for (case, input, output, rate) in [
        (pressed, "/network/chains/0/ends/0/pressure_pa", "tip_u1", 0),
        (pushed, "/ends/tip/free/force_x_n", "tip_u1", 0),
        (turned, "/ends/tip/free/moment_n_m", "tip_angle", 0),
        (filled, "/network/chains/0/ends/0/volume_m3", "tip_u1", 1),
        (shaken, "/ends/root/clamped/u1_m", "tip_u1", 2),
    ] {
        let case = checked(&case);
        let response = response(&case, input, &[output]);
        let (small, _) = reduced(&case, &response, [0.01, 200.0], 1e-3);
        for mut model in [small, StateSpace::new(&response).unwrap()] {
            assert_eq!(model.input_rate, rate, "{input}");
            let test = SelfTest::new(&response, &model, 0).unwrap();
            assert!(test.passed() && test.worst().1 < 5e-4, "{input}: {test:?}");
            assert!(
                test.change[0] > 0.0 && test.time_s > 5.0 * test.ramp_s,
                "{input}: {test:?}"
            );
            if output == "tip_angle" {
                model.c[0].iter_mut().for_each(|entry| *entry *= 1.02);
                let test = SelfTest::new(&response, &model, 0).unwrap();
                assert!(!test.passed() && test.worst().1 > 0.015, "{test:?}");
            }
        }
        assert!(SelfTest::new(&response, &StateSpace::new(&response).unwrap(), 1).is_err());
    }
}

/// Goal: the poles that an output shows are found where many decays of the fluid are nearer to the middle of the band.
#[test]
fn poles_that_are_shown_are_found() {
    let case = checked(&shipped("syringe-finger"));
    let response = response(&case, "/network/ports/1/pressure_pa", &["tip_u1"]);
    let (_, reduction) = reduced(&case, &response, [0.1, 20.0], 1e-3);
    assert!(reduction.modes[0] > 0 && reduction.modes[1] > 0, "{reduction:?}");
}

/// Goal: a mode without damping is named, since no model has an error at its infinite peak.
#[test]
fn a_mode_without_damping_has_no_model() {
    let mut case = shipped("dry-cantilever");
    case["ends"]["tip"] = json!({"free": {"force_x_n": 0.0}});
    let case = checked(&case);
    let response = response(&case, "/ends/tip/free/force_x_n", &["tip_u1"]);
    let mut found = poles(&case, None, &response, [1.0, 200.0]).unwrap();
    let refused = reduce(&response, [1.0, 200.0], &mut found, 1e-3)
        .err()
        .unwrap()
        .to_string();
    assert!(refused.contains("has no damping"), "{refused}");
}

/// Goal: an opening without flow has no influence; its model has no states, and the self-test says that nothing moves.
#[test]
fn an_input_without_influence_has_no_test() {
    let case = checked(&shipped("bladder-pump"));
    let response = response(&case, "/network/chains/0/opening", &["tip_u1"]);
    let mut found = poles(&case, None, &response, [1.0, 200.0]).unwrap();
    if let Ok(model) = reduce(&response, [1.0, 200.0], &mut found, 1e-3) {
        assert_eq!(model.b.len(), 0);
    }
    let model = StateSpace::new(&response).unwrap();
    let refused = SelfTest::new(&response, &model, 0).unwrap_err();
    assert!(refused.contains("nothing moves"), "{refused}");
}
