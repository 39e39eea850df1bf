//! Beams with spans, [E83]: against the uniform beam, mirror images, closed forms, balances and differences.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::modes::{ModeOptions, modes};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::{Status, Summary};

use crate::jacobian::agrees;

pub fn parse(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("mine.json"), Path::new(""), &[]).unwrap()
}

pub fn faults(value: &Value) -> String {
    match case::parse(&value.to_string(), Path::new("mine.json"), Path::new(""), &[]) {
        Err(slcbeam::error::Error::Case(fault)) => case::render(&fault, false, 200),
        other => panic!("{other:?}"),
    }
}

pub fn run(value: &Value) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let summary = dynamics::run(&parse(value), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    (memory, summary)
}

/// The published beam of 0.1 m with ten segments: a chain of bladders is pumped up, gravity acts across the beam.
pub fn pumped(chain: &[i32], gravity: f64, spans: &Value) -> Value {
    json!({
        "name": "pumped", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 0.3},
        "bladders": {"coupling": "reciprocal"},
        "network": {"chains": [{"bladders": chain,
            "ends": [{"pressure_pa": {"ramp": {"to": 20000, "start_s": 0, "duration_s": 0.05, "shape": "smooth"}}}, "sealed"]}]},
        "loads": [{"gravity": {"x_m_s2": gravity}}],
        "ends": {"root": "clamped", "tip": "free"}, "spans": spans,
        "beam": {"length_m": 0.1, "damping": {"bending_time_s": 2e-3, "axial_time_s": 2e-3}},
        "effects": "full", "companion": "off",
        "time": {"end_s": 0.2, "output_interval_s": 0.02}, "solver": {"rtol": 1e-7}
    })
}

/// A rigid root block, a taper of one row from the second to the seventh segment, and an uncovered tip.
fn graded(rows: &str) -> Value {
    json!([
        {"length_m": 0.01, "rows": "none", "beam": {"young_modulus_pa": 2e7}},
        {"length_m": 0.06, "rows": rows, "beam": {"height_m": {"polynomial": {"coefficients": [0.02, -0.003]}}},
         "bladders": {"height_m": 0.0075}},
        {"rows": "none", "beam": {"density_kg_m3": 1200, "height_m": 0.016}}
    ])
}

/// Column of a recorded run.
pub fn column(run: &(Memory, Summary), name: &str) -> Vec<f64> {
    run.0.column(name).unwrap_or_else(|| panic!("no column {name}"))
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
}

/// Goal: spans with the values of the case are the uniform beam, and several equal spans are one, both to the last bit; one span with
/// other values is the uniform beam with these values.
#[test]
fn equal_spans_are_the_uniform_beam() {
    let chain: Vec<i32> = (1..=10).map(|k| -k).collect();
    let uniform = pumped(&chain, -9.81, &json!([]));
    let height = parse(&uniform).beam.height_m;
    let same = json!([{"length_m": 0.03}, {"beam": {"height_m": height}}, {"length_m": 0.05, "rows": "both"}]);
    assert_eq!(run(&uniform).0.rows, run(&pumped(&chain, -9.81, &same)).0.rows);
    let stiff = json!({"young_modulus_pa": 3e6, "density_kg_m3": 1100});
    let one = run(&pumped(&chain, -9.81, &json!([{"beam": stiff}])));
    let three = json!([{"length_m": 0.03, "beam": stiff}, {"length_m": 0.02, "beam": stiff}, {"beam": stiff}]);
    assert_eq!(one.0.rows, run(&pumped(&chain, -9.81, &three)).0.rows);
    let mut whole = uniform;
    for (key, value) in stiff.as_object().unwrap() {
        whole["beam"][key] = value.clone();
    }
    // coefficients of the case belong to its modulus: those of the preset scale with it
    let (a, b) = (column(&run(&whole), "tip_u1"), column(&one, "tip_u1"));
    let apart = a.iter().zip(&b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-5 * largest(&a), "{apart:.1e} of {:.1e}", largest(&a));
}

/// Goal: the mirrored structure under mirrored loads moves as the mirror image; energy and volume close.
#[test]
fn a_mirrored_structure_moves_as_its_mirror_image() {
    let chain: Vec<i32> = (2..=7).collect();
    let below: Vec<i32> = chain.iter().map(|k| -k).collect();
    let lower = run(&pumped(&below, -9.81, &graded("lower")));
    let upper = run(&pumped(&chain, 9.81, &graded("upper")));
    let (a, b) = (column(&lower, "tip_u1"), column(&upper, "tip_u1"));
    let apart = a.iter().zip(&b).map(|(x, y)| (x + y).abs()).fold(0.0, f64::max);
    assert!(largest(&a) > 1e-3 && apart < 1e-10 * largest(&a), "{apart:.1e}");
    for one in [&lower, &upper] {
        let relative = one.1.balances.energy_residual_relative;
        assert!(relative.abs() < 1e-5, "energy {relative:.1e}");
        assert!(column(one, "min_pressure").iter().all(|p| *p > -20000.0));
    }
}

/// Goal: the Jacobian belongs to the residual, with absent bladders, with shear, and in the published form.
#[test]
fn unknowns_and_their_jacobian() {
    let chain: Vec<i32> = (2..=7).collect();
    let mut case = pumped(&chain, 9.81, &graded("upper"));
    let unknowns = |case: &Value| System::new(&parse(case)).unwrap().layout.network.area.len();
    let both = unknowns(&pumped(&chain, 9.81, &json!([])));
    // the lower row and four bladders of the upper one are gone; sealed bladders have no unknown
    assert_eq!(unknowns(&case), both);
    for (key, value) in [
        ("formulation", json!("conservative")),
        ("formulation", json!("published")),
    ] {
        case[key] = value;
        for shear in [None, Some(50.0)] {
            let beam = case["beam"].as_object_mut().unwrap();
            match shear {
                Some(shear) => beam.insert("shear_stiffness_n".into(), json!(shear)),
                None => beam.remove("shear_stiffness_n"),
            };
            if case["formulation"] == "published" && shear.is_some() {
                continue;
            }
            agrees(&parse(&case), format_args!("{} {shear:?}", case["formulation"]));
        }
    }
}

/// A dry beam of unit stiffness and mass per length with these spans.
pub fn dry(segments: usize, spans: &Value) -> Value {
    json!({
        "name": "dry", "ends": {"root": "clamped", "tip": {"free": {"force_x_n": 1e-3}}},
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
                 "axial_stiffness_factor": 1000},
        "spans": spans, "mesh": {"segments": segments, "cells_per_segment": 1}, "time": {"end_s": 1.0}
    })
}

/// Static deflection of the tip.
pub fn deflection(case: &Value) -> f64 {
    let case = parse(case);
    let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    let at = columns(&system(&case, 1.0).unwrap())
        .iter()
        .position(|c| c.name == "tip_u1");
    path.last().row[at.unwrap()]
}

/// Observed order of an error between a mesh and one of twice the cells.
pub fn order(errors: [f64; 2]) -> f64 {
    (errors[0] / errors[1]).abs().log2()
}

/// Goal: `δ = F/3 [a³/EI_2 + (l³ - a³)/EI_1]` of a stepped cantilever, a from the tip, with order two in spite of the jump.
#[test]
fn a_stepped_cantilever_bends_as_its_closed_form() {
    let spans = json!([{"length_m": 0.5}, {"beam": {"young_modulus_pa": 3e8}}]);
    let exact = 1e-3 / 3.0 * (0.125 / 0.25 + 0.875);
    let errors = [20, 40].map(|cells| deflection(&dry(cells, &spans)) / exact - 1.0);
    assert!(errors[1].abs() < 1e-3 && order(errors) > 1.9, "{errors:?}");
}

/// A cantilever whose height falls linearly to half, and its `δ = ∫ F s²/EI ds`, `EI ~ h³`: `∫_0^1 (1-x)²/(1 - x/2)³ dx = 8 ln 2 - 5`.
pub fn tapered() -> (Value, f64) {
    let spans = json!([{"beam": {"height_m": {"linear": [0.01, 0.005]}}}]);
    (spans, 1e-3 * (8.0 * 2f64.ln() - 5.0))
}

/// Goal: order two of a tapered cantilever in segments, and in the cells of one segment.
#[test]
fn a_tapered_cantilever_bends_as_its_closed_form() {
    let (spans, exact) = tapered();
    for in_segments in [true, false] {
        let errors = [20, 40].map(|cells| {
            let mut case = dry(if in_segments { cells } else { 1 }, &spans);
            case["mesh"]["cells_per_segment"] = json!(if in_segments { 1 } else { cells });
            deflection(&case) / exact - 1.0
        });
        assert!(errors[1].abs() < 1e-3 && order(errors) > 1.9, "{errors:?}");
    }
}

/// `cosh, sinh, cos, sin` of a uniform part: deflection, slope, moment and shear at its end, from those at its beginning.
pub fn transfer(k: f64, ei: f64, l: f64) -> [[f64; 4]; 4] {
    let (ch, sh, c, s) = ((k * l).cosh(), (k * l).sinh(), (k * l).cos(), (k * l).sin());
    let f = [
        0.5 * (ch + c),
        0.5 * (sh + s) / k,
        0.5 * (ch - c) / (k * k),
        0.5 * (sh - s) / k.powi(3),
    ];
    let k4 = k.powi(4);
    [
        [f[0], f[1], f[2] / ei, f[3] / ei],
        [k4 * f[3], f[0], f[1] / ei, f[2] / ei],
        [k4 * ei * f[2], k4 * ei * f[3], f[0], f[1]],
        [k4 * ei * f[1], k4 * ei * f[2], k4 * f[3], f[0]],
    ]
}

/// The first two frequencies of a cantilever of unit length and mass whose EI is 1 up to the middle and 1/4 behind it [Hz].
pub fn stepped_frequencies() -> [f64; 2] {
    let ei = [1.0, 0.25];
    // moment and shear at the free tip, for unit moment and shear at the clamped root
    let determinant = |omega: f64| {
        let k = ei.map(|ei: f64| (omega * omega / ei).powf(0.25));
        let (a, b) = (transfer(k[0], ei[0], 0.5), transfer(k[1], ei[1], 0.5));
        let product = |i: usize, j: usize| (0..4).map(|n| b[i][n] * a[n][j]).sum::<f64>();
        product(2, 2) * product(3, 3) - product(2, 3) * product(3, 2)
    };
    let mut exact = vec![];
    let mut omega = 0.5;
    while exact.len() < 2 {
        let next = omega + 0.05;
        if determinant(omega) * determinant(next) < 0.0 {
            let (mut low, mut high) = (omega, next);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                match determinant(low) * determinant(middle) < 0.0 {
                    true => high = middle,
                    false => low = middle,
                }
            }
            exact.push(low / (2.0 * PI));
        }
        omega = next;
    }
    [exact[0], exact[1]]
}

/// Goal: the first two frequencies of a cantilever of two materials are the zeros of its frequency equation, with order two.
#[test]
fn a_stepped_beam_vibrates_with_the_frequencies_of_its_equation() {
    let exact = stepped_frequencies();
    let spans = json!([{"length_m": 0.5}, {"beam": {"young_modulus_pa": 3e8}}]);
    let plan = ModeOptions {
        count: 4,
        near_hz: 0.5,
        limits: false,
    };
    let mut errors = vec![];
    for cells in [20, 40] {
        let mut case = dry(cells, &spans);
        case["ends"]["tip"] = json!("free");
        let found = modes(&parse(&case), &plan).unwrap();
        let mut frequencies: Vec<f64> = found.modes.iter().filter_map(|mode| mode.frequency_hz()).collect();
        frequencies.sort_by(f64::total_cmp);
        errors.push([0, 1].map(|k| frequencies[k] / exact[k] - 1.0));
    }
    for k in [0, 1] {
        let both = [errors[0][k], errors[1][k]];
        assert!(both[1].abs() < 5e-3 && order(both) > 1.8, "mode {k}: {both:?}");
    }
}

/// Goal: numbers of a span have derivatives, and weight acts where the mass is.
#[test]
fn weight_acts_where_the_mass_is() {
    let heavy = json!([{"length_m": 0.5, "beam": {"density_kg_m3": 1}}, {"beam": {"density_kg_m3": 2e4}}]);
    let mut case = dry(40, &heavy);
    case["ends"]["tip"] = json!("free");
    case["loads"] = json!([{"gravity": {"x_m_s2": 1e-3}}]);
    // a uniform load q on the outer half: q l⁴/EI (1/8 - 7/384)
    let exact = 2e-3 * (1.0 / 8.0 - 7.0 / 384.0);
    let error = deflection(&case) / exact - 1.0;
    assert!(error.abs() < 2e-3, "{error:.1e}");
}

/// Goal: each mistake is one fault with place, limit and remedy.
#[test]
fn mistakes_are_explained() {
    let chain: Vec<i32> = (1..=10).collect();
    let case = |spans: Value| faults(&pumped(&chain, 0.0, &spans));
    for (spans, parts) in [
        (
            json!([{"length_m": 0.015}, {}]),
            ["/spans/0/length_m", "multiples of 0.01 m; nearest 0.02"],
        ),
        (
            json!([{"length_m": 0.05}]),
            [
                "the spans are 0.05 m long together, the beam 0.1 m",
                "omit that of one span",
            ],
        ),
        (json!([{}, {}]), ["2 spans without length", "rest of the beam"]),
        (
            json!([{"length_m": 0.015, "segments": 4}, {"segments": 5}]),
            [
                "the spans have 9 segments together, /bladders/per_row is 10",
                "allowed: /bladders/per_row 9",
            ],
        ),
        (
            json!([{"length_m": 0.015, "segments": 10}, {}]),
            [
                "the spans have 10 segments and 1 span without a number of them",
                "/bladders/per_row of at least 11",
            ],
        ),
        (
            json!([{"length_m": 0.015, "segments": 4}, {"length_m": 0.02}, {}]),
            [
                "0.02 m is not a whole number of segments of 0.0141666667 m (6 segments are left",
                "give \"segments\" of this span",
            ],
        ),
        (
            json!([{"length_m": 0.015, "segments": 4}, {}]),
            [
                "/spans/0",
                "the width of a bladder is 0.0078 m in this span, the length of a segment 0.00375 m",
            ],
        ),
        (
            json!([{"length_m": 0.02, "rows": "lower"}, {}]),
            ["there is no bladder 1: /spans/0 has none", "/spans/0/rows"],
        ),
        (
            json!([{"beam": {"height_m": {"polynomial": {"coefficients": [0.02, -0.03]}}}}]),
            ["/spans/0/beam/height_m", "numbers above 0"],
        ),
        (
            json!([{"beam": {"height_m": 0.012}}]),
            ["the height of the bladders", "height of the beam"],
        ),
        (json!([{"rows": "none"}]), ["no span has bladders", "dry beam"]),
        (
            json!([{"beam": {"young_modulus_pa": 2.0}}]),
            ["/spans/0", "at /beam/young_modulus_pa of this span"],
        ),
        (
            json!([{"length_m": 0.1}, {}]),
            ["nothing of the beam is left", "shorten other spans"],
        ),
        (
            json!([{"length_m": 0.05, "rows": "bottom"}, {}]),
            ["unknown name \"bottom\"", "the row below is called \"lower\""],
        ),
    ] {
        let text = case(spans.clone());
        for part in parts {
            assert!(text.contains(part), "{spans}: {part}\n{text}");
        }
    }
    // a line at the neutral axis of the case is no key of the span
    let mut thin = pumped(
        &[1, 2, 3, 4, 5],
        0.0,
        &json!([{"length_m": 0.05}, {"rows": "none", "beam": {"height_m": 0.005}}]),
    );
    thin["beam"]["neutral_axis_m"] = json!(0.006);
    let text = faults(&thin);
    assert!(
        text.contains("at /beam/neutral_axis_m") && text.contains("0.006 m, in a section 0.005 m high in /spans/1"),
        "{text}"
    );
    let text = faults(&dry(10, &json!([{"rows": "none"}])));
    assert!(
        text.contains("/spans/0/rows") && text.contains("\"rows\" of a span without bladders"),
        "{text}"
    );
    for segments in [0_u64, 1_000_000_000_000_000_000, u64::MAX] {
        let mut wet = pumped(&chain, 0.0, &json!([{"length_m": 0.05}, {}]));
        wet["bladders"]["per_row"] = json!(segments);
        let mut dry = dry(10, &json!([{"length_m": 0.5}, {}]));
        dry["mesh"]["segments"] = json!(segments);
        for (case, key) in [(wet, "/bladders/per_row"), (dry, "/mesh/segments")] {
            let text = faults(&case);
            let alone = text.contains(key) && text.matches("fault[").count() == 1;
            assert!(alone && text.contains("fault[E006]"), "{key} {segments}: {text}");
        }
    }
}
