//! Random scenes with what few samples miss: pulses, sudden ramps, narrow and oscillating loads, switching.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};

use crate::chance::Random;

/// Kinds of scenes, each once in as many.
pub const KINDS: [&str; 8] = ["smooth", "sudden", "pulse", "narrow", "waves", "driven", "held", "wet"];

/// The scene of a number, and its kind.
pub fn scene(number: u64) -> (&'static str, Case) {
    let kind = KINDS[number as usize % KINDS.len()];
    let text = text(&mut Random(number), kind).to_string();
    let path = Path::new("scene.json");
    match case::parse(&text, path, path, &[]) {
        Ok(case) => (kind, case),
        Err(error) => panic!("{error}: {error:?}\n{text}"),
    }
}

fn text(r: &mut Random, kind: &str) -> Value {
    let length = r.log(0.05, 0.5);
    let height = length / r.log(15.0, 40.0);
    let width = height * r.log(1.0, 4.0);
    let (modulus, density) = (r.log(1e5, 1e9), r.between(800.0, 2000.0));
    let ei = modulus * width * height.powi(3) / 12.0;
    let mass = density * width * height;
    let time = (mass * length.powi(4) / ei).sqrt();
    let period = 2.0 * PI * time / 3.516;
    // Runs of a few periods, or so long that inertia hardly matters to what is smooth.
    let end = period
        * if r.between(0.0, 1.0) < 0.5 {
            r.log(0.5, 3.0)
        } else {
            r.log(10.0, 60.0)
        };
    let share = r.log(0.003, 0.3);
    let force = share * ei / length.powi(2);
    let load = 2.0 * force / length;
    let smooth = |r: &mut Random, size: f64| {
        if r.between(0.0, 1.0) < 0.5 {
            json!({"sine": {"amplitude": size, "frequency_hz": r.log(0.5, 3.0) / end, "ramp_cycles": 1}})
        } else {
            json!({"ramp": {"to": size, "duration_s": end * r.between(0.3, 1.0)}})
        }
    };
    let sudden = |r: &mut Random, size: f64| json!({"ramp": {"to": size, "start_s": end * r.between(0.05, 0.6), "duration_s": end * r.log(1e-5, 1e-2)}});
    let pulse = |r: &mut Random, size: f64| {
        let (start, long) = (end * r.between(0.05, 0.6), end * r.log(1e-3, 3e-2));
        json!({"sum": [
            {"ramp": {"to": size, "start_s": start, "duration_s": 0.5 * long}},
            {"ramp": {"to": -size, "start_s": start + 0.5 * long, "duration_s": 0.5 * long}}
        ]})
    };
    let mut case = json!({
        "name": kind,
        "beam": {
            "length_m": length, "height_m": height, "width_m": width, "young_modulus_pa": modulus, "density_kg_m3": density,
            "damping": {"bending_time_s": time * r.log(3e-3, 3e-2), "axial_time_s": time * r.log(3e-3, 3e-2)}
        },
        "ends": {"root": "clamped", "tip": "free"},
        "mesh": {"segments": 4},
        "time": {"end_s": end, "output_interval_s": end / 1000.0}
    });
    match kind {
        "smooth" => {
            case["ends"]["tip"] = json!({"free": {"force_x_n": smooth(r, force), "force_z_n": smooth(r, force)}})
        }
        "sudden" => case["ends"]["tip"] = json!({"free": {"force_x_n": sudden(r, force)}}),
        "pulse" => {
            case["ends"]["tip"] =
                json!({"free": {"force_x_n": pulse(r, force), "moment_n_m": smooth(r, 0.3 * force * length)}})
        }
        "narrow" => {
            let (at, half) = (r.between(0.3, 0.9), 0.5 * r.log(0.01, 0.1));
            let pad = json!({"table": {
                "positions": [0.0, at - 1.1 * half, at - half, at + half, at + 1.1 * half, 1.0],
                "values": [0, 0, 1, 1, 0, 0], "interpolation": "linear"
            }});
            case["loads"] = json!([
                {"force_x_n_m": {"signal": smooth(r, load)}},
                {"force_x_n_m": {"signal": smooth(r, -0.2 * load / half), "profile": pad}}
            ]);
        }
        "waves" => {
            let waves = r.between(3.0, 20.0).round();
            case["loads"] = json!([
                {"force_x_n_m": {"signal": smooth(r, 3.0 * load), "profile": {"cosine": {"waves": waves}}}}
            ]);
        }
        "driven" => {
            let motion = json!({"ramp": {"to": 0.3 * share * length, "start_s": 0.1 * end, "duration_s": end * r.log(0.01, 0.5)}});
            case["ends"]["root"] = json!({"clamped": {"u1_m": motion}});
        }
        "held" => {
            case["ends"]["tip"] = if r.between(0.0, 1.0) < 0.5 {
                json!("clamped")
            } else {
                json!("guided")
            };
            case["loads"] = json!([{"force_x_n_m": {"signal": smooth(r, 5.0 * load)}}]);
        }
        _ => {
            wet(r, &mut case, [length, height, width, modulus], ei);
            let pressure = json!({"pressure_pa": pulse(r, 0.02 * modulus)});
            case["network"] = json!({"chains": [{"bladders": [1, 2, 3], "ends": [pressure, "sealed"]}]});
            case["ends"]["tip"] = json!({"free": {"force_x_n": smooth(r, force)}});
            case["mesh"] = json!({});
        }
    }
    case
}

/// Three bladders a row, with slopes well below passivity.
fn wet(r: &mut Random, case: &mut Value, [length, height, width, modulus]: [f64; 4], ei: f64) {
    let (high, wide, long) = (0.3 * height, 0.6 * width, (0.25 * length).min(0.9 * width));
    let per_pressure = high * wide / modulus * r.log(1.0, 10.0);
    let (ea, ratio) = (modulus * height * width, 3.0 * long / length);
    let force = (0.1 * per_pressure / (2.0 * ea * ratio)).sqrt();
    let moment = (0.1 * per_pressure / (2.0 * ei * ratio)).sqrt();
    case["fluid"] = json!({"density_kg_m3": 1000.0, "viscosity_pa_s": r.log(1e-3, 1.0)});
    case["bladders"] = json!({
        "per_row": 3, "length_m": long, "height_m": high, "width_m": wide,
        "area_per_pressure_m2_per_pa": per_pressure,
        "area_per_moment_m2_per_n_m": {"opening": moment, "closing": moment},
        "area_per_force_m2_per_n": {"tension": force, "compression": force},
        "coupling": "reciprocal"
    });
    case["tubes"] = json!({"length_m": width, "radius_m": 0.2 * high});
}
