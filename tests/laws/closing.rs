//! Bladders whose walls meet, [E71].

use crate::differences::worst_difference;
use crate::scene::{finished, parse};
use serde_json::{Value, json};
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;
use slcbeam::run::equilibrium::{self, EquilibriumOptions};
use slcbeam::run::record::Control;

/// Cross-section of a bladder at rest [m^2], and `a_p` [m^2/Pa]: without contact it would be gone at -61 kPa.
const AREA: f64 = 0.0078 * 0.0078;
const SOFT: f64 = 1e-9;
const BELOW: f64 = 0.2;
const STIFF: f64 = 2e4;

fn water() -> Value {
    json!({"density_kg_m3": 1000, "viscosity_pa_s": 1e-3})
}

fn air() -> Value {
    json!({"kind": "gas", "density_kg_m3": 1.2, "viscosity_pa_s": 1.8e-5, "polytropic_exponent": 1.2})
}

/// The paper's beam with soft bladders, its lower row sucked at, its root shaken; changed.
fn sucked(fluid: Value, suction: f64, sets: Value) -> Value {
    let mut case = json!({
        "name": "sucked", "preset": "matia-gat-beam", "fluid": fluid,
        "bladders": {"coupling": "reciprocal", "area_per_pressure_m2_per_pa": SOFT, "closing": {"below": BELOW, "stiffness_pa": STIFF}},
        "network": {"chains": [{"bladders": [1, 2, 3, 4, 5]},
            {"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10],
             "ends": [{"pressure_pa": {"ramp": {"to": -suction, "duration_s": 0.02, "shape": "smooth"}}}, "sealed"]}]},
        "ends": {"root": {"clamped": {"u1_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 20, "ramp_cycles": 1}}}}, "tip": "free"},
        "effects": {"tube_inertia": "off", "tube_losses": "off"},
        "time": {"end_s": 0.1, "output_interval_s": 0.002},
        "solver": {"rtol": 1e-8}
    });
    for (key, value) in sets.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

/// `p_c` by the share that is left.
fn contact(x: f64) -> f64 {
    if x < BELOW {
        STIFF * (BELOW / x - 1.0).powi(2)
    } else {
        0.0
    }
}

/// Source: `a1 = a_p (p + p_c)` of a bladder that neither bending nor stretch touches, by bisection. Goal: bladders at rest under suction are as narrow as
/// that, where walls do not meet, where they touch, and where without contact nothing would be left, to 1e-9, of water and of air.
#[test]
fn walls_hold_what_suction_leaves() {
    for fluid in [water(), air()] {
        for suction in [2e4, 5.5e4, 9e4] {
            let mut case = sucked(
                fluid.clone(),
                suction,
                json!({"ends": {"root": "clamped", "tip": "free"}}),
            );
            case["bladders"]["area_per_moment_m2_per_n_m"] = json!({"opening": 0, "closing": 0});
            case["bladders"]["area_per_force_m2_per_n"] = json!({"tension": 0, "compression": 0});
            case["probes"] = json!([{"name": "middle", "at": 0.55}]);
            let (mut low, mut high) = (1e-9, 1.0);
            for _ in 0..200 {
                let x = 0.5 * (low + high);
                if AREA * (x - 1.0) - SOFT * (contact(x) - suction) < 0.0 {
                    low = x;
                } else {
                    high = x;
                }
            }
            let case = parse(&case);
            let path = equilibrium::follow(&case, &EquilibriumOptions::at(0.1), &mut |_| Control::Continue).unwrap();
            assert!(path.fault.is_none(), "{:?}", path.fault);
            let columns = equilibrium::columns(&equilibrium::system(&case, 0.1).unwrap());
            let value = |name: &str| {
                let place = columns.iter().position(|column| column.name == name);
                path.last().row[place.unwrap_or_else(|| panic!("no column {name}"))]
            };
            let found = value("least_opening");
            println!("{suction}: {found} {low}");
            assert!((found / low - 1.0).abs() < 1e-9, "{found} {low}");
            // pressures are those of the fluid, not those of the walls
            for name in ["bladder__6_pressure", "middle_pressure_lower"] {
                let pressure = value(name);
                assert!((pressure / -suction - 1.0).abs() < 1e-9, "{name} {pressure}");
            }
        }
    }
}

/// Goal: energy closes to 1e-6 and volume to 1e-9, which is how well roots are told, while walls meet, in bladders through which fluid flows, that keep theirs, and that share a pressure,
/// of water and of air, and the Jacobian is that of the residual.
#[test]
fn balances_close_where_walls_meet() {
    let squeezed = json!({
        "network": {"chains": [{"bladders": [1, 2, 3, 4, 5]}, {"bladders": [-1, -2, -3]}]},
        "start": {"pressures": [{"bladders": [-1, -2, -3], "pressure_pa": -5.8e4}]},
        "time": {"end_s": 0.02, "output_interval_s": 0.001}
    });
    let with = |effects: Value| {
        let mut sets = squeezed.clone();
        sets["effects"] = effects;
        sets
    };
    let cases = [
        ("water", sucked(water(), 7e4, json!({}))),
        ("air", sucked(air(), 7e4, json!({}))),
        (
            "small rotations",
            sucked(
                water(),
                7e4,
                json!({"effects": {"finite_rotation": "off", "tube_inertia": "off", "tube_losses": "off"}}),
            ),
        ),
        ("kept", sucked(water(), 0.0, with(json!({"flow": "off"})))),
        ("kept, air", sucked(air(), 0.0, with(json!({"flow": "off"})))),
        (
            "shared",
            sucked(water(), 0.0, with(json!({"network_pressure_differences": "off"}))),
        ),
        (
            "shared, air",
            sucked(air(), 0.0, with(json!({"network_pressure_differences": "off"}))),
        ),
        (
            "inertia",
            sucked(
                air(),
                7e4,
                json!({"effects": {"tube_inertia": "on", "unsteady_friction": "on", "tube_losses": "on"}}),
            ),
        ),
    ];
    for (what, case) in cases {
        let worst = worst_difference(&mut BeamDae::new(System::new(&parse(&case)).unwrap()), 1, 0.3);
        let (memory, summary) = finished(&case);
        let narrowest = memory.column("least_opening").unwrap().into_iter().fold(1.0, f64::min);
        let b = &summary.balances;
        let [energy, volume] = [b.energy_residual_relative.abs(), b.volume_residual_relative];
        println!(
            "{what}: {narrowest:.3} left, {energy:.1e} {volume:.1e}, Jacobian {worst:.1e}, {} steps",
            summary.solver.steps
        );
        assert!(narrowest > 0.0 && narrowest < BELOW, "{what}: {narrowest}");
        assert!(energy < 1e-6 && volume < 1e-9 && worst < 1e-5, "{what}");
    }
}

/// Goal: walls that do not meet cost no unknown and change nothing, to 1e-6: areas have other tolerances then.
#[test]
fn open_walls_are_not_there() {
    let open = sucked(water(), 2e4, json!({}));
    let mut without = open.clone();
    without["bladders"].as_object_mut().unwrap().remove("closing");
    let [a, b] = [&open, &without].map(finished);
    assert_eq!(a.1.unknowns, b.1.unknowns);
    for column in ["tip_u1", "max_pressure", "least_opening"] {
        let [a, b] = [&a, &b].map(|run| run.0.column(column).unwrap());
        let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let off = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6 * size, "{column}: {:e}", off / size);
    }
    // and where they do, a run without contact ends
    let mut shut = sucked(water(), 9e4, json!({}));
    let narrowest = finished(&shut)
        .0
        .column("least_opening")
        .unwrap()
        .into_iter()
        .fold(1.0, f64::min);
    assert!(narrowest > 0.02, "{narrowest}");
    shut["bladders"].as_object_mut().unwrap().remove("closing");
    let summary = slcbeam::run::dynamics::run(&parse(&shut), &mut slcbeam::run::record::Memory::default())
        .unwrap()
        .summary;
    assert!(summary.reason.unwrap().contains("closed"));
}

/// Goal: hard: a row is sucked shut in five milliseconds, at half as much again as closes it, at loose and at tight tolerance, by both methods: each run ends, and
/// nothing closes.
#[test]
fn walls_that_slam_hold() {
    let mut case = sucked(water(), 9.5e4, json!({}));
    case["network"]["chains"][1]["ends"][0]["pressure_pa"]["ramp"]["duration_s"] = json!(5e-3);
    case["bladders"]["closing"] = json!({"below": 0.1, "stiffness_pa": 5e4});
    for (method, rtol, most) in [
        ("ida", 1e-3, 5e-2),
        ("ida", 1e-6, 2e-4),
        ("esdirk46", 1e-3, 5e-2),
        ("esdirk46", 1e-6, 2e-4),
    ] {
        case["solver"] = json!({"method": method, "rtol": rtol});
        let (memory, summary) = finished(&case);
        let narrowest = memory.column("least_opening").unwrap().into_iter().fold(1.0, f64::min);
        let energy = summary.balances.energy_residual_relative.abs();
        println!(
            "{method} {rtol:e}: {narrowest:.4} left, energy {energy:.1e}, {} steps",
            summary.solver.steps
        );
        assert!(narrowest > 0.0 && energy < most);
    }
}
