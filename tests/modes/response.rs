//! Sources: closed forms of Euler-Bernoulli cantilevers and bars; steady cycles of small amplitude of the same equations.
//! Goal: the frequency response is that of the linearized equations, for inputs that move an end, load it, or press on bladders.
//! Tolerance: 1e-6 after extrapolation to fine meshes of fourth order; 1e-4 beside cycles, whose amplitude is small but finite.

use nalgebra::Complex;
use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::response::LinearResponse;
use slcbeam::run::response::state_space::StateSpace;
use slcbeam::run::stop::StopFlag;
use slcbeam::study::refine::numbers;
use slcbeam::study::response::{Request, growing, poles, respond};

use super::common::checked;

/// Length 1 m, EI 1 N m^2, 1 kg/m, EA 1.2e5 N.
fn beam(cells: usize, root: &Value, tip: &Value) -> Value {
    json!({
        "name": "response",
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4},
        "ends": {"root": root, "tip": tip},
        "effects": {"rotary_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1, "order": 4},
        "time": {"end_s": 1.0}
    })
}

fn at(case: &Value, input: &str, output: &str, hz: f64) -> Complex<f64> {
    let response = LinearResponse::new(&checked(case), input, &[output.into()], None).unwrap();
    response.solver().unwrap().at(hz).unwrap()[0]
}

/// Extrapolated limit of meshes of fourth order, from 64 and 128 cells.
fn limit(case: impl Fn(usize) -> Value, input: &str, output: &str, hz: f64) -> Complex<f64> {
    let [coarse, fine] = [64, 128].map(|cells| at(&case(cells), input, output, hz));
    fine + (fine - coarse) / 15.0
}

fn close(found: Complex<f64>, exact: f64) {
    assert!((found - exact).norm() < 1e-6 * exact.abs(), "{found} for {exact}");
}

/// Source: with L^4 = m w^2 l^4/EI, a transversely shaken root moves the tip by (cos L + cosh L)/(1 + cos L cosh L), a force at the tip by
/// (sin L cosh L - cos L sinh L)/(1 + cos L cosh L)/L^3.
#[test]
fn a_cantilever_answers_as_its_closed_form() {
    for hz in [0.2, 0.7, 2.0, 5.0] {
        let l = (std::f64::consts::TAU * hz).sqrt();
        let below = 1.0 + l.cos() * l.cosh();
        let shaken = |cells| beam(cells, &json!({"clamped": {"u1_m": 0.0}}), &json!("free"));
        close(
            limit(shaken, "/ends/root/clamped/u1_m", "tip_u1", hz),
            (l.cos() + l.cosh()) / below,
        );
        let pushed = |cells| beam(cells, &json!("clamped"), &json!({"free": {"force_x_n": 0.0}}));
        let exact = (l.sin() * l.cosh() - l.cos() * l.sinh()) / (below * l.powi(3));
        close(limit(pushed, "/ends/tip/free/force_x_n", "tip_u1_m", hz), exact);
    }
}

/// Source: a bar axially shaken at one end moves the other by 1/cos(w l sqrt(m/EA)).
#[test]
fn a_bar_answers_as_its_closed_form() {
    for hz in [10.0, 60.0, 200.0] {
        let shaken = |cells| beam(cells, &json!({"clamped": {"u3_m": 0.0}}), &json!("free"));
        let exact = 1.0 / (std::f64::consts::TAU * hz / 1.2e5_f64.sqrt()).cos();
        close(limit(shaken, "/ends/root/clamped/u3_m", "tip_u3", hz), exact);
    }
}

/// The paper's beam with bladders sealed, or joined in pairs across the beam; without rotary inertia and inertia of the fluid.
fn papers(pairs: bool, [cells, along]: [usize; 2]) -> Value {
    let ends = json!(["sealed", "sealed"]);
    let both = |k: i64| match pairs {
        true => vec![json!({"bladders": [k, -k], "ends": ends})],
        false => vec![
            json!({"bladders": [k], "ends": ends}),
            json!({"bladders": [-k], "ends": ends}),
        ],
    };
    let chains: Vec<Value> = (1..=10).flat_map(both).collect();
    json!({
        "name": "papers", "preset": "matia-gat-beam", "network": {"chains": chains}, "formulation": "conservative",
        "bladders": {"coupling": "reciprocal", "area_per_moment_m2_per_n_m": {"opening": 5.145e-6, "closing": 5.145e-6}},
        "ends": {"root": {"clamped": {"u1_m": 0.0}}, "tip": "free"},
        "effects": {"rotary_inertia": "off", "tube_inertia": "off"},
        "mesh": {"cells_per_segment": cells, "cells_per_bladder": along}, "time": {"end_s": 1.0}
    })
}

/// Source: transfer matrices of an Euler-Bernoulli line whose mean curvature in a segment drives a diffusion line of pressure, in extended
/// precision. Tolerance: 1e-6 with sealed bladders; 3e-5 with flow, whose mesh is of first order.
#[test]
fn the_papers_beam_answers_as_its_transfer_matrix() {
    let input = "/ends/root/clamped/u1_m";
    for (hz, sealed, pairs) in [
        (5.0, 1.284737428, (1.310464891, -1.41887e-4)),
        (10.0, 3.556238687, (4.136353783, -0.00719762)),
        (15.0, -4.530913441, (-3.712125799, -0.01056180)),
        (50.0, -1.219798019, (-1.282461977, 0.00363774)),
    ] {
        let of = |pairs: bool, along: usize| {
            let [a, b, c] = [4, 8, 16].map(|cells| at(&papers(pairs, [cells, along]), input, "tip_u1", hz));
            let [first, second] = [(a, b), (b, c)].map(|(coarse, fine)| fine + (fine - coarse) / 3.0);
            second + (second - first) / 15.0
        };
        close(of(false, 2), sealed);
        let [coarse, fine] = [8, 16].map(|along| of(true, along));
        let (found, exact) = (2.0 * fine - coarse, Complex::new(pairs.0, pairs.1));
        assert!(
            (found - exact).norm() < 3e-5 * exact.norm(),
            "{hz} Hz: {found} for {exact}"
        );
    }
}

/// Source: [E37], cycles with an amplitude of a millionth of the length. Goal: flow between bladders damps both equally.
#[test]
fn a_small_cycle_has_the_amplitude_of_the_response() {
    for (hz, chains) in [(9.0, 1), (14.0, 1), (31.0, 10)] {
        let names: Vec<i64> = (1..=10).chain((1..=10).map(|k| -k)).collect();
        let chains: Vec<Value> = match chains {
            1 => vec![json!({"bladders": names, "ends": ["sealed", "sealed"]})],
            _ => (1..=10)
                .map(|k| json!({"bladders": [k, -k], "ends": ["sealed", "sealed"]}))
                .collect(),
        };
        let amplitude = 1e-7;
        let case = |signal: Value| {
            json!({
                "name": "small", "preset": "matia-gat-beam", "network": {"chains": chains},
                "bladders": {"coupling": "reciprocal"}, "formulation": "conservative",
                "ends": {"root": {"clamped": {"u1_m": signal}}, "tip": "free"},
                "effects": {"unsteady_friction": "off"}, "effects_tolerance": 1e-9,
                "mesh": {"cells_per_segment": 2}, "solver": {"rtol": 1e-8}, "time": {"end_s": 1.0}
            })
        };
        let cycle = checked(&case(json!({"sine": {"amplitude": amplitude, "frequency_hz": hz}})));
        let found = numbers::of_cycle(&cycle, 1, &StopFlag::default()).unwrap();
        let largest = found["tip_u1_m.window_max_abs"].value / amplitude;
        let linear = at(&case(json!(0.0)), "/ends/root/clamped/u1_m", "tip_u1", hz).norm();
        assert!(
            (largest - linear).abs() < 1e-4 * linear,
            "{hz} Hz: {largest} for {linear}"
        );
    }
}

/// Goal: a band of one frequency has the response there; it was the static one.
#[test]
fn one_frequency_is_a_band() {
    let shaken = beam(16, &json!({"clamped": {"u1_m": 0.0}}), &json!("free"));
    let request = Request {
        input: "/ends/root/clamped/u1_m".into(),
        outputs: vec!["tip_u1".into()],
        at: None,
        band: [10.0, 10.0],
        points: 200,
    };
    let case = checked(&shaken);
    let found = respond(&case, &request, request.compute(&case).unwrap()).unwrap();
    assert_eq!(found.frequencies, [10.0]);
    let exact = at(&shaken, &request.input, "tip_u1", 10.0);
    let (own, error) = (found.curves[0].values[0], found.curves[0].errors[0]);
    assert!((own - exact).norm() < 1e-5 * exact.norm(), "{own} for {exact}");
    assert!(error < 0.1 * exact.norm(), "{error}");
}

/// Goal: check valves, whose characteristic has a kink at zero flow, transmit a static pressure, at any pressure.
#[test]
fn check_valves_pass_a_slow_pressure_on() {
    let file = std::fs::read_to_string("cases/bladder-pump.json").unwrap();
    let mut case: Value = serde_json::from_str(&file).unwrap();
    for pressure in [0.0, 200.0, -200.0] {
        case["network"]["ports"][0]["pressure_pa"] = json!(pressure);
        let output = ["accumulator_vessel_pressure".to_owned()];
        let response =
            LinearResponse::new(&checked(&case), "/network/ports/0/pressure_pa", &output, Some(0.0)).unwrap();
        let gain = response.solver().unwrap().at(1e-8).unwrap()[0];
        assert!((gain - 1.0).norm() < 1e-3, "{gain} at {pressure} Pa");
    }
}

/// Source: statics. Goal: an axial force on a bent or loaded beam balances the reaction of its root, on any mesh; differences relative to
/// the force had no digits there.
#[test]
fn a_force_on_a_loaded_beam_is_carried_by_its_root() {
    let file = std::fs::read_to_string("cases/elastica.json").unwrap();
    let mut case: Value = serde_json::from_str(&file).unwrap();
    let bent = at(&case, "/ends/tip/free/force_z_n", "reaction_root_z", 1e-3);
    assert!((bent + 1.0).norm() < 1e-5, "{bent}");
    case["mesh"]["segments"] = json!(128);
    case["start"] = json!({});
    case["ends"]["tip"]["free"]["force_z_n"] = json!(-2.0);
    let output = ["reaction_root_z".to_owned()];
    let response = LinearResponse::new(&checked(&case), "/ends/tip/free/force_z_n", &output, Some(0.0)).unwrap();
    let straight = response.solver().unwrap().at(1e-3).unwrap()[0];
    assert!((straight + 1.0).norm() < 1e-5, "{straight}");
}

/// Source: Womersley, Y = π a² (1 - 2 J₁(z)/(z J₀(z)))/(i ω ρ l) with z = a sqrt(-i ω ρ/μ), in extended precision. Goal: a response
/// includes unsteady friction. Tolerance: 1 %, that of its memory [E52].
#[test]
fn a_tube_has_unsteady_friction() {
    let sealed = |bladder: i64| json!({"bladders": [bladder], "ends": ["sealed", "sealed"]});
    let port = |name: &str| json!({"name": name, "at": {"junction": name}, "pressure_pa": 0.0});
    let tube = json!({"from": {"junction": "a"}, "to": {"junction": "b"}, "length_m": 0.1, "cross_section": {"circle": {"radius_m": 1e-3}}});
    let case = json!({
        "name": "tube", "preset": "matia-gat-beam", "bladders": {"per_row": 1},
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 0.01},
        "network": {"chains": [sealed(1), sealed(-1)], "junctions": ["a", "b"], "tubes": [tube], "ports": [port("a"), port("b")]},
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.0}
    });
    let flow = at(&case, "/network/ports/0/pressure_pa", "port_a_flow", 50.0);
    let exact = Complex::new(2.194e-11, -7.466e-11);
    assert!((flow - exact).norm() < 0.01 * exact.norm(), "{flow}");
}

/// Source: equilibria of 1e-8 m³ more and less. Goal: an input may be a number absent from the case, or a volume that begins at zero.
#[test]
fn inputs_begin_anywhere() {
    let case = json!({
        "name": "inputs", "preset": "matia-gat-beam", "bladders": {"per_row": 1, "coupling": "reciprocal"},
        "network": {"chains": [{"bladders": [1, -1], "ends": ["sealed", {"volume_m3": 0.0}]}]},
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.0}
    });
    let slow = at(&case, "/network/chains/0/ends/1/volume_m3", "bladder_1_pressure", 1e-4);
    assert!((slow.re / 6.2111801242e10 - 1.0).abs() < 1e-9, "{slow}");
    let none = at(&case, "/network/chains/0/opening", "bladder_1_pressure", 10.0);
    assert!(
        none.norm() < 1e-9,
        "where nothing flows an opening changes nothing: {none}"
    );
}

/// Goal: unknown names are rejected with the nearest known one.
#[test]
fn inputs_and_outputs_are_named() {
    let case = checked(&beam(4, &json!({"clamped": {"u1_m": 0.0}}), &json!("free")));
    let refused = |input: &str, output: &str| match LinearResponse::new(&case, input, &[output.into()], None) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("{input} and {output} are accepted"),
    };
    assert!(refused("/ends/root/clamped/u3_m", "tip_u1").contains("/ends/root/clamped/u1_m"));
    assert!(refused("/ends/root/clamped/u1_m", "tip_u2").contains("nearest is tip_u"));
    assert!(refused("/ends/root/clamped/u1_m", "kinetic_energy_j").contains("no such linear output"));
    let file = std::fs::read_to_string("cases/tour-actuator.json").unwrap();
    let tour = checked(&serde_json::from_str(&file).unwrap());
    let volume = ["port_inlet_of_bladder__1_volume".to_owned()];
    let error = LinearResponse::new(&tour, "/network/chains/0/ends/0/pressure_pa", &volume, None)
        .err()
        .unwrap();
    assert!(error.to_string().contains("no such linear output"), "{error}");
}

/// Source: [E81]. Goal: `C (s - A)⁻¹ B + D` of a state-space model is the response: of an input that moves an end, over s², and of another
/// input.
#[test]
fn a_state_space_model_has_the_same_response() {
    let chain = json!({"bladders": [1, 2, -1, -2], "ends": ["sealed", {"pressure_pa": 100.0}]});
    let case = checked(&json!({
        "name": "states", "preset": "matia-gat-beam", "bladders": {"per_row": 2, "coupling": "reciprocal"},
        "network": {"chains": [chain]}, "formulation": "conservative",
        "ends": {"root": {"clamped": {"u1_m": 0.0}}, "tip": "free"},
        "mesh": {"cells_per_segment": 2}, "time": {"end_s": 1.0}
    }));
    let outputs = ["tip_u1".to_owned(), "tip_angle".to_owned()];
    for (input, input_rate) in [
        ("/ends/root/clamped/u1_m", 2),
        ("/network/chains/0/ends/1/pressure_pa", 0),
        ("/network/chains/0/opening", 0),
    ] {
        let response = LinearResponse::new(&case, input, &outputs, None).unwrap();
        let model = StateSpace::new(&response).unwrap();
        assert_eq!(model.input_rate, input_rate, "{input}");
        let n = model.b.len();
        let mut solver = response.solver().unwrap();
        for hz in [0.5, 3.0, 12.0, 40.0] {
            let s = Complex::new(0.0, std::f64::consts::TAU * hz);
            let mut matrix = nalgebra::DMatrix::from_fn(n, n, |i, j| Complex::from(-model.a[i][j]));
            (0..n).for_each(|k| matrix[(k, k)] += s);
            let b = nalgebra::DVector::from_iterator(n, model.b.iter().map(|b| Complex::from(*b)));
            let x = matrix.lu().solve(&b).unwrap();
            let exact = solver.at(hz).unwrap();
            for (k, exact) in exact.into_iter().enumerate() {
                let of_states: Complex<f64> = model.c[k].iter().zip(x.iter()).map(|(c, x)| x * *c).sum();
                let over = s.powi(input_rate as i32);
                let found = (of_states + model.d[k]) * over;
                assert!(
                    (found - exact).norm() <= 1e-6 * exact.norm() && (exact.norm() > 0.0 || input.ends_with("opening")),
                    "{input} {hz} Hz: {found} for {exact}"
                );
            }
        }
    }
}

/// A finger on a constant supply, with the valve of its supply half open, without inertia in tubes.
fn beating() -> Case {
    let sets = [
        "/network/tubes/0/opening=0.5",
        "/network/ports/0/pressure_pa/ramp/to=160000",
        "/effects={\"tube_inertia\":\"off\",\"tube_losses\":\"off\"}",
    ]
    .map(String::from);
    case::load("cases/relaxation-oscillator.json".as_ref(), &sets).unwrap()
}

/// Goal: modes that grow without oscillation are counted, whatever the band: both that `modes` finds.
#[test]
fn growth_without_oscillation_is_seen() {
    let case = beating();
    let input = "/network/ports/0/pressure_pa";
    let linear = LinearResponse::new(&case, input, &["tip_u1".into()], Some(6.0)).unwrap();
    for band in [[0.01, 1.0], [1.0, 200.0], [1.0, 1000.0]] {
        let found = poles(&case, Some(6.0), &linear, band).unwrap().growing;
        assert!(
            found.len() == 2 && found.iter().all(|s| s.re > 1.0),
            "{band:?}: {found:?}"
        );
    }
    assert_eq!(growing(&case, Some(6.0), &linear), Ok(2));
}

/// Source: creeping flow through a valve, `q = o Δp/R`: an opening acts as its port times `Δp/o`, at every frequency. Goal: no rates of the
/// opening in the equations.
#[test]
fn an_opening_of_creeping_flow_acts_as_its_port() {
    let case = beating();
    let response =
        |input: &str| LinearResponse::new(&case, input, &["accumulator_dome_pressure_pa".into()], Some(6.0)).unwrap();
    let [opening, port] = ["/network/tubes/0/opening", "/network/ports/0/pressure_pa"].map(response);
    assert_eq!(opening.input_rate(), 0);
    let [mut opening, mut port] = [&opening, &port].map(|response| response.solver().unwrap());
    let mut ratio = |hz: f64| opening.at(hz).unwrap()[0] / port.at(hz).unwrap()[0];
    let first = ratio(1.0);
    for hz in [30.0, 1000.0, 3000.0] {
        assert!((ratio(hz) / first - 1.0).norm() < 1e-6, "{hz} Hz: {}", ratio(hz));
    }
}
