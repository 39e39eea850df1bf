//! Random functions of time, nested up to three deep.

use serde_json::{Value, json};

use crate::chance::Random;
use crate::digits::short;

/// Times that signals of a scene are drawn by.
#[derive(Clone, Copy)]
pub struct Times {
    /// First period of the beam, or in slow runs a good part of the run [s].
    pub period: f64,
    /// Length of the run [s].
    pub end: f64,
    /// Only what a user of such a beam would usually ask for: no pulses, nothing faster than a fifth of the period.
    pub sane: bool,
}

/// A load, pressure or flow of about the given size, with jumps, pulses and waves.
pub fn load(r: &mut Random, t: Times, size: f64) -> Value {
    let amplitude = size * r.sign() * r.log(0.02, 1.0);
    if t.sane {
        return quiet(r, t, amplitude);
    }
    let deep = [0, 0, 0, 1, 1, 2, 3][r.below(7)];
    nested(r, t, amplitude, deep)
}

/// What is smooth on the scale of the beam.
fn quiet(r: &mut Random, t: Times, a: f64) -> Value {
    match r.below(4) {
        0 => short(a),
        1 => {
            let duration = t.period * r.log(0.2, 2.0);
            ramp(r, a, 0.0, duration, "smooth")
        }
        2 => table(r, t, a, 4),
        _ => sine(a, r.log(0.2, 3.0) / t.period, 0.0, 1.0 + r.below(2) as f64),
    }
}

/// A sum or product of signals one level less deep, down to a plain one.
fn nested(r: &mut Random, t: Times, a: f64, deep: usize) -> Value {
    if deep == 0 {
        return plain(r, t, a);
    }
    if r.one_in(2) {
        let terms: Vec<Value> = (0..2 + r.below(2))
            .map(|_| {
                let part = a * r.between(-1.0, 1.0);
                nested(r, t, part, deep - 1)
            })
            .collect();
        json!({ "sum": terms })
    } else {
        let (other, one) = (r.below(deep), nested(r, t, a, deep - 1));
        json!({"product": [one, nested(r, t, 1.0, other)]})
    }
}

fn plain(r: &mut Random, t: Times, a: f64) -> Value {
    let end = t.end;
    match r.below(12) {
        0 => short(a),
        1 | 2 => {
            let phase = if r.one_in(2) { 0.0 } else { r.between(0.0, 6.2) };
            sine(a, r.log(0.2, 20.0) / t.period, phase, [0.0, 0.0, 1.0, 2.5][r.below(4)])
        }
        // As many cycles as samples might be taken of it.
        3 => sine(a, *r.choose(&[10.0, 25.0, 50.0, 100.0]) / end, 0.0, 0.0),
        4 => sigmoid(r, t, a),
        5 | 6 => {
            let shape = *r.choose(&["linear", "smooth"]);
            let (start, duration) = (end * r.between(0.0, 0.9), sudden(r, end));
            ramp(r, a, start, duration, shape)
        }
        7 => {
            let coefficients: Vec<Value> = (0..2 + r.below(4))
                .map(|k| short(a * r.between(-1.0, 1.0) / end.powi(k as i32)))
                .collect();
            json!({"polynomial": {"coefficients": coefficients}})
        }
        8 => {
            let count = 2 + r.below(6);
            table(r, t, a, count)
        }
        _ => pulse(r, t, a),
    }
}

fn sine(a: f64, frequency: f64, phase: f64, ramp_cycles: f64) -> Value {
    let mut sine = json!({"amplitude": short(a), "frequency_hz": short(frequency)});
    if phase != 0.0 {
        sine["phase_rad"] = short(phase);
    }
    if ramp_cycles != 0.0 {
        sine["ramp_cycles"] = json!(ramp_cycles);
    }
    json!({ "sine": sine })
}

fn sigmoid(r: &mut Random, t: Times, a: f64) -> Value {
    // A largest step that goes by the steepness would else make the run long.
    let most = if r.one_in(6) { 3e2 } else { 5e1 };
    let steepness = r.log(1.0, most) / t.end;
    json!({"sigmoid": {
        "amplitude": short(a), "steepness_per_s": short(steepness), "midpoint_s": short(t.end * r.between(0.05, 0.95))
    }})
}

/// How long a change takes: nothing, 0.1 ms, or 1e-5 of the run to all of it [s].
fn sudden(r: &mut Random, end: f64) -> f64 {
    match r.below(5) {
        0 => 0.0,
        1 => 1e-4_f64.min(0.1 * end),
        _ => end * r.log(1e-5, 1.0),
    }
}

fn ramp(r: &mut Random, a: f64, start: f64, duration: f64, shape: &str) -> Value {
    let mut ramp = json!({"to": short(a), "duration_s": short(duration)});
    if start > 0.0 {
        ramp["start_s"] = short(start);
    }
    if shape == "linear" {
        ramp["shape"] = json!(shape);
    }
    if r.one_in(4) {
        ramp["from"] = short(a * r.between(-0.5, 0.5));
    }
    json!({ "ramp": ramp })
}

/// Points anywhere in the run, now and then close to each other.
fn table(r: &mut Random, t: Times, a: f64, count: usize) -> Value {
    let (mut at, mut times, mut values) = (0.0, vec![], vec![]);
    let interpolation = *r.choose(&["linear", "monotone", "cubic"]);
    for k in 0..count {
        let least = if t.sane || interpolation != "linear" { 0.2 } else { 1e-3 };
        at += t.end * r.log(least, 1.0) / count as f64 * if k == 0 { 0.0 } else { 1.0 };
        times.push(short(at));
        values.push(short(a * r.between(-1.0, 1.0)));
    }
    if t.sane {
        values[0] = json!(0.0);
    }
    json!({"table": {"times_s": times, "values": values, "interpolation": interpolation}})
}

/// There and back again, anywhere, as narrow as 1e-5 of the run.
fn pulse(r: &mut Random, t: Times, a: f64) -> Value {
    let width = t.end * r.log(1e-5, 0.2);
    let start = r.between(0.02, 0.95) * (t.end - width);
    let last = start + width;
    match r.below(5) {
        0 | 1 => {
            let edge = width * r.between(0.1, 0.5);
            json!({"table": {
                "times_s": [start, start + edge, last - 0.99 * edge, last], "values": [0.0, short(a), short(a), 0.0],
                "interpolation": "linear"
            }})
        }
        2 | 3 => {
            let edge = width * r.between(0.0, 0.5);
            json!({"sum": [
                {"ramp": {"to": short(a), "start_s": start, "duration_s": edge}},
                {"ramp": {"to": short(-a), "start_s": last - edge, "duration_s": edge}}
            ]})
        }
        _ => {
            // A smooth one: no switching time marks it. Rarely narrow, for the sake of the cost.
            let least = if r.one_in(4) { 3e-3 } else { 5e-2 };
            let width = t.end * r.log(least, 0.4);
            json!({"product": [
                {"sigmoid": {"amplitude": short(a), "steepness_per_s": short(12.0 / width), "midpoint_s": start}},
                {"sigmoid": {"amplitude": 1.0, "steepness_per_s": short(-12.0 / width), "midpoint_s": start + 0.7 * width}}
            ]})
        }
    }
}

/// A motion that starts from zero without a jump.
pub fn motion(r: &mut Random, t: Times, size: f64) -> Value {
    let a = size * r.sign() * r.log(0.02, 1.0);
    let (slow, fast) = if t.sane { (0.3, 2.0) } else { (0.02, 5.0) };
    match r.below(if t.sane { 2 } else { 5 }) {
        0 => {
            let ramps = if t.sane { 1 + r.below(2) } else { r.below(3) };
            sine(a, r.log(0.2, fast) / t.period, 0.0, ramps as f64)
        }
        1 => {
            let start = if r.one_in(2) { 0.0 } else { t.end * r.between(0.0, 0.5) };
            json!({"ramp": {"to": short(a), "start_s": short(start), "duration_s": short(t.period * r.log(slow, 1.0))}})
        }
        2 => json!({"product": [motion(r, t, size), {"sine": {
            "amplitude": 1.0, "frequency_hz": short(r.log(0.2, 5.0) / t.period), "phase_rad": short(r.between(0.0, 6.0))
        }}]}),
        3 => json!({"sum": [motion(r, t, 0.5 * size), motion(r, t, 0.5 * size)]}),
        _ => {
            // A pulse of motion.
            let duration = t.period * r.log(slow, 0.5);
            let start = t.end * r.between(0.0, 0.7);
            let back = 1.0 - r.between(0.1, 0.99);
            json!({"product": [
                {"ramp": {"to": short(a), "start_s": start, "duration_s": duration}},
                {"ramp": {"from": 1.0, "to": short(back), "start_s": start + duration, "duration_s": duration}}
            ]})
        }
    }
}

/// The opening of a valve, 0 to 1.
pub fn opening(r: &mut Random, t: Times) -> Value {
    let start = t.end * r.between(0.0, 0.8);
    let duration = t.end * r.log(if t.sane { 1e-2 } else { 1e-5 }, 0.5);
    match r.below(5) {
        0 => short(r.between(0.0, 1.0)),
        1 => json!({"ramp": {"from": 1.0, "to": 0.0, "start_s": start, "duration_s": duration}}),
        2 => json!({"ramp": {"to": 1.0, "start_s": start, "duration_s": duration, "shape": "linear"}}),
        3 => {
            let frequency = r.log(0.2, if t.sane { 1.0 } else { 5.0 }) / t.period;
            json!({"sum": [0.5, {"sine": {"amplitude": 0.5, "frequency_hz": short(frequency)}}]})
        }
        _ => json!({"table": {
            "times_s": [start, start + duration, start + 1.5 * duration, start + 2.5 * duration],
            "values": [0.0, 1.0, 1.0, 0.0], "interpolation": "linear"
        }}),
    }
}
