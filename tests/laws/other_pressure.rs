//! Area of a bladder by the pressure in the other one of its segment, [E90]: closed forms, balances, differences, and the cell.

use serde_json::{Value, json};
use slcbeam::discrete::System;
use slcbeam::model::{Model, passivity, relaxation_times};
use slcbeam::run::modes::{ModeOptions, modes};
use slcbeam_section::cell::Cell;
use slcbeam_section::coefficients::Options;
use slcbeam_section::finite::{Drive, FiniteCell};
use slcbeam_section::input::Section;

use crate::eccentric::merge;
use crate::jacobian::agrees;
use crate::spans::{faults, largest, parse, run};

/// `a_p` of the case [m^2/Pa].
const OWN: f64 = 2e-10;
/// Key of `a_x`.
const KEY: &str = "area_per_other_pressure_m2_per_pa";

/// A beam of four segments whose rows are pumped up to different pressures; loads shake its tip.
fn pumped(cross: Option<f64>, changes: &Value) -> Value {
    let sine = |amplitude: f64, frequency: f64| json!({"sine": {"amplitude": amplitude, "frequency_hz": frequency, "ramp_cycles": 1}});
    let mut case = json!({
        "name": "pumped", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 0.05},
        "beam": {"length_m": 0.1},
        "bladders": {"per_row": 4, "coupling": "reciprocal", "area_per_pressure_m2_per_pa": OWN},
        "network": {"chains": [
            {"bladders": [1, 2, 3], "ends": [{"pressure_pa": sine(3000.0, 20.0)}, "sealed"]},
            {"bladders": [-1, -2, -3], "ends": [{"pressure_pa": sine(-2000.0, 33.0)}, "connected"]},
            {"bladders": [4], "ends": ["sealed", "sealed"]}],
            "junctions": ["end"],
            "tubes": [{"from": {"bladder": -3, "end": "outlet"}, "to": {"junction": "end"}},
                {"from": {"junction": "end"}, "to": {"bladder": -4, "end": "inlet"}}]},
        "loads": [{"force_x_n_m": {"signal": sine(1.0, 11.0)}}],
        "ends": {"root": "clamped", "tip": {"free": {"moment_n_m": sine(1e-3, 27.0)}}},
        "effects": "full", "companion": "off",
        "time": {"end_s": 0.1, "output_interval_s": 0.005}, "solver": {"rtol": 1e-8}
    });
    if let Some(cross) = cross {
        case["bladders"][KEY] = json!(cross);
    }
    merge(&mut case, changes);
    case
}

/// Goal: without slopes by moment and force, closed volumes have the pressures of `[a_p,u a_x; a_x a_p,d]`, also with unlike rows: the volume
/// V in the upper bladder of each segment, none in the lower one. Rounding error.
#[test]
fn closed_volumes_have_the_pressures_of_their_compliance() {
    for (cross, lower) in [(-0.6, 1.0), (0.3, 1.0), (-1.1, 2.5)] {
        let none = json!({"area_per_moment_m2_per_n_m": {"opening": 0, "closing": 0}, "area_per_force_m2_per_n": {"tension": 0, "compression": 0}});
        let mut bladders = none.clone();
        let mut other = none;
        other["area_per_pressure_m2_per_pa"] = json!(lower * OWN);
        bladders["lower"] = json!({"unlike": other});
        let volume = 4e-9;
        let ramp = json!({"ramp": {"to": volume, "duration_s": 0.05, "shape": "smooth"}});
        let mut case = pumped(
            Some(cross * OWN),
            &json!({"bladders": bladders, "loads": [], "ends": {"tip": "free"}, "effects": {"network_pressure_differences": "off"}}),
        );
        case["network"] = json!({"chains": [{"bladders": [1, 2, 3, 4], "ends": [{"volume_m3": ramp}, "sealed"]}]});
        let long = parse(&case).bladders.unwrap().length_m;
        let area = volume / 4.0 / long;
        let determinant = (lower - cross * cross) * OWN;
        let exact = [lower * area / determinant, -cross * area / determinant];
        let (memory, _) = run(&case);
        let found = memory.field("pressure_pa").unwrap().last().unwrap();
        for (row, exact) in found.chunks(found.len() / 2).zip(exact) {
            for p in row {
                assert!((p - exact).abs() < 1e-8 * exact.abs(), "{cross} {lower}: {p} {exact}");
            }
        }
    }
}

/// Goal: energy closes as far as tolerances say while rows at different pressures, end moments and loads move the beam, for all kinds of
/// storage; the term matters in all of them.
#[test]
fn energy_closes_with_rows_at_different_pressures() {
    let gas = json!({"kind": "gas", "density_kg_m3": 1.2, "viscosity_pa_s": 0.01});
    for changes in [
        json!({}),
        json!({"mesh": {"cells_per_bladder": 4, "order": 4}}),
        json!({"effects": {"network_pressure_differences": "off"}}),
        json!({"bladders": {"lower": {"unlike": {"area_per_pressure_m2_per_pa": 4e-10}}}}),
        json!({"fluid": gas, "bladders": {"closing": {"below": 0.4, "stiffness_pa": 500}}}),
        json!({"spans": [{"length_m": 0.05}, {"beam": {"young_modulus_pa": 1e6}, "bladders": {KEY: 1e-10}}]}),
    ] {
        let [with, without] = [Some(-0.5 * OWN), None].map(|cross| {
            let (memory, summary) = run(&pumped(cross, &changes));
            let energy = summary.balances.energy_residual_relative;
            (memory.column("tip_u1").unwrap(), energy)
        });
        let apart = with.0.iter().zip(&without.0).map(|(a, b)| a - b).collect::<Vec<_>>();
        println!(
            "{changes}: energy {:.1e}, {:.1e} without; differs by {:.1e}",
            with.1,
            without.1,
            largest(&apart) / largest(&with.0)
        );
        assert!(with.1.abs() < 1e-6, "{changes}: {:.1e}", with.1);
        assert!(largest(&apart) > 1e-3 * largest(&with.0), "{changes}");
    }
}

/// Goal: the Jacobian belongs to the residual for all kinds of storage, with the published coupling, and in spans.
#[test]
fn the_jacobian_belongs_to_the_residual() {
    let published = json!({"published": {"slope_per_pressure_rad": 0.004, "length_per_pressure_m": 0.001}});
    for changes in [
        json!({}),
        json!({"effects": {"flow": "off"}, "mesh": {"order": 4}}),
        json!({"effects": {"network_pressure_differences": "off"}}),
        json!({"formulation": "published", "bladders": {"coupling": published}}),
        json!({"fluid": {"kind": "gas", "density_kg_m3": 1.2}, "bladders": {"closing": {"below": 0.4, "stiffness_pa": 500}}}),
        json!({"spans": [{"length_m": 0.05, "bladders": {KEY: -1e-10}}, {}]}),
    ] {
        agrees(&parse(&pumped(Some(0.4 * OWN), &changes)), &changes);
    }
}

/// Goal: bending presses the rows of a sealed beam against each other: its frequencies are those of bladders with `a_p - a_x`, without the
/// term. Rounding error of the eigenvalues.
#[test]
fn sealed_rows_vibrate_with_the_difference_of_the_coefficients() {
    let sealed = json!({"network": {"chains": [], "tubes": [], "junctions": []}, "loads": [], "ends": {"tip": "free"}});
    let bends = |own: f64, cross: f64| {
        let mut case = pumped(Some(cross * OWN), &sealed);
        case["bladders"]["area_per_pressure_m2_per_pa"] = json!(own * OWN);
        let plan = ModeOptions {
            count: 3,
            near_hz: 1.0,
            limits: false,
        };
        let found = modes(&parse(&case), &plan).unwrap();
        let all: Vec<f64> = found.modes.iter().filter_map(|mode| mode.frequency_hz()).collect();
        all.into_iter().fold(f64::INFINITY, f64::min)
    };
    let [both, difference, own] = [bends(1.0, -0.5), bends(1.5, 0.0), bends(1.0, 0.0)];
    assert!((both / difference - 1.0).abs() < 1e-9, "{both} {difference}");
    assert!((own / difference - 1.0).abs() > 1e-3, "{own} {difference}");
}

/// Goal: zero is no term and no unknown, to the last bit; else each bladder that has another one adds an unknown.
#[test]
fn a_zero_costs_nothing() {
    let unknowns = |case: &Value| System::new(&parse(case)).unwrap().layout.len;
    let [absent, zero, some] = [None, Some(0.0), Some(1e-11)].map(|cross| pumped(cross, &json!({})));
    assert_eq!(run(&absent).0.rows, run(&zero).0.rows);
    assert_eq!(unknowns(&some), unknowns(&absent) + 8);
    let spans = json!({"spans": [{"length_m": 0.05}, {"rows": "none"}], "network": {"chains": [], "tubes": [], "junctions": []}});
    let [absent, some] = [None, Some(1e-11)].map(|cross| pumped(cross, &spans));
    assert_eq!(unknowns(&some), unknowns(&absent) + 4);
}

/// Goal: the least work of pressures is that of the matrix: `1 - |a_x|/a_p` without slopes; the law is reciprocal. A matrix that releases
/// energy, and a row that does not exist, are refused.
#[test]
fn the_law_is_passive_or_refused() {
    let none = json!({"bladders": {"area_per_moment_m2_per_n_m": {"opening": 0, "closing": 0}, "area_per_force_m2_per_n": {"tension": 0, "compression": 0}}});
    for cross in [-0.7, 0.2] {
        let case = parse(&pumped(Some(cross * OWN), &none));
        let found = passivity::assess(&Model::new(&case).unwrap()).unwrap();
        assert!(
            (found.least - (1.0 - f64::abs(cross))).abs() < 1e-12 && found.passive(),
            "{found:?}"
        );
    }
    for (changes, parts) in [
        (
            json!({"bladders": {KEY: -2e-10}}),
            ["/bladders/area_per_other_pressure_m2_per_pa", "release energy"],
        ),
        (
            json!({"bladders": {KEY: 3e-10, "lower": {"unlike": {"area_per_pressure_m2_per_pa": 4e-10}}}}),
            ["below 2.83·10⁻¹⁰ m^2/Pa", "release energy"],
        ),
        (
            json!({"bladders": {KEY: 1e-11, "lower": "none"}, "network": {"chains": [], "tubes": [], "junctions": []}}),
            ["/bladders/area_per_other_pressure_m2_per_pa", "one row"],
        ),
        (
            json!({"spans": [{"length_m": 0.05, "bladders": {KEY: 3e-10}}, {}]}),
            ["/spans/0", "release energy"],
        ),
        (
            json!({"spans": [{"length_m": 0.025, "rows": "upper", "bladders": {KEY: 1e-11}}, {}], "network": {"chains": [], "tubes": [], "junctions": []}}),
            ["/spans/0/bladders/area_per_other_pressure_m2_per_pa", "not both rows"],
        ),
    ] {
        let text = faults(&pumped(None, &changes));
        for part in parts {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }
}

/// A section with a thin wall between the rows.
fn thin(law: &str) -> Value {
    json!({"height_m": 0.02, "width_m": 0.014, "pitch_m": 0.008,
        "material": {"young_modulus_pa": 5e5, "poisson_ratio": 0.45, "density_kg_m3": 1070, "law": law},
        "bladders": {"length_m": 0.014, "lower": "mirrored",
            "upper": {"center_m": 0.003, "shape": {"rounded_rectangle": {"along_m": 0.006, "high_m": 0.005, "fillet_m": 0.0015}}}}})
}

/// Tip angle, and pressure of the sealed lower row, with a pressure in the upper row.
fn at_rest(section: &Value, pressure: f64, effects: &Value) -> [f64; 2] {
    let row = |sign: i64| (1..=10).map(|k| sign * k).collect::<Vec<i64>>();
    let case = json!({"name": "cell", "section": section, "beam": {"length_m": 0.08},
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 1e-3}, "tubes": {"length_m": 0.001, "radius_m": 0.001},
        "network": {"chains": [{"bladders": row(1), "ends": [{"pressure_pa": pressure}, "sealed"]}, {"bladders": row(-1), "ends": ["sealed", "sealed"]}]},
        "ends": {"root": "clamped", "tip": "free"}, "effects": effects, "companion": "off", "time": {"end_s": 1}});
    let [angle, least, most] = crate::eccentric::at_rest(&case, ["tip_angle", "min_pressure", "max_pressure"]);
    [angle, least + most - pressure]
}

/// Goal: where the wall between the rows is thin, a beam with its upper row under pressure and its lower row sealed bends as the finite
/// elements of its cell, and the sealed fluid has their pressure: within 0.01 % with small strains, and within 0.5 % of the pressure with a law at
/// finite strain, whose energy is known beyond a quadratic part that contains the term.
#[test]
fn a_beam_with_a_thin_wall_bends_as_its_cell() {
    for (law, pressure, close) in [("saint_venant_kirchhoff", 1.0, 1e-4), ("neo_hookean", 12e3, 0.005)] {
        let section: Section = serde_json::from_value(thin(law)).unwrap();
        let meshes = section
            .meshes(&Options {
                meshes: 3,
                ..Options::default()
            })
            .unwrap();
        let cell = FiniteCell::new(&section, Cell::new(&section, &meshes[2]), section.material.law.unwrap()).unwrap();
        let state = |lower: f64| cell.equilibrium(Drive::Load([0.0; 2]), [pressure, lower]).unwrap();
        let (mut low, mut high) = (0.0, 0.5 * pressure);
        for _ in 0..12 {
            let [a, b] = [low, high].map(|p| state(p).areas_m2[1]);
            if (b - a).abs() <= 1e-13 * a.abs() {
                break;
            }
            (low, high) = (high, high - b * (high - low) / (b - a));
        }
        let exact = [-state(high).strain[1] * 0.08, high];
        let (own, effects) = match law == "saint_venant_kirchhoff" {
            true => ("linear", json!({})),
            false => (law, json!({"nonlinear_section": "on"})),
        };
        let found = at_rest(&thin(own), pressure, &effects);
        println!("{law}: cell {exact:?}, beam {found:?}");
        assert!((found[0] / exact[0] - 1.0).abs() < close, "{found:?} {exact:?}");
        assert!(
            (found[1] - exact[1]).abs() < close * pressure && exact[1] > 0.05 * pressure,
            "{found:?} {exact:?}"
        );
    }
}

/// Goal: the time constant that is printed covers the slowest exchange between both bladders of a segment, against each other.
#[test]
fn the_slowest_time_covers_bladders_against_each_other() {
    for cross in [-0.9, 0.5] {
        let case = json!({
            "name": "pair", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 0.05}, "beam": {"length_m": 0.1},
            "bladders": {"per_row": 1, "coupling": "reciprocal", "area_per_pressure_m2_per_pa": OWN, KEY: cross * OWN},
            "network": {"tubes": [{"from": {"bladder": 1, "end": "outlet"}, "to": {"bladder": -1, "end": "inlet"}}]},
            "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 0.1}
        });
        let alone = |cross: f64| {
            let mut case = case.clone();
            case["bladders"][KEY] = json!(cross);
            let case = parse(&case);
            let model = Model::new(&case).unwrap();
            relaxation_times::times(model.wet.as_ref().unwrap())[0].unwrap()
        };
        let (own, uncoupled) = (alone(cross * OWN), alone(0.0));
        assert!(
            (own / uncoupled - (1.0 + cross.abs())).abs() < 1e-9,
            "{cross}: {own} {uncoupled}"
        );
    }
}
