//! Fluid, bladders and how they are wired.

use serde_json::{Value, json};

use crate::chance::Random;
use crate::digits::short;
use crate::scene::Beam;
use crate::signals;

/// Pressure that opens a bladder by about a third [Pa].
pub fn pressure(case: &Value) -> f64 {
    let bladders = &case["bladders"];
    let size = |key: &str| bladders[key].as_f64().unwrap_or(0.0);
    0.3 * size("height_m") * size("width_m") / size("area_per_pressure_m2_per_pa")
}

/// Adds fluid, bladders, tubes and a network.
pub fn fluid(r: &mut Random, b: &Beam, case: &mut Value) {
    let sane = b.times.sane;
    let per_row = if r.one_in(6) { 3 } else { 1 + r.below(2) };
    let height = b.height * r.between(0.1, 0.45);
    let width = b.length / per_row as f64 * r.between(0.3, 0.9);
    let length = b.width * r.between(0.4, 0.95);
    let ratio = length * per_row as f64 / b.length;
    let ap = height * width / b.modulus * if sane { r.log(2.0, 20.0) } else { r.log(0.5, 50.0) };
    // Slopes below passivity: `2 EA phi_b l_b aN+^2 = share a_p`, `EI phi_b l_b (aM+^2 + aM-^2) = share a_p`.
    let closing_n = (r.between(0.01, 0.5) * ap / (2.0 * b.ea * ratio)).sqrt();
    let closing_m = (r.between(0.01, 0.5) * ap / (2.0 * b.ei * ratio)).sqrt();
    let (down_n, down_m) = (r.between(0.4, 1.0), r.between(0.4, 1.0));
    let mean = |closing: f64, down: f64| 0.5 * closing * (1.0 + down);
    let coupling = match r.below(8) {
        0 => json!("reciprocal_kinked"),
        1 | 2 => json!({"published": {
            "slope_per_pressure_rad": short(length * mean(closing_m, down_m) * b.modulus * r.log(0.03, 1.0)),
            "length_per_pressure_m": short(length * mean(closing_n, down_n) * b.modulus * r.log(0.03, 1.0))
        }}),
        _ => json!("reciprocal"),
    };
    // Viscosity by the time a bladder takes to exchange its content through a tube, over the beam's period.
    let radius = height * r.log(0.05, 0.5);
    let tube = b.width * r.log(0.1, 2.0);
    let conductance = std::f64::consts::PI * radius.powi(4) / (8.0 * tube);
    let ratio = if sane { r.log(1e-2, 1e2) } else { r.log(1e-4, 1e4) };
    let viscosity = (ratio * b.times.period * conductance / (ap * length)).clamp(1e-6, 1e4);
    case["fluid"] = json!({"density_kg_m3": short(r.between(0.0, 2000.0)), "viscosity_pa_s": short(viscosity)});
    case["bladders"] = json!({
        "per_row": per_row, "length_m": short(length), "height_m": short(height), "width_m": short(width),
        "area_per_pressure_m2_per_pa": short(ap),
        "area_per_moment_m2_per_n_m": {"opening": short(closing_m * down_m), "closing": short(closing_m)},
        "area_per_force_m2_per_n": {"tension": short(closing_n * down_n), "compression": short(closing_n)},
        "coupling": coupling
    });
    if coupling == "reciprocal_kinked" {
        case["bladders"]["kink_width"] = short(r.log(1e-2, 1.0));
    } else if !sane && r.one_in(3) {
        case["bladders"]["kink_width"] = short(r.log(1e-5, 1e-1));
    }
    case["tubes"] = json!({"length_m": short(tube), "radius_m": short(radius)});
    if !r.one_in(8) {
        wires(r, b, per_row, conductance / viscosity, case);
    }
}

/// Chains of all lengths, crossing from row to row, joined by junctions, tubes, turbines and ports.
fn wires(r: &mut Random, b: &Beam, per_row: usize, conductance: f64, case: &mut Value) {
    let t = b.times;
    let mut order: Vec<i64> = (1..=per_row as i64).chain((1..=per_row as i64).map(|k| -k)).collect();
    if r.one_in(2) {
        for k in (1..order.len()).rev() {
            order.swap(k, r.below(k + 1));
        }
    }
    let pressure = pressure(case) * if t.sane { 0.3 } else { 1.0 };
    let flow = conductance * pressure * 0.1;
    let content = 0.3 * b.width * b.height * b.length / per_row as f64 * 0.05;
    let flow = flow.min(content / t.end);
    let (mut chains, mut ports, mut free) = (vec![], vec![], vec![]);
    let mut rest = order.as_slice();
    while !rest.is_empty() {
        let count = (1 + r.below(4)).min(rest.len());
        let (chain, later) = rest.split_at(count);
        rest = later;
        if r.one_in(8) {
            continue;
        }
        let mut ends = vec![];
        for (bladder, end) in [(chain[0], "inlet"), (chain[count - 1], "outlet")] {
            let point = json!({"bladder": bladder, "end": end});
            ends.push(match r.below(8) {
                0 => json!({"pressure_pa": signals::load(r, t, pressure)}),
                1 => json!({"flow_m3_s": signals::load(r, t, flow)}),
                2 => {
                    ports.push(json!({"at": point, "pressure_pa": signals::load(r, t, pressure)}));
                    json!("connected")
                }
                3..6 => {
                    free.push(point);
                    json!("connected")
                }
                _ => json!("sealed"),
            });
        }
        let mut chain = json!({"bladders": chain, "ends": ends});
        if count > 1 && r.one_in(5) {
            chain["opening"] = signals::opening(r, t);
        }
        chains.push(chain);
    }
    let (mut junctions, mut tubes, mut turbines) = (vec![], vec![], vec![]);
    if free.len() >= 3 && r.one_in(2) {
        junctions.push(json!("tee"));
        for point in free.drain(..3) {
            tubes.push(json!({"from": point, "to": {"junction": "tee"}, "length_m": short(b.width * r.log(0.1, 2.0))}));
        }
    }
    while free.len() >= 2 {
        let (from, to) = (free.remove(0), free.remove(0));
        if r.one_in(2) {
            let mut tube = json!({"from": from, "to": to});
            if r.one_in(2) {
                tube["opening"] = signals::opening(r, t);
            }
            tubes.push(tube);
        } else {
            let conductance = conductance * r.log(1e-2, 1e1);
            let rectifier = match r.below(2) {
                0 => json!("ideal"),
                _ => json!({"check_valves": {
                    "cracking_pressure_pa": short(pressure * r.between(0.0, 0.05)),
                    "forward_conductance_m3_s_pa": short(conductance * r.log(1.0, 30.0)),
                    "reverse_conductance_m3_s_pa": short(conductance * r.log(1e-4, 1e-1)),
                    "smoothing_pa": short(pressure * r.log(1e-3, 1e-1))
                }}),
            };
            turbines.push(json!({
                "from": from, "to": to, "conductance": {"m3_s_pa": short(conductance)}, "rectifier": rectifier
            }));
        }
    }
    for point in free {
        ports.push(json!({"at": point, "flow_m3_s": signals::load(r, t, flow)}));
    }
    case["network"] = json!({"chains": chains});
    for (key, all) in [
        ("junctions", junctions),
        ("tubes", tubes),
        ("ports", ports),
        ("turbines", turbines),
    ] {
        if !all.is_empty() {
            case["network"][key] = json!(all);
        }
    }
    if !t.sane && r.one_in(3) {
        case["network"]["permeability_factor"] = short(r.log(1e-2, 1e2));
    }
}
