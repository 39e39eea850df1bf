//! Vessels with a pressure over their volume, [E102], and valves that a vessel opens, [E103]: exact fillings, derivatives, mistakes.

use serde_json::{Value, json};
use slcbeam::error::Error;

use crate::jacobian::agrees;
use crate::network::{at_rest, elastic, last, near, parse, run, still, tube};
use crate::pump_curves::pchip;

const VOLUMES: [f64; 6] = [-2e-8, 0.0, 3e-8, 9e-8, 1.2e-7, 1.3e-7];
const PRESSURES: [f64; 6] = [-3e4, 0.0, 4e4, 1.5e4, 4e4, 7e4];

fn dome(at: &str) -> Value {
    json!({"name": "dome", "at": {"junction": at}, "kind": {"curve": {"volume_m3": VOLUMES, "pressure_pa": PRESSURES}}})
}

fn port(at: &str, pressure: f64) -> Value {
    json!({"name": at, "at": {"junction": at}, "pressure_pa": pressure})
}

/// Source: monotone cubics in Hermite's form, and Simpson's rule, which integrates them exactly.
/// Goal: a dome that is filled and emptied through a tube has the pressure of its curve on all branches and beyond both ends, the energy
/// of its integral to rounding errors, and balances.
#[test]
fn a_snapping_dome_follows_its_curve() {
    for supply in [1e5, -8e4] {
        let case = still(
            json!({"junctions": ["d", "s"], "tubes": [tube("s", "d", 4e11)], "ports": [port("s", supply)],
                "accumulators": [dome("d")]}),
            1.0,
        );
        let (memory, summary) = run(&case);
        let column = |name: &str| memory.column(name).unwrap();
        let (volumes, pressures) = (column("accumulator_dome_volume"), column("accumulator_dome_pressure"));
        for ((volume, pressure), energy) in volumes.iter().zip(&pressures).zip(column("accumulator_energy")) {
            let exact = pchip(&VOLUMES, &PRESSURES, *volume);
            assert!(
                (pressure - exact).abs() < 1e-9 * 1e5,
                "{volume}: {pressure} for {exact}"
            );
            let pieces = 4000;
            let width = volume / f64::from(pieces);
            let simpson = |k: i32| {
                let at = |part: f64| pchip(&VOLUMES, &PRESSURES, width * (f64::from(k) + part));
                width / 6.0 * (at(0.0) + 4.0 * at(0.5) + at(1.0))
            };
            let exact: f64 = (0..pieces).map(simpson).sum();
            assert!(
                (energy - exact).abs() < 1e-7 * exact.abs() + 1e-12,
                "{volume}: {energy} for {exact}"
            );
        }
        assert!(volumes.last().unwrap() / supply > 4e-13, "{:?}", volumes.last());
        println!("energy balance: {:e}", summary.balances.energy_residual_relative);
        assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    }
}

/// Goal: under a pressure between its extrema a dome begins with the smallest of three volumes.
#[test]
fn a_dome_begins_on_its_first_branch() {
    let mut vessel = dome("d");
    vessel["start_pressure_pa"] = json!(2e4);
    let held = json!({"junctions": ["d", "p"], "tubes": [tube("d", "p", 1e12)], "ports": [port("p", 2e4)], "accumulators": [vessel]});
    let volume = last(&run(&still(held, 0.1)).0, "accumulator_dome_volume");
    assert!(volume > 0.0 && volume < 3e-8, "{volume}");
    near("pressure", pchip(&VOLUMES, &PRESSURES, volume), 2e4, 1e-9);
}

/// A vessel opens, or shuts, a valve between two ports; `kind` is that of the vessel, which a supply fills.
fn piloted(kind: Value, [closed, open]: [f64; 2]) -> Value {
    let mut valve = tube("a", "b", 1e9);
    valve["pilot"] = json!({"vessel": "dome", "closed_at_m3": closed, "open_at_m3": open});
    still(
        json!({"junctions": ["a", "b", "d", "s"], "tubes": [valve, tube("s", "d", 8e11)],
            "ports": [port("a", 1e4), port("b", 0.0), port("s", 1e5)],
            "accumulators": [{"name": "dome", "at": {"junction": "d"}, "kind": kind}]}),
        1.0,
    )
}

/// Goal: the flow through a valve is its conductance times S of the volume of its vessel: exactly 0 and 1 beyond both volumes, for vessels
/// that open or shut it.
#[test]
fn a_vessel_opens_a_valve() {
    let curve = json!({"curve": {"volume_m3": VOLUMES, "pressure_pa": PRESSURES}});
    for (kind, range) in [
        (curve, [4e-8, 8e-8]),
        (json!({"elastic": {"compliance_m3_pa": 1e-12}}), [5e-8, 2e-8]),
    ] {
        let (memory, summary) = run(&piloted(kind, range));
        let column = |name: &str| memory.column(name).unwrap();
        let (mut shut, mut open) = (0, 0);
        for (volume, flow) in column("accumulator_dome_volume").iter().zip(column("tube_1_flow")) {
            let x = ((volume - range[0]) / (range[1] - range[0])).clamp(0.0, 1.0);
            let part = x * x * x * (x * (6.0 * x - 15.0) + 10.0);
            assert!(
                (flow - 1e-5 * part).abs() < 1e-12 * 1e-5 + 1e-9 * part * 1e-5,
                "{volume}: {flow} for {part}"
            );
            shut += usize::from(flow == 0.0);
            open += usize::from(part == 1.0);
        }
        assert!(shut > 5 && open > 5, "{shut} {open}");
        println!("energy balance: {:e}", summary.balances.energy_residual_relative);
        assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    }
}

/// Goal: the equilibrium under a supply beyond the snap is found through both folds of the load path, on the falling branch, where the valve
/// lets out what enters.
#[test]
fn an_equilibrium_is_found_beyond_folds() {
    let (supply, narrow, wide) = (8e4, 4e9, 2e8);
    let mut valve = tube("d", "r", wide);
    valve["pilot"] = json!({"vessel": "dome", "closed_at_m3": 4e-8, "open_at_m3": 8e-8});
    let case = still(
        json!({"junctions": ["d", "r", "s"], "tubes": [valve, tube("s", "d", narrow)],
            "ports": [port("r", 0.0), port("s", supply)], "accumulators": [dome("d")]}),
        1.0,
    );
    let (mut low, mut high) = (4e-8, 8e-8);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let (p, x) = (pchip(&VOLUMES, &PRESSURES, middle), (middle - 4e-8) / 4e-8);
        let opening = x * x * x * (x * (6.0 * x - 15.0) + 10.0);
        let filled = (supply - p) / narrow - opening * p / wide;
        *(if filled > 0.0 { &mut low } else { &mut high }) = middle;
    }
    let exact = pchip(&VOLUMES, &PRESSURES, low);
    near("pressure", at_rest(&case, "accumulator_dome_pressure"), exact, 1e-9);
}

/// Goal: just below the pressure at which the dome snaps, the equilibrium is that before the snap.
#[test]
fn a_load_just_below_a_fold_does_not_snap() {
    let snap = PRESSURES[2];
    for share in [0.999, 0.9997, 0.99997, 0.999997] {
        let mut valve = tube("d", "r", 2e8);
        valve["pilot"] = json!({"vessel": "dome", "closed_at_m3": 4e-8, "open_at_m3": 8e-8});
        let case = still(
            json!({"junctions": ["d", "r", "s"], "tubes": [valve, tube("s", "d", 4e9)],
                "ports": [port("r", 0.0), port("s", share * snap)], "accumulators": [dome("d")]}),
            1.0,
        );
        near(
            "pressure",
            at_rest(&case, "accumulator_dome_pressure"),
            share * snap,
            1e-9,
        );
    }
}

/// Goal: the Jacobian contains the coupling of valves to vessels for creeping flow, for flow with inertia and losses, for compressed
/// fluid, between bladders, and across components of the network.
#[test]
fn derivatives_contain_the_pilot() {
    let curve = json!({"curve": {"volume_m3": VOLUMES, "pressure_pa": PRESSURES}});
    let soft = json!({"elastic": {"compliance_m3_pa": 1e-12, "volume_m3": 1e-7}});
    let inertia = json!({"tube_inertia": "on", "tube_losses": "on"});
    let gas = json!({"kind": "gas", "density_kg_m3": 1.2, "viscosity_pa_s": 1.8e-5});
    for (kind, range) in [(curve, [-1e-7, 1e-7]), (soft, [1e-7, -1e-7])] {
        let case = piloted(kind.clone(), range);
        agrees(&parse(&case).unwrap(), "creeping");
        let mut fast = case.clone();
        fast["effects"] = inertia.clone();
        agrees(&parse(&fast).unwrap(), "inertia");
        if kind.get("elastic").is_some() {
            for mut gaseous in [case, fast] {
                gaseous["fluid"] = gas.clone();
                agrees(&parse(&gaseous).unwrap(), "gas");
            }
        }
    }
    let between = json!({"bladder": 1, "end": "outlet"});
    let tubes = json!([{"from": between, "to": {"bladder": -1, "end": "inlet"},
        "pilot": {"vessel": "dome", "closed_at_m3": -1e-8, "open_at_m3": 1e-8}}, tube("d", "r", 1e9)]);
    let bladders = json!({
        "name": "between", "preset": "matia-gat-beam", "bladders": {"per_row": 1, "coupling": "reciprocal"},
        "network": {"junctions": ["d", "r"], "tubes": tubes, "ports": [port("r", 0.0)], "accumulators": [dome("d")]},
        "ends": {"root": "clamped", "tip": "free"}, "effects": {"tube_inertia": "off"}, "time": {"end_s": 1.0}
    });
    agrees(&parse(&bladders).unwrap(), "between bladders");
}

/// Goal: every mistake is reported where it is, with what is allowed.
#[test]
fn mistakes_are_reported() {
    let good = json!({"curve": {"volume_m3": VOLUMES, "pressure_pa": PRESSURES}});
    let faults = |change: &dyn Fn(&mut Value)| {
        let mut case = piloted(good.clone(), [4e-8, 8e-8]);
        change(&mut case);
        let Err(Error::Case(error)) = parse(&case) else {
            panic!("accepted: {case}")
        };
        let words = |v: &slcbeam::error::Violation| format!("{} {} {:?} {:?}", v.pointer, v.what, v.allowed, v.nearest);
        error.violations.iter().map(words).collect::<Vec<_>>().join("\n")
    };
    let at = |case: &mut Value, pointer: &str, value: Value| *case.pointer_mut(pointer).unwrap() = value;
    for (pointer, value, part) in [
        (
            "/network/tubes/0/pilot/vessel",
            json!("dom"),
            "\"dom\" is not the name of an accumulator",
        ),
        (
            "/network/tubes/0/pilot/open_at_m3",
            json!(4e-8),
            "another volume than closed_at_m3",
        ),
        (
            "/network/accumulators/0/kind/curve/volume_m3/3",
            json!(1e-9),
            "ascending volumes",
        ),
        (
            "/network/accumulators/0/kind/curve/volume_m3",
            json!([0, 1e-8]),
            "2 volumes for 6 pressures",
        ),
        (
            "/network/accumulators/0/kind/curve/pressure_pa/5",
            json!(1e4),
            "does not rise with volume at the last point",
        ),
        (
            "/network/accumulators/0/kind/curve/pressure_pa/0",
            json!(1e4),
            "does not rise with volume at the first point",
        ),
        (
            "/fluid",
            json!({"kind": "gas", "density_kg_m3": 1.2, "viscosity_pa_s": 1.8e-5}),
            "for a compressible fluid",
        ),
    ] {
        let reported = faults(&|case| at(case, pointer, value.clone()));
        assert!(reported.contains(part), "{pointer}: {reported}");
    }
    assert!(faults(&|case| at(case, "/network/tubes/0/pilot/vessel", json!("dom"))).contains("Some(\"dome\")"));
    let reported = faults(&|case| {
        case["network"]["tubes"][0]["check_valve"] = json!({"cracking_pressure_pa": 0, "forward_conductance_m3_s_pa": 1e-9,
            "reverse_conductance_m3_s_pa": 1e-14, "smoothing_pa": 50});
    });
    assert!(reported.contains("a pilot of a tube with a check valve"), "{reported}");
    let reported = faults(&|case| {
        case["fluid"] = json!({"kind": "gas", "density_kg_m3": 1.2, "viscosity_pa_s": 1.8e-5});
        case["network"]["accumulators"][0]["kind"] = json!({"tank": {"volume_m3": 1e-7}});
    });
    assert!(reported.contains("the rigid tank \"dome\""), "{reported}");
    let reported = faults(&|case| {
        let mut other = elastic("a", 1e-12, 0.0);
        other["name"] = json!("dome");
        case["network"]["accumulators"].as_array_mut().unwrap().push(other);
    });
    assert!(
        reported.contains("\"dome\" is the name of several accumulators"),
        "{reported}"
    );
    // behind the valve alone a junction has no pressure while it is shut
    let reported = faults(&|case| {
        case["network"]["ports"].as_array_mut().unwrap().remove(1);
        case["network"]["accumulators"]
            .as_array_mut()
            .unwrap()
            .push(elastic("a", 1e-12, 0.0));
        case["network"]["ports"].as_array_mut().unwrap().remove(0);
    });
    assert!(
        reported.contains("junction \"b\" reaches no bladder, accumulator or pressure port"),
        "{reported}"
    );
}
