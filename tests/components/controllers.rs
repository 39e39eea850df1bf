//! Controllers: their laws [E109], [E110] and [E111] against exact recursions, and their part in runs and analyses.

use std::path::Path;

use slcbeam::case;
use slcbeam::discrete::System;
use slcbeam::run::dynamics::simulator::{Simulator, SimulatorInput};
use slcbeam::run::dynamics::{self, Outcome};
use slcbeam::run::record::{Control, Memory};

use super::valves::{fluid, resistance};
use super::{RIG, apart, read, run};

/// Compliance of the vessel [m^3/Pa].
const COMPLIANCE: f64 = 4e-11;
const VESSEL: &str = r#"/network/accumulators=[{"name": "vessel", "at": {"junction": "b"}, "kind": {"elastic": {"compliance_m3_pa": 4e-11}}}]"#;
const EIGHT_SECONDS: &str = r#"/time={"end_s": 8, "output_interval_s": 0.05}"#;

/// A port whose pressure a controller sets; `more` replaces some of its keys.
fn port(law: &str, more: &str) -> String {
    format!(
        r#"/network/ports=[{{"name": "supply", "at": {{"junction": "a"}}, "pressure_pa": {{"controller": {{"name": "regulator",
            "measures": "accumulator_vessel_pressure_pa", "setpoint": 1000, "sample_interval_s": 0.25, "law": {law}{more}}}}}}}]"#
    )
}

const PI: &str = r#"{"pi": {"gain": 1.5, "integral_time_s": 1.2, "lowest": 0, "highest": 1200}}"#;

/// Time constant of tube and vessel [s].
fn time_constant() -> f64 {
    resistance(fluid().1) * COMPLIANCE
}

/// Pressures of the vessel at the samples: between them `p = u + (p_k - u) e^(-t/RC)` exactly.
fn sampled(interval: f64, count: usize, mut law: impl FnMut(usize, f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let (mut pressures, mut outputs) = (vec![0.0], vec![]);
    let decay = (-interval / time_constant()).exp();
    for k in 0..count {
        let output = law(k, pressures[k]);
        pressures.push(output + (pressures[k] - output) * decay);
        outputs.push(output);
    }
    (pressures, outputs)
}

/// Every n-th value of a column, from the first.
fn every(memory: &Memory, column: &str, n: usize) -> Vec<f64> {
    memory.column(column).unwrap().into_iter().step_by(n).collect()
}

/// [E109] PI law on a tube and a vessel, which is saturated at first. Source: the recursion of the sampled system, exact between samples.
/// Goal: 1e-6 of pressures and outputs; the ledger of the run closes. Without conditional integration the pressure overshoots: the
/// difference is large.
#[test]
fn a_sampled_pi_law_follows_its_recursion() {
    let (memory, summary) = run(RIG, &[&port(PI, ""), VESSEL, EIGHT_SECONDS]);
    let law = |winds_up: bool| {
        let mut sum = 0.0;
        move |_: usize, measured: f64| {
            let error = 1000.0 - measured;
            let wanted: f64 = 1.5 * (error + sum);
            if winds_up || (0.0..=1200.0).contains(&wanted) || (wanted > 0.0) != (error > 0.0) {
                sum += 0.25 / 1.2 * error;
            }
            wanted.clamp(0.0, 1200.0)
        }
    };
    let (pressures, outputs) = sampled(0.25, 32, law(false));
    let ours = every(&memory, "accumulator_vessel_pressure", 5);
    assert!(apart(&ours, &pressures) < 1e-6, "{:e}", apart(&ours, &pressures));
    assert!(apart(&ours, &sampled(0.25, 32, law(true)).0) > 0.01);
    // the row at a sample has the output before it
    let held = memory.column("controller_regulator_output").unwrap();
    let held: Vec<f64> = held.into_iter().skip(1).step_by(5).collect();
    assert!(apart(&held, &outputs) < 1e-6);
    assert_eq!(outputs[..2], [1200.0, 0.0]);
    let figures = &summary.ports["controller_regulator_output_pa"];
    assert_eq!(figures.max_abs, Some(1200.0));
    assert!((figures.last.unwrap() - outputs[31]).abs() < 1e-6 * 1200.0);
    assert!(summary.balances.energy_residual_relative.abs() < 1e-5);
}

/// [E110] A relay with hysteresis on the same vessel. Sources: the recursion, and the period of a relay without delay,
/// `RC ln((u - a)/(u - b)) + RC ln(b/a)` between the ends a and b of its band. Goals: 1e-6 of the pressures; the period longer by at most
/// two samples.
#[test]
fn a_relay_swings_with_the_period_of_its_band() {
    let law = r#"{"relay": {"output_below": 2000, "output_above": 0, "hysteresis": 400}}"#;
    let interval = 0.01;
    let (memory, summary) = run(
        RIG,
        &[
            &port(law, ""),
            VESSEL,
            r#"/time={"end_s": 4, "output_interval_s": 0.01}"#,
            "/network/ports/0/pressure_pa/controller/sample_interval_s=0.01",
        ],
    );
    let mut last = 0.0;
    let (pressures, outputs) = sampled(interval, 400, |_, measured| {
        last = match 1000.0 - measured {
            error if error > 200.0 => 2000.0,
            error if error < -200.0 => 0.0,
            _ => last,
        };
        last
    });
    let ours = every(&memory, "accumulator_vessel_pressure", 1);
    assert!(apart(&ours, &pressures) < 1e-6, "{:e}", apart(&ours, &pressures));
    let switched: Vec<usize> = (1..outputs.len()).filter(|k| outputs[*k] > outputs[k - 1]).collect();
    let period = (switched[switched.len() - 1] - switched[0]) as f64 * interval / (switched.len() - 1) as f64;
    let exact = time_constant() * ((1200.0_f64 / 800.0).ln() + (1200.0_f64 / 800.0).ln());
    assert!(
        switched.len() > 3 && (exact..exact + 2.0 * interval).contains(&period),
        "{period} {exact}"
    );
    assert!(summary.balances.energy_residual_relative.abs() < 1e-5);
}

/// [E111] A ramp from sample to sample drives a port of prescribed volume, which must not jump. Goals: the volume is the sum of the ramps
/// to round-off, and the ledger closes; a step is refused.
#[test]
fn a_ramp_moves_a_volume_without_jumps() {
    let volume = |hold: &str| {
        format!(
            r#"/network/ports=[{{"name": "syringe", "at": {{"junction": "a"}}, "volume_m3": {{"controller": {{"name": "regulator",
                "measures": "accumulator_vessel_pressure", "setpoint": 1000, "sample_interval_s": 0.25, {hold}
                "law": {{"pi": {{"gain": 1e-11, "integral_time_s": 0.5, "lowest": 0, "highest": 1e-7}}}}}}}}}}]"#
        )
    };
    let (memory, summary) = run(RIG, &[&volume(r#""hold": "ramp","#), VESSEL, EIGHT_SECONDS]);
    let output = memory.column("controller_regulator_output").unwrap();
    let moved = memory.column("port_syringe_volume").unwrap();
    assert!(apart(&moved, &output) < 1e-12, "{:e}", apart(&moved, &output));
    assert!(output[160] > 3e-8);
    // a straight line within each interval
    for part in output.windows(6).step_by(5) {
        assert!((part[3] - part[0] - 0.6 * (part[5] - part[0])).abs() < 1e-14);
    }
    let pressure = memory.column("accumulator_vessel_pressure").unwrap();
    assert!((950.0..1000.0).contains(&pressure[160]), "{}", pressure[160]);
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
    let error = refused(&[&volume(""), VESSEL]);
    assert!(
        error.contains("this input must not jump") && error.contains(r#"\"hold\": \"ramp\""#),
        "{error}"
    );
}

/// A setpoint that jumps at a sample counts from that sample on; between samples it does not. Goal: outputs of a proportional law by hand.
#[test]
fn setpoints_are_read_at_samples() {
    let law = r#"{"pi": {"gain": 2, "lowest": -1e4, "highest": 1e4}}"#;
    let setpoint = r#"/network/ports/0/pressure_pa/controller/setpoint={"table": {"times_s": [0, 0.5, 0.5, 0.6, 0.6, 1],
        "values": [0, 0, 300, 300, 500, 500], "interpolation": "linear"}}"#;
    let (memory, _) = run(RIG, &[&port(law, ""), VESSEL, setpoint]);
    let output = memory.column("controller_regulator_output").unwrap();
    let pressure = memory.column("accumulator_vessel_pressure").unwrap();
    assert_eq!(output[..=50], [0.0; 51]);
    assert_eq!(output[51..=75], [600.0; 25]);
    assert!((output[76] - 2.0 * (500.0 - pressure[75])).abs() < 1e-6);
    let setpoints = memory.column("controller_regulator_setpoint").unwrap();
    assert_eq!([setpoints[49], setpoints[55], setpoints[70]], [0.0, 300.0, 500.0]);
}

/// A run that resumes from checkpoints at and between samples repeats the uninterrupted one bit for bit, with steps and ramps.
#[test]
fn resumed_runs_with_controllers_repeat_uninterrupted_ones() {
    for more in ["", r#", "hold": "ramp""#] {
        let time = r#"/time={"end_s": 3, "output_interval_s": 0.05, "checkpoint_interval_s": 0.4}"#;
        let case = read(RIG, &[&port(PI, more), VESSEL, time]);
        let mut whole = Memory::default();
        let uninterrupted = dynamics::run(&case, &mut whole).unwrap().summary;
        for checkpoint in &whole.checkpoints {
            let mut rest = Memory::default();
            let system = System::new(&case).unwrap();
            let resumed = dynamics::resume(&case, system, checkpoint, &mut rest).unwrap().summary;
            assert_eq!(
                rest.rows[..],
                whole.rows[whole.rows.len() - rest.rows.len()..],
                "t = {}",
                checkpoint.t
            );
            assert_eq!(resumed.ports, uninterrupted.ports);
        }
        assert_eq!(whole.checkpoints.len(), 7);
    }
}

/// The simulator takes the same samples as a run, also from a saved state. Goal: 1e-6 of the pressures; bit for bit after a restore.
#[test]
fn the_simulator_takes_the_samples_of_the_case() {
    let sets = [&port(PI, ""), VESSEL, EIGHT_SECONDS];
    let (memory, _) = run(RIG, &sets);
    let case = read(RIG, &sets);
    let mut sim = Simulator::new(&case, &[]).unwrap();
    let column = sim
        .columns()
        .iter()
        .position(|one| one.name == "accumulator_vessel_pressure")
        .unwrap();
    let to = |sim: &mut Simulator, t: f64| {
        sim.step(t, &[], &mut || Control::Continue).unwrap();
        sim.row().to_vec()
    };
    let mut ours = vec![sim.row()[column]];
    // steps of its own, between samples and across them
    for k in 1..=20 {
        ours.push(to(&mut sim, 0.4 * f64::from(k))[column]);
    }
    let exact = every(&memory, "accumulator_vessel_pressure", 8);
    assert!(apart(&ours, &exact) < 1e-6, "{:e}", apart(&ours, &exact));
    let mut sim = Simulator::new(&case, &[]).unwrap();
    to(&mut sim, 0.9);
    let saved = sim.save().unwrap();
    let rest = to(&mut sim, 2.3);
    sim.restore(&saved).unwrap();
    assert_eq!(to(&mut sim, 2.3), rest);
    let pointer = "/network/ports/0/pressure_pa".to_owned();
    let range = [0.0, 1200.0];
    let error = Simulator::new(&case, &[SimulatorInput { pointer, range }])
        .err()
        .unwrap();
    assert!(
        error.to_string().contains("a controller of the case sets it"),
        "{error}"
    );
}

/// Two inputs with the same controller share its output: of two valves side by side, both close at once.
#[test]
fn inputs_share_a_controller() {
    let tube = r#"{"from": {"junction": "a"}, "to": {"junction": "b"}, "length_m": 0.2, "cross_section": {"circle": {"radius_m": 1e-3}},
        "loss_coefficient": 0, "opening": {"controller": {"name": "gate", "measures": "accumulator_vessel_pressure", "setpoint": 500,
        "sample_interval_s": 0.05, "law": {"relay": {"output_below": 1, "output_above": 0}}, "start": 1}}}"#;
    let network = format!(
        r#"/network={{"junctions": ["a", "b"], "tubes": [{tube}, {tube}],
            "ports": [{{"name": "supply", "at": {{"junction": "a"}}, "pressure_pa": 2000}}],
            "accumulators": [{{"name": "vessel", "at": {{"junction": "b"}}, "kind": {{"elastic": {{"compliance_m3_pa": 4e-11}}}}}}]}}"#
    );
    let (memory, summary) = run(RIG, &[&network]);
    let (pressure, output) = (
        memory.column("accumulator_vessel_pressure").unwrap(),
        memory.column("controller_gate_output").unwrap(),
    );
    // open until the first sample above 500 Pa
    let rise = |t: f64| 2000.0 * (1.0 - (-t / time_constant()).exp());
    let closed = (0..20).map(|k| 0.05 * f64::from(k)).find(|t| rise(*t) > 500.0).unwrap();
    assert_eq!((output[1], output[100]), (1.0, 0.0));
    assert!(
        (pressure[100] / rise(closed) - 1.0).abs() < 1e-4,
        "{} {}",
        pressure[100],
        rise(closed)
    );
    assert!(summary.balances.energy_residual_relative.abs() < 1e-4);
    let other = "/network/tubes/1/opening/controller/setpoint=400";
    let error = refused(&[&network, other]);
    assert!(error.contains(r#"another controller has the name \"gate\""#), "{error}");
}

/// The message that refuses a case, or its system.
fn refused(sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|one| (*one).to_owned()).collect();
    let error =
        case::parse(RIG, Path::new("mine.json"), Path::new(""), &sets).and_then(|case| System::new(&case).map(|_| ()));
    format!("{:?}", error.unwrap_err())
}

/// Every mistake has a message with its place and a remedy.
#[test]
fn mistakes_are_refused() {
    let at = "/network/ports/0/pressure_pa/controller";
    for (key, value, expected) in [
        (
            "measures",
            r#""accumulator_vesel_pressure""#,
            r#"nearest is \"accumulator_vessel_pressure\""#,
        ),
        ("measures", r#""t""#, "records no quantity"),
        ("measures", r#""controller_regulator_setpoint""#, "records no quantity"),
        ("sample_interval_s", "1e-12", "samples in a run of 8 s"),
        ("sample_interval_s", "9", "longer than the run"),
        ("sample_interval_s", "0", "0 is out of range"),
        ("name", r#""left regulator""#, "cannot begin the name of a column"),
        ("start", "1300", "not between the limits of the law"),
        ("law/pi/lowest", "1200", "is not below the highest"),
        (
            "law",
            r#"{"relay": {"output_below": 3, "output_above": 3}}"#,
            "both outputs of the relay are 3",
        ),
        (
            "law",
            r#"{"relay": {"output_below": 3, "output_above": 4}}"#,
            "none of the relay",
        ),
        (
            "law",
            r#"{"relay": {"output_below": 3, "output_above": 0, "hysteresis": -1}}"#,
            "hysteresis",
        ),
        (
            "setpoint",
            r#"{"polynomial": {"coefficients": [1e300, 1e308, 1e308]}}"#,
            "not a finite number",
        ),
        (
            "setpoint",
            r#"{"table": {"times_s": [1, 0], "values": [1, 2]}}"#,
            "ascending order",
        ),
    ] {
        let change = format!("{at}/{key}={value}");
        let message = refused(&[&port(PI, ""), VESSEL, EIGHT_SECONDS, &change]);
        assert!(message.contains(expected), "{change}: {message}");
        assert!(message.contains(at), "{change}: {message}");
    }
    let nested = port(PI, "").replace("\"setpoint\": 1000", &format!("\"setpoint\": {}", inner()));
    assert!(refused(&[&nested, VESSEL]).contains("a controller in the setpoint of a controller"));
    let open = port(PI, "").replace("\"pressure_pa\": {", "\"opening\": {");
    assert!(refused(&[&open, VESSEL]).contains("opening"));
    let valve = format!("/network/tubes/0/opening={}", inner());
    assert!(refused(&[&port(PI, ""), VESSEL, &valve]).contains("0 (closed) to 1 (open)"));
}

/// Two controllers of one input are tested at all combinations of their limits: -1 times 1 is no opening.
#[test]
fn limits_of_controllers_are_combined() {
    let one = |name: &str| {
        inner()
            .replace("inner", name)
            .replace("1.5", "1")
            .replace(r#""lowest": 0"#, r#""lowest": -1"#)
    };
    let product = format!(
        r#"/network/tubes/0/opening={{"product": [{}, {}]}}"#,
        one("c"),
        one("d")
    );
    assert!(refused(&[&port(PI, ""), VESSEL, &product]).contains("0 (closed) to 1 (open)"));
}

/// Rows at samples have the output before them also where multiples of the two intervals differ by rounding (11 times 0.03, 66 times
/// 0.005). Goal: the output changes behind such a row only.
#[test]
fn rows_at_samples_precede_them() {
    let quick = port(PI, "").replace("0.25", "0.03");
    let (memory, _) = run(
        RIG,
        &[&quick, VESSEL, r#"/time={"end_s": 1.2, "output_interval_s": 0.005}"#],
    );
    let output = memory.column("controller_regulator_output").unwrap();
    for k in (6..output.len() - 1).step_by(6) {
        assert_eq!(output[k], output[k - 1], "row {k}");
    }
    assert!((6..output.len() - 1).step_by(6).any(|k| output[k + 1] != output[k]));
}

fn inner() -> &'static str {
    r#"{"controller": {"name": "inner", "measures": "tip_u1", "setpoint": 0, "sample_interval_s": 0.1,
        "law": {"pi": {"gain": 1, "lowest": 0, "highest": 1.5}}}}"#
}

/// A controller that measures its own output is reported; derivatives of its run are refused.
#[test]
fn a_controller_that_measures_its_own_output_is_reported() {
    let own = "/network/ports/0/pressure_pa/controller/measures=\"port_supply_pressure_pa\"";
    let (_, summary) = run(RIG, &[&port(PI, ""), VESSEL, EIGHT_SECONDS, own]);
    assert!(
        summary
            .warnings
            .iter()
            .any(|one| one.starts_with("W044") && one.contains("its own output"))
    );
    let (_, summary) = run(RIG, &[&port(PI, ""), VESSEL, EIGHT_SECONDS]);
    assert!(!summary.warnings.iter().any(|one| one.starts_with("W044")));
    let case = read(RIG, &[&port(PI, ""), VESSEL]);
    let by = slcbeam::case::parameter::Parameter::all(&case, &["/fluid/viscosity_pa_s".to_owned()]).unwrap();
    let refused = dynamics::run_with(&case, System::new(&case).unwrap(), &by, &mut Memory::default());
    let refused = refused
        .map(|Outcome { summary, .. }| summary.status)
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("regulator") && refused.contains("sweep --vary"),
        "{refused}"
    );
}
