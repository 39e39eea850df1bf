//! Source: `docs/exact-results.md` section 4, derived from the paper's data and printed there to the digits used here.
//! Goal: every characteristic number that the program shows before a run.
//! Tolerance: half a unit of the last printed digit.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use slcbeam::discrete::System;
use slcbeam::discrete::fluid_mesh::LinkEnd;
use slcbeam::model::characteristic::{MATHIEU_COUPLING, mathieu_growth, numbers};
use slcbeam::model::{Model, audit};

use super::common::shipped;

fn summary_numbers(case: &str, sets: &[&str]) -> BTreeMap<String, f64> {
    let case = shipped(case, sets);
    numbers(&case, &Model::new(&case).unwrap())
}

/// Half a unit of the last digit of a printed number.
fn half_unit(printed: &str) -> f64 {
    let (mantissa, exponent) = printed.split_once('e').unwrap_or((printed, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len()) as i32;
    0.5 * 10_f64.powi(exponent.parse::<i32>().unwrap() - decimals)
}

fn as_printed(what: &str, value: f64, printed: &str) {
    println!("{what}: {value:.7e}, printed {printed}");
    let expected: f64 = printed.parse().unwrap();
    assert!(
        (value - expected).abs() <= 1.000_001 * half_unit(printed),
        "{what}: {value} is not {printed}"
    );
}

#[test]
fn the_papers_beam_filled_with_water() {
    let water = summary_numbers("wiring-2", &[]);
    for (key, printed) in [
        ("mass_factor", "1.0273"),
        ("bending_stiffness_n_m2", "0.0503885"),
        ("axial_stiffness_n", "1144.8"),
        ("gyration_radius_squared_m2", "2.2709e-5"),
        ("t_s_s", "0.045735"),
        ("t_f_s", "3.9165e-4"),
        ("first_bending_frequency_hz", "12.235"),
        ("first_axial_frequency_hz", "82.39"),
        ("bladder_compliance_m3_pa", "8.05e-12"),
        ("bladder_resistance_pa_s_m3", "2.576e7"),
        ("tube_resistance_pa_s_m3", "2.583e7"),
        ("t_s_over_t_f", "117"),
    ] {
        as_printed(key, water[key], printed);
    }
}

#[test]
fn times_of_the_fluid_for_every_figure() {
    for (case, key, printed) in [
        ("valves-open", "f_u", "0.00705"),
        ("wiring-1", "f_u", "0.00783"),
        ("harvester-parallel-wave", "f_u", "3.92e-4"),
        ("shake-wet", "f_u", "0.0361"),
        ("shake-wet", "t_s_over_t_f", "10.1"),
        ("bend-wet", "t_s_over_t_f", "1.0"),
    ] {
        as_printed(&format!("{case} {key}"), summary_numbers(case, &[])[key], printed);
    }
    let turbine = &Model::new(&shipped::<&str>("harvester-parallel-wave", &[]))
        .unwrap()
        .wet
        .unwrap()
        .network
        .turbines[0];
    as_printed("turbine conductance", turbine.conductance, "2.676e-10");
}

/// "f_m = 0.481, m = 0.494" (A.4.1) holds for a massless fluid, `f_m` cut off rather than rounded: 0.4817.
#[test]
fn the_empty_beam() {
    let empty = summary_numbers("wiring-2", &["/fluid/density_kg_m3=0"]);
    as_printed("mass per length", empty["mass_per_length_kg_m"], "0.494");
    let f_m = empty["mass_factor"];
    println!("f_m of the empty beam: {f_m:.6}");
    assert_eq!((1000.0 * f_m).floor(), 481.0);
}

/// `EI/l_s^3` is the paper's `b_x* = 46.189` N/m only with f_i = 0.55. The compression by inertia in Fig. 4 exceeds the load of a column
/// that buckles under its own weight.
#[test]
fn loads_of_the_shaken_beam() {
    let other = summary_numbers("valves-open", &["/beam/bending_stiffness_factor=0.55"]);
    as_printed("b_x*", other["bending_stiffness_n_m2"] / 1e-3, "46.189");
    let shaken = summary_numbers("valves-open", &[]);
    as_printed("m a", shaken["inertial_compression_n_m"], "445");
    as_printed("self-weight buckling", shaken["self_weight_buckling_load_n_m"], "395");
}

/// `q'' + [w1^2 - kappa_1 a(t)/l_s] q = 0`, `a(t) = U3 l_s (2 pi f)^2 sin(2 pi f t)`. Goal: the stability limit at 18 Hz, the growth rate
/// at Fig. 4's amplitude, and that Fig. 5 is stable.
#[test]
fn the_mathieu_tongue_of_figure_4() {
    let growth = |sets: &[&str]| summary_numbers("valves-open", sets)["mathieu_growth_rate_per_s"];
    as_printed("growth at U3 0.33", growth(&[]), "6.2");
    assert_eq!(growth(&["/ends/root/clamped/u3_m/sine/amplitude=0.025"]), 0.0);
    assert_eq!(summary_numbers("wiring-2", &[])["mathieu_growth_rate_per_s"], 0.0);

    let w1 = 2.0 * std::f64::consts::PI * summary_numbers("valves-open", &[])["first_bending_frequency_hz"];
    as_printed("w1", w1, "76.9");
    as_printed("kappa_1", MATHIEU_COUPLING, "1.5709");
    let omega = 2.0 * std::f64::consts::PI * 18.0;
    let (mut stable, mut unstable) = (0.25, 0.33);
    while unstable - stable > 1e-5 {
        let middle = 0.5 * (stable + unstable);
        let grows = mathieu_growth(w1 * w1, MATHIEU_COUPLING * middle * omega * omega, omega) > 0.0;
        if grows {
            unstable = middle;
        } else {
            stable = middle;
        }
    }
    as_printed("onset U3", unstable, "0.313");
}

/// Goal: the warning errs on the safe side. The drained beam grows from 0.2928 of its length at 18 Hz on (conservative balance of momentum:
/// `slcbeam verify floquet-drained`); a single mode of an inextensible axis gives 0.313. The bound begins below, but by no more than the
/// margin of 2 % and the 1 % of neglected effects.
#[test]
fn the_bound_of_the_tongue_begins_before_the_beam_grows() {
    let all = |amplitude: f64| {
        summary_numbers(
            "valves-open",
            &[&format!("/ends/root/clamped/u3_m/sine/amplitude={amplitude}")],
        )
    };
    for (over_length, warned) in [(0.275, false), (0.2925, true), (0.30, true)] {
        let numbers = all(0.1 * over_length);
        assert_eq!(numbers["mathieu_growth_bound_per_s"] > 0.0, warned, "{over_length}");
        assert_eq!(numbers["mathieu_growth_rate_per_s"], 0.0, "{over_length}");
    }
    // at 0.033 m the drained beam grows with 9.56 1/s (`slcbeam floquet` without fluid, conservative)
    assert!((9.5..11.5).contains(&all(0.033)["mathieu_growth_bound_per_s"]));
}

/// Slowest relaxation of the closed chain of ten, each bladder divided into `cells`: eigenvalues of the graph's
/// Laplacian over the cells' compliance.
fn slowest_time(cells: usize) -> f64 {
    let system = System::new(&shipped("valves-open", &[&format!("/mesh/cells_per_bladder={cells}")])).unwrap();
    let (fluid, wet) = (system.fluid.as_ref().unwrap(), system.model.wet.as_ref().unwrap());
    // The upper row comes first.
    let n = 10 * cells;
    let mut laplacian = DMatrix::<f64>::zeros(n, n);
    let mut join = |a: usize, b: usize, g: f64| {
        for (i, j) in [(a, b), (b, a)] {
            laplacian[(i, i)] += g;
            laplacian[(i, j)] -= g;
        }
    };
    for cell in (0..n).filter(|c| (c + 1) % cells != 0) {
        join(cell, cell + 1, fluid.conductance);
    }
    for link in &fluid.links {
        let (LinkEnd::Cell(a), LinkEnd::Cell(b)) = (link.from, link.to) else {
            panic!("a chain has tubes only")
        };
        join(a, b, 1.0 / (link.half_cells + link.resistance));
    }
    let mut rates: Vec<f64> = laplacian.symmetric_eigenvalues().iter().copied().collect();
    rates.sort_by(f64::total_cmp);
    wet.area[0].per_pressure * fluid.ds / rates[1]
}

/// 4.22 ms continuous to 4.24 ms with one volume a bladder, so that `w tau = 1` at 18 Hz for a permeability factor of
/// 0.48.
#[test]
fn the_slowest_mode_of_a_closed_chain() {
    let times: Vec<f64> = [1, 2, 4, 8].into_iter().map(slowest_time).collect();
    println!("slowest mode with 1, 2, 4, 8 cells a bladder: {times:.6?} s");
    as_printed("one volume a bladder", 1e3 * times[0], "4.24");
    as_printed("eight", 1e3 * times[3], "4.22");
    let shown = summary_numbers("valves-open", &[])["slowest_time_of_network_1_s"];
    assert!((shown / times[0] - 1.0).abs() < 1e-9);
    as_printed(
        "factor for w tau = 1",
        2.0 * std::f64::consts::PI * 18.0 * shown,
        "0.48",
    );
}

/// Reciprocity 124.08 and 0.458, asymmetries 0.271 and 0.268; passivity and solvability are satisfied.
#[test]
fn the_audit_of_the_published_coupling() {
    let case = shipped::<&str>("valves-open", &[]);
    let model = Model::new(&case).unwrap();
    let found = audit::coupling(&case, &model);
    let value = |start: &str| {
        found
            .iter()
            .find(|f| f.name.starts_with(start))
            .unwrap_or_else(|| panic!("no finding {start}"))
            .value
    };
    as_printed("l_b am E/psi'", value("l_b am"), "124.08");
    as_printed("l_b an E/zeta'", value("l_b an"), "0.458");
    as_printed("dm/am", value("dm/am"), "0.271");
    as_printed("dn/an", value("dn/an"), "0.268");
    as_printed("solvable in bending", value("1 - 2 EI"), "0.9994");
    as_printed("solvable in stretch", value("1 - 2 EA"), "0.587");
    // a_p needs 4.2e-11 and 1.3e-11 (`docs/exact-results.md` section 4).
    as_printed("a_p for axial passivity", 1.75e-10 / value("1/(EA"), "4.2e-11");
    as_printed("a_p for bending passivity", 1.75e-10 / value("1/(EI"), "1.3e-11");
    let warnings = audit::warnings(&case, &model, &numbers(&case, &model)).join("\n");
    println!("{warnings}");
    for named in ["bending returns 124 times, and stretch 0.458 times", "Mathieu"] {
        assert!(warnings.contains(named), "no warning names {named}");
    }
}
