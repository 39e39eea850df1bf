//! Random functions of place: broad, narrow and oscillating ones.

use serde_json::{Value, json};

use crate::chance::Random;
use crate::digits::short;

/// A shape of a load of about unit mean: narrow ones are as much higher as they are narrower.
pub fn profile(r: &mut Random, sane: bool) -> Value {
    if sane {
        return match r.below(3) {
            0 => json!(1.0),
            1 => json!({"polynomial": {"coefficients": [short(r.between(0.0, 1.0)), short(r.between(-1.0, 1.0))]}}),
            _ => json!({"cosine": {"waves": short(r.between(0.0, 1.5))}}),
        };
    }
    match r.below(9) {
        0 => json!(1.0),
        1 => wave(r),
        2 | 3 => pad(r),
        4 => json!({"polynomial": {"coefficients":
            (0..2 + r.below(4)).map(|_| short(r.between(-1.0, 1.0))).collect::<Vec<_>>()}}),
        5 => table(r),
        // A narrow load beside a broad one of the other sign.
        6 => json!({"sum": [short(-r.between(0.3, 1.2)), pad(r)]}),
        7 => json!({"sum": [wave(r), profile(r, true)]}),
        _ => json!({"product": [wave(r), profile(r, true)]}),
    }
}

/// Up to 30 waves; often a whole number, which a mesh may see as one that does not change.
fn wave(r: &mut Random) -> Value {
    let waves = if r.one_in(2) {
        json!(*r.choose(&[1.0, 2.0, 4.0, 8.0, 10.0, 12.0, 16.0, 20.0, 30.0]))
    } else {
        short(r.between(0.0, 30.0))
    };
    let mut wave = json!({ "waves": waves });
    if r.one_in(2) {
        wave["phase_rad"] = short(r.between(0.0, 6.2));
    }
    let form = *r.choose(&["cosine", "sine"]);
    json!({ form: wave })
}

/// A pad of 1 % to 40 % of the length, anywhere.
fn pad(r: &mut Random) -> Value {
    let width = r.log(0.01, 0.4);
    let start = r.between(0.0, 1.0) * (1.0 - width);
    let edge = width * r.between(0.01, 0.4);
    let height = short(r.sign() / width);
    json!({"table": {
        "positions": [start, start + edge, start + width - edge, start + width], "values": [0.0, height, height, 0.0],
        "interpolation": "linear"
    }})
}

fn table(r: &mut Random) -> Value {
    let count = 2 + r.below(6);
    let mut at: Vec<f64> = (0..count).map(|_| r.between(0.0, 1.0)).collect();
    at.sort_by(f64::total_cmp);
    at.dedup_by(|b, a| *b - *a < 3e-3);
    let values: Vec<Value> = at.iter().map(|_| short(r.between(-1.0, 1.0))).collect();
    let interpolation = *r.choose(&["linear", "monotone", "cubic"]);
    json!({"table": {"positions": at, "values": values, "interpolation": interpolation}})
}

/// A shape at the start with nothing at either end, whatever holds it: `x^2 (1 - x)^2`, alone or times waves.
pub fn at_rest_at_its_ends(r: &mut Random, size: f64, sane: bool) -> Value {
    // Few binary digits, so that the sum at the end is nothing.
    let a = 2f64.powf((16.0 * size).log2().floor()) * r.choose(&[1.0, 1.25, 1.5, 1.75]);
    let hump = json!({"polynomial": {"coefficients": [0.0, 0.0, a, -2.0 * a, a]}});
    if sane || r.one_in(2) {
        return hump;
    }
    let waves = if r.one_in(2) {
        1.0 + r.below(8) as f64
    } else {
        r.between(0.5, 6.0)
    };
    json!({"product": [hump, {"sine": {"waves": short(waves)}}]})
}
