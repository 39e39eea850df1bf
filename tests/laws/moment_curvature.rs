//! Moment-curvature laws, [E91]: against closed forms, quadrature, the linear beam, balances and differences.

use std::f64::consts::PI;

use serde_json::{Value, json};
use slcbeam::run::modes::{ModeOptions, modes};

use crate::foundation::{at_rest, order, unit};
use crate::jacobian::agrees;
use crate::pump_curves::pchip;
use crate::spans::{column, largest, parse, run};

/// Curvatures and moments of a law with a plateau.
pub const PLATEAU: ([f64; 5], [f64; 5]) = ([0.0, 0.5, 1.0, 3.0, 4.0], [0.0, 0.5, 0.8, 0.9, 1.4]);
/// A law with different signs.
pub const UNLIKE: ([f64; 5], [f64; 5]) = ([-3.0, -1.0, 0.0, 1.0, 2.0], [-2.0, -0.9, 0.0, 1.2, 3.0]);

pub fn table((curvature, moment): ([f64; 5], [f64; 5])) -> Value {
    json!({"curvature_1_m": curvature, "moment_n_m": moment})
}

/// Moment of a table by Hermite's form: with points of the other sign and one beyond each end.
pub fn moment((curvatures, moments): ([f64; 5], [f64; 5]), at: f64) -> f64 {
    let mut all: Vec<[f64; 2]> = curvatures.into_iter().zip(moments).map(|(x, y)| [x, y]).collect();
    if curvatures[0] == 0.0 {
        let mirrored: Vec<[f64; 2]> = all[1..].iter().rev().map(|point| point.map(|value| -value)).collect();
        all.splice(0..0, mirrored);
    }
    let n = all.len();
    all.push([0, 1].map(|k| 2.0 * all[n - 1][k] - all[n - 2][k]));
    all.insert(0, [0, 1].map(|k| 2.0 * all[0][k] - all[1][k]));
    let [x, y] = [0, 1].map(|k| all.iter().map(|point| point[k]).collect::<Vec<f64>>());
    pchip(&x, &y, at)
}

/// Root of an increasing function.
fn bisect(function: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (-50.0, 50.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// A cantilever of unit stiffness with a law and values at its tip.
pub fn cantilever(cells: usize, law: &Value, tip: &Value) -> Value {
    let mut case = unit(cells, &json!({"root": "clamped", "tip": {"free": tip}}), &json!({}));
    case["beam"]["moment_curvature"] = law.clone();
    // a thin section has small strains where it is much curved
    for (key, value) in [
        ("height_m", 2e-3),
        ("width_m", 0.015),
        ("young_modulus_pa", 1e11),
        ("axial_stiffness_factor", 40.0),
        ("mass_factor", 1.0 / 0.3),
    ] {
        case["beam"][key] = json!(value);
    }
    case["effects"] = json!("full");
    case
}

/// Goal: a law through points on the line of EI is the linear beam, at rest and moving, with and without shear.
#[test]
fn a_straight_law_is_the_linear_beam() {
    let line = json!({"curvature_1_m": [0, 0.3], "moment_n_m": [0, 0.3]});
    for shear in [json!({}), json!({"shear_stiffness_n": 50.0})] {
        let mut lawful = cantilever(12, &line, &json!({"force_x_n": 0.7, "moment_n_m": -0.4}));
        lawful["beam"]["axial_stiffness_factor"] = json!(1e-3);
        lawful["beam"]
            .as_object_mut()
            .unwrap()
            .extend(shear.as_object().unwrap().clone());
        lawful["time"] = json!({"end_s": 0.2, "output_interval_s": 0.02});
        let mut linear = lawful.clone();
        linear["beam"].as_object_mut().unwrap().remove("moment_curvature");
        for name in ["tip_u1", "tip_u3", "tip_angle"] {
            let [a, b] = [&linear, &lawful].map(|case| at_rest(case, name));
            assert!((a - b).abs() < 1e-12 * a.abs(), "{name}: {a:e} {b:e}");
        }
        let [a, b] = [&linear, &lawful].map(|case| column(&run(case), "tip_u1"));
        let apart = a.iter().zip(&b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-10 * largest(&a), "{apart:e}");
    }
}

/// Goal: a moment at the tip bends a cantilever to an arc with the curvature of the law's inverse: on both sides of the plateau, beyond the
/// table, and for both signs of a law that is not odd.
#[test]
fn a_moment_bends_a_cantilever_to_an_arc() {
    for (law, moments) in [(PLATEAU, [0.3, 0.85, -1.2, 2.0]), (UNLIKE, [0.8, -1.7, -0.3, -3.0])] {
        for given in moments {
            let curvature = bisect(|x| moment(law, x) - given);
            let angle = at_rest(&cantilever(8, &table(law), &json!({"moment_n_m": given})), "tip_angle");
            assert!(
                (angle + curvature).abs() < 1e-8 * curvature.abs(),
                "{given}: {angle} for {curvature}"
            );
            let errors = [16, 32].map(|cells| {
                let case = cantilever(cells, &table(law), &json!({"moment_n_m": given}));
                at_rest(&case, "tip_u1") + (1.0 - curvature.cos()) / curvature
            });
            assert!(
                errors[1].abs() < 2e-3 && (order(errors) - 2.0).abs() < 0.1,
                "{given}: {errors:?}"
            );
        }
    }
}

/// Deflection, shortening and angle of a cantilever `M = κ + κ³` with the dead force P across at its tip, by shooting with Runge and Kutta's
/// method from the root: `φ' = -κ(M)`, `M' = P λ cos φ`, `λ = 1 + P sin φ/EA`.
fn elastica(force: f64, ea: f64) -> [f64; 3] {
    let curvature = |m: f64| {
        // Cardano's root of κ³ + κ = m
        let root = (0.25 * m * m + 1.0 / 27.0).sqrt();
        (root + 0.5 * m).cbrt() - (root - 0.5 * m).cbrt()
    };
    let slope = |[_, _, phi, m]: [f64; 4]| {
        let stretch = 1.0 + force * phi.sin() / ea;
        [
            stretch * phi.sin(),
            stretch * phi.cos(),
            -curvature(m),
            force * stretch * phi.cos(),
        ]
    };
    let shoot = |root_moment: f64| {
        let steps = 4000;
        let h = 1.0 / f64::from(steps);
        let mut y = [0.0, 0.0, 0.0, root_moment];
        for _ in 0..steps {
            let add = |y: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|i| y[i] + h * k[i]);
            let a = slope(y);
            let b = slope(add(y, a, 0.5 * h));
            let c = slope(add(y, b, 0.5 * h));
            let d = slope(add(y, c, h));
            y = [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        y
    };
    let [x, z, phi, _] = shoot(bisect(|moment| shoot(moment)[3]));
    [x, z - 1.0, phi]
}

/// Goal: a force at the tip bends a cantilever with a cubic law as the elastica by shooting, with second order in the cells.
#[test]
fn a_force_bends_a_cubic_law_as_its_elastica() {
    let curvatures: Vec<f64> = (0..=400).map(|k| 0.01 * f64::from(k)).collect();
    let moments: Vec<f64> = curvatures.iter().map(|x| x + x * x * x).collect();
    let law = json!({"curvature_1_m": curvatures, "moment_n_m": moments});
    let force = 4.0;
    let case = |cells: usize| cantilever(cells, &law, &json!({"force_x_n": force}));
    let exact = elastica(force, 1.2e8);
    for (name, exact) in ["tip_u1", "tip_u3", "tip_angle"].into_iter().zip(exact) {
        let [coarse, fine] = [40, 80].map(|cells| at_rest(&case(cells), name));
        let extrapolated = fine + (fine - coarse) / 3.0;
        assert!(
            (extrapolated - exact).abs() < 3e-6 * exact.abs(),
            "{name}: {extrapolated} for {exact}"
        );
        assert!((order([coarse - exact, fine - exact]) - 2.0).abs() < 0.05, "{name}");
    }
}

/// Goal: the energy balance closes while force, moment and curvature at rest move, for odd and other laws, with shear, damping, relaxation,
/// spans and a neutral axis beside the line, for all kinematics.
#[test]
fn energy_closes() {
    let sine = |amplitude: f64, frequency: f64| json!({"sine": {"amplitude": amplitude, "frequency_hz": frequency, "ramp_cycles": 1}});
    let variants = [
        json!({}),
        json!({"shear_stiffness_n": 50.0}),
        json!({"damping": {"bending_time_s": 2e-3}}),
        json!({"viscoelasticity": {"prony": [{"modulus_ratio": 0.5, "time_s": 0.05}]}}),
        json!({"neutral_axis_m": 3e-4, "reference_axis_m": 0.0, "damping": {"axial_time_s": 1e-4}}),
    ];
    for (k, variant) in variants.into_iter().enumerate() {
        for root in ["clamped", "pinned"] {
            let tip = json!({"force_x_n": sine(0.3, 1.0), "moment_n_m": sine(1.2, 1.7)});
            let mut case = cantilever(10, &table([PLATEAU, UNLIKE][k % 2]), &tip);
            case["ends"]["root"] = json!(root);
            case["loads"] = json!([{"rest_curvature_1_m": {"signal": sine(0.4, 1.3)}}]);
            for (key, value) in variant.as_object().unwrap() {
                case["beam"][key] = value.clone();
            }
            case["beam"]["axial_stiffness_factor"] = json!(1e-3);
            case["spans"] = json!([{"length_m": 0.5}, {"beam": {"moment_curvature": {"curvature_1_m": [0, 1, 3], "moment_n_m": [0, 2, 3]}}}]);
            case["time"] = json!({"end_s": 0.6, "output_interval_s": 0.05});
            case["solver"]["rtol"] = json!(2e-8);
            for effects in [json!("full"), json!({"finite_rotation": "off"})] {
                case["effects"] = effects;
                let one = run(&case);
                let relative = one.1.balances.energy_residual_relative;
                assert!(
                    largest(&column(&one, "tip_u1")) > 0.1 && relative.abs() < 1e-6,
                    "{variant} {root}: {relative:.1e}"
                );
            }
        }
    }
}

/// The published beam with ten segments, a law that stiffens, and pressure in its upper row.
fn pressed(more: &Value) -> Value {
    let mut case = json!({
        "name": "pressed", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 0.3},
        "network": {"chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10],
            "ends": [{"pressure_pa": {"ramp": {"to": 20000, "start_s": 0, "duration_s": 0.05, "shape": "smooth"}}}, "sealed"]}]},
        "bladders": {"coupling": "reciprocal", "lower": "none"},
        "beam": {"length_m": 0.1, "damping": {"bending_time_s": 2e-3, "axial_time_s": 1e-3}, "bending_stiffness_factor": 1,
                 "moment_curvature": {"curvature_1_m": [-20, -5, 0, 5, 20], "moment_n_m": [-0.8, -0.3, 0, 0.2, 1.0]}},
        "ends": {"root": "clamped", "tip": "free"}, "effects": "full", "companion": "off",
        "time": {"end_s": 0.2, "output_interval_s": 0.01}, "solver": {"rtol": 1e-7}
    });
    for (key, value) in more.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

/// Goal: pressure alone curves as in the linear beam, `κ = α_p`, and a moment adds `f⁻¹(M)`; energy and volume close.
#[test]
fn pressure_curves_beside_the_law() {
    let law = ([-20.0, -5.0, 0.0, 5.0, 20.0], [-0.8, -0.3, 0.0, 0.2, 1.0]);
    let free = at_rest(&pressed(&json!({})), "tip_angle");
    let mut linear = pressed(&json!({}));
    linear["beam"].as_object_mut().unwrap().remove("moment_curvature");
    linear["beam"]["bending_stiffness_factor"] = json!(0.6);
    let by_pressure = at_rest(&linear, "tip_angle");
    assert!(
        free.abs() > 0.04 && (free - by_pressure).abs() < 1e-9 * free.abs(),
        "{free} {by_pressure}"
    );
    for given in [0.4, -0.5] {
        let ends = json!({"ends": {"root": "clamped", "tip": {"free": {"moment_n_m": given}}}});
        let more = at_rest(&pressed(&ends), "tip_angle") - free;
        let expected = -0.1 * bisect(|x| moment(law, x) - given);
        assert!(
            (more - expected).abs() < 1e-8 * expected.abs(),
            "{given}: {more} for {expected}"
        );
    }
    let moment = json!({"sine": {"amplitude": 0.3, "frequency_hz": 6, "ramp_cycles": 1}});
    let published = json!({"published": {"slope_per_pressure_rad": 0.2, "length_per_pressure_m": 0.004}});
    for coupling in [json!("reciprocal"), json!("reciprocal_kinked"), published] {
        let mut case = pressed(&json!({"ends": {"root": "clamped", "tip": {"free": {"moment_n_m": moment}}}}));
        case["bladders"] = json!({"coupling": coupling, "kink_width": 0.1});
        let relative = run(&case).1.balances.energy_residual_relative;
        assert!(relative.abs() < 1e-6, "{coupling}: energy {relative:.1e}");
    }
}

/// Goal: the Jacobian belongs to the residual, with bladders, moments at ends, shear, relaxation, spans and a neutral axis beside the line.
/// A rest curvature keeps all states within one cubic, since differences across points of the table are inexact.
#[test]
fn the_jacobian_belongs_to_the_residual() {
    let ends =
        json!({"root": {"conditions": {"u1_m": 0, "moment_n_m": 1, "u3_m": 0}}, "tip": {"free": {"moment_n_m": 1.2}}});
    let law = |moments: [f64; 3]| json!({"curvature_1_m": [0, 100, 200], "moment_n_m": moments});
    for effects in [json!("full"), json!({"finite_rotation": "off"})] {
        for beam in [
            json!({}),
            json!({"shear_stiffness_n": 60.0}),
            json!({"viscoelasticity": {"prony": [{"modulus_ratio": 0.5, "time_s": 0.05}]}}),
            json!({"neutral_axis_m": 0.003, "reference_axis_m": -0.001}),
        ] {
            let mut case = pressed(
                &json!({"ends": ends, "effects": effects, "loads": [{"rest_curvature_1_m": {"signal": -50}}],
                "spans": [{"length_m": 0.05}, {"rows": "upper", "beam": {"moment_curvature": law([0.0, 8.0, 10.0])}}]}),
            );
            case["beam"]["moment_curvature"] = law([0.0, 4.0, 12.0]);
            for (key, value) in beam.as_object().unwrap() {
                case["beam"][key] = value.clone();
            }
            agrees(&parse(&case), format_args!("{effects} {beam}"));
        }
    }
}

/// Goal: spans bend by their own laws, `φ = -Σ l f⁻¹(M)`: a law of its own, that of the beam scaled to a higher section, and a linear
/// span; at the border the moment is continuous.
#[test]
fn spans_bend_by_their_own_laws() {
    let given = 0.85;
    let mut case = cantilever(12, &table(PLATEAU), &json!({"moment_n_m": given}));
    case["spans"] = json!([{"length_m": 0.25}, {"length_m": 0.25, "beam": {"moment_curvature": table(UNLIKE)}},
        {"length_m": 0.25, "beam": {"height_m": 1.6e-3}}, {"beam": {"height_m": 2.5e-3, "young_modulus_pa": 2e11}}]);
    let scaled = |height: f64, modulus: f64| {
        let factor = modulus * height * height;
        bisect(|x| factor * moment(PLATEAU, x * height) - given)
    };
    let curvatures = [
        scaled(1.0, 1.0),
        bisect(|x| moment(UNLIKE, x) - given),
        scaled(0.8, 1.0),
        scaled(1.25, 2.0),
    ];
    let (angle, expected) = (at_rest(&case, "tip_angle"), -0.25 * curvatures.iter().sum::<f64>());
    assert!((angle - expected).abs() < 1e-8 * expected.abs(), "{angle} {expected}");
    // a law in one span only
    case["beam"].as_object_mut().unwrap().remove("moment_curvature");
    case["spans"] = json!([{"length_m": 0.5}, {"beam": {"moment_curvature": table(PLATEAU)}}]);
    let (angle, expected) = (at_rest(&case, "tip_angle"), -0.5 * (given + scaled(1.0, 1.0)));
    assert!((angle - expected).abs() < 1e-8 * expected.abs(), "{angle} {expected}");
}

/// Goal: a straight beam that clamps hold against its curvature at rest vibrates with the slope of the law there, `ω = 22.3733 √(f'/m)/l²`.
#[test]
fn frequencies_are_those_of_the_slope() {
    for rest in [0.7, -2.0, 3.5] {
        let mut case = cantilever(40, &table(PLATEAU), &json!({}));
        case["ends"] = json!({"root": "clamped", "tip": {"conditions": {"u1_m": 0, "slope_rad": 0, "force_z_n": 0}}});
        case["loads"] = json!([{"rest_curvature_1_m": {"signal": rest}}]);
        let slope = (moment(PLATEAU, rest + 1e-6) - moment(PLATEAU, rest - 1e-6)) / 2e-6;
        // mass per length and length are 1
        let expected = 22.373_285 * slope.sqrt() / (2.0 * PI);
        let plan = ModeOptions {
            count: 1,
            near_hz: expected,
            limits: false,
        };
        let found = modes(&parse(&case), &plan).unwrap();
        let frequency = found.modes[0].frequency_hz().unwrap();
        assert!(
            (frequency / expected - 1.0).abs() < 5e-3,
            "{rest}: {frequency} for {expected}"
        );
    }
}
