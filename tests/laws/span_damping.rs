//! Damping of materials that differ along a beam, [E83]: against perturbation theory, the uniform beam, balances and differences.

use serde_json::{Value, json};
use slcbeam::run::modes::{ModeOptions, modes};

use crate::eccentric::merge;
use crate::jacobian::agrees;
use crate::spans::{dry, faults, parse, pumped, run};

/// Goal: the first mode of a cantilever with damping in its root half decays at `ω² τ_b f/2`, f the share of this half in the bending
/// energy: of the exact mode shape. Tolerance: second order of the mesh of 40 cells.
#[test]
fn a_half_damps_by_its_share_of_the_energy() {
    let time = 1e-4;
    let half = json!({"length_m": 0.5, "beam": {"damping": {"bending_time_s": time}}});
    let mut case = dry(40, &json!([half, {}]));
    case["ends"]["tip"] = json!("free");
    let plan = ModeOptions {
        count: 2,
        near_hz: 0.5,
        limits: false,
    };
    let found = modes(&parse(&case), &plan).unwrap();
    let first = found.modes.iter().find(|mode| mode.s.im > 1.0).unwrap();
    let k = 1.875_104_068_711_961_f64;
    let ratio = (k.cosh() + k.cos()) / (k.sinh() + k.sin());
    let bend = |x: f64| (k * x).cosh() + (k * x).cos() - ratio * ((k * x).sinh() + (k * x).sin());
    let squares = |range: std::ops::Range<u32>| range.map(|i| bend((f64::from(i) + 0.5) / 1000.0).powi(2)).sum::<f64>();
    let share = squares(0..500) / squares(0..1000);
    let expected = 0.5 * first.s.im.powi(2) * time * share;
    println!("{} {expected} {share}", first.s.re);
    assert!(share > 0.9 && share < 0.99);
    assert!((-first.s.re / expected - 1.0).abs() < 2e-3, "{} {expected}", first.s.re);
}

/// Goal: damping given in all spans is that of the beam, to the last bit; with damping in one span energy closes, and the Jacobian belongs
/// to the residual, with shear and a jump of the neutral axis too.
#[test]
fn damping_of_spans_conserves_energy() {
    let chain: Vec<i32> = (1..=10).map(|k| -k).collect();
    let times = json!({"bending_time_s": 2e-3, "axial_time_s": 2e-3});
    let of = |root: &serde_json::Value| {
        let spans = json!([{"length_m": 0.03, "beam": {"young_modulus_pa": 3e6, "damping": root}}, {"beam": {"young_modulus_pa": 2e6}}]);
        pumped(&chain, -9.81, &spans)
    };
    assert_eq!(run(&of(&json!({}))).0.rows, run(&of(&times)).0.rows);
    let mut case = of(&json!({"bending_time_s": 2e-2, "axial_time_s": 0}));
    let balances = run(&case).1.balances;
    assert!(balances.energy_residual_relative.abs() < 1e-5, "{balances:?}");
    agrees(&parse(&case), "damping");
    case["effects"] = json!({});
    merge(
        &mut case,
        &json!({"beam": {"shear_stiffness_n": 40}, "effects": {"shear": "on"}}),
    );
    agrees(&parse(&case), "shear");
    merge(&mut case, &json!({"beam": {"reference_axis_m": 0.0}}));
    case["spans"][0]["beam"]["neutral_axis_m"] = json!(0.001);
    agrees(&parse(&case), "axis");
}

/// Goal: damping of a span counts as that of the beam: a rest curvature must not jump, and without inertia every span needs it.
#[test]
fn damping_of_a_span_is_checked_as_that_of_the_beam() {
    let spans = |rest: Value| json!([{"length_m": 0.5, "beam": {"damping": {"bending_time_s": 1e-3, "axial_time_s": 1e-3}}}, {"beam": {"damping": rest}}]);
    let mut jumping = dry(10, &spans(json!({})));
    jumping["loads"] =
        json!([{"rest_curvature_1_m": {"signal": {"ramp": {"to": 1, "start_s": 0.1, "duration_s": 0}}}}]);
    let text = faults(&jumping);
    assert!(
        text.contains("E009") && text.contains("/loads/0/rest_curvature_1_m"),
        "{text}"
    );
    for (rest, missing) in [
        (json!({}), true),
        (json!({"bending_time_s": 2e-3, "axial_time_s": 1e-3}), false),
    ] {
        let mut case = dry(10, &spans(rest));
        case["effects"] = json!({"solid_inertia": "off"});
        let refused = match slcbeam::discrete::System::new(&parse(&case)) {
            Ok(_) => String::new(),
            Err(slcbeam::error::Error::Case(refused)) => slcbeam::case::render(&refused, false, 200),
            Err(other) => panic!("{other:?}"),
        };
        assert_eq!(refused.contains("a span has no bending_time_s"), missing, "{refused}");
    }
}

/// Goal: negative times and a mesh of fourth order are refused with place and remedy.
#[test]
fn mistakes_in_damping_are_explained() {
    let spans = |time: f64| json!([{"length_m": 0.5, "beam": {"damping": {"bending_time_s": time}}}, {}]);
    let text = faults(&dry(10, &spans(-1.0)));
    assert!(text.contains("/spans/0/beam/damping/bending_time_s"), "{text}");
    let mut fourth = dry(10, &spans(1e-3));
    fourth["mesh"]["order"] = json!(4);
    let Err(slcbeam::error::Error::Case(refused)) = slcbeam::discrete::System::new(&parse(&fourth)) else {
        panic!("a mesh of fourth order is accepted");
    };
    let text = slcbeam::case::render(&refused, false, 200);
    assert!(text.contains("spans with damping of their own"), "{text}");
}
