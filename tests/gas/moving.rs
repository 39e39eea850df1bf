//! Fluid that is compressed and has inertia, [E65] [E66].

use std::f64::consts::{PI, TAU};

use serde_json::{Value, json};
use slcbeam::dae::{BeamDae, Dae};
use slcbeam::discrete::System;
use slcbeam::run::equilibrium::{self, EquilibriumOptions};
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::record::Control;

use super::differences::worst_difference;
use super::scene::{finished, parse};
use super::vessels::{RESISTANCE, rig};
use super::{AMBIENT, actuator, becomes_incompressible, gas};

const RADIUS: f64 = 4e-4;

/// `4/3 ρ_0 l/A` of the rig's tube.
fn inertance() -> f64 {
    4.0 / 3.0 * 1.2 * 0.1 / (PI * RADIUS * RADIUS)
}

fn tank(at: &str, volume: f64, start: f64) -> Value {
    json!({"name": at, "at": {"junction": at}, "kind": {"tank": {"volume_m3": volume}}, "start_pressure_pa": start})
}

const PLAIN: [&str; 3] = ["on", "off", "off"];

pub fn effects([inertia, memory, losses]: [&str; 3]) -> Value {
    json!({"tube_inertia": inertia, "unsteady_friction": memory, "tube_losses": losses})
}

/// The mode of a rig that is damped, nearest a frequency: nothing damps the beam beside it.
fn mode(case: &Value, near_hz: f64) -> (f64, f64) {
    let plan = ModeOptions {
        count: 4,
        near_hz,
        limits: false,
    };
    let found = modes::modes(&parse(case), &plan).unwrap().modes;
    let off = |im: f64| (im.abs() / TAU - near_hz).abs();
    let damped = found.iter().map(|mode| mode.s).filter(|s| -s.re > 1e-3 * s.im.abs());
    let s = damped.min_by(|a, b| off(a.im).total_cmp(&off(b.im))).unwrap();
    (s.im.abs(), -s.re)
}

/// Source: Helmholtz; with friction `ω² = (1/C_a + 1/C_b)/I - δ²`, `δ = R/(2 I r)`, `C = V r/(n P)` of a tank at P, since I, q and C are counted at
/// ambient density: in them the pressure of the rest stands in the stiffness of gas, and in its viscous drag. Goal: air between two tanks, at ambient
/// pressure and at four times that, and between a tank and the open air, has that mode to 1e-6.
#[test]
fn air_swings_between_tanks() {
    let volumes = [1e-6, 3e-6];
    for exponent in [1.0, 1.4] {
        for start in [0.0, 3.0 * AMBIENT] {
            let pressure = start + AMBIENT;
            let density = (pressure / AMBIENT).powf(1.0 / exponent);
            // half of the tube stands at each tank
            let half = 0.5 * 0.1 * PI * RADIUS * RADIUS;
            let stiffness = |volume: f64| exponent * pressure / ((volume + half) * density);
            let decay = 0.5 * RESISTANCE / (inertance() * density);
            let both = json!([tank("a", volumes[0], start), tank("b", volumes[1], start)]);
            let mut closed = rig(gas(exponent), json!({"accumulators": both}), 1.0);
            closed["effects"] = effects(PLAIN);
            let one = json!({"accumulators": [tank("b", volumes[1], start)],
                "ports": [{"at": {"junction": "a"}, "pressure_pa": start}]});
            let mut open = rig(gas(exponent), one, 1.0);
            open["effects"] = effects(PLAIN);
            let together = volumes.map(stiffness).iter().sum::<f64>();
            for (case, stiffness) in [(closed, together), (open, stiffness(volumes[1]))] {
                let exact = (stiffness / inertance() - decay * decay).sqrt();
                let (omega, damping) = mode(&case, exact / TAU);
                println!(
                    "n {exponent}, {start} Pa: {:.1e} {:.1e}",
                    omega / exact - 1.0,
                    damping / decay - 1.0
                );
                assert!((omega / exact - 1.0).abs() < 1e-6 && (damping / decay - 1.0).abs() < 1e-6);
            }
        }
    }
}

/// Source: `P_a² - P_b² = (f l/D) G² P_0/ρ_0`, G the mass flow per area, isothermal flow of gas in a long tube (the logarithm of the densities' ratio
/// left out, as the model does), f by Churchill at the Reynolds number `G D/μ`. Goal: flow from one pressure to another that is steady is
/// that to 1e-6, laminar and turbulent.
#[test]
fn steady_flow_of_gas_is_the_textbooks() {
    let (viscosity, density) = (1.8e-5, 1.2);
    for drop in [50.0, 2e3, 2e5] {
        let ports = json!([{"name": "a", "at": {"junction": "a"}, "pressure_pa": {"ramp": {"to": drop, "duration_s": 0.01, "shape": "smooth"}}},
            {"name": "b", "at": {"junction": "b"}, "pressure_pa": 0}]);
        let mut case = rig(gas(1.0), json!({"ports": ports}), 0.5);
        case["network"]["tubes"][0]["roughness_m"] = json!(1e-5);
        case["effects"] = effects(["on", "on", "on"]);
        let (memory, _) = finished(&case);
        let q = *memory.column("port_a_flow").unwrap().last().unwrap();
        let diameter = 2.0 * RADIUS;
        let mass = density * q / (PI * RADIUS * RADIUS);
        let reynolds = mass * diameter / viscosity;
        let a = (2.457 * (1.0 / ((7.0 / reynolds).powf(0.9) + 0.27 * 1e-5 / diameter)).ln()).powi(16);
        let b = (37530.0 / reynolds).powi(16);
        let f = 8.0 * ((8.0 / reynolds).powi(12) + (a + b).powf(-1.5)).powf(1.0 / 12.0);
        let squares = f * 0.1 / diameter * mass * mass * AMBIENT / density;
        let exact = (drop + AMBIENT).powi(2) - AMBIENT * AMBIENT;
        println!("{drop} Pa, Re {reynolds:.0}: {:.1e}", squares / exact - 1.0);
        assert!((squares / exact - 1.0).abs() < 1e-6);
    }
}

/// Tubes with inertia that meet at tees, valves that move and that open by themselves, a pump, a bridge of check valves, tanks, a bent beam.
pub fn everything(fluid: Value, exponent: f64) -> Value {
    let valve = json!({"cracking_pressure_pa": 200, "forward_conductance_m3_s_pa": 1e-8, "reverse_conductance_m3_s_pa": 1e-13, "smoothing_pa": 200});
    let bladder = |k: i32| json!({"bladder": k, "end": "outlet"});
    let tee = |name: &str| json!({"junction": name});
    let mut case = actuator(fluid, json!({}));
    case["network"] = json!({
        "chains": [{"bladders": [1, 2, 3], "ends": ["sealed", "connected"]}, {"bladders": [-1, -2, -3], "ends": ["sealed", "connected"]},
                   {"bladders": [4, 5], "ends": ["connected", "sealed"]}, {"bladders": [-4, -5], "ends": ["connected", "sealed"]}],
        "junctions": ["tee", "tank", "air"],
        "tubes": [
            {"from": bladder(3), "to": tee("tee"), "length_m": 0.02, "cross_section": {"circle": {"radius_m": 1e-3}}},
            {"from": bladder(-3), "to": tee("tee"), "length_m": 0.03, "cross_section": {"circle": {"radius_m": 1e-3}}, "opening": {"ramp": {"from": 1, "to": 0.1, "start_s": 0.02, "duration_s": 0.005}}},
            {"from": tee("tee"), "to": tee("tank"), "length_m": 0.05, "cross_section": {"circle": {"radius_m": 1e-3}}, "check_valve": valve},
            {"from": tee("air"), "to": tee("tank"), "length_m": 0.05, "cross_section": {"circle": {"radius_m": 1e-3}}, "pump": {"pressure_pa": 3e3, "resistance_pa_s_m3": 1e9}}],
        "accumulators": [{"at": tee("tank"), "kind": {"elastic": {"compliance_m3_pa": 1e-11, "volume_m3": 5e-6}}, "start_pressure_pa": 1e3}],
        "ports": [{"at": tee("air"), "pressure_pa": 0}],
        "turbines": [{"from": {"bladder": 4, "end": "inlet"}, "to": {"bladder": -4, "end": "inlet"}, "conductance": {"m3_s_pa": 1e-9},
                      "rectifier": {"check_valves": valve}}]
    });
    if exponent > 1.0 {
        case["network"]["accumulators"][0]["kind"] =
            json!({"gas": {"volume_m3": 2e-6, "polytropic_exponent": exponent}});
    }
    case
}

/// Goal: energy and volume close with all of that, for gas, mixtures and liquids that yield, whatever of the tubes is left out; and the Jacobian is
/// that of the residual.
#[test]
fn balances_close_with_inertia() {
    let mixture =
        json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3, "bulk_modulus_pa": 2.2e9, "gas_fraction": 0.05});
    let soft = json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3, "bulk_modulus_pa": 1e7});
    let fluids = [
        ("isothermal", gas(1.0), 1.0),
        ("adiabatic", gas(1.4), 1.4),
        ("mixture", mixture, 1.0),
        ("soft", soft, 1.0),
    ];
    for (what, fluid, exponent) in fluids {
        for tubes in [["on", "on", "on"], PLAIN, ["off", "off", "on"], ["off", "off", "off"]] {
            let mut case = everything(fluid.clone(), exponent);
            case["effects"] = effects(tubes);
            let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
            dae.approach(1e3);
            let worst = worst_difference(&mut dae, 1, 0.1);
            assert!(worst < 1e-5, "{what} {tubes:?}: {worst:e}");
            let (_, summary) = finished(&case);
            let b = &summary.balances;
            let [energy, volume] = [b.energy_residual_relative.abs(), b.volume_residual_relative];
            println!(
                "{what} {tubes:?}: {energy:.1e} {volume:.1e}, Jacobian {worst:.1e}, {} steps",
                summary.solver.steps
            );
            assert!(energy < 1e-5 && volume < 1e-10, "{what} {tubes:?}");
        }
    }
}

/// Goal: with inertia in tubes, too, a liquid whose bulk modulus grows becomes what an incompressible one is, with order one.
#[test]
fn a_stiff_liquid_with_inertia_is_incompressible() {
    becomes_incompressible(&effects(["on", "on", "on"]));
}

/// Goal: tanks at one pressure beyond a bare junction, wherever that stands in the list of junctions, rest at that pressure less what the halves of tubes
/// at the junction take: `P (V_a + V_c + V_tubes) = P_0 (V_a + V_c) ..`, isothermal, to 1e-9. Before, the search failed unless the bare junction came last.
#[test]
fn the_order_of_junctions_does_not_matter() {
    let tube = |from: &str| json!({"from": {"junction": from}, "to": {"junction": "b"}, "length_m": 0.1, "cross_section": {"circle": {"radius_m": 1e-3}}});
    let (start, volume) = (3000.0, 1e-5);
    // the halves at the tanks begin at their pressure, those at the junction at none
    let halves = PI * 1e-6 * 0.1;
    let exact = (2.0 * volume + halves) * start / (2.0 * volume + 2.0 * halves);
    for order in [["a", "b", "c"], ["b", "c", "a"], ["a", "c", "b"]] {
        let network = json!({"junctions": order, "tubes": [tube("a"), tube("c")],
            "accumulators": [tank("a", volume, start), tank("c", volume, start)]});
        let mut case = rig(gas(1.0), network, 0.1);
        case["effects"] = effects(["on", "on", "on"]);
        let case = parse(&case);
        let path = equilibrium::follow(&case, &EquilibriumOptions::at(0.1), &mut |_| Control::Continue).unwrap();
        assert!(path.fault.is_none(), "{order:?}: {:?}", path.fault);
        let columns = equilibrium::columns(&equilibrium::system(&case, 0.1).unwrap());
        let place = columns
            .iter()
            .position(|column| column.name == "accumulator_c_pressure")
            .unwrap();
        let found = path.last().row[place];
        assert!((found / exact - 1.0).abs() < 1e-9, "{order:?}: {found} {exact}");
    }
}

/// Goal: where a valve shuts between two stages of an equilibrium, what is behind it keeps its pressure, what tubes hold included.
#[test]
fn a_valve_that_shuts_keeps_what_is_behind_it() {
    let text = std::fs::read_to_string("cases/tank-finger.json").unwrap();
    let case = parse(&serde_json::from_str(&text).unwrap());
    let options = EquilibriumOptions {
        via_s: vec![0.3],
        ..EquilibriumOptions::at(1.0)
    };
    let path = equilibrium::follow(&case, &options, &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let columns = equilibrium::columns(&equilibrium::system(&case, 1.0).unwrap());
    let place = columns.iter().position(|column| column.name == "max_pressure").unwrap();
    let first = path.states.iter().rfind(|state| state.stage == 0).unwrap().row[place];
    let last = path.last().row[place];
    assert!((last / first - 1.0).abs() < 1e-8 && last > 4e4, "{first} {last}");
}
