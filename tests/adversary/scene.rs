//! A random scene: sizes over decades, wirings, ends, loads, starts; small enough to be run many times.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::chance::Random;
use crate::digits::short;
use crate::further;
use crate::graphs;
use crate::network;
use crate::parts;
use crate::profiles;
use crate::signals::{self, Times};

/// Sizes of the beam that the rest of the scene is drawn in proportion to.
pub struct Beam {
    /// Length [m].
    pub length: f64,
    /// Height [m].
    pub height: f64,
    /// Width [m].
    pub width: f64,
    /// Young's modulus [Pa].
    pub modulus: f64,
    /// Axial stiffness [N].
    pub ea: f64,
    /// Bending stiffness [N m^2].
    pub ei: f64,
    /// Mass per length [kg/m].
    pub mass: f64,
    /// Signals are drawn by these.
    pub times: Times,
}

/// Which scenes are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Everything the schema allows.
    Extreme,
    /// The same with further effects.
    Further,
    /// The same with walls and parts of networks.
    Parts,
    /// Graphs of beams, otherwise sane.
    Graph,
    /// Sizes and loads like those of the shipped cases.
    Sane,
}

/// The scene of a seed.
pub fn draw(seed: u64, kind: Kind) -> Value {
    let sane = matches!(kind, Kind::Sane | Kind::Graph);
    let r = &mut Random(seed.wrapping_mul(0x5851_F42D_4C95_7F2D) ^ if sane { 0x5A5A } else { 0 });
    let name = if sane { "sane" } else { "adversary" };
    let (b, mut case) = beam(r, sane);
    case["name"] = json!(format!("{name}-{seed}"));
    let wet = !r.one_in(3);
    if wet {
        network::fluid(r, &b, &mut case);
    }
    ends(r, &b, &mut case);
    loads(r, &b, &mut case);
    start(r, &b, &mut case, wet);
    case["time"] = json!({"end_s": short(b.times.end)});
    let end = case["time"]["end_s"].as_f64().unwrap_or(b.times.end);
    if !sane && r.one_in(3) {
        // Whole parts of the run, so that the last output is at its end.
        case["time"]["output_interval_s"] = json!(end / *r.choose(&[20.0, 50.0, 200.0]));
        case["time"]["window_s"] = json!(end / *r.choose(&[2.0, 5.0, 10.0]));
    }
    if r.one_in(3) {
        case["formulation"] = json!("published");
    }
    if !wet && !r.one_in(4) {
        case["mesh"] = json!({"segments": 1 + r.below(3)});
    }
    if kind == Kind::Further {
        further::add(r, &b, &mut case, wet);
    }
    if kind == Kind::Parts {
        parts::add(r, &b, &mut case, wet);
    }
    if kind == Kind::Graph {
        graphs::add(r, &b, &mut case, wet);
    }
    case
}

fn beam(r: &mut Random, sane: bool) -> (Beam, Value) {
    let pick = |r: &mut Random, tame: (f64, f64), wild: (f64, f64)| {
        let (low, high) = if sane { tame } else { wild };
        r.log(low, high)
    };
    let length = pick(r, (0.05, 0.5), (0.01, 10.0));
    let height = length / pick(r, (5.0, 30.0), (5.0, 200.0));
    let width = height * r.log(0.7, 4.0);
    let (modulus, density) = (pick(r, (3e5, 1e8), (1e4, 1e11)), r.log(500.0, 4000.0));
    let (fe, fi) = (r.between(0.4, 1.0), r.between(0.4, 1.0));
    let ea = modulus * height * width * fe;
    let ei = modulus * width * height.powi(3) / 12.0 * fi;
    let mass = density * width * height;
    let time = (mass * length.powi(4) / ei).sqrt();
    let period = 2.0 * PI * time / 3.516;
    // Slow long runs are those where inertia may be left out.
    let slow = r.one_in(4);
    let damped = slow || !r.one_in(8);
    let end = period
        * match (slow, damped) {
            (true, _) => r.log(10.0, 300.0),
            (_, true) => r.log(0.3, 3.0),
            _ => r.log(0.1, 1.0),
        };
    let mut case = json!({
        "name": "",
        "beam": {
            "length_m": short(length), "height_m": short(height), "width_m": short(width),
            "young_modulus_pa": short(modulus), "density_kg_m3": short(density),
            "axial_stiffness_factor": short(fe), "bending_stiffness_factor": short(fi)
        }
    });
    if damped {
        // Axial waves, which no one follows for their own sake, are damped within some of their periods.
        let axial = length * (mass / ea).sqrt() * r.log(0.05, 0.5);
        // A long run follows what is slow: what rings is gone within a few periods.
        let (least, most) = if slow { (0.1, 0.5) } else { (3e-3, 1e-1) };
        case["beam"]["damping"] = json!({
            "axial_time_s": short(axial), "bending_time_s": short(time * r.log(least, most)),
            "drag_n_s_m2": if r.one_in(2) { short(mass / time * r.log(1e-2, 1e1)) } else { json!(0.0) }
        });
    }
    let period = if slow { end * r.log(0.1, 0.5) } else { period };
    let times = Times { period, end, sane };
    let beam = Beam {
        length,
        height,
        width,
        modulus,
        ea,
        ei,
        mass,
        times,
    };
    (beam, case)
}

fn ends(r: &mut Random, b: &Beam, case: &mut Value) {
    let (force, t, l) = (b.ei / (b.length * b.length), b.times, b.length);
    let large = if t.sane { 0.03 } else { 0.1 };
    let held = |r: &mut Random| match r.below(6) {
        0 => json!({"clamped": {"u3_m": signals::motion(r, t, large * l)}}),
        1 => json!({"clamped": {"u1_m": signals::motion(r, t, large * l)}}),
        2 => json!({"clamped": {"slope_rad": signals::motion(r, t, 0.3)}}),
        _ => json!("clamped"),
    };
    let any = |r: &mut Random| match r.below(12) {
        0 | 1 => json!("free"),
        2 => json!("pinned"),
        3 => json!({"pinned": {"u1_m": signals::motion(r, t, large * l)}}),
        4 => json!({"pinned": {"moment_n_m": signals::load(r, t, force * l)}}),
        5 => json!({"guided": {"force_z_n": signals::load(r, t, force), "force_x_n": signals::load(r, t, force)}}),
        6 => json!({"free": {"force_x_n": signals::load(r, t, 2.0 * force)}}),
        7 => json!({"free": {"force_z_n": signals::load(r, t, 3.0 * force), "force_x_n": short(0.01 * force)}}),
        8 => json!({"free": {"moment_n_m": signals::load(r, t, 2.0 * force * l)}}),
        9 => json!({"free": {
            "follower_normal_n": signals::load(r, t, 5.0 * force), "follower_shear_n": signals::load(r, t, force)
        }}),
        10 => json!("clamped"),
        _ => json!({"conditions": {"u1_m": 0.0, "moment_n_m": 0.0, "force_z_n": signals::load(r, t, 2.0 * force)}}),
    };
    let (mut root, mut tip) = if !t.sane && r.one_in(8) {
        (any(r), any(r))
    } else {
        (held(r), any(r))
    };
    if !t.sane && r.one_in(3) {
        std::mem::swap(&mut root, &mut tip);
    }
    case["ends"] = json!({"root": root, "tip": tip});
}

fn loads(r: &mut Random, b: &Beam, case: &mut Value) {
    let q = b.ei / b.length.powi(3);
    let t = b.times;
    // Most scenes bend a little, some by as much as the length.
    let size = q * if t.sane { r.log(0.02, 2.0) } else { r.log(1e-3, 5.0) };
    let loads: Vec<Value> = (0..r.below(4))
        .map(|_| {
            let profile = profiles::profile(r, t.sane);
            let with = |signal: Value| json!({"signal": signal, "profile": profile});
            match r.below(8) {
                0 => json!({"force_z_n_m": with(signals::load(r, t, size))}),
                1 => json!({"moment_z_n": with(signals::load(r, t, 0.3 * size * b.length))}),
                2 => json!({"body_x_m_s2": with(signals::load(r, t, size / b.mass))}),
                3 => json!({"gravity": {"x_m_s2": short(r.between(-1.0, 1.0) * size / b.mass)}}),
                4 if !t.sane => json!({"moment_x_n": with(signals::load(r, t, 0.1 * size * b.length))}),
                5 if !t.sane => json!({"body_z_m_s2": with(signals::load(r, t, size / b.mass))}),
                _ => json!({"force_x_n_m": with(signals::load(r, t, 2.0 * size))}),
            }
        })
        .collect();
    case["loads"] = json!(loads);
}

fn start(r: &mut Random, b: &Beam, case: &mut Value, wet: bool) {
    let sane = b.times.sane;
    let mut start = json!({});
    if r.one_in(if sane { 8 } else { 5 }) {
        let size = b.length * r.log(1e-3, if sane { 0.05 } else { 0.2 });
        start["u1_m"] = profiles::at_rest_at_its_ends(r, size, sane);
    }
    if r.one_in(8) {
        let size = b.length / b.times.period * r.log(1e-3, if sane { 0.1 } else { 0.5 });
        start["u1_rate_m_s"] = profiles::at_rest_at_its_ends(r, size, sane);
    }
    if wet && r.one_in(4) {
        let pressure = 0.5 * network::pressure(case);
        let profile = match r.below(if sane { 1 } else { 3 }) {
            1 => json!({"cosine": {"amplitude": short(pressure), "waves": short(r.between(0.0, 3.0))}}),
            2 => json!({"polynomial": {"coefficients": [0.0, short(pressure), short(-pressure)]}}),
            _ => short(pressure * r.sign()),
        };
        start["pressures"] = json!([{"bladders": [1], "pressure_pa": profile}]);
    }
    if start.as_object().is_some_and(serde_json::Map::is_empty) && r.one_in(8) {
        start["equilibrium"] = json!({"loads_at_s": 0.0});
    }
    case["start"] = start;
}
