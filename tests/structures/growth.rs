//! Work with the number of beams.
//!
//! Goal: unknowns, entries of the Jacobian and bytes of its factors grow in proportion to the number of beams.

use serde_json::{Value, json};
use slcbeam::dae::{BeamDae, Dae, Seeds};
use slcbeam::discrete::{System, start};
use slcbeam::sparse::Lu;

use crate::plans::{beam, held, joint};
use crate::scene::parse;

/// A chain of beams of ten bladders each, at 20 degrees to each other, with one row of bladders from its root to its tip.
fn chain(beams: usize) -> Value {
    let mut parts: Vec<Value> = (0..beams)
        .map(|k| beam(&format!("b{k}"), 0.1, if k % 2 == 0 { 0.0 } else { 20.0 }, 10))
        .collect();
    parts[0] = held(parts[0].clone(), "root", json!("clamped"));
    let joints = (1..beams).map(|k| {
        let kind = if k % 4 == 0 { "hinge" } else { "rigid" };
        let mut one = joint(kind, &[&format!("b{}.tip", k - 1), &format!("b{k}.root")]);
        if k % 4 == 0 {
            one["kind"]["hinge"] = json!({"stiffness_n_m_rad": 1.0});
        }
        one
    });
    let row: Vec<String> = (0..10 * beams).map(|k| format!("b{}:{}", k / 10, k % 10 + 1)).collect();
    json!({
        "name": "chain", "preset": "matia-gat-beam", "beams": parts, "joints": joints.collect::<Vec<_>>(),
        "network": {"chains": [{"bladders": row, "ends": [{"pressure_pa": 1000}, "sealed"]}]},
        "mesh": {"cells_per_segment": 2}, "companion": "off", "time": {"end_s": 0.1}
    })
}

/// Unknowns, entries of the Jacobian, and bytes of its factors.
fn sizes(beams: usize) -> [f64; 3] {
    let case = parse(&chain(beams));
    let mut dae = BeamDae::new(System::new(&case).unwrap());
    let (system, now) = dae.instant(0.0);
    let y = start::state(system, &case, now);
    let pattern = dae.pattern().clone();
    let mut values = vec![0.0; pattern.entries()];
    dae.jacobian(0.0, &y, &vec![0.0; y.len()], Seeds::Step { cj: 1e3 }, &mut values)
        .unwrap();
    let mut lu = Lu::new(&pattern).unwrap();
    lu.factor(&values).unwrap();
    println!("{beams} beams, factors in blocks: {}", lu.in_blocks());
    [y.len(), pattern.entries(), lu.bytes()].map(|size| size as f64)
}

#[test]
fn sizes_grow_with_the_number_of_beams() {
    let found = [8, 16, 32, 64].map(sizes);
    println!("unknowns, entries, bytes of factors: {found:?}");
    for pair in found.windows(2) {
        for (few, many) in pair[0].iter().zip(pair[1]) {
            let exponent = (many / few).log2();
            assert!((0.9..1.1).contains(&exponent), "{few} to {many}: exponent {exponent}");
        }
    }
}
