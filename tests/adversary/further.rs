//! Further effects of a scene: what is attached, what is around, axes that turn, a solid that relaxes, is curved at rest or shears, fluid that is compressed.

use std::f64::consts::PI;

use serde_json::{Map, Value, json};

use crate::chance::Random;
use crate::digits::short;
use crate::network;
use crate::profiles;
use crate::scene::Beam;
use crate::signals;

/// Adds one of them at least.
pub fn add(r: &mut Random, b: &Beam, case: &mut Value, wet: bool) {
    let first = r.below(if wet { 6 } else { 5 });
    let mut takes = |which: usize| which == first || r.one_in(5);
    let [attached, around, relaxing, curved, sheared] = [0, 1, 2, 3, 4].map(&mut takes);
    let compressed = wet && takes(5);
    if attached {
        case["attachments"] = (0..1 + r.below(2)).map(|_| attachment(r, b)).collect();
    }
    if around {
        case["surroundings"] = surroundings(r, b);
    }
    if relaxing {
        case["beam"]["viscoelasticity"] = viscoelasticity(r, b);
    }
    if curved {
        let signal = signals::load(r, b.times, 0.5 / b.length);
        let load = json!({"rest_curvature_1_m": {"signal": signal, "profile": profiles::profile(r, b.times.sane)}});
        case["loads"].as_array_mut().expect("loads").push(load);
        case.as_object_mut().expect("a case").remove("formulation");
    }
    if sheared {
        case["beam"]["shear_stiffness_n"] = short(b.ea * r.log(0.02, 0.5));
        case.as_object_mut().expect("a case").remove("formulation");
    }
    if compressed {
        let pressure = network::pressure(case);
        let fluid = case["fluid"].as_object_mut().expect("a fluid");
        fluid.extend(compression(r, pressure));
    }
    // bodies that turn must not be near the borders of spans
    if !attached && r.one_in(3) {
        spans(r, b, case);
    }
    if r.one_in(4) {
        case["foundation"] = json!({"stiffness_x_n_m2": short(b.ei / b.length.powi(4) * r.log(1.0, 1e3))});
    }
    if !around && r.one_in(4) {
        rotating_frame(r, b, case);
    }
    if r.one_in(4) {
        unlike_halves(r, b, case);
    }
    if wet && r.one_in(4) {
        let own = case["bladders"]["area_per_pressure_m2_per_pa"]
            .as_f64()
            .expect("an area");
        case["bladders"]["area_per_other_pressure_m2_per_pa"] = short(own * r.between(-0.4, 0.4));
    }
    if r.one_in(4) {
        moment_curvature(r, b, case);
    }
}

/// A law that softens or stiffens up to a few times, of the same slope at zero; odd or not.
fn moment_curvature(r: &mut Random, b: &Beam, case: &mut Value) {
    let size = r.log(0.03, 1.0) / b.length;
    let side = |r: &mut Random, sign: f64| {
        let (mut curvature, mut moment) = (0.0, 0.0);
        let mut slope = b.ei;
        let point = |_| {
            let step = size * r.log(0.5, 2.0);
            curvature += step;
            moment += slope * step;
            slope = b.ei * r.log(0.2, 4.0);
            [sign * curvature, sign * moment]
        };
        (0..4).map(point).collect::<Vec<_>>()
    };
    let mut points = vec![[0.0; 2]];
    points.extend(side(r, 1.0));
    if r.one_in(2) {
        let mut below = side(r, -1.0);
        below.reverse();
        points.splice(0..0, below);
    }
    let [curvature, moment] = [0, 1].map(|k| points.iter().map(|point| short(point[k])).collect::<Vec<_>>());
    case.as_object_mut().expect("a case").remove("formulation");
    case["beam"]["bending_stiffness_factor"] = json!(1);
    case["beam"]["moment_curvature"] = json!({"curvature_1_m": curvature, "moment_n_m": moment});
}

/// A neutral axis beside mid-height, with the beam's line there or at mid-height, and a softer lower row.
fn unlike_halves(r: &mut Random, b: &Beam, case: &mut Value) {
    let published = case.pointer("/bladders/coupling/published").is_some();
    let relaxes = case["beam"].get("viscoelasticity").is_some();
    case.as_object_mut().expect("a case").remove("formulation");
    case["beam"]["neutral_axis_m"] = short(b.height * r.between(-0.3, 0.3));
    if !relaxes && r.one_in(2) {
        case["beam"]["reference_axis_m"] = json!(0);
    }
    let area = case
        .pointer("/bladders/area_per_pressure_m2_per_pa")
        .and_then(Value::as_f64);
    if let Some(area) = area.filter(|_| !published) {
        let row = json!({"area_per_pressure_m2_per_pa": short(area * r.log(1.0, 5.0))});
        case["bladders"]["lower"] = json!({"unlike": row});
    }
}

/// A hub that turns up to a few times as fast as the beam swings; what would not turn with it is taken away.
fn rotating_frame(r: &mut Random, b: &Beam, case: &mut Value) {
    let speed = (b.ei / b.mass).sqrt() / (b.length * b.length) * r.log(0.03, 6.0);
    let hub = json!([
        short(b.length * r.between(-0.2, 0.2)),
        short(-b.length * r.between(0.0, 1.0))
    ]);
    let turns = match r.below(3) {
        0 => short(speed * r.sign()),
        _ => signals::motion(r, b.times, speed),
    };
    case["rotating_frame"] = json!({"angular_velocity_rad_s": turns});
    if r.one_in(2) {
        case["rotating_frame"]["center_m"] = hub;
    }
    let fields = case.as_object_mut().expect("a case");
    fields.remove("formulation");
    let loads = fields["loads"].as_array_mut().expect("loads");
    loads.retain(|load| load.get("gravity").is_none());
    if let Some(damping) = case["beam"].get_mut("damping").and_then(Value::as_object_mut) {
        damping.remove("drag_n_s_m2");
    }
}

/// Two or three spans of other materials, some of them tapered or with segments of their own length.
fn spans(r: &mut Random, b: &Beam, case: &mut Value) {
    let count = |at: &str| case.pointer(at).and_then(Value::as_u64);
    let segments = count("/bladders/per_row").or(count("/mesh/segments")).unwrap_or(10);
    if segments < 4 {
        return;
    }
    let pitch = b.length / segments as f64;
    let span = |r: &mut Random, length: Option<u64>| {
        let modulus = case["beam"]["young_modulus_pa"].as_f64().expect("a modulus") * r.log(0.2, 20.0);
        let mut one = json!({"beam": {"young_modulus_pa": short(modulus)}});
        if r.one_in(3) {
            one["beam"]["height_m"] = json!({"linear": [b.height, b.height * r.between(1.0, 1.4)]});
        }
        if let Some(length) = length {
            one["length_m"] = json!(length as f64 * pitch);
        }
        one
    };
    let first = 1 + r.below(segments as usize / 2) as u64;
    let mut all = vec![span(r, Some(first)), span(r, None)];
    if r.one_in(2) {
        all.push(span(r, Some(1)));
    }
    if r.one_in(3) {
        let own = pitch * r.between(0.7, 1.3);
        let rest = (b.length - first as f64 * own) / (segments - first) as f64;
        let last = all.len() - 1;
        all[0]["length_m"] = json!(first as f64 * own);
        all[0]["segments"] = json!(first);
        if last == 2 {
            all[last]["length_m"] = json!(rest);
            all[last]["segments"] = json!(1);
        }
        if let Some(width) = case.pointer("/bladders/width_m").and_then(Value::as_f64) {
            all[0]["bladders"] = json!({"width_m": short(width.min(0.9 * own))});
            for one in &mut all[1..] {
                one["bladders"] = json!({"width_m": short(width.min(0.9 * rest))});
            }
        }
    }
    case["spans"] = json!(all);
}

fn attachment(r: &mut Random, b: &Beam) -> Value {
    let at = *r.choose(&[0.0, 0.25, 0.5, 0.8, 1.0, 1.0]);
    let (k, m) = (b.ei / b.length.powi(3), b.mass * b.length);
    let time = b.times.period;
    let mut one = json!({"at": at});
    match r.below(6) {
        0 => one["stiffness_x_n_m"] = short(k * r.log(0.1, 1e3)),
        1 => one["stiffness_rotation_n_m_rad"] = short(k * b.length * b.length * r.log(0.1, 1e3)),
        2 => one["stiffness_z_n_m"] = short(b.ea / b.length * r.log(1e-3, 1e1)),
        3 => one["damping_x_n_s_m"] = short(m / time * r.log(1e-2, 1e1)),
        4 => one["force_x_n"] = signals::load(r, b.times, b.ei / (b.length * b.length)),
        _ => one["mass_kg"] = short(m * r.log(1e-2, 3.0)),
    }
    if r.one_in(3) {
        one["mass_kg"] = short(m * r.log(1e-2, 3.0));
    }
    if r.one_in(5) {
        let key = *r.choose(&["force_tangential_n", "force_normal_n"]);
        one[key] = signals::load(r, b.times, b.ei / (b.length * b.length));
    }
    if one.get("mass_kg").is_some() && r.one_in(3) {
        one["rotary_inertia_kg_m2"] = short(m * b.length * b.length * r.log(1e-4, 1e-1));
        let key = *r.choose(&["offset_across_m", "offset_along_m"]);
        one[key] = short(r.sign() * b.length * r.log(1e-3, 0.3));
    }
    one
}

fn surroundings(r: &mut Random, b: &Beam) -> Value {
    // added mass over that of the beam
    let density = r.log(1e-2, 1e1) * b.mass / (0.25 * PI * b.width * b.width);
    let mut around = json!({"density_kg_m3": short(density), "drag_coefficient": short(r.between(0.0, 2.5))});
    if r.one_in(3) {
        around["added_mass_coefficient"] = json!(0.0);
    }
    if r.one_in(3) {
        let speed = (b.ei / (b.length.powi(3) * density * b.width)).sqrt().min(100.0);
        around["stream_x_m_s"] = signals::load(r, b.times, 0.5 * speed);
    }
    if r.one_in(5) {
        around["stream_z_m_s"] = short(0.3 * (b.length / b.times.period).min(100.0));
    }
    around
}

fn viscoelasticity(r: &mut Random, b: &Beam) -> Value {
    if r.one_in(3) {
        let from = r.log(1e-2, 1.0) / b.times.period;
        let band = r.log(2.0, 1e3);
        return json!({"loss_factor": {"value": short(r.log(1e-2, 0.4)), "from_hz": short(from), "to_hz": short(from * band)}});
    }
    let branch = |r: &mut Random| {
        let time = b.times.period * r.log(1e-3, 1e2);
        json!({"modulus_ratio": short(r.log(1e-2, 5.0)), "time_s": short(time)})
    };
    json!({"prony": (0..1 + r.below(3)).map(|_| branch(r)).collect::<Vec<_>>()})
}

pub fn compression(r: &mut Random, pressure: f64) -> Map<String, Value> {
    let ambient = short((10.0 * pressure).max(1e5));
    let fluid = match r.below(3) {
        0 => json!({"bulk_modulus_pa": short(pressure * r.log(3.0, 1e4))}),
        1 => json!({"gas_fraction": short(r.log(1e-3, 0.5)), "ambient_pressure_pa": ambient}),
        _ => json!({"kind": "gas", "ambient_pressure_pa": ambient, "polytropic_exponent": *r.choose(&[1.0, 1.4])}),
    };
    fluid.as_object().expect("an object").clone()
}
