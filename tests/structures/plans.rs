//! Plans of structures in JSON, and readers of their results.

use serde_json::{Value, json};
use slcbeam::run::equilibrium::{self, EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::Control;

use crate::scene::parse;

/// Section with `EA` [N], `EI` [N m^2] and mass per length [kg/m].
pub fn section([ea, ei, mass]: [f64; 3]) -> Value {
    let height = (12.0 * ei / ea).sqrt();
    json!({"height_m": height, "width_m": 1.0, "young_modulus_pa": ea / height, "density_kg_m3": mass / height})
}

/// Beam of a length [m] at an angle from z towards x [degrees].
pub fn beam(name: &str, length: f64, degrees: f64, segments: usize) -> Value {
    json!({"name": name, "length_m": length, "angle_rad": degrees.to_radians(), "segments": segments})
}

/// The same with conditions at its root or tip.
pub fn held(mut beam: Value, end: &str, how: Value) -> Value {
    beam["ends"][end] = how;
    beam
}

/// A joint of this kind, without values.
pub fn joint(kind: &str, at: &[&str]) -> Value {
    json!({"at": at, "kind": {kind: {}}})
}

/// A structure of one section without rotary inertia, one cell per segment.
pub fn structure(section: Value, beams: Vec<Value>, joints: Vec<Value>) -> Value {
    json!({
        "name": "structure", "beam": section, "beams": beams, "joints": joints, "mesh": {"cells_per_segment": 1},
        "effects": {"rotary_inertia": "off"}, "companion": "off", "time": {"end_s": 1.0}, "solver": {"rtol": 1e-9}
    })
}

/// A path to the loads of the end of a case, and its columns.
pub fn path_of(case: &Value) -> (equilibrium::Path, Vec<String>) {
    let case = parse(case);
    let at = case.time.end_s;
    let path = follow(&case, &EquilibriumOptions::at(at), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let names = columns(&system(&case, at).unwrap()).into_iter().map(|c| c.name);
    (path, names.collect())
}

/// Reader of the last state of a path.
pub fn at_rest(case: &Value) -> impl Fn(&str) -> f64 + use<> {
    let (path, names) = path_of(case);
    let row = path.last().row.clone();
    move |name: &str| {
        let at = names.iter().position(|known| known == name);
        row[at.unwrap_or_else(|| panic!("no {name} among {names:?}"))]
    }
}

/// Value in the limit of fine meshes, from two meshes of which the second has twice the cells (second order).
pub fn extrapolated([coarse, fine]: [f64; 2]) -> f64 {
    fine + (fine - coarse) / 3.0
}

/// Fails unless a value is within a part of its reference.
pub fn near(what: &str, ours: f64, reference: f64, within: f64) {
    let error = (ours - reference).abs() / reference.abs();
    println!("{what}: {ours:.10} for {reference:.10}, {error:.1e}");
    assert!(error < within, "{what}: {ours} for {reference}, {error:.1e}");
}
