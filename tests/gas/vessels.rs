//! Vessels, valves and pumps of fluid that is compressed, [E64] [E67], on a rig beside a beam whose bladders take no part.

use std::f64::consts::PI;

use serde_json::{Value, json};
use slcbeam::case::schema::Effect;
use slcbeam::discrete::System;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::Summary;

use super::scene::{finished, parse};
use super::{AIR, AMBIENT, gas};

/// Resistance of the rig's tube [Pa s/m^3].
pub const RESISTANCE: f64 = 8.0 * AIR * 0.1 / (PI * 2.56e-14);

/// Junctions "a" and "b", a tube of 0.1 m and 0.4 mm radius between them, creeping flow; changed.
pub fn rig(fluid: Value, network: Value, end: f64) -> Value {
    let mut case = json!({
        "name": "rig", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"}, "fluid": fluid,
        "network": {"junctions": ["a", "b"],
            "tubes": [{"from": {"junction": "a"}, "to": {"junction": "b"}, "length_m": 0.1, "loss_coefficient": 0,
                       "cross_section": {"circle": {"radius_m": 4e-4}}}]},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": {"tube_inertia": "off", "tube_losses": "off"},
        "time": {"end_s": end, "output_interval_s": end / 50.0}, "solver": {"rtol": 1e-9}
    });
    for (key, value) in network.as_object().unwrap() {
        case["network"][key] = value.clone();
    }
    case
}

/// The same as it runs.
fn run(fluid: Value, network: Value, end: f64) -> (Memory, Summary) {
    finished(&rig(fluid, network, end))
}

/// A vessel at "b".
fn at_b(kind: Value, start: f64) -> Value {
    json!([{"name": "b", "at": {"junction": "b"}, "kind": kind, "start_pressure_pa": start}])
}

/// A pressure at "a".
fn held(pressure: Value) -> Value {
    json!([{"name": "a", "at": {"junction": "a"}, "pressure_pa": pressure}])
}

/// Largest difference of a column from what times and it should be, over the largest of that.
fn apart(memory: &Memory, column: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let (times, found) = (memory.column("t").unwrap(), memory.column(column).unwrap());
    let exact: Vec<f64> = times.into_iter().map(exact).collect();
    let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let off = found.iter().zip(&exact).map(|(a, b)| (a - b).abs());
    off.fold(0.0, f64::max) / size
}

/// Source: `V P'/P_0 = -(P^2 - P_0^2)/(2 P_0 R)`, isothermal, whose solution is `(P - P_0)/(P + P_0) ~ exp(-P_0 t/(V R))`. Goal: a tank of air blows
/// down through a capillary so, from four times ambient pressure and from a third of it, and energy closes (1e-5 at rtol 1e-9, where it goes with rtol).
#[test]
fn a_tank_blows_down() {
    let volume = 2e-5;
    for start in [3.0 * AMBIENT, -0.67 * AMBIENT] {
        let network =
            json!({"accumulators": at_b(json!({"tank": {"volume_m3": volume}}), start), "ports": held(json!(0))});
        let (memory, summary) = run(gas(1.0), network, 0.3);
        let share = start / (start + 2.0 * AMBIENT);
        let off = apart(&memory, "accumulator_b_pressure", |t| {
            let share = share * (-AMBIENT * t / (volume * RESISTANCE)).exp();
            2.0 * AMBIENT * share / (1.0 - share)
        });
        let b = &summary.balances;
        println!("{start}: {off:.1e} {:.1e}", b.energy_residual_relative);
        assert!(off < 1e-6, "{off:e}");
        assert!(b.energy_residual_relative.abs() < 1e-5 && b.volume_residual_relative < 1e-11);
    }
}

/// `c'` of a vessel behind the tube, integrated by Runge and Kutta; `flow` by (t, p).
fn filled(times: &[f64], start: f64, pressure: impl Fn(f64) -> f64, flow: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let rate = |t: f64, c: f64| flow(t, pressure(c));
    let (mut c, mut all) = (start, vec![pressure(start)]);
    for pair in times.windows(2) {
        let steps = 400;
        let h = (pair[1] - pair[0]) / f64::from(steps);
        for n in 0..steps {
            let t = pair[0] + f64::from(n) * h;
            let k1 = rate(t, c);
            let k2 = rate(t + 0.5 * h, c + 0.5 * h * k1);
            let k3 = rate(t + 0.5 * h, c + 0.5 * h * k2);
            let k4 = rate(t + h, c + h * k3);
            c += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        all.push(pressure(c));
    }
    all
}

/// `r̄` and D of isothermal gas between two pressures: `r̄² = ((P_a² - P_b²)/(2 P_0))/(P_0 ln(P_a/P_b))`.
fn between(a: f64, b: f64) -> (f64, f64) {
    let [a, b] = [a, b].map(|p| p + AMBIENT);
    if (a / b - 1.0).abs() < 1e-9 {
        return (a / AMBIENT, a - b);
    }
    let (potential, enthalpy) = ((a * a - b * b) / (2.0 * AMBIENT), AMBIENT * (a / b).ln());
    let mean = (potential / enthalpy).sqrt();
    (mean, mean * enthalpy)
}

/// Source: [E64] integrated by itself. Goal: a swinging pressure fills a tank of air through a check valve, and a pump of air fills an elastic
/// vessel against a relief valve, to 1e-6; energy closes.
#[test]
fn valves_and_pumps_work_with_air() {
    let (forward, volume) = (1e-8, 2e-5);
    let valve = |cracking: f64| {
        json!({"cracking_pressure_pa": cracking, "forward_conductance_m3_s_pa": forward,
               "reverse_conductance_m3_s_pa": 1e-14, "smoothing_pa": 500})
    };
    let through = |cracking: f64, drop: f64| {
        // by bisection of x + R q(x) = D, with the law [E7]
        let law = |x: f64| {
            let y = x - cracking;
            let open = if y <= 0.0 {
                0.0
            } else if y < 500.0 {
                y * y / 1000.0
            } else {
                y - 250.0
            };
            1e-14 * x + (forward - 1e-14) * open
        };
        let (mut low, mut high) = (-drop.abs() - 1.0, drop.abs() + 1.0);
        for _ in 0..200 {
            let x = 0.5 * (low + high);
            if x + RESISTANCE * law(x) < drop {
                low = x
            } else {
                high = x
            }
        }
        law(0.5 * (low + high))
    };
    let mut network = json!({"accumulators": at_b(json!({"tank": {"volume_m3": volume}}), 0.0),
        "ports": held(json!({"sine": {"amplitude": 5e4, "frequency_hz": 0.5}}))});
    let mut tubes = rig(gas(1.0), json!({}), 1.0)["network"]["tubes"].clone();
    tubes[0]["check_valve"] = valve(1e3);
    network["tubes"] = tubes.clone();
    let (memory, summary) = run(gas(1.0), network, 8.0);
    let times = memory.column("t").unwrap();
    let exact = filled(
        &times,
        0.0,
        |c| AMBIENT * c / volume,
        |t, p| {
            let (mean, drop) = between(5e4 * (PI * t).sin(), p);
            mean * through(1e3, drop)
        },
    );
    let off = apart(&memory, "accumulator_b_pressure", |t| {
        exact[(t / 0.16).round() as usize]
    });
    println!("valve {off:.1e} {:.1e}", summary.balances.energy_residual_relative);
    assert!(off < 1e-6, "{off:e}");
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6 && exact[50] > 3e4);
    // a pump from the open air into walls that give way, back through a relief valve
    let mut tubes = rig(gas(1.0), json!({}), 1.0)["network"]["tubes"].clone();
    let mut back = tubes[0].clone();
    tubes[0]["pump"] = json!({"pressure_pa": 6e4, "resistance_pa_s_m3": 1e10});
    (back["from"], back["to"]) = (json!({"junction": "b"}), json!({"junction": "a"}));
    back["check_valve"] = valve(2e4);
    tubes.as_array_mut().unwrap().push(back);
    let (soft, holds) = (1e-10, 1e-5);
    let elastic = json!({"elastic": {"compliance_m3_pa": soft, "volume_m3": holds}});
    let network = json!({"accumulators": at_b(elastic, 0.0), "ports": held(json!(0)), "tubes": tubes});
    let (memory, summary) = run(gas(1.0), network, 8.0);
    let times = memory.column("t").unwrap();
    // c = (1 + p/P_0)(V_0 + C p) - V_0
    let pressure = |c: f64| {
        let (a, b) = (soft / AMBIENT, soft + holds / AMBIENT);
        2.0 * c / (b + (b * b + 4.0 * a * c).sqrt())
    };
    let exact = filled(&times, 0.0, pressure, |_, p| {
        let (mean, drop) = between(0.0, p);
        mean * ((drop + 6e4) / (RESISTANCE + 1e10) - through(2e4, -drop))
    });
    let off = apart(&memory, "accumulator_b_pressure", |t| {
        exact[(t / 0.16).round() as usize]
    });
    println!("pump {off:.1e} {:.1e}", summary.balances.energy_residual_relative);
    assert!(off < 1e-6, "{off:e}");
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6 && exact[50] > 2e4);
}

/// Goal: what cannot be is refused where it stands: a tank of what is not compressed, an elastic vessel of gas that holds none at rest.
#[test]
fn vessels_that_cannot_be_are_refused() {
    let refused = |fluid: Value, kind: Value| {
        let case = rig(
            fluid,
            json!({"accumulators": at_b(kind, 0.0), "ports": held(json!(0))}),
            1.0,
        );
        let text = serde_json::to_string_pretty(&case).unwrap();
        let found = slcbeam::case::parse(&text, std::path::Path::new("mine.json"), std::path::Path::new(""), &[]);
        match found {
            Err(slcbeam::error::Error::Case(told)) => format!("{:?}", told.violations),
            other => other.map(|_| String::new()).unwrap(),
        }
    };
    let water = || json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3});
    let told = refused(water(), json!({"tank": {"volume_m3": 1e-5}}));
    assert!(
        told.contains("/network/accumulators/0/kind/tank") && told.contains("stores nothing"),
        "{told}"
    );
    let told = refused(gas(1.0), json!({"elastic": {"compliance_m3_pa": 1e-11}}));
    assert!(
        told.contains("/network/accumulators/0/kind/elastic") && told.contains("volume_m3"),
        "{told}"
    );
    assert_eq!(refused(gas(1.0), json!({"tank": {"volume_m3": 1e-5}})), "");
    // a liquid too stiff to matter, by itself, and left out by name
    let stiff = json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3, "bulk_modulus_pa": 1e12});
    let tank = json!({"accumulators": at_b(json!({"tank": {"volume_m3": 1e-5}}), 0.0), "ports": held(json!(0))});
    let mut case = rig(stiff, tank, 1.0);
    let has = |case: &Value| System::new(&parse(case)).map(|system| system.model.effects.has(Effect::Compressibility));
    assert!(has(&case).unwrap());
    case["effects"]["compressibility"] = json!("off");
    let told = has(&case).unwrap_err().to_string();
    assert!(told.contains("1 fault"), "{told}");
}

/// Goal: vessels that hold nothing at rest begin at the pressure that is given, of a liquid with gas in it and of gas; and where more is drawn than there is,
/// from a vessel or by a port, the run ends and says so. Before, they began in a vacuum, or went on beyond it without a word.
#[test]
fn empty_vessels_begin_as_given_and_emptied_ones_end_a_run() {
    let foam = json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3, "gas_fraction": 0.01});
    let cushion = json!({"gas": {"volume_m3": 2e-6}});
    for (fluid, kind) in [
        (foam.clone(), json!({"elastic": {"compliance_m3_pa": 1e-11}})),
        (foam, cushion.clone()),
        (gas(1.0), cushion),
    ] {
        let network = json!({"accumulators": at_b(kind, 0.0),
            "ports": held(json!({"ramp": {"to": 1e3, "duration_s": 0.1, "shape": "smooth"}}))});
        let (memory, summary) = run(fluid, network, 1.0);
        let pressures = memory.column("accumulator_b_pressure").unwrap();
        assert!(
            pressures[0].abs() < 1e-6 && pressures.iter().all(|p| (-1e-3..=1e3 + 1e-3).contains(p)),
            "{pressures:?}"
        );
        assert!(summary.balances.energy_residual_relative.abs() < 1e-5);
    }
    let drawn = json!({"ports": [{"name": "pump", "at": {"junction": "b"}, "flow_m3_s": {"ramp": {"to": -1e-6, "duration_s": 0.5}}},
        {"name": "a", "at": {"junction": "a"}, "pressure_pa": 0}]});
    let emptied = json!({"accumulators": at_b(json!({"tank": {"volume_m3": 1e-6}}), 0.0),
        "ports": [{"name": "pump", "at": {"junction": "b"}, "flow_m3_s": {"ramp": {"to": -1e-3, "duration_s": 0.5}}},
                  {"name": "a", "at": {"junction": "a"}, "pressure_pa": 0}]});
    let ends = |network: &Value, end: f64| {
        let case = parse(&rig(gas(1.0), network.clone(), end));
        slcbeam::run::dynamics::run(&case, &mut Memory::default())
            .unwrap()
            .summary
    };
    assert_eq!(ends(&drawn, 0.5).reason, None);
    let told = ends(&emptied, 0.5).reason.unwrap();
    assert!(told.contains("evacuated"), "{told}");
    let more = drawn
        .to_string()
        .replace("-1e-6", "-1e-3")
        .replace("-0.000001", "-0.001");
    let told = ends(&serde_json::from_str(&more).unwrap(), 0.5).reason.unwrap();
    assert!(told.contains("evacuated"), "{told}");
}
