//! Fluid that is hard for an integrator: water hammer, gas that chokes, valves that chatter in it.

use std::f64::consts::PI;

use serde_json::{Value, json};
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

use super::moving::{effects, everything};
use super::scene::{finished, parse};
use super::vessels::rig;
use super::{actuator, gas};

/// Methods with their tolerances, and how far a balance of energy may stay open under shocks: some ten times rtol, of each of many of them.
const METHODS: [(&str, f64, f64); 4] = [
    ("ida", 1e-3, 5e-2),
    ("ida", 1e-6, 2e-4),
    ("esdirk46", 1e-3, 5e-2),
    ("esdirk46", 1e-6, 2e-4),
];

/// Runs a case by each method to its end, and holds its balances: that of energy to so many times what shocks may.
fn held_by_all(what: &str, case: &Value, times: f64) -> Vec<Summary> {
    let run = |(method, rtol, most): (&str, f64, f64)| {
        let mut case = case.clone();
        case["solver"] = json!({"method": method, "rtol": rtol});
        let summary = dynamics::run(&parse(&case), &mut Memory::default()).unwrap().summary;
        let b = &summary.balances;
        let [energy, volume] = [b.energy_residual_relative.abs(), b.volume_residual_relative];
        println!(
            "{what}, {method} {rtol:e}: {energy:e} {volume:e}, {} steps, {:?}",
            summary.solver.steps, summary.warnings
        );
        assert_eq!(
            summary.status,
            Status::Finished,
            "{what}, {method} {rtol:e}: {:?}",
            summary.reason
        );
        assert!(energy < times * most && volume < 1e-9, "{what}, {method} {rtol:e}");
        summary
    };
    METHODS.map(run).to_vec()
}

/// Source: a slug of inertance I that flows with q when its way is shut gives what it has, `I q²/2`, to the compliance C before the valve: `p = q √(I/C)`
/// (Joukowsky's rise of a lumped line; `C = V/K` of a tank of water). Goal: water from a port through a tube and a valve that shuts a hundred times
/// as fast as the line swings makes that pressure in the tank before the valve to 2 %, of which friction takes a part.
#[test]
fn water_hammer_of_a_lumped_line() {
    let (modulus, volume, radius) = (2.2e9, 1e-5, 2e-3);
    let water = json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-4, "bulk_modulus_pa": modulus});
    let tube = |from: &str, to: &str, length: f64| {
        json!({"from": {"junction": from}, "to": {"junction": to}, "length_m": length, "loss_coefficient": 0,
               "cross_section": {"circle": {"radius_m": radius}}})
    };
    let mut valve = tube("b", "c", 0.001);
    let shut = 0.2;
    valve["opening"] = json!({"ramp": {"from": 1, "to": 0, "start_s": shut, "duration_s": 1e-5, "shape": "smooth"}});
    let network = json!({"junctions": ["a", "b", "c"], "tubes": [tube("a", "b", 1.0), valve],
        "accumulators": [{"name": "b", "at": {"junction": "b"}, "kind": {"tank": {"volume_m3": volume}}}],
        "ports": [{"name": "a", "at": {"junction": "a"}, "pressure_pa": {"ramp": {"to": 500, "duration_s": 0.05, "shape": "smooth"}}},
                  {"name": "c", "at": {"junction": "c"}, "pressure_pa": 0}]});
    let mut case = rig(water, network, 0.21);
    case["time"]["output_interval_s"] = json!(2e-5);
    case["effects"] =
        json!({"compressibility": "on", "tube_inertia": "on", "unsteady_friction": "off", "tube_losses": "off"});
    case["solver"]["rtol"] = json!(1e-7);
    let (memory, summary) = finished(&case);
    let times = memory.column("t").unwrap();
    let flows = memory.column("port_a_flow").unwrap();
    let before = times.iter().position(|t| *t >= shut).unwrap() - 1;
    let inertance = 4.0 / 3.0 * 1000.0 / (PI * radius * radius);
    // halves of both tubes stand at the tank
    let halves = 0.5 * (1.0 + 0.001) * PI * radius * radius;
    let exact = flows[before] * (inertance * modulus / (volume + halves)).sqrt();
    let peak = memory
        .column("accumulator_b_pressure")
        .unwrap()
        .into_iter()
        .fold(0.0, f64::max);
    let (energy, volume) = (
        summary.balances.energy_residual_relative.abs(),
        summary.balances.volume_residual_relative,
    );
    println!(
        "{peak:e} of {exact:e} Pa, q {:e}, energy {energy:e}, volume {volume:e}",
        flows[before]
    );
    assert!((peak / exact - 1.0).abs() < 0.02 && energy < 1e-4 && volume < 1e-10);
}

/// Goal: valves that shut at full flow in a chain of bladders filled with water that yields, with every effect of tubes: each method ends at loose and
/// at tight tolerance, and balances stay open by no more than tolerances explain.
#[test]
fn water_hammer_on_a_compliant_chain() {
    let water = json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3, "bulk_modulus_pa": 2.2e9});
    let slam = json!({"ramp": {"from": 1, "to": 0, "start_s": 0.03, "duration_s": 2e-4, "shape": "smooth"}});
    let mut case = actuator(water, json!({}));
    case["network"] = json!({"chains": [{"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "opening": slam,
        "ends": [{"pressure_pa": {"ramp": {"to": 3e4, "duration_s": 2e-3}}}, {"pressure_pa": 0}]}]});
    case["effects"] =
        json!({"compressibility": "on", "tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"});
    held_by_all("chain", &case, 1.0);
}

/// Goal: air at ten times ambient pressure that leaves a bladder through a wide, short tube, faster than the model's flow can be: the run ends, balances close,
/// and the Mach number is told (W024).
#[test]
fn gas_that_chokes_is_told() {
    let mut case = super::behind_a_capillary(gas(1.4), 9e5, 1.5e-3, 0.02);
    case["network"]["tubes"][0]["roughness_m"] = json!(1e-5);
    case["beam"]["young_modulus_pa"] = json!(2e8);
    case["bladders"]["area_per_pressure_m2_per_pa"] = json!(1e-11);
    case["effects"] = effects(["on", "on", "on"]);
    // all of the pressure is let go in no time
    for summary in held_by_all("choking", &case, 3.0) {
        let told = summary
            .warnings
            .iter()
            .find(|warning| warning.starts_with("W024"))
            .unwrap();
        // what is in the model, and not that flow creeps
        assert!(
            told.contains("friction, losses and inertia alone") && !told.contains("creep"),
            "{told}"
        );
    }
}

/// Goal: everything at once in air and in a liquid full of gas, by each method, at loose and at tight tolerance.
#[test]
fn everything_at_once_ends() {
    let mixture =
        json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3, "bulk_modulus_pa": 2.2e9, "gas_fraction": 0.05});
    for (what, fluid) in [("air", gas(1.4)), ("mixture", mixture)] {
        let mut case = everything(fluid, 1.0);
        case["effects"] = effects(["on", "on", "on"]);
        held_by_all(what, &case, 1.0);
    }
}
