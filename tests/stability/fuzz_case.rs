//! Random plausible cases: every geometry, wiring, end, load, start, law and tolerance, within wide ranges.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::chance::Random;

/// Scales of the beam, to which the rest of the case is proportional.
struct Beam {
    length: f64,
    height: f64,
    width: f64,
    modulus: f64,
    ea: f64,
    ei: f64,
    mass: f64,
    /// First period of a cantilever [s].
    period: f64,
}

/// The text of a random case.
pub fn text(seed: u64) -> String {
    let r = &mut Random(seed);
    let (beam, mut case) = beam(r);
    let wet = !r.one_in(6);
    if wet {
        fluid(r, &beam, &mut case);
    }
    ends(r, &beam, &mut case);
    loads(r, &beam, &mut case);
    start(r, &beam, &mut case, wet);
    let end = beam.period * r.log(0.2, 3.0);
    case["time"] = json!({"end_s": end, "output_interval_s": end / 200.0});
    if r.one_in(2) {
        case["formulation"] = json!("published");
    }
    let choice = |r: &mut Random| ["auto", "on", "off"][r.below(3)];
    match r.below(4) {
        0 => case["effects"] = json!("full"),
        1 => {
            let inertia = if r.one_in(3) { "off" } else { "on" };
            case["effects"] = json!({"rotary_inertia": choice(r), "solid_inertia": inertia, "asymmetry": choice(r)});
        }
        _ => {}
    }
    case["mesh"] = json!({"cells_per_segment": 1 + r.below(6), "cells_per_bladder": 1 + r.below(4)});
    if !wet {
        case["mesh"]["segments"] = json!(1 + r.below(20));
    }
    case["solver"] = json!({"rtol": 10f64.powi(-3 - r.below(4) as i32)});
    serde_json::to_string_pretty(&case).expect("JSON")
}

fn beam(r: &mut Random) -> (Beam, Value) {
    let length = r.log(0.01, 10.0);
    let height = length / r.log(5.0, 500.0);
    let width = height * r.log(0.5, 5.0);
    let (modulus, density) = (r.log(1e4, 1e11), r.log(100.0, 8000.0));
    let (fe, fi) = (r.between(0.3, 1.0), r.between(0.3, 1.0));
    let (ea, ei) = (
        modulus * height * width * fe,
        modulus * width * height.powi(3) / 12.0 * fi,
    );
    let mass = density * width * height;
    let time = (mass * length.powi(4) / ei).sqrt();
    let mut case = json!({
        "name": "fuzz",
        "beam": {
            "length_m": length, "height_m": height, "width_m": width, "young_modulus_pa": modulus,
            "density_kg_m3": density, "axial_stiffness_factor": fe, "bending_stiffness_factor": fi
        }
    });
    if r.one_in(2) {
        case["beam"]["damping"] = json!({
            "axial_time_s": if r.one_in(2) { time * r.log(1e-5, 1e-1) } else { 0.0 },
            "bending_time_s": if r.one_in(2) { time * r.log(1e-5, 1e-1) } else { 0.0 },
            "drag_n_s_m2": if r.one_in(2) { mass / time * r.log(1e-3, 1e1) } else { 0.0 }
        });
    }
    (
        Beam {
            length,
            height,
            width,
            modulus,
            ea,
            ei,
            mass,
            period: 2.0 * PI * time / 3.516,
        },
        case,
    )
}

fn fluid(r: &mut Random, b: &Beam, case: &mut Value) {
    let per_row = 1 + r.below(12);
    let (height, width, length) = (
        b.height * r.between(0.05, 0.45),
        b.length / per_row as f64 * r.between(0.2, 0.95),
        b.width * r.between(0.3, 0.98),
    );
    let ratio = length * per_row as f64 / b.length;
    let ap = height * width / b.modulus * r.log(0.5, 50.0);
    // Slopes below passivity: `2 EA phi_b l_b aN+^2 = share a_p`, `EI phi_b l_b (aM+^2 + aM-^2) = share a_p`.
    let closing_n = (r.between(0.01, 0.6) * ap / (2.0 * b.ea * ratio)).sqrt();
    let closing_m = (r.between(0.01, 0.6) * ap / (2.0 * b.ei * ratio)).sqrt();
    let (down_n, down_m) = (r.between(0.4, 1.0), r.between(0.4, 1.0));
    let mean = |closing: f64, down: f64| 0.5 * closing * (1.0 + down);
    let coupling = match r.below(5) {
        0 | 1 => json!("reciprocal"),
        2 => json!("reciprocal_kinked"),
        _ => json!({"published": {
            "slope_per_pressure_rad": length * mean(closing_m, down_m) * b.modulus * r.log(0.01, 1.0),
            "length_per_pressure_m": length * mean(closing_n, down_n) * b.modulus * r.log(0.01, 1.0)
        }}),
    };
    let kink = if coupling == "reciprocal_kinked" {
        r.log(1e-2, 1.0)
    } else {
        r.log(1e-5, 1e-1)
    };
    case["fluid"] = json!({"density_kg_m3": r.between(0.0, 2000.0), "viscosity_pa_s": r.log(1e-5, 1e2)});
    case["bladders"] = json!({
        "per_row": per_row, "length_m": length, "height_m": height, "width_m": width,
        "area_per_pressure_m2_per_pa": ap,
        "area_per_moment_m2_per_n_m": {"opening": closing_m * down_m, "closing": closing_m},
        "area_per_force_m2_per_n": {"tension": closing_n * down_n, "compression": closing_n},
        "coupling": coupling, "kink_width": kink
    });
    if r.one_in(2) {
        case["bladders"]["permeability_m4"] = json!((height * width).powi(2) * r.log(1e-8, 1e-1));
    }
    case["tubes"] = json!({"length_m": b.width * r.log(0.1, 3.0), "radius_m": height * r.log(0.01, 0.5)});
    network(r, b, per_row, height * width, ap, case);
}

fn network(r: &mut Random, b: &Beam, per_row: usize, section: f64, ap: f64, case: &mut Value) {
    if r.one_in(10) {
        return;
    }
    let mut order: Vec<i64> = (1..=per_row as i64).flat_map(|k| [k, -k]).collect();
    for k in (1..order.len()).rev() {
        order.swap(k, r.below(k + 1));
    }
    if r.one_in(2) {
        order.sort_unstable();
    }
    // pressures that open or close a bladder by up to a third; flows that fill a third in a period
    let (pressure, flow) = (0.3 * section / ap, 0.3 * section * b.width / b.period);
    let (mut chains, mut ports, mut free) = (vec![], vec![], vec![]);
    let mut rest = order.as_slice();
    while !rest.is_empty() {
        let count = (1 + r.below(6)).min(rest.len());
        let (chain, later) = rest.split_at(count);
        rest = later;
        if r.one_in(6) {
            continue;
        }
        let mut ends = vec![];
        for (bladder, end) in [(chain[0], "inlet"), (chain[count - 1], "outlet")] {
            let point = json!({"bladder": bladder, "end": end});
            ends.push(match r.below(8) {
                0 => json!({"pressure_pa": signal(r, b, pressure)}),
                1 => json!({"flow_m3_s": signal(r, b, flow)}),
                2 => {
                    ports.push(json!({"at": point, "pressure_pa": signal(r, b, pressure)}));
                    json!("connected")
                }
                3 | 4 => {
                    free.push(point);
                    json!("connected")
                }
                _ => json!("sealed"),
            });
        }
        let mut chain = json!({"bladders": chain, "ends": ends});
        if r.one_in(5) {
            chain["opening"] = opening(r, b);
        }
        chains.push(chain);
    }
    let (mut junctions, mut tubes, mut turbines) = (vec![], vec![], vec![]);
    if free.len() >= 3 && r.one_in(2) {
        junctions.push(json!("tee"));
        for point in free.drain(..3) {
            tubes.push(json!({"from": point, "to": {"junction": "tee"}, "length_m": b.width * r.log(0.1, 3.0)}));
        }
    }
    while free.len() >= 2 {
        let (from, to) = (free.remove(0), free.remove(0));
        if r.one_in(2) {
            let mut tube = json!({"from": from, "to": to});
            if r.one_in(2) {
                tube["permeability_m4"] = json!(section * section * r.log(1e-10, 1e-1));
            }
            if r.one_in(3) {
                tube["opening"] = opening(r, b);
            }
            tubes.push(tube);
        } else {
            let conductance = flow / pressure * r.log(1e-3, 1e2);
            let rectifier = match r.below(2) {
                0 => json!("ideal"),
                _ => json!({"check_valves": {
                    "cracking_pressure_pa": pressure * r.between(0.0, 0.1),
                    "forward_conductance_m3_s_pa": conductance * r.log(1.0, 100.0),
                    "reverse_conductance_m3_s_pa": conductance * r.log(1e-5, 1e-1),
                    "smoothing_pa": pressure * r.log(1e-3, 1e-1)
                }}),
            };
            turbines.push(json!({
                "from": from, "to": to, "conductance": {"m3_s_pa": conductance}, "rectifier": rectifier
            }));
        }
    }
    for point in free {
        ports.push(json!({"at": point, "flow_m3_s": signal(r, b, flow)}));
    }
    case["network"] = json!({
        "permeability_factor": r.log(1e-4, 1e4), "chains": chains, "junctions": junctions, "tubes": tubes,
        "ports": ports, "turbines": turbines
    });
}

/// A signal of about the given size; its first second is scaled to the beam's period.
fn signal(r: &mut Random, b: &Beam, size: f64) -> Value {
    let amplitude = size * r.sign() * r.log(0.01, 1.0);
    let t = b.period;
    match r.below(7) {
        0 => json!(amplitude),
        1 => json!({"ramp": {"to": amplitude, "start_s": t * r.between(0.0, 0.3), "duration_s": 0}}),
        2 => json!({"ramp": {"to": amplitude, "duration_s": t * r.log(1e-6, 1.0), "shape": "linear"}}),
        3 => {
            json!({"sigmoid": {"amplitude": amplitude, "steepness_per_s": r.log(1.0, 1e3) / t, "midpoint_s": 0.3 * t}})
        }
        4 => {
            let values: Vec<f64> = (0..4).map(|_| amplitude * r.between(-1.0, 1.0)).collect();
            let kind = ["linear", "monotone", "cubic"][r.below(3)];
            json!({"table": {"times_s": [0.0, 0.1 * t, 0.2 * t, 0.5 * t], "values": values, "interpolation": kind}})
        }
        _ => json!({"sine": {"amplitude": amplitude, "frequency_hz": r.log(0.2, 10.0) / t, "ramp_cycles": r.below(2)}}),
    }
}

/// A motion that starts from zero without a jump.
fn motion(r: &mut Random, b: &Beam, size: f64) -> Value {
    let amplitude = size * r.sign() * r.log(0.01, 1.0);
    match r.below(3) {
        0 => json!({"ramp": {"to": amplitude, "duration_s": b.period * r.log(0.03, 1.0)}}),
        _ => json!({"sine": {
            "amplitude": amplitude, "frequency_hz": r.log(0.2, 3.0) / b.period, "ramp_cycles": r.below(2)
        }}),
    }
}

fn opening(r: &mut Random, b: &Beam) -> Value {
    match r.below(3) {
        0 => json!(0),
        1 => {
            json!({"ramp": {"from": 1, "to": 0, "start_s": 0.1 * b.period, "duration_s": b.period * r.log(1e-6, 1.0)}})
        }
        _ => json!({"ramp": {"to": 1, "start_s": 0.1 * b.period, "duration_s": b.period * r.log(1e-6, 1.0)}}),
    }
}

fn ends(r: &mut Random, b: &Beam, case: &mut Value) {
    let force = b.ei / (b.length * b.length);
    let held = |r: &mut Random| match r.below(3) {
        0 => json!({"clamped": {"u3_m": motion(r, b, 0.1 * b.length)}}),
        1 => json!({"clamped": {"u1_m": motion(r, b, 0.1 * b.length), "slope_rad": motion(r, b, 0.3)}}),
        _ => json!("clamped"),
    };
    let any = |r: &mut Random| match r.below(8) {
        0 => json!("free"),
        1 => json!("pinned"),
        2 => json!({"pinned": {"u1_m": motion(r, b, 0.1 * b.length)}}),
        3 => json!("guided"),
        4 => json!({"free": {"force_x_n": signal(r, b, 2.0 * force), "force_z_n": signal(r, b, 2.0 * force)}}),
        5 => json!({"free": {"moment_n_m": signal(r, b, 3.0 * force * b.length)}}),
        6 => {
            json!({"free": {"follower_normal_n": signal(r, b, 10.0 * force), "follower_shear_n": signal(r, b, force)}})
        }
        _ => json!({"conditions": {"u1_m": 0, "moment_n_m": 0, "force_z_n": signal(r, b, 2.0 * force)}}),
    };
    let (mut root, mut tip) = if r.one_in(5) {
        (any(r), any(r))
    } else {
        (held(r), any(r))
    };
    if r.one_in(2) {
        std::mem::swap(&mut root, &mut tip);
    }
    case["ends"] = json!({"root": root, "tip": tip});
}

fn loads(r: &mut Random, b: &Beam, case: &mut Value) {
    let per_length = b.ei / b.length.powi(3);
    let loads: Vec<Value> = (0..r.below(3))
        .map(|_| {
            let profile = match r.below(3) {
                0 => json!(1),
                1 => json!({"cosine": {"waves": r.between(0.0, 2.0)}}),
                _ => json!({"polynomial": {"coefficients": [0.2, r.between(-1.0, 1.0), r.between(-1.0, 1.0)]}}),
            };
            match r.below(5) {
                0 => json!({"force_z_n_m": {"signal": signal(r, b, 3.0 * per_length), "profile": profile}}),
                1 => json!({"moment_z_n": {"signal": signal(r, b, per_length * b.length), "profile": profile}}),
                2 => json!({"body_x_m_s2": {"signal": signal(r, b, 3.0 * per_length / b.mass)}}),
                3 => json!({"gravity": {"x_m_s2": r.between(-3.0, 3.0) * per_length / b.mass}}),
                _ => json!({"force_x_n_m": {"signal": signal(r, b, 4.0 * per_length), "profile": profile}}),
            }
        })
        .collect();
    case["loads"] = json!(loads);
}

fn start(r: &mut Random, b: &Beam, case: &mut Value, wet: bool) {
    let mut start = json!({});
    if r.one_in(4) {
        // x^2 (1 - x)^2: zero at both ends, for any support
        let a = b.length * r.log(1e-4, 1.0);
        start["u1_m"] = json!({"polynomial": {"coefficients": [0.0, 0.0, a, -2.0 * a, a]}});
    }
    if r.one_in(6) {
        let v = b.length / b.period * r.log(1e-3, 1.0);
        start["u1_rate_m_s"] = json!({"polynomial": {"coefficients": [0.0, 0.0, v, -2.0 * v, v]}});
    }
    if wet && r.one_in(3) {
        let bladders = &case["bladders"];
        let size = |key: &str| bladders[key].as_f64().unwrap_or(0.0);
        let pressure = 0.2 * size("height_m") * size("width_m") / size("area_per_pressure_m2_per_pa");
        start["pressures"] = json!([{"bladders": [1], "pressure_pa": pressure * r.between(-1.0, 1.0)}]);
    }
    case["start"] = start;
}
