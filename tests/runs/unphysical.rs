//! States that satisfy the equations but are unphysical: reported with place and time.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, follow};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Summary;

fn parse(value: &Value) -> Case {
    let parsed = case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[]);
    parsed.map_err(|e| format!("{e:?}")).unwrap()
}

fn run(value: &Value) -> Summary {
    dynamics::run(&parse(value), &mut Memory::default()).unwrap().summary
}

fn told<'a>(all: &'a [String], code: &str) -> Option<&'a String> {
    all.iter().find(|warning| warning.starts_with(code))
}

/// A strip whose rest curvature grows to a value within a second.
fn curled(curvature: f64) -> Value {
    json!({
        "name": "curled",
        "beam": {"length_m": 0.3, "height_m": 0.02, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
                 "damping": {"bending_time_s": 0.02}},
        "loads": [{"rest_curvature_1_m": {"signal": {"ramp": {"to": curvature, "duration_s": 1}}}}],
        "ends": {"root": "clamped", "tip": "free"}, "time": {"end_s": 1.5}
    })
}

/// Source: a circle of length 2π/κ closes on the strip. Goal: bending beyond a full turn is reported as self-intersection, at equilibrium
/// from the load factor 2π/(κ l) on. Bending by less, even far beyond half a turn, is not.
#[test]
fn a_beam_that_crosses_itself_is_told() {
    let summary = run(&curled(26.0));
    let warning = told(&summary.warnings, "W023").expect("a warning");
    let (_, rest) = warning.split_once(": ").expect(warning);
    let (places, _) = rest.split_once(" meet from t = ").expect(warning);
    let (first, second) = places.split_once(" and ").expect(warning);
    let is_place = |place: &str| ["the root", "the tip"].contains(&place) || place.ends_with("m from the root");
    assert!(is_place(first) && is_place(second), "{warning}");
    assert_eq!(told(&run(&curled(15.0)).warnings, "W023"), None);
    let of_path = |curvature: f64| {
        let options = EquilibriumOptions {
            points: Some(64),
            ..EquilibriumOptions::at(1.5)
        };
        follow(&parse(&curled(curvature)), &options, &mut |_| Control::Continue)
            .unwrap()
            .warnings()
    };
    let warnings = of_path(26.0);
    let warning = told(&warnings, "W023").expect("a warning");
    let factor = warning
        .split("load factor ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next());
    let factor: f64 = factor.expect("a factor").parse().unwrap();
    let closes = 2.0 * std::f64::consts::PI / (26.0 * 0.3);
    assert!(factor >= closes - 0.01 && factor < closes + 0.1, "{warning}");
    assert_eq!(told(&of_path(20.0), "W023"), None);
}

/// Two bladders of the paper's beam, and a port that sucks fluid out of them.
fn sucked(port: Value, junctions: Value, tube: Option<Value>, fluid: Value) -> Value {
    let mut tubes = vec![json!({"from": {"bladder": 1, "end": "outlet"}, "to": {"bladder": -1, "end": "inlet"}})];
    tubes.extend(tube);
    json!({
        "name": "sucked", "preset": "matia-gat-beam", "fluid": fluid,
        "beam": {"damping": {"bending_time_s": 0.002, "axial_time_s": 0.002}},
        "bladders": {"per_row": 1},
        "network": {"tubes": tubes, "ports": [port], "junctions": junctions},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": {"tube_inertia": "off", "tube_losses": "off"},
        "time": {"end_s": 0.5, "output_interval_s": 0.01}
    })
}

fn by_pressure(pressure: f64, fluid: Value) -> Value {
    let ramp = json!({"ramp": {"to": pressure, "duration_s": 0.4}});
    let port = json!({"name": "in", "at": {"bladder": 1, "end": "inlet"}, "pressure_pa": ramp});
    sucked(port, json!([]), None, fluid)
}

/// Source: the vapor pressure of water at 20 C, 2.34 kPa, and an ambient pressure of 101.325 kPa: -98.99 kPa gauge. Goal: pressures below
/// it, and below vacuum for other liquids, are reported with place and time; higher ones are not. The largest pressure keeps its sign.
#[test]
fn a_liquid_below_its_vapor_pressure_is_told() {
    let summary = run(&by_pressure(-150e3, json!({"kind": "liquid"})));
    let warning = told(&summary.warnings, "W040").expect("a warning");
    assert!(
        warning.contains("in bladder ") && warning.contains("−101.3 kPa, vacuum"),
        "{warning}"
    );
    let pressure = &summary.quantities["max_pressure_pa"];
    let [extreme, in_window] = [pressure.extreme.unwrap(), pressure.window_extreme.unwrap()];
    assert!(
        extreme < -149e3 && in_window == -pressure.window_max_abs.unwrap(),
        "{pressure:?}"
    );
    for (pressure, fluid, expected) in [
        (-100e3, json!({"preset": "water"}), true),
        (-98e3, json!({"preset": "water"}), false),
        (-100e3, json!({}), false),
        (150e3, json!({}), false),
    ] {
        let warnings = run(&by_pressure(pressure, fluid.clone())).warnings;
        assert_eq!(
            told(&warnings, "W040").is_some(),
            expected,
            "{pressure} {fluid}: {warnings:?}"
        );
    }
}

/// Goal: a port flow forced back through a check valve is reported with the junction or port at which the liquid column breaks.
#[test]
fn a_junction_below_vacuum_is_told() {
    let valve = json!({"cracking_pressure_pa": 100, "forward_conductance_m3_s_pa": 1e-9, "reverse_conductance_m3_s_pa": 1e-15, "smoothing_pa": 50});
    let tube = json!({"from": {"junction": "j"}, "to": {"bladder": 1, "end": "inlet"}, "check_valve": valve});
    let port = json!({"name": "in", "at": {"junction": "j"}, "flow_m3_s": -1e-8});
    let summary = run(&sucked(port, json!(["j"]), Some(tube), json!({})));
    let warning = told(&summary.warnings, "W040").expect("a warning");
    assert!(warning.contains("in junction \"j\" at t = "), "{warning}");
}
