//! Stepwise simulation: energies over jumps of valves, limits of the model, switches of the case.

use std::path::Path;

use slcbeam::case::{self, Case};
use slcbeam::error::Error;
use slcbeam::run::dynamics::simulator::{Simulator, SimulatorInput, Snapshot};
use slcbeam::run::record::Control;

const INLET: &str = "/network/chains/0/ends/0/pressure_pa";
const CHAIN: &str = "/network/chains/0/opening";

fn load(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    case::load(Path::new(&format!("cases/{name}.json")), &sets).unwrap()
}

fn simulator(case: &Case, pointer: &str, range: [f64; 2]) -> Simulator {
    let pointer = pointer.to_string();
    Simulator::new(case, &[SimulatorInput { pointer, range }]).unwrap()
}

fn step(sim: &mut Simulator, until: f64, value: f64) {
    go(sim, until, &[value]).unwrap_or_else(|error| panic!("{error}"));
}

fn go(sim: &mut Simulator, until: f64, values: &[f64]) -> Result<(), Error> {
    sim.step(until, values, &mut || Control::Continue)
}

fn value(sim: &Simulator, name: &str) -> f64 {
    let place = sim.columns().iter().position(|column| column.name == name);
    sim.row()[place.expect("a column of the row")]
}

/// Goal: a valve that closes, abruptly or nearly, dissipates the kinetic energy of the fluid in its tube. The loss falls with the closing
/// time of the flow, at any tolerance. Tolerance: the balance is as open as steps of a rising pressure leave it.
#[test]
fn valves_that_shut_lose_no_energy_that_is_not_there() {
    let ramp = format!("{INLET}={{\"ramp\": {{\"to\": 2e4, \"duration_s\": 0.2}}}}");
    for (rtol, open) in [("1e-4", 4e-7), ("1e-5", 4e-8), ("1e-6", 4e-9), ("1e-7", 1e-9)] {
        let rtol = format!("/solver/rtol={rtol}");
        let case = load(
            "tour-actuator",
            &[&rtol, &ramp, "/time/end_s=0.4", "/solver/method=\"esdirk46\""],
        );
        for at in [0.03, 0.05] {
            let mut sim = simulator(&case, CHAIN, [0.0, 1.0]);
            step(&mut sim, at, 1.0);
            let begin = sim.save().unwrap();
            for opening in [0.0, 1e-6, 1e-4, 1.0] {
                sim.restore(&begin).unwrap();
                step(&mut sim, at + 0.01, opening);
                let residual = value(&sim, "energy_residual").abs();
                assert!(residual < open, "{rtol}, {opening} at {at} s: {residual:e} J");
            }
        }
    }
}

/// Goal: valves may close at any time and repeatedly, with check valves and turbines, too; the balance closes to a part of the input.
#[test]
fn valves_that_go_to_and_fro_are_followed() {
    let tank = "/network/tubes/0/opening";
    for (name, pointer, step_s, count) in [
        ("tour-actuator", CHAIN, 0.01, 12),
        ("tour-harvester", CHAIN, 0.05, 8),
        ("tank-finger", tank, 0.05, 8),
    ] {
        let mut sim = simulator(&load(name, &["/mesh/cells_per_segment=1"]), pointer, [0.0, 1.0]);
        let first = sim.values().next().unwrap();
        let mut most: f64 = 0.0;
        for k in 0..count {
            let opening = [first, 0.0, 1.0, 1e-6][k % 4];
            step(&mut sim, step_s * (k + 1) as f64, opening);
            let stored = ["kinetic_energy", "bending_energy", "bladder_energy", "tube_energy"];
            most = most.max(stored.iter().map(|one| value(&sim, one)).sum());
        }
        let residual = value(&sim, "energy_residual").abs();
        assert!(residual < 2e-3 * most, "{name}: {residual:e} J of {most:e}");
        assert!(
            !sim.warnings()
                .iter()
                .any(|told| told.starts_with("W008") || told.starts_with("W019"))
        );
    }
}

/// Goal: a moment that jumps repeatedly does the work of its mean on a beam without delay; the two sides of the jump are not confused.
/// Tolerance: the ledger is exact for linear motion; rotations of a sixth of a radian are not quite linear.
#[test]
fn work_of_jumps_is_taken_from_both_sides() {
    let case = load(
        "roll-up",
        &[
            "/effects={\"solid_inertia\": \"off\"}",
            "/beam/damping={}",
            "/ends/tip/free/moment_n_m=0",
        ],
    );
    let mut sim = simulator(&case, "/ends/tip/free/moment_n_m", [0.0, 1.0]);
    let mut most: f64 = 0.0;
    for (k, moment) in [0.02, 0.08, 0.04, 0.0, 0.06].into_iter().enumerate() {
        step(&mut sim, 0.1 * (k + 1) as f64, moment);
        let [work, residual] = ["work_ends", "energy_residual"].map(|one| value(&sim, one));
        most = most.max(work);
        assert!(residual.abs() < 1e-2 * most, "{moment}: {residual:e} J of {most:e}");
    }
}

/// Goal: the limit of the model is located within a step, independent of the requested durations, and the row is that of the limit.
#[test]
fn the_end_of_the_model_is_found_within_steps() {
    let case = load("hard/closing-bladder", &[]);
    let mut ends = vec![];
    for length in [1.0, 0.01, 0.002] {
        let mut sim = Simulator::new(&case, &[]).unwrap();
        let end = sim.end();
        let ended = (1..).find_map(|k| go(&mut sim, (length * f64::from(k)).min(end), &[]).err());
        let told = ended.map(|error| error.to_string()).unwrap_or_default();
        assert!(told.contains("a bladder is closed"), "{told}");
        assert_eq!(sim.row()[0], sim.time());
        // the simulation remains there
        let beyond = sim.time() + 1e-3;
        assert!(go(&mut sim, beyond, &[]).is_err());
        ends.push(sim.time());
    }
    let apart = ends.iter().map(|t| (t - ends[0]).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-4 * ends[0], "{ends:?}");
}

/// Goal: a row at an instant at which the case itself switches is that before the switch, as in a history; inputs set there take part in
/// the switch.
#[test]
fn rows_at_switches_are_those_before() {
    let jump = format!("{INLET}={{\"ramp\": {{\"to\": 2e4, \"start_s\": 0.05, \"duration_s\": 0}}}}");
    let case = load("tour-actuator", &[&jump, "/time/end_s=0.1"]);
    for shut in [1.0, 0.0] {
        let mut sim = simulator(&case, CHAIN, [0.0, 1.0]);
        // five times 0.01 s is 0.05 s except for rounding errors
        let mut t = 0.0;
        for _ in 0..5 {
            t += 0.01;
            step(&mut sim, t, 1.0);
        }
        assert_eq!(sim.time(), 0.05);
        assert_eq!(value(&sim, "port_inlet_of_bladder__1_pressure"), 0.0);
        assert!(value(&sim, "port_inlet_of_bladder__1_flow").abs() < 1e-15);
        let saved = sim.save().unwrap();
        step(&mut sim, 0.06, shut);
        assert_eq!(value(&sim, "port_inlet_of_bladder__1_pressure"), 2e4);
        assert!(value(&sim, "port_inlet_of_bladder__1_volume") > 1e-9);
        let row = sim.row().to_vec();
        let bytes = serde_json::to_string(&saved).unwrap();
        let saved: Snapshot = serde_json::from_str(&bytes).unwrap();
        let mut other = simulator(&case, CHAIN, [0.0, 1.0]);
        other.restore(&saved).unwrap();
        step(&mut other, 0.06, shut);
        assert_eq!(row, other.row());
    }
}

/// Goal: the mesh is judged by the past inputs, not by the possible duration of the case.
#[test]
fn the_mesh_is_judged_by_what_inputs_did() {
    let told = |end: &str, period: f64, values: [f64; 2]| {
        let case = load("tour-actuator", &[end, &format!("{INLET}=2e4")]);
        let mut sim = simulator(&case, INLET, [0.0, 6e4]);
        for k in 0..6 {
            step(&mut sim, period * (k + 1) as f64, values[k % 2]);
        }
        sim.warnings().iter().any(|told| told.starts_with("W016"))
    };
    for end in ["/time/end_s=0.05", "/time/end_s=100"] {
        assert!(!told(end, 5e-3, [2e4, 2e4]), "{end}");
        assert!(told(end, 5e-3, [0.0, 6e4]), "{end}");
    }
}

/// Goal: an invalid range has its own message.
#[test]
fn ranges_are_refused_in_their_own_words() {
    let case = load("tour-actuator", &[]);
    for (pointer, range, what) in [
        (INLET, [0.0, f64::INFINITY], "finite"),
        (INLET, [0.0, 0.0], "must increase"),
        (INLET, [1.0, 2.0], "must contain the initial value"),
        (CHAIN, [0.0, 2.0], "its range, 0 to 2, is not allowed"),
    ] {
        let pointer = pointer.to_string();
        let error = Simulator::new(&case, &[SimulatorInput { pointer, range }])
            .err()
            .unwrap()
            .to_string();
        assert!(error.contains(what) && !error.contains("table"), "{error}");
    }
}

/// Goal: a state is restored exactly from its bytes; all of 300 bit flips and truncations are rejected.
#[test]
fn a_state_that_was_changed_is_refused() {
    let case = load("tour-actuator", &["/time/end_s=0.4", "/solver/method=\"esdirk46\""]);
    let mut sim = simulator(&case, CHAIN, [0.0, 1.0]);
    step(&mut sim, 0.01, 1.0);
    let state = sim.save().unwrap();
    let bytes = state.to_bytes().unwrap();
    assert!(Snapshot::from_bytes(&bytes).unwrap() == state);
    for k in 0..300 {
        let at = k * (bytes.len() - 1) / 299;
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << (k % 8);
        assert!(Snapshot::from_bytes(&flipped).is_err(), "bit {} of byte {at}", k % 8);
        assert!(Snapshot::from_bytes(&bytes[..at]).is_err(), "{at} bytes");
    }
}
