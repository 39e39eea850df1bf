//! Valves that closed before the instant of the loads: the fluid filled by a port remains trapped.

use serde_json::{Value, json};
use slcbeam::case::Case;
use slcbeam::case::parameter::Parameter;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, differentiate, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::study::sense::basis::Basis;
use slcbeam::study::sense::estimate_at_rest::{SenseOptions, find};
use slcbeam::study::sense::pressures::PressureTable;

use crate::common::{parse, path_of};

fn ramp(from: f64, to: f64, start: f64, duration: f64) -> Value {
    json!({"ramp": {"from": from, "to": to, "start_s": start, "duration_s": duration}})
}

/// The published beam in thick oil; a port fills the upper row through a tube with a moving valve, then the tip is pushed.
fn filled(opening: &Value, pressure: &Value, more: &Value) -> Case {
    let mut case = json!({
        "name": "filled", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 0.01},
        "bladders": {"coupling": "reciprocal"},
        "network": {
            "chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["connected", "sealed"]},
                       {"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "ends": [{"pressure_pa": 0}, {"pressure_pa": 0}]}],
            "junctions": ["pump"],
            "ports": [{"at": {"junction": "pump"}, "pressure_pa": pressure}],
            "tubes": [{"from": {"junction": "pump"}, "to": {"bladder": 1, "end": "inlet"}, "length_m": 0.02,
                       "cross_section": {"circle": {"radius_m": 1e-3}}, "opening": opening}]},
        "ends": {"root": "clamped", "tip": {"free": {"force_x_n": ramp(0.0, 0.3, 2.2, 0.2)}}},
        "probes": [{"name": "near", "at": 0.05}, {"name": "middle", "at": 0.55}, {"name": "far", "at": 0.95}],
        "mesh": {"cells_per_segment": 2, "cells_per_bladder": 1}, "time": {"end_s": 6.0}
    });
    if let (Some(case), Some(more)) = (case.as_object_mut(), more.as_object()) {
        case.extend(more.clone());
    }
    parse(&case)
}

/// A figure of the last state.
fn last(case: &Case, options: &EquilibriumOptions, name: &str) -> f64 {
    let path = path_of(case, options);
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let columns = columns(&system(case, options.at_s).expect("a system"));
    path.last().row[columns.iter().position(|c| c.name == name).expect("a column")]
}

/// Goal: the equilibrium is the final state of a run. The valve closes at 2.1 s at 3 kPa; the run continues for four seconds after the
/// push, with a residual motion of a few thousandths. Without trapped fluid the pressure would be 440 Pa, not 3440.
#[test]
fn what_a_port_had_filled_stays_behind_its_valve() {
    let case = filled(&ramp(1.0, 0.0, 2.0, 0.1), &ramp(0.0, 3000.0, 0.0, 0.2), &json!({}));
    let mut record = Memory::default();
    dynamics::run(&case, &mut record).expect("a run");
    let at = EquilibriumOptions::at(6.0);
    for name in ["tip_u1", "max_pressure", "middle_pressure_upper"] {
        let run = record.column(name).expect("a column")[record.column(name).expect("a column").len() - 1];
        let rest = last(&case, &at, name);
        assert!((rest / run - 1.0).abs() < 0.01, "{name}: {rest}, in the run {run}");
    }
    sensed(&case, &record);
    let path = path_of(&case, &at);
    let warning = path.warnings().join("\n");
    let resolved = at.resolved(&case).expect("stages");
    assert!(
        warning.starts_with("W030 fluid is trapped behind /network/tubes/0/opening (shut since t = 2.1 s)"),
        "{warning}"
    );
    assert!(
        (resolved.via_s[0] - 2.1).abs() < 1e-12 && resolved.valves_s[0] < 2.1,
        "{resolved:?}"
    );
    assert_eq!(path.last().stage, 1);
}

/// Estimates the push, 0.3 N, from the final pressures of the run. It acts after the closing of the valve, on the trapped fluid.
fn sensed(case: &Case, record: &Memory) {
    let mut without = case.clone();
    without.ends.tip = serde_json::from_value(json!("free")).expect("an end");
    let pressure = |name: &str| record.column(name).and_then(|all| all.last().copied());
    let names = ["near", "middle", "far"].map(|name| format!("{name}_pressure_upper"));
    let measured = PressureTable {
        times: None,
        bladders: vec![0, 5, 9],
        rows: vec![names.iter().map(|name| pressure(name)).collect()],
        deviations: None,
        lines: vec![2],
        left_alone: vec![],
    };
    let asked = SenseOptions {
        loads: vec![Basis::TipForce],
        noise_pa: Some(2.0),
        at_s: 6.0,
        ..SenseOptions::default()
    };
    let found = find(&without, Some(&measured), &asked, &|| false).expect("loads");
    let told = found.rows[0].amplitudes[0].as_ref().expect("a force");
    assert!((told.value / 0.3 - 1.0).abs() < 0.01, "{told:?}");
    assert!(told.low < 0.3 && 0.3 < told.high, "{told:?}");
    let trapped = found.warnings.iter().filter(|warning| warning.starts_with("W030"));
    assert_eq!((trapped.count(), found.warnings.len()), (1, 1), "{:?}", found.warnings);
}

/// Goal: a jump at the instant at which a valve closes acts after the closing; the trapped volume does not depend on anything later.
#[test]
fn what_jumps_as_a_valve_shuts_comes_after() {
    let step = ramp(1.0, 0.0, 1.0, 0.0);
    let jumps = filled(&step, &ramp(3000.0, 0.0, 1.0, 0.0), &json!({}));
    let stays = filled(&step, &json!(3000), &json!({}));
    let [jumps, stays] = [jumps, stays].map(|case| last(&case, &EquilibriumOptions::at(6.0), "max_pressure"));
    assert!(stays > 3000.0 && (jumps / stays - 1.0).abs() < 1e-9, "{jumps} {stays}");
}

/// Goal: a run that starts in equilibrium has the fluid of that state, with the valves of that state; signals before t = 0 have no effect.
/// Both rest where a case does with 3 kPa behind the valve when it closed.
#[test]
fn a_start_in_equilibrium_has_shut_valves_too() {
    let stays = filled(&ramp(1.0, 0.0, 1.0, 0.0), &json!(3000), &json!({}));
    let stays = last(&stays, &EquilibriumOptions::at(6.0), "max_pressure");
    let shut = json!({"table": {"times_s": [-2, -1.9], "values": [1, 0], "interpolation": "linear"}});
    let falls = |times: &[f64], values: &[f64]| json!({"table": {"times_s": times, "values": values, "interpolation": "linear"}});
    let started = |pressure: Value, start: Value| filled(&shut, &pressure, &json!({"start": {"equilibrium": start}}));
    let before = started(
        falls(&[-2.5, -2.4, -1.0, -0.5], &[3000.0, 1000.0, 1000.0, 0.0]),
        json!({"loads_at_s": -3}),
    );
    let stages = started(
        falls(&[-1.5, -1.0], &[3000.0, 0.0]),
        json!({"via_s": [-3], "loads_at_s": 0}),
    );
    for case in [before, stages] {
        let options = EquilibriumOptions::at(6.0);
        let rests = last(&case, &options, "max_pressure");
        assert!((rests / stays - 1.0).abs() < 1e-6, "{rests} {stays}");
        let warning = path_of(&case, &options).trapped.expect("a warning");
        assert!(
            warning.contains("(open in the start equilibrium under the loads at t = -3 s, and shut since)"),
            "{warning}"
        );
        assert!(!warning.contains("still flowing"), "{warning}");
    }
}

/// Goal: no history matters for valves that moved but are open, a valve that opens in the end, one that was never open, or one between a
/// port and a junction without volume.
#[test]
fn valves_that_trap_nothing_add_no_stages() {
    let table = json!({"table": {"times_s": [0, 1, 2, 3], "values": [1, 0.2, 0.7, 0.4]}});
    let again = json!({"sum": [ramp(1.0, 0.0, 1.0, 0.1), ramp(0.0, 1.0, 2.0, 0.1)]});
    for opening in [table, again, json!(0), ramp(0.0, 1.0, 1.0, 1.0)] {
        let case = filled(&opening, &json!(1000), &json!({}));
        let resolved = EquilibriumOptions::at(6.0).resolved(&case).expect("stages");
        assert_eq!(resolved, EquilibriumOptions::at(6.0), "{opening}");
        assert_eq!(path_of(&case, &resolved).trapped, None);
    }
    // closed towards a second port while the row is open to the first
    let shut = filled(&ramp(1.0, 0.0, 2.0, 0.1), &json!(1000), &json!({}));
    let mut open = shut.clone();
    open.network.as_mut().expect("a network").chains[0].ends[1] =
        serde_json::from_value(json!({"pressure_pa": 500})).expect("an end");
    assert_eq!(
        EquilibriumOptions::at(6.0).resolved(&open).expect("stages").via_s,
        Vec::<f64>::new()
    );
    assert_eq!(
        EquilibriumOptions::at(1.0).resolved(&shut).expect("stages").via_s,
        Vec::<f64>::new()
    );
    assert_eq!(
        EquilibriumOptions::at(6.0).resolved(&shut).expect("stages").via_s.len(),
        1
    );
}

/// Goal: a pump of two valves. A vessel fills from a port of 2 kPa while the one is open, and empties into the closed row while the other
/// is. After n strokes the row pressure is that of n mixings, p_n = p_(n-1) + (p - p_(n-1)) C/(C + C_row), with a row compliance that
/// includes the motion of the beam (measured once).
#[test]
fn strokes_of_a_pump_add_up() {
    let square = |first: f64| {
        let steps = (1..6).map(|k| {
            ramp(
                0.0,
                if k % 2 == 1 {
                    1.0 - 2.0 * first
                } else {
                    2.0 * first - 1.0
                },
                f64::from(k),
                0.0,
            )
        });
        let all: Vec<Value> = [json!(first)].into_iter().chain(steps).collect();
        json!({"sum": all})
    };
    let strokes = |count: f64| {
        let network = json!({
            "chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["connected", "sealed"]},
                       {"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "ends": ["sealed", {"pressure_pa": 0}]}],
            "junctions": ["source", "vessel"],
            "ports": [{"at": {"junction": "source"}, "pressure_pa": 2000}],
            "accumulators": [{"at": {"junction": "vessel"}, "kind": {"elastic": {"compliance_m3_pa": 2e-11}}}],
            "tubes": [{"from": {"junction": "source"}, "to": {"junction": "vessel"}, "opening": square(1.0)},
                      {"from": {"junction": "vessel"}, "to": {"bladder": 1, "end": "inlet"}, "opening": square(0.0)}]});
        let case = filled(
            &json!(1),
            &json!(0),
            &json!({"network": network, "ends": {"root": "clamped", "tip": "free"}}),
        );
        // the row is open to the vessel from 1 to 2 s, from 3 to 4 s and from 5 s on
        let options = EquilibriumOptions::at(2.0 * count - 0.5);
        let resolved = options.resolved(&case).expect("stages");
        assert_eq!(resolved.via_s.len() as f64, 2.0 * count - 1.0, "{resolved:?}");
        last(&case, &options, "max_pressure") / 2000.0
    };
    let [one, two, three] = [1.0, 2.0, 3.0].map(strokes);
    assert!(one > 0.02 && one < 0.9, "{one}");
    let follows = |before: f64, after: f64| ((1.0 - after) / (1.0 - before) / (1.0 - one) - 1.0).abs();
    assert!(
        follows(one, two) < 1e-3 && follows(two, three) < 1e-3,
        "{one} {two} {three}"
    );
}

/// Goal: if fluid is fed while a valve closes, a state at rest does not determine the trapped volume: an error, not a number.
#[test]
fn a_pump_that_runs_as_a_valve_shuts_is_refused() {
    let chains = json!([
        {"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["sealed", "sealed"], "opening": ramp(1.0, 0.0, 1.0, 0.1)},
        {"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "ends": [{"pressure_pa": 0}, "sealed"]}]);
    let fed = |until: f64| {
        let mut network = json!({"chains": chains});
        network["chains"][0]["ends"][0] = json!({"flow_m3_s": ramp(1e-8, 0.0, until, 0.1)});
        filled(&json!(1), &json!(0), &json!({"network": network}))
    };
    let fault = path_of(&fed(2.0), &EquilibriumOptions::at(4.0))
        .fault
        .expect("no equilibrium");
    assert!(fault.what.starts_with("a valve shuts at t = 1.1 s"), "{}", fault.what);
    assert!(fault.hint.expect("a hint").contains("slcbeam run"));
    // nine valves close, each traps its share of the earlier inflow: as with open valves, until the push at 2.2 s
    let case = fed(0.5);
    let mut open = case.clone();
    open.network.as_mut().expect("a network").chains[0].opening = slcbeam::functions::Signal::Constant(1.0);
    let names = ["near_pressure_upper", "middle_pressure_upper", "far_pressure_upper"];
    let [shut, open] = [case, open].map(|case| names.map(|name| last(&case, &EquilibriumOptions::at(2.0), name)));
    for (shut, open) in shut.iter().zip(open) {
        assert!(open > 10.0 && (shut / open - 1.0).abs() < 1e-6, "{shut} {open}");
    }
}

/// Goal: derivatives include the trapped volume and the instant of closing: compared with fourth-order differences, as for stages.
#[test]
fn derivatives_know_when_a_valve_shuts() {
    let case = filled(&ramp(1.0, 0.0, 1.0, 0.5), &ramp(0.0, 3000.0, 0.0, 2.0), &json!({}));
    let options = EquilibriumOptions::at(6.0);
    let path = path_of(&case, &options);
    let pointers = [
        "/network/tubes/0/opening/ramp/duration_s",
        "/bladders/area_per_pressure_m2_per_pa",
    ];
    let parameters = pointers.map(|p| Parameter::find(&case, p).expect("a number"));
    for found in differentiate(&case, &options, &path, &parameters).expect("derivatives") {
        let at = |steps: f64| {
            let value = found.parameter.value * (1.0 + 1e-3 * steps);
            let changed = found.parameter.changed(&case, value).expect("a case");
            path_of(&changed, &options).last().row.clone()
        };
        let rows = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
        let columns = columns(&system(&case, 6.0).expect("a system"));
        for name in ["tip_u1", "max_pressure"] {
            let k = columns.iter().position(|c| c.name == name).expect("a column");
            let d = (8.0 * (rows[0][k] - rows[1][k]) - (rows[2][k] - rows[3][k])) / (12e-3 * found.parameter.value);
            assert!(
                (found.row[k] / d - 1.0).abs() < 1e-5,
                "{} {name}: {} {d}",
                found.parameter.pointer,
                found.row[k]
            );
        }
    }
}

/// Goal: an oscillating opening closes many times; the stages are those since the last relevant closing, and too many are rejected with a
/// message.
#[test]
fn too_many_strokes_are_refused() {
    // every 40 ms open for less than 20 ms
    let every = |open: usize| {
        let times: Vec<f64> = (0..=600).map(|k| 0.01 * f64::from(k)).collect();
        let values: Vec<usize> = (0..=600).map(|k| usize::from(k % 4 == open)).collect();
        json!({"table": {"times_s": times, "values": values, "interpolation": "linear"}})
    };
    let (swinging, other) = (every(0), every(2));
    let network = json!({
        "chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ["connected", "sealed"]}],
        "junctions": ["source", "vessel"],
        "ports": [{"at": {"junction": "source"}, "pressure_pa": 2000}],
        "accumulators": [{"at": {"junction": "vessel"}, "kind": {"elastic": {"compliance_m3_pa": 2e-11}}}],
        "tubes": [{"from": {"junction": "source"}, "to": {"junction": "vessel"}, "opening": swinging},
                  {"from": {"junction": "vessel"}, "to": {"bladder": 1, "end": "inlet"}, "opening": other}]});
    let case = filled(&json!(1), &json!(0), &json!({"network": network}));
    let error = follow(&case, &EquilibriumOptions::at(6.0), &mut |_| Control::Continue).expect_err("too many stages");
    assert!(error.to_string().contains("valves shut off fluid"), "{error}");
    // a single valve to a port closes as often, but only the last closing counts
    let case = filled(&swinging, &json!(1000), &json!({}));
    let resolved = EquilibriumOptions::at(5.965).resolved(&case).expect("stages");
    assert_eq!(resolved.via_s.len(), 0, "open then");
    let resolved = EquilibriumOptions::at(5.985).resolved(&case).expect("stages");
    assert!(
        resolved.via_s.len() == 1 && (resolved.via_s[0] - 5.97).abs() < 1e-9,
        "{resolved:?}"
    );
}
