//! Spans with segments of their own length, [E83]: against equal segments, closed forms, balances and differences.

use std::f64::consts::PI;

use serde_json::{Value, json};
use slcbeam::case::parameter::Parameter;
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, differentiate, follow, system};
use slcbeam::run::modes::{ModeOptions, modes};
use slcbeam::run::record::Control;

use crate::differences::worst_difference;
use crate::eccentric::{merge, tip};
use crate::jacobian::agrees;
use crate::spans::{deflection, dry, faults, order, parse, pumped, run, transfer};

/// Segments of 15, 5 and 12 mm: a rigid root, two rows of wide bladders, narrow bladders of one row.
fn unequal() -> Value {
    json!([
        {"length_m": 0.015, "segments": 1, "rows": "none", "beam": {"young_modulus_pa": 2e7}},
        {"length_m": 0.025, "segments": 5, "bladders": {"width_m": 0.004}},
        {"segments": 4, "rows": "upper", "beam": {"density_kg_m3": 1200}}
    ])
}

/// Goal: segments of equal length are the same beam, to the last bit, with and without their number.
#[test]
fn equal_segments_need_no_number() {
    let chain: Vec<i32> = (1..=10).collect();
    let stiff = json!({"young_modulus_pa": 3e6});
    let spans = |segments: [Value; 2]| {
        let [mut first, mut rest] = [json!({"length_m": 0.03, "beam": stiff}), json!({})];
        for (span, segments) in [&mut first, &mut rest].into_iter().zip(segments) {
            if !segments.is_null() {
                span["segments"] = segments;
            }
        }
        json!([first, rest])
    };
    let counted = run(&pumped(&chain, -9.81, &spans([json!(3), json!(7)])));
    assert_eq!(
        run(&pumped(&chain, -9.81, &spans([json!(null), json!(null)]))).0.rows,
        counted.0.rows
    );
    assert_eq!(
        run(&pumped(&chain, -9.81, &spans([json!(3), json!(null)]))).0.rows,
        counted.0.rows
    );
}

/// Goal: with unequal segments energy and volume close, and the Jacobian belongs to the residual in every formulation and kinematics.
#[test]
fn unequal_segments_conserve_energy() {
    let chain: Vec<i32> = (7..=10).collect();
    let case = pumped(&chain, 9.81, &unequal());
    let balances = run(&case).1.balances;
    assert!(balances.energy_residual_relative.abs() < 1e-5, "{balances:?}");
    assert!(balances.volume_residual_relative.abs() < 1e-9, "{balances:?}");
    let small = json!({"finite_rotation": "off"});
    let linear = json!({"finite_rotation": "off", "axial_force_on_bending": "off"});
    let drawn_in = json!({"finite_rotation": "off", "axial_stretch": "off"});
    let variants = [
        ("published", json!("full"), None),
        ("conservative", json!("full"), None),
        ("conservative", json!("full"), Some(50.0)),
        ("conservative", small.clone(), None),
        ("conservative", small, Some(50.0)),
        ("conservative", linear, None),
        ("conservative", drawn_in, None),
    ];
    for (formulation, effects, shear) in variants {
        let mut case = case.clone();
        case["formulation"] = json!(formulation);
        case["effects"] = effects.clone();
        if let Some(shear) = shear {
            case["beam"]["shear_stiffness_n"] = json!(shear);
        }
        agrees(&parse(&case), format_args!("{formulation} {effects} {shear:?}"));
    }
}

/// Goal: bladders of one row under one pressure turn the tip by `l_b aM p` each, however long their segments are.
#[test]
fn each_bladder_turns_the_tip_by_the_same_angle() {
    let chain: Vec<i32> = (1..=10).collect();
    let angle = |spans: Value| {
        let mut case = pumped(&chain, 0.0, &spans);
        // slopes without kink: linear
        case["bladders"]["area_per_moment_m2_per_n_m"] = json!({"opening": 5e-6, "closing": 5e-6});
        case["bladders"]["width_m"] = json!(0.004);
        let case = parse(&case);
        let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
        let at = columns(&system(&case, 1.0).unwrap())
            .iter()
            .position(|c| c.name == "tip_angle");
        path.last().row[at.unwrap()]
    };
    let written = json!([
        {"length_m": 0.02, "segments": 4, "bladders": {"area_per_moment_m2_per_n_m": {"opening": 5e-6, "closing": 5e-6}}},
        {"segments": 6, "bladders": {"area_per_moment_m2_per_n_m": {"opening": 5e-6, "closing": 5e-6}}}
    ]);
    let exact = 10.0 * 0.046 * 5e-6 * 20000.0;
    for (name, found) in [("equal", angle(json!([]))), ("unequal", angle(written))] {
        assert!((found.abs() / exact - 1.0).abs() < 1e-9, "{name}: {found} {exact}");
    }
}

/// Goal: on cells of two lengths, static deflection, frequency, and the reaction of a spring between nodes converge with order two.
#[test]
fn unequal_cells_keep_the_order() {
    let spans = |cells: usize| json!([{"length_m": 0.3, "segments": cells / 2}, {"segments": cells / 4}]);
    let errors = [24, 48].map(|cells| deflection(&dry(3 * cells / 4, &spans(cells))) / (1e-3 / 3.0) - 1.0);
    assert!(errors[1].abs() < 1.5e-3 && order(errors) > 1.9, "{errors:?}");
    // a spring at 0.55 of the length: F (1 - R), δ(s) by superposition
    let (at, stiffness) = (0.55_f64, 5.0);
    let by_tip = |s: f64| s * s * (3.0 - s) / 6.0;
    let reaction = 1e-3 * by_tip(at) / (1.0 / stiffness + at.powi(3) / 3.0);
    let exact = 1e-3 / 3.0 - reaction * by_tip(at);
    let errors = [24, 48].map(|cells| {
        let mut case = dry(3 * cells / 4, &spans(cells));
        case["attachments"] = json!([{"at": at, "stiffness_x_n_m": stiffness}]);
        deflection(&case) / exact - 1.0
    });
    assert!(errors[1].abs() < 1.5e-3, "{errors:?}");
    let plan = ModeOptions {
        count: 4,
        near_hz: 0.5,
        limits: false,
    };
    let errors = [24, 48].map(|cells| {
        let mut case = dry(3 * cells / 4, &spans(cells));
        case["ends"]["tip"] = json!("free");
        let found = modes(&parse(&case), &plan).unwrap();
        let lowest = found
            .modes
            .iter()
            .filter_map(|mode| mode.frequency_hz())
            .reduce(f64::min);
        lowest.unwrap() * 2.0 * PI / 3.516_015_268_67 - 1.0
    });
    assert!(errors[1].abs() < 3e-3 && order(errors) > 1.9, "{errors:?}");
}

/// Goal: the derivative by the length of a span is that of a difference.
#[test]
fn lengths_of_spans_have_derivatives() {
    let spans = |length: f64| json!([{"length_m": length, "segments": 10}, {"segments": 20, "beam": {"young_modulus_pa": 3e8}}]);
    let case = dry(30, &spans(0.4));
    let (case, options) = (parse(&case), EquilibriumOptions::at(1.0));
    let path = follow(&case, &options, &mut |_| Control::Continue).unwrap();
    let length = Parameter::find(&case, "/spans/0/length_m").unwrap();
    let found = differentiate(&case, &options, &path, &[length]).unwrap();
    let differenced = (deflection(&dry(30, &spans(0.401))) - deflection(&dry(30, &spans(0.399)))) / 0.002;
    let at = columns(&system(&case, 1.0).unwrap())
        .iter()
        .position(|c| c.name == "tip_u1");
    let slope = found[0].row[at.unwrap()];
    assert!((slope / differenced - 1.0).abs() < 1e-4, "{slope} {differenced}");
}

/// Goal: gas in bladders of different sizes, also of unlike rows with touching walls, keeps energy and volume, and has its Jacobian.
#[test]
fn gas_fills_bladders_of_any_size() {
    let chain: Vec<i32> = (1..=10).collect();
    let spans = json!([{"length_m": 0.04, "bladders": {"width_m": 0.006}}, {"bladders": {"height_m": {"linear": [0.008, 0.005]}}}]);
    let mut case = pumped(&chain, 9.81, &spans);
    case["fluid"] = json!({"preset": "air"});
    case["network"]["chains"][0]["ends"][0] =
        json!({"pressure_pa": {"ramp": {"to": -60000, "duration_s": 0.05, "shape": "smooth"}}});
    case["bladders"]["closing"] = json!({"below": 0.9, "stiffness_pa": 50000.0});
    case["bladders"]["lower"] = json!({"unlike": {"height_m": 0.006}});
    let (memory, summary) = run(&case);
    let balances = summary.balances;
    assert!(balances.energy_residual_relative.abs() < 1e-5, "{balances:?}");
    assert!(balances.volume_residual_relative.abs() < 1e-9, "{balances:?}");
    let mut open = case.clone();
    open["bladders"].as_object_mut().unwrap().remove("closing");
    let [with, without] = [memory, run(&open).0].map(|memory| *memory.column("tip_u1").unwrap().last().unwrap());
    assert!((with / without - 1.0).abs() > 1e-3, "walls touch: {with} {without}");
    agrees(&parse(&case), "gas");
}

/// Goal: in a fluid, a cantilever of two widths with one bending stiffness and one mass vibrates with the frequency of its equation: its
/// outer half carries four times the added mass.
#[test]
fn fluid_moves_with_the_width_of_the_section() {
    let added = |width: f64| 0.25 * PI * 1000.0 * width * width;
    let mass = [1.0 + added(0.02), 1.0 + added(0.04)];
    let determinant = |omega: f64| {
        let k = mass.map(|m| (omega * omega * m).powf(0.25));
        let (a, b) = (transfer(k[0], 1.0, 0.5), transfer(k[1], 1.0, 0.5));
        let product = |i: usize, j: usize| (0..4).map(|n| b[i][n] * a[n][j]).sum::<f64>();
        product(2, 2) * product(3, 3) - product(2, 3) * product(3, 2)
    };
    let (mut low, mut high) = (1.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match determinant(low) * determinant(middle) < 0.0 {
            true => high = middle,
            false => low = middle,
        }
    }
    let plan = ModeOptions {
        count: 4,
        near_hz: 0.5,
        limits: false,
    };
    let errors = [20, 40].map(|cells| {
        let spans = json!([{"length_m": 0.4, "segments": cells / 4}, {"length_m": 0.1, "segments": cells / 4},
            {"segments": cells / 2, "beam": {"width_m": 0.04, "young_modulus_pa": 3e8, "density_kg_m3": 2.5e3}}]);
        let mut case = dry(cells, &spans);
        case["beam"]["width_m"] = json!(0.02);
        case["beam"]["young_modulus_pa"] = json!(6e8);
        case["beam"]["density_kg_m3"] = json!(5e3);
        case["surroundings"] = json!({"density_kg_m3": 1000.0, "added_mass_coefficient": 1.0, "drag_coefficient": 0.0});
        case["ends"]["tip"] = json!("free");
        let found = modes(&parse(&case), &plan).unwrap();
        let lowest = found
            .modes
            .iter()
            .filter_map(|mode| mode.frequency_hz())
            .reduce(f64::min);
        lowest.unwrap() * 2.0 * PI / low - 1.0
    });
    assert!(errors[1].abs() < 5e-3 && order(errors) > 1.8, "{errors:?}");
}

/// Goal: a stream drags each part by its width, and energy closes; a tip 20 mm high touches a wall 2 mm before a beam 10 mm high does.
#[test]
fn walls_and_streams_meet_each_section() {
    let spans = json!([{"length_m": 0.8}, {"segments": 8, "beam": {"height_m": 0.02, "width_m": 0.02}}]);
    let mut case = dry(16, &spans);
    case["ends"]["tip"] = json!({"free": {"force_x_n": {"ramp": {"to": -0.03, "duration_s": 0.5, "shape": "smooth"}}}});
    case["contacts"] = json!([{"name": "floor", "point_m": [-0.012, 0.0], "normal": [1.0, 0.0],
        "stiffness_pa": 1e5, "smoothing_m": 1e-5}]);
    let tip = deflection(&case);
    assert!((tip + 0.002).abs() < 5e-5, "{tip}");
    case["surroundings"] =
        json!({"density_kg_m3": 1.2, "drag_coefficient": 1.9, "added_mass_coefficient": 1.0, "stream_x_m_s": 3.0});
    case["time"]["output_interval_s"] = json!(0.1);
    case["solver"] = json!({"rtol": 1e-7});
    case["companion"] = json!("off");
    let balances = run(&case).1.balances;
    assert!(balances.energy_residual_relative.abs() < 1e-5, "{balances:?}");
    let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
    let worst = worst_difference(&mut dae, 1, 0.1);
    assert!(worst < 1e-6, "{worst:.1e}");
}

/// Source: the axial force bends the half whose neutral axis is e above the line, which the case leaves at mid-height: `φ = F e l/2EI`.
/// Goal: the same with the line given and without, also with the axis of the case at a rounding error.
#[test]
fn the_axis_of_a_span_is_above_that_of_the_case() {
    let angle = |beam: &Value| {
        let mut case = json!({
            "name": "axis", "beam": {"length_m": 0.1, "height_m": 0.002, "width_m": 0.015, "young_modulus_pa": 7e8, "density_kg_m3": 2700},
            "ends": {"root": "clamped", "tip": {"free": {"force_z_n": 0.01}}},
            "spans": [{"length_m": 0.05}, {"beam": {"neutral_axis_m": 0.0005}}],
            "mesh": {"segments": 20}, "time": {"end_s": 0.1, "output_interval_s": 0.001}
        });
        merge(&mut case["beam"], beam);
        tip(&case)[2]
    };
    let exact = 0.01 * 0.0005 * 0.05 / (7e8 * 0.015 * 0.002_f64.powi(3) / 12.0);
    let given = angle(&json!({"reference_axis_m": 0}));
    assert!((given.abs() / exact - 1.0).abs() < 1e-2, "{given} {exact}");
    for beam in [
        json!({}),
        json!({"neutral_axis_m": 0}),
        json!({"neutral_axis_m": 1e-12}),
    ] {
        let found = angle(&beam);
        assert!((found / given - 1.0).abs() < 1e-6, "{beam}: {found} {given}");
    }
}

/// Goal: a thin hinge beside thick parts is strained as its own section, not as the thicker one with the mean curvature: a run to a strain of
/// 0.3 ends, where a strain of 1 stops it.
#[test]
fn a_hinge_is_strained_as_its_own_section() {
    let stiffness = 1e6 * 0.02 * 0.002_f64.powi(3) / 12.0;
    let case = json!({
        "name": "hinge", "beam": {"length_m": 0.1, "height_m": 0.02, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
        "spans": [{"length_m": 0.004, "segments": 2, "beam": {"height_m": 0.002}}, {"length_m": 0.004, "segments": 2}, {"segments": 2}],
        "ends": {"root": "clamped", "tip": {"free": {"moment_n_m": {"ramp": {"to": -300.0 * stiffness, "duration_s": 1.0}}}}},
        "mesh": {"segments": 6, "cells_per_segment": 8}, "time": {"end_s": 1.0, "output_interval_s": 0.1},
        "effects": {"solid_inertia": "off"}, "companion": "off"
    });
    // 4 mm at 300/m, and 96 mm at a thousandth of it
    let angle = *run(&case).0.column("tip_angle").unwrap().last().unwrap();
    assert!((angle.abs() / 1.2288 - 1.0).abs() < 1e-3, "{angle}");
}

/// Goal: spans that all give their segments keep the coefficients of the first with bladders; a section of another pitch is refused.
#[test]
fn coefficients_belong_to_the_first_bladders() {
    let spans = json!([{"length_m": 0.02, "segments": 1, "rows": "none"}, {"length_m": 0.08, "segments": 8}]);
    let chain: Vec<i32> = (2..=9).collect();
    let mut case = pumped(&chain, 0.0, &spans);
    case["bladders"]["per_row"] = json!(9);
    let values = slcbeam::case::spans::segments(&parse(&case));
    assert!(
        (values[1].beam.length_m - 0.09).abs() < 1e-15,
        "{}",
        values[1].beam.length_m
    );
    assert_eq!(
        values[1].bladders.as_ref().unwrap()[0],
        *parse(&case).bladders.as_ref().unwrap()
    );
}

/// Goal: a taper that vanishes or is negative anywhere is refused with its place, also at the ends of the span and between the segments.
#[test]
fn tapers_are_positive_throughout() {
    let dip = |amplitude: f64| json!({"sum": [0.01, {"sine": {"amplitude": amplitude, "waves": 40}}]});
    let touching = json!({"polynomial": {"coefficients": [0.0009, -0.006, 0.01]}});
    for (key, taper, place) in [
        ("height_m", json!({"linear": [0.0216, -0.001]}), "at 1.00 of"),
        ("height_m", json!({"linear": [0.0216, 0]}), "is 0 at 1.00 of"),
        ("young_modulus_pa", json!({"linear": [0, 1e6]}), "is 0 at 0 of"),
        (
            "density_kg_m3",
            json!({"table": {"positions": [0, 0.33, 1], "values": [1e3, 0, 1e3]}}),
            "is 0 at 0.330 of",
        ),
        ("mass_factor", json!({"linear": [1, 0]}), "is 0 at 1.00 of"),
        ("height_m", dip(0.011), "is −0.00100 at"),
        ("width_m", touching, "at 0.300 of"),
        ("height_m", dip(0.0099), ""),
    ] {
        let case = json!({
            "name": "taper", "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
            "spans": [{"length_m": 0.05}, {"beam": {key: taper}}], "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.0}
        });
        if place.is_empty() {
            parse(&case);
            continue;
        }
        let text = faults(&case);
        assert!(
            text.contains("numbers above 0 throughout the span") && text.contains(place),
            "{text}"
        );
    }
}

/// Goal: a number of segments of 0, and rows of a dry beam, are one fault each; a section without bladders is explained where it is missing.
#[test]
fn spans_without_segments_or_bladders_are_explained() {
    let faults_of = |spans: Value| {
        faults(&json!({
            "name": "dry", "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
            "spans": spans, "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.0}
        }))
    };
    let section = json!({"height_m": 0.01, "width_m": 0.02, "pitch_m": 0.01,
        "material": {"young_modulus_pa": 1e6, "poisson_ratio": 0.4, "density_kg_m3": 1000}});
    for (spans, part, count) in [
        (
            json!([{"length_m": 0.05, "segments": 0}, {"length_m": 0.05}]),
            "0 is out of range",
            1,
        ),
        (json!([{"segments": 0}]), "0 is out of range", 1),
        (json!([{"rows": "none"}]), "the case has none", 1),
        (
            json!([{"rows": "none", "bladders": {"height_m": 0.004}}]),
            "the case has none",
            2,
        ),
        (json!([{"section": section}]), "\"upper\":", 1),
    ] {
        let text = faults_of(spans);
        assert!(text.contains(part) && text.matches("fault[").count() == count, "{text}");
    }
}
