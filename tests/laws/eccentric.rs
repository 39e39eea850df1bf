//! One row, unlike rows and neutral axes beside the beam's line, [E89]: against closed forms, other descriptions of the same structure,
//! balances and differences.

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::model::{Model, passivity};
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::Control;

use crate::jacobian::agrees;
use crate::spans::{column, faults, largest, parse, run};

/// The published beam with ten segments under the pressure of its upper row.
pub fn pressed(beam: &Value, bladders: &Value, extra: &Value) -> Value {
    let mut case = json!({
        "name": "pressed", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 0.3},
        "network": {"chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10],
            "ends": [{"pressure_pa": {"ramp": {"to": 20000, "start_s": 0, "duration_s": 0.05, "shape": "smooth"}}}, "sealed"]}]},
        "bladders": {"coupling": "reciprocal"},
        "beam": {"length_m": 0.1, "mass_factor": 0.9, "damping": {"bending_time_s": 2e-3, "axial_time_s": 1e-3}},
        "ends": {"root": "clamped", "tip": "free"}, "effects": "full", "companion": "off",
        "time": {"end_s": 0.1, "output_interval_s": 0.01}, "solver": {"rtol": 1e-7}
    });
    merge(&mut case["beam"], beam);
    merge(&mut case["bladders"], bladders);
    merge(&mut case, extra);
    case
}

pub fn merge(into: &mut Value, from: &Value) {
    for (key, value) in from.as_object().unwrap() {
        match into.get_mut(key).filter(|old| old.is_object() && value.is_object()) {
            Some(old) => merge(old, value),
            None => into[key] = value.clone(),
        }
    }
}

/// Quantities of the equilibrium by their names.
pub fn at_rest<const N: usize>(value: &Value, names: [&str; N]) -> [f64; N] {
    let case = parse(value);
    let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let all = columns(&system(&case, 1.0).unwrap());
    names.map(|name| path.last().row[all.iter().position(|c| c.name == name).unwrap()])
}

/// Tip deflection, extension and angle of the equilibrium.
pub fn tip(value: &Value) -> [f64; 3] {
    at_rest(value, ["tip_u1", "tip_u3", "tip_angle"])
}

fn dry(beam: &Value, ends: &Value, cells: usize) -> Value {
    let mut case = json!({
        "name": "dry", "beam": {"length_m": 0.2, "height_m": 0.02, "width_m": 0.03, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
        "mesh": {"segments": 1, "cells_per_segment": cells}, "ends": ends, "effects": "full", "companion": "off",
        "time": {"end_s": 0.1, "output_interval_s": 0.01}
    });
    merge(&mut case["beam"], beam);
    case
}

/// Goal: a force beside the neutral axis bends the beam, a moment stretches its line, both as the compliances say:
/// `κ = -d N/EI`, `λ - 1 = N/EA + d² N/EI`, and by a moment `κ = M/EI`, `λ - 1 = -d M/EI`.
#[test]
fn force_and_moment_are_coupled_by_the_offset() {
    let (l, d) = (0.2, 0.004);
    let (ea, ei) = (1e6 * 0.02 * 0.03, 1e6 * 0.03 * 0.02_f64.powi(3) / 12.0);
    for shear in [json!({}), json!({"shear_stiffness_n": 200.0})] {
        let mut beam = json!({"neutral_axis_m": 0.003, "reference_axis_m": -0.001});
        merge(&mut beam, &shear);
        let force = 1e-5;
        let [u1, u3, angle] = tip(&dry(
            &beam,
            &json!({"root": "clamped", "tip": {"free": {"force_z_n": force}}}),
            8,
        ));
        // u1'' = -κ
        let expected = [
            0.5 * d * force * l * l / ei,
            l * force * (1.0 / ea + d * d / ei),
            d * force * l / ei,
        ];
        for (value, expected) in [u1, u3, angle].into_iter().zip(expected) {
            assert!((value / expected - 1.0).abs() < 2e-4, "{value:e} for {expected:e}");
        }
        let moment = 1e-7;
        let [u1, u3, angle] = tip(&dry(
            &beam,
            &json!({"root": "clamped", "tip": {"free": {"moment_n_m": moment}}}),
            8,
        ));
        let expected = [-0.5 * moment * l * l / ei, -l * d * moment / ei, -moment * l / ei];
        for (value, expected) in [u1, u3, angle].into_iter().zip(expected) {
            assert!((value / expected - 1.0).abs() < 2e-4, "{value:e} for {expected:e}");
        }
    }
}

/// Goal: one structure under pressure has one shape, wherever its line is: equal angles, and a line beside the neutral axis is at its
/// distance from it.
#[test]
fn the_shape_does_not_depend_on_the_line() {
    let at = |line: f64, cells: usize| {
        let beam = json!({"neutral_axis_m": -0.004, "reference_axis_m": line});
        tip(&pressed(
            &beam,
            &json!({"lower": "none"}),
            &json!({"mesh": {"cells_per_segment": cells}}),
        ))
    };
    let neutral = at(-0.004, 4);
    let apart = |cells: usize| {
        let [u1, u3, angle] = at(0.006, cells);
        let (a, b) = (at(-0.004, cells), 0.01);
        assert!(a[2].abs() > 0.04 && (angle - a[2]).abs() < 1e-9, "{angle} {a:?}");
        // normal to the line, towards +x at rest
        let expected = [a[0] + b * (angle.cos() - 1.0), a[1] - b * angle.sin()];
        (u1 - expected[0]).hypot(u3 - expected[1])
    };
    let [coarse, fine] = [2, 4].map(apart);
    assert!(
        fine < 1e-4 * neutral[0].abs() && coarse / fine > 3.0,
        "{coarse:e} {fine:e}"
    );
}

/// Goal: without a lower row the beam is that with one span of an upper row to the last bit, and that with a lower row at no pressure,
/// which costs unknowns.
#[test]
fn one_row_is_a_beam_without_the_other() {
    let one = run(&pressed(&json!({}), &json!({"lower": "none"}), &json!({})));
    let span = run(&pressed(&json!({}), &json!({}), &json!({"spans": [{"rows": "upper"}]})));
    assert_eq!(one.0.rows, span.0.rows);
    let mut both = pressed(&json!({}), &json!({}), &json!({}));
    let open = json!({"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "ends": [{"pressure_pa": 0}, {"pressure_pa": 0}]});
    both["network"]["chains"].as_array_mut().unwrap().push(open);
    let unknowns = |case: &Value| System::new(&parse(case)).unwrap().layout.len;
    let alone = pressed(&json!({}), &json!({"lower": "none"}), &json!({}));
    assert!(unknowns(&alone) < unknowns(&both));
    let [alone, both] = [alone, both].map(|case| tip(&case));
    for (alone, both) in alone.into_iter().zip(both) {
        assert!((alone - both).abs() < 1e-9 * both.abs().max(1e-3), "{alone:e} {both:e}");
    }
}

/// Values of a row that is thinner and softer than the other.
fn row() -> Value {
    json!({"height_m": 0.006, "area_per_pressure_m2_per_pa": 3e-10,
        "area_per_moment_m2_per_n_m": {"opening": 3e-6, "closing": 3e-6}})
}

/// Goal: a lower row with the values of the upper one is its mirror image to the last bit; with both rows and the axes exchanged, the beam
/// moves as the mirror image. Energy and volume close with unlike rows, a line beside the neutral axis and damping.
#[test]
fn unlike_rows_move_as_their_mirror_image() {
    let usual = parse(&pressed(&json!({}), &json!({}), &json!({}))).bladders.unwrap();
    let same = json!({"lower": {"unlike": {"height_m": usual.height_m}}});
    let plain = run(&pressed(&json!({}), &json!({}), &json!({})));
    assert_eq!(plain.0.rows, run(&pressed(&json!({}), &same, &json!({}))).0.rows);
    // rows exchanged: the case's own values become those of the other row
    let own = json!({"height_m": usual.height_m, "area_per_pressure_m2_per_pa": usual.area_per_pressure_m2_per_pa,
        "area_per_moment_m2_per_n_m": usual.area_per_moment_m2_per_n_m, "area_per_force_m2_per_n": usual.area_per_force_m2_per_n});
    let mut exchanged = row();
    exchanged["area_per_force_m2_per_n"] = json!({"tension": 2e-8, "compression": 2e-8});
    exchanged["permeability_m4"] = json!(9e-13);
    let mut lower = exchanged.clone();
    exchanged["lower"] = json!({"unlike": own});
    exchanged["lower"]["unlike"]["permeability_m4"] = json!(usual.permeability_m4.unwrap());
    lower = json!({"lower": {"unlike": lower}});
    let chain = |sign: i64| {
        let numbers: Vec<i64> = (1..=10).map(|k| sign * k).collect();
        json!({"network": {"chains": [{"bladders": numbers, "ends": [{"pressure_pa": {"ramp": {"to": 2000, "start_s": 0, "duration_s": 0.05,
            "shape": "smooth"}}}, "sealed"]}]}, "loads": [{"gravity": {"x_m_s2": 2.0 * sign as f64, "z_m_s2": 1.0}}]})
    };
    let axes = |sign: f64| json!({"neutral_axis_m": 0.003 * sign, "reference_axis_m": -0.002 * sign});
    let pair = [
        pressed(&axes(1.0), &lower, &chain(1)),
        pressed(&axes(-1.0), &exchanged, &chain(-1)),
    ];
    let [at, mirrored] = pair.each_ref().map(tip);
    let scale = at[0].abs();
    assert!(
        scale > 1e-4 && (at[0] + mirrored[0]).abs() < 1e-9 * scale,
        "{at:?} {mirrored:?}"
    );
    assert!((at[1] - mirrored[1]).abs() < 1e-9 * scale && (at[2] + mirrored[2]).abs() < 1e-9 * at[2].abs());
    // the tolerance of the steps is scaled with the upper row
    let [a, b] = pair.each_ref().map(run);
    let [u, v] = [&a, &b].map(|run| column(run, "tip_u1"));
    let apart = u.iter().zip(&v).map(|(x, y)| (x + y).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-5 * largest(&u), "{apart:.1e} of {:.1e}", largest(&u));
    for one in [&a, &b] {
        let relative = one.1.balances.energy_residual_relative;
        assert!(relative.abs() < 1e-5, "energy {relative:.1e}");
    }
}

/// Goal: the energy balance closes while a moment at the tip and the rest curvature change, with free and held ends.
#[test]
fn energy_closes_under_moving_moments() {
    let sine = json!({"sine": {"amplitude": 2e-4, "frequency_hz": 8, "ramp_cycles": 1}});
    let beam = json!({"neutral_axis_m": 0.005, "reference_axis_m": 0.0, "damping": {"axial_time_s": 2e-3}});
    for root in [json!("clamped"), json!("pinned")] {
        let ends = json!({"root": root, "tip": {"free": {"moment_n_m": sine, "force_z_n": {"sine": {"amplitude": 0.02, "frequency_hz": 5, "ramp_cycles": 1}}}}});
        let mut case = dry(&beam, &ends, 6);
        case["loads"] = json!([{"rest_curvature_1_m": {"signal": {"sine": {"amplitude": 0.5, "frequency_hz": 4, "ramp_cycles": 1}}}}]);
        case["solver"] = json!({"rtol": 1e-7});
        case["time"] = json!({"end_s": 0.3, "output_interval_s": 0.01});
        let one = run(&case);
        let relative = one.1.balances.energy_residual_relative;
        assert!(
            largest(&column(&one, "tip_u1")) > 1e-4 && relative.abs() < 1e-5,
            "{root}: {relative:.1e}"
        );
    }
}

/// Goal: the Jacobian belongs to the residual with offsets and unlike rows, for all kinematics, with shear and with moments at ends.
#[test]
fn the_jacobian_belongs_to_the_residual() {
    for effects in [
        json!("full"),
        json!({"finite_rotation": "off"}),
        json!({"finite_rotation": "off", "axial_force_on_bending": "off"}),
    ] {
        for shear in [json!({}), json!({"shear_stiffness_n": 60.0})] {
            let mut beam = json!({"neutral_axis_m": 0.003, "reference_axis_m": -0.001});
            merge(&mut beam, &shear);
            let ends = json!({"root": "pinned", "tip": {"free": {"moment_n_m": 1e-3}}});
            let extra = json!({"ends": ends, "effects": effects, "loads": [{"rest_curvature_1_m": {"signal": 0.3}}]});
            let case = parse(&pressed(&beam, &json!({"lower": {"unlike": row()}}), &extra));
            agrees(&case, format_args!("{effects} {shear}"));
        }
    }
}

/// Goal: the law of unlike rows is reciprocal and passive, that of one row too, with the sum over the rows that exist.
#[test]
fn unlike_rows_are_passive() {
    let least = |bladders: &Value| {
        let case: Case = parse(&pressed(
            &json!({"neutral_axis_m": 0.003, "reference_axis_m": 0.0}),
            bladders,
            &json!({}),
        ));
        let found = passivity::assess(&Model::new(&case).unwrap()).unwrap();
        assert!(found.passive(), "{found:?}");
        found.least
    };
    let [both, unlike, one] =
        [json!({}), json!({"lower": {"unlike": row()}}), json!({"lower": "none"})].map(|b| least(&b));
    assert!(both < unlike && unlike < one && one < 1.0, "{both} {unlike} {one}");
}

/// Goal: a beam with the section of a cell strains as the cell's own finite elements, by force and moment at mid-height and by pressure,
/// with one row and with unlike rows; and with its line at the neutral axis it is as curved.
#[test]
fn a_beam_strains_as_the_cell_of_its_section() {
    let upper = json!({"center_m": 0.001, "shape": {"rounded_rectangle": {"along_m": 0.004, "high_m": 0.008, "fillet_m": 0.0015}}});
    let lower = json!({"center_m": -0.0055, "shape": {"circle": {"radius_m": 0.0012}}});
    for lower in [json!("none"), lower] {
        let section = json!({"height_m": 0.016, "width_m": 0.018, "pitch_m": 0.008,
            "material": {"young_modulus_pa": 5e5, "poisson_ratio": 0.45, "density_kg_m3": 1070},
            "bladders": {"length_m": 0.018, "upper": upper, "lower": lower}});
        let own: slcbeam_section::input::Section = serde_json::from_value(section.clone()).unwrap();
        let c = own
            .coefficients(&slcbeam_section::coefficients::Options::default())
            .unwrap()
            .numbers
            .compliance;
        let length = 0.08;
        let case = |end: Value, pressures: [f64; 2], line: Option<f64>| {
            let mut beam = json!({"length_m": length});
            if let Some(line) = line {
                beam["reference_axis_m"] = json!(line);
            }
            let row = |sign: i64| (1..=10).map(|k| sign * k).collect::<Vec<i64>>();
            let chain = |sign: i64, p: f64| json!({"bladders": row(sign), "ends": [{"pressure_pa": p}, "sealed"]});
            let mut chains = vec![chain(1, pressures[0])];
            chains.extend((lower != "none").then(|| chain(-1, pressures[1])));
            tip(&json!({"name": "cell", "section": section, "beam": beam,
                "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 1e-3}, "tubes": {"length_m": 0.001, "radius_m": 0.001},
                "network": {"chains": chains}, "ends": {"root": "clamped", "tip": {"free": end}}, "effects": "full",
                "companion": "off", "time": {"end_s": 1, "output_interval_s": 0.1}}))
        };
        let small = [
            ("force", json!({"force_z_n": 1e-5}), [1e-5, 0.0, 0.0, 0.0]),
            ("moment", json!({"moment_n_m": 1e-8}), [0.0, 1e-8, 0.0, 0.0]),
            ("upper", json!({}), [0.0, 0.0, 0.01, 0.0]),
            ("lower", json!({}), [0.0, 0.0, 0.0, 0.01]),
        ];
        for (name, end, by) in small
            .into_iter()
            .filter(|(name, ..)| lower != "none" || *name != "lower")
        {
            let strain = |i: usize| (0..4).map(|j| c[i][j] * by[j]).sum::<f64>();
            let [_, u3, angle] = case(end.clone(), [by[2], by[3]], Some(0.0));
            for (found, expected) in [(u3, length * strain(0)), (angle, -length * strain(1))] {
                assert!(
                    (found / expected - 1.0).abs() < 2e-4,
                    "{name}: {found:e} for {expected:e}"
                );
            }
            let [_, _, about] = case(end, [by[2], by[3]], None);
            if name != "force" {
                assert!((about / angle - 1.0).abs() < 1e-6, "{name}: {about:e} {angle:e}");
            }
        }
    }
}

/// Goal: mistakes are explained.
#[test]
fn mistakes_are_explained() {
    let beam = json!({"neutral_axis_m": 0.002, "reference_axis_m": 0});
    let fourth = parse(&pressed(&beam, &json!({}), &json!({"mesh": {"order": 4}})));
    let refused = match System::new(&fourth) {
        Err(Error::Case(fault)) => case::render(&fault, false, 200),
        other => panic!("{other:?}"),
    };
    assert!(
        refused.contains("/mesh/order") && refused.contains("neutral axis"),
        "{refused}"
    );
    let explained = |beam: Value, bladders: Value, extra: Value| faults(&pressed(&beam, &bladders, &extra));
    for (text, parts) in [
        (
            explained(json!({"neutral_axis_m": 0.02}), json!({}), json!({})),
            ["/beam/neutral_axis_m", "inside the section"],
        ),
        (
            explained(json!({"reference_axis_m": -1}), json!({}), json!({})),
            ["/beam/reference_axis_m", "one height"],
        ),
        (
            explained(
                json!({"neutral_axis_m": 0.002}),
                json!({}),
                json!({"contacts": [{"name": "wall", "point_m": [0.05, 0], "normal": [-1, 0], "stiffness_pa": 1e4, "smoothing_m": 1e-3}]}),
            ),
            ["/contacts/0", "reach_m"],
        ),
        (
            explained(
                json!({"neutral_axis_m": 0.002, "reference_axis_m": 0}),
                json!({}),
                json!({"formulation": "published"}),
            ),
            ["/formulation", "conservative"],
        ),
        (
            explained(json!({}), json!({"lower": "nothing"}), json!({})),
            ["/bladders/lower", "none"],
        ),
        (
            explained(json!({}), json!({"lower": {"unlike": {"height_m": 0.02}}}), json!({})),
            ["/bladders/lower/unlike/height_m", "the height of the beam"],
        ),
        (
            explained(
                json!({}),
                json!({"lower": {"unlike": {"area_per_moment_m2_per_n_m": {"opening": 2e-6, "closing": 1e-6}}}}),
                json!({}),
            ),
            ["/bladders/lower", "closing"],
        ),
        (
            explained(
                json!({}),
                json!({"lower": "none"}),
                json!({"network": {"chains": [{"bladders": [1, -1], "ends": ["sealed", "sealed"]}]}}),
            ),
            ["/network/chains/0/bladders/1", "no bladder -1"],
        ),
    ] {
        for part in parts {
            assert!(text.contains(part), "{part}\n{text}");
        }
    }
}
