//! Parts of a scene: walls and circles, and in the network check valves, pumps, vessels at any height and syringes, of fluid that may be
//! compressed.

use serde_json::{Value, json};

use crate::chance::Random;
use crate::digits::short;
use crate::further;
use crate::network;
use crate::scene::Beam;
use crate::signals;

/// Adds one of them at least.
pub fn add(r: &mut Random, b: &Beam, case: &mut Value, wet: bool) {
    let walled = !wet || r.one_in(3);
    if walled {
        case["contacts"] = (0..1 + r.below(2)).map(|k| wall(r, b, k)).collect();
    }
    if wet && (!walled || r.one_in(2)) {
        let pressure = network::pressure(case);
        if r.one_in(3) {
            let fluid = case["fluid"].as_object_mut().expect("a fluid");
            fluid.extend(further::compression(r, pressure));
        }
        supplied(r, b, case);
    }
    if walled && r.one_in(2) {
        let radius = b.length * r.log(0.05, 1e2);
        let inside = r.one_in(3) && radius > b.length;
        round(&mut case["contacts"][0], radius, inside);
    }
}

/// Turns a wall into a circle that is tangent to it.
fn round(contact: &mut Value, radius: f64, inside: bool) {
    let part = |key: &str| [0, 1].map(|axis| contact[key][axis].as_f64().expect("a number"));
    let (point, normal) = (part("point_m"), part("normal"));
    let size = normal[0].hypot(normal[1]);
    let back = if inside { radius } else { -radius } / size;
    let center = [0, 1].map(|axis| point[axis] + back * normal[axis]);
    contact["circle"] = json!({"center_m": center, "radius_m": radius, "inside": inside});
    for key in ["point_m", "normal"] {
        contact.as_object_mut().expect("a contact").remove(key);
    }
}

fn wall(r: &mut Random, b: &Beam, number: usize) -> Value {
    let gap = b.height * r.log(1e-3, 3.0);
    let side = r.sign();
    let smoothing = b.height * r.log(1e-3, 1e-1);
    let mut wall = json!({
        "name": format!("wall-{number}"),
        "point_m": [short(-side * (gap + 0.5 * b.height)), short(b.length)],
        "normal": [side, short(r.between(-0.3, 0.3))],
        "smoothing_m": short(smoothing)
    });
    // Stiff against the beam: EI/l^4 of deflections, EI/l^3 of a force at a place.
    let stiff = r.log(1e1, 1e5);
    if r.one_in(2) {
        wall["at"] = json!(*r.choose(&[0.5, 0.9, 1.0]));
        wall["stiffness_n_m"] = short(stiff * b.ei / b.length.powi(3));
    } else {
        wall["stiffness_pa"] = short(stiff * b.ei / b.length.powi(4));
    }
    let speed = b.height / b.times.period;
    if r.one_in(2) {
        wall["damping_s_m"] = short(r.log(1e-2, 1.0) / speed);
    }
    if r.one_in(3) {
        wall["friction_coefficient"] = short(r.between(0.05, 1.0));
        wall["friction_velocity_m_s"] = short(speed * r.log(1e-2, 1.0));
    }
    wall
}

/// A bladder's end that nothing is joined to, and a vessel at a junction with a supply, joined by a tube with a valve or a pump.
fn supplied(r: &mut Random, b: &Beam, case: &mut Value) {
    let pressure = network::pressure(case) * 0.3;
    let size = |case: &Value, key: &str| case["bladders"][key].as_f64().expect("a number");
    let compliance = size(case, "area_per_pressure_m2_per_pa") * size(case, "length_m");
    let (length, radius) = (
        case["tubes"]["length_m"].as_f64().expect("a length"),
        case["tubes"]["radius_m"].as_f64().expect("a radius"),
    );
    let viscosity = case["fluid"]["viscosity_pa_s"].as_f64().expect("a viscosity");
    let conductance = std::f64::consts::PI * radius.powi(4) / (8.0 * viscosity * length);
    let per_row = case["bladders"]["per_row"].as_i64().expect("a number");
    // every bladder on its own, joined to the vessel's junction
    case["network"] = json!({"chains": [], "junctions": ["vessel"], "tubes": []});
    for k in 0..1 + r.below(2 * per_row as usize) as i64 {
        let bladder = if k < per_row { k + 1 } else { per_row - k - 1 };
        let ends = [
            json!({"bladder": bladder, "end": *r.choose(&["inlet", "outlet"])}),
            json!({"junction": "vessel"}),
        ];
        let way = r.below(2);
        let mut tube = json!({"from": ends[way], "to": ends[1 - way]});
        match r.below(4) {
            0 | 1 => {
                tube["check_valve"] = json!({
                    "cracking_pressure_pa": if r.one_in(2) { json!(0.0) } else { short(pressure * r.log(1e-3, 1.0)) },
                    "forward_conductance_m3_s_pa": short(conductance * r.log(1e-1, 1e2)),
                    "reverse_conductance_m3_s_pa": short(conductance * r.log(1e-8, 1e-2)),
                    "smoothing_pa": short(pressure * r.log(1e-4, 1e-1))
                });
            }
            2 => {
                tube["pump"] = json!({"pressure_pa": signals::load(r, b.times, pressure), "resistance_pa_s_m3": short(r.log(1e-1, 1e1) / conductance)});
            }
            _ => {}
        }
        case["network"]["tubes"].as_array_mut().expect("tubes").push(tube);
    }
    let compressed = ["kind", "bulk_modulus_pa", "gas_fraction"]
        .iter()
        .any(|key| case["fluid"].get(key).is_some());
    let room = short(compliance * 1e5 * r.log(1e-1, 1e2));
    let kind = match r.below(if compressed { 3 } else { 2 }) {
        0 => {
            let mut elastic = json!({"compliance_m3_pa": short(compliance * r.log(1e-1, 1e2))});
            if compressed {
                elastic["volume_m3"] = room;
            }
            json!({"elastic": elastic})
        }
        2 => json!({"tank": {"volume_m3": room}}),
        _ => {
            json!({"gas": {"volume_m3": short(compliance * 1e5 * r.log(1.0, 1e2)), "polytropic_exponent": short(r.between(1.0, 1.4))}})
        }
    };
    case["network"]["accumulators"] = json!([{"name": "vessel", "at": {"junction": "vessel"}, "kind": kind,
        "start_pressure_pa": if r.one_in(2) { json!(0.0) } else { short(pressure * r.between(0.0, 1.0)) }}]);
    if r.one_in(2) {
        let volume = compliance * pressure * r.between(0.1, 2.0);
        let duration = b.times.end * r.between(0.1, 0.9);
        case["network"]["ports"] = json!([{"name": "syringe", "at": {"junction": "vessel"},
            "volume_m3": {"ramp": {"from": 0.0, "to": short(volume), "start_s": 0.0, "duration_s": short(duration), "shape": "smooth"}}}]);
    }
    // half of the pumps get a curve, which may rise; the vessel may be at another height
    for tube in case["network"]["tubes"].as_array_mut().expect("tubes") {
        if !tube["pump"].is_null() && r.one_in(2) {
            let flow = conductance * pressure;
            let points = [0.0, 0.3, 0.7, 1.0].map(|x| short(flow * x));
            let pressures = [1.0, r.between(0.5, 1.2), r.between(0.2, 1.0), 0.0].map(|x| short(pressure * x));
            tube["pump"] = json!({"curve": {"flow_m3_s": points, "pressure_pa": pressures, "factor": signals::load(r, b.times, 1.0)}});
        }
    }
    let density = case["fluid"]["density_kg_m3"].as_f64().unwrap_or(0.0);
    if density > 1.0 && r.one_in(3) {
        let height = (pressure * r.between(-1.0, 1.0) / (9.81 * density)).clamp(-1e4, 1e4);
        case["network"]["elevations"] = json!([{"junction": "vessel", "elevation_m": short(height)}]);
    }
}
