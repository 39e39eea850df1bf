//! Mean powers of small forced motions.

use serde_json::{Value, json};
use slcbeam::discrete::ledger::EnergyRate;
use slcbeam::run::response::LinearResponse;
use slcbeam::run::response::power::MeanPowers;
use slcbeam::run::stop::StopFlag;
use slcbeam::study::refine::numbers;
use slcbeam::study::response::power::powers;

use super::common::checked;

/// The tour's harvester with a load of an amplitude [N/m], undriven for 0.
fn harvester(amplitude: f64, hz: f64) -> Value {
    let text = std::fs::read_to_string("cases/tour-harvester.json").unwrap();
    let mut case: Value = serde_json::from_str(&text).unwrap();
    case["loads"][0]["force_x_n_m"]["signal"] = match amplitude {
        0.0 => json!(0.0),
        _ => json!({"sine": {"amplitude": amplitude, "frequency_hz": hz}}),
    };
    case["effects"] = json!({"unsteady_friction": "off"});
    case["solver"] = json!({"rtol": 1e-8});
    case
}

fn powers_of(case: &Value, input: &str, frequencies: &[f64]) -> Vec<MeanPowers> {
    let outputs = ["tip_u1".to_owned()];
    let response = LinearResponse::new(&checked(case), input, &outputs, None).unwrap();
    powers(&response, frequencies).unwrap()
}

/// Source: [E37], a cycle with a load of a thousandth. Goal: power put in, harvested and lost as in the cycle. Tolerance: 1e-4.
#[test]
fn a_small_cycle_has_the_mean_powers_of_the_response() {
    for hz in [1.0, 12.0] {
        let amplitude = 1e-3;
        let cycle = checked(&harvester(amplitude, hz));
        let found = numbers::of_cycle(&cycle, 1, &StopFlag::default()).unwrap();
        let linear = powers_of(&harvester(0.0, hz), "/loads/0/force_x_n_m/signal", &[hz])[0];
        for (name, linear) in [
            ("input_energy_j.window", linear.input()),
            ("harvested_energy_j.window", linear.power(EnergyRate::Turbines)),
        ] {
            let mean = found[name].value * hz / (amplitude * amplitude);
            println!("{hz} Hz {name}: {mean:.6e} {linear:.6e}");
            assert!(
                (mean / linear - 1.0).abs() < 1e-4,
                "{hz} Hz {name}: {mean} for {linear}"
            );
        }
    }
}

/// Goal: power put in equals that harvested and lost, for every kind of input, and no part of a passive beam gives power. Tolerance:
/// 1e-6 of the largest power, that of derivatives by differences.
#[test]
fn mean_powers_add_up() {
    let frequencies: Vec<f64> = (0..60).map(|k| 2.0 * 100_f64.powf(f64::from(k) / 59.0)).collect();
    let mut shaken = harvester(0.0, 1.0);
    shaken["ends"] = json!({"root": {"clamped": {"u1_m": 0.0}}, "tip": "free"});
    let mut pressed = harvester(0.0, 1.0);
    pressed["network"]["chains"][0]["ends"][1] = json!({"pressure_pa": 0.0});
    for (case, input) in [
        (harvester(0.0, 1.0), "/loads/0/force_x_n_m/signal"),
        (shaken, "/ends/root/clamped/u1_m"),
        (pressed, "/network/chains/0/ends/1/pressure_pa"),
    ] {
        for (hz, powers) in frequencies.iter().zip(powers_of(&case, input, &frequencies)) {
            let residual = powers.residual() / powers.input();
            assert!(residual.abs() < 1e-6, "{input} {hz} Hz: {residual:e} {powers:?}");
            for rate in [
                EnergyRate::Turbines,
                EnergyRate::Bladders,
                EnergyRate::Tubes,
                EnergyRate::Damping,
            ] {
                assert!(
                    powers.power(rate) >= -1e-9 * powers.input(),
                    "{input} {hz} Hz: {powers:?}"
                );
            }
        }
    }
}

/// Goal: quadratic drag, sharp check valves and equilibria with fluid: powers of small motions add up. Tolerance: 3e-3 of the power put
/// in; far below a resonance most of it is returned, and rounding errors remain. They were those of a finite amplitude, up to 80 times
/// the power put in, and refused about equilibria.
#[test]
fn powers_are_those_of_vanishing_amplitude() {
    let shipped = |name: &str| -> Value {
        serde_json::from_str(&std::fs::read_to_string(format!("cases/{name}.json")).unwrap()).unwrap()
    };
    let mut finned = shipped("fin-in-water");
    finned["mesh"] = json!({"segments": 10});
    for (case, input, at, hz) in [
        (finned, "/ends/root/clamped/u1_m", Some(0.0), [0.1, 0.4]),
        (
            shipped("bladder-pump"),
            "/network/ports/0/pressure_pa",
            None,
            [0.5, 5.0],
        ),
        (
            harvester(0.0, 1.0),
            "/loads/0/force_x_n_m/signal",
            Some(0.0),
            [0.5, 5.0],
        ),
    ] {
        let outputs = ["tip_u1".to_owned()];
        let response = LinearResponse::new(&checked(&case), input, &outputs, at).unwrap();
        for (hz, powers) in hz.iter().zip(powers(&response, &hz).unwrap()) {
            let residual = powers.residual() / powers.input();
            assert!(residual.abs() < 3e-3, "{input} {hz} Hz: {residual:e} {powers:?}");
        }
    }
}
