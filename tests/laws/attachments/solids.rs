//! Masses with rotary inertia, [E69], and with their centre beside the beam, [E70].
//!
//! Sources: Euler-Bernoulli's beam with the boundary and jump conditions of a rigid body, whose determinants are solved here by bisection; the
//! elastica under a weight, integrated by Runge and Kutta's rule; conservation laws.

use serde_json::{Value, json};
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

use super::followers::onward;
use super::{parse, root_between, slender, wave_number};

/// A rigid body: place, mass, rotary inertia, offsets across and along, with EI = m = l = 1.
#[derive(Clone, Copy)]
struct Rigid {
    at: f64,
    mass: f64,
    inertia: f64,
    across: f64,
    along: f64,
}

impl Rigid {
    fn json(&self) -> Value {
        json!({"at": self.at, "mass_kg": self.mass, "rotary_inertia_kg_m2": self.inertia,
               "offset_across_m": self.across, "offset_along_m": self.along})
    }

    /// What is zero at a frequency of a cantilever that carries the body, `ω = β²`, and that stretches with EA: moment, shear and normal
    /// force at the tip of two ways to bend and one to stretch. With `x_G = w + a w'`, `z_G = u - b w'`,
    ///
    /// ```text
    /// jumps at the body:  w'' by -ω² (J w' + a M x_G - b M z_G)    w''' by ω² M x_G    EA u' by -ω² M z_G
    /// ```
    fn determinant(&self, beta: f64, ea: f64) -> f64 {
        let squared = beta.powi(4);
        let k = (squared / ea).sqrt();
        let starts = [
            ([0.0, 0.0, 1.0, 0.0], 0.0),
            ([0.0, 0.0, 0.0, 1.0], 0.0),
            ([0.0; 4], 1.0 / k),
        ];
        let tips = starts.map(|(bent, pulled)| {
            let mut w = onward(bent, 0.0, squared, self.at);
            let (u, slope) = (pulled * (k * self.at).sin(), pulled * k * (k * self.at).cos());
            let (x, z) = (w[0] + self.along * w[1], u - self.across * w[1]);
            w[2] -= squared * (self.inertia * w[1] + self.mass * (self.along * x - self.across * z));
            w[3] += squared * self.mass * x;
            let slope = slope - squared * self.mass * z / ea;
            let (rest, beyond) = (1.0 - self.at, onward(w, 0.0, squared, 1.0 - self.at));
            [
                beyond[2],
                beyond[3],
                slope * (k * rest).cos() - u * k * (k * rest).sin(),
            ]
        });
        let [a, b, c] = tips;
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    }

    /// The lowest β.
    fn exact(&self, ea: f64) -> f64 {
        let f = |beta: f64| self.determinant(beta, ea);
        let step = 0.01;
        let mut low = 0.2;
        while f(low) * f(low + step) > 0.0 {
            low += step;
        }
        root_between(f, low, low + step)
    }
}

/// Goal: the lowest frequency of a cantilever with a body at the tip, between nodes, beside the beam and beyond its tip; with the rotary
/// inertia of the beam itself left out by name. Second order with the places alike in both meshes: what two leave is of fourth order.
#[test]
fn a_cantilever_swings_with_a_body() {
    let bodies = [
        (1.0, 0.0, 0.2, 0.0, 0.0),
        (1.0, 0.5, 0.05, 0.0, 0.0),
        (0.41, 0.5, 0.3, 0.0, 0.0),
        (0.02, 0.5, 0.3, 0.0, 0.0),
        (0.99, 0.5, 0.3, 0.0, 0.0),
        (1.0, 0.5, 0.0, 0.0, 0.3),
        (1.0, 0.5, 0.02, 0.25, 0.0),
        (1.0, 0.5, 0.02, 0.25, -0.3),
        (0.63, 1.0, 0.02, -0.2, 0.4),
    ];
    for (at, mass, inertia, across, along) in bodies {
        let body = Rigid {
            at,
            mass,
            inertia,
            across,
            along,
        };
        // slender, and so stocky that the mass beside the beam pulls it long
        for height in [3.5e-4_f64, 0.35] {
            let ea = 12.0 / (height * height);
            let exact = body.exact(ea);
            let of = |cells| {
                let mut case = slender(json!("clamped"), json!("free"), json!([body.json()]), cells);
                case["beam"]["height_m"] = json!(height);
                case["beam"]["young_modulus_pa"] = json!(12.0 / height.powi(3));
                case["beam"]["density_kg_m3"] = json!(1.0 / height);
                case["effects"]["rotary_inertia"] = json!("off");
                wave_number(&case)
            };
            let (coarse, fine) = (of(25), of(75));
            let found = fine + (fine - coarse) / 8.0;
            println!(
                "{} EA {ea:.0}: {exact}, coarse {:.1e}, fine {:.1e}, limit {:.1e}",
                body.json(),
                coarse / exact - 1.0,
                fine / exact - 1.0,
                found / exact - 1.0
            );
            assert!((found / exact - 1.0).abs() < 1e-5);
        }
    }
}

/// Tip of an elastica that is clamped, with its own weight and that of a body at its tip across: `φ'' = -(M + m (1 - s)) g cos φ`,
/// `φ'(1) = M g (a cos φ - b sin φ)`; across and along.
fn hanging(mass: f64, g: f64, across: f64, along: f64) -> [f64; 2] {
    // from the tip back: φ, φ', x and z that are still to come
    let back = |tip: f64| {
        let mut y = [tip, mass * g * (along * tip.cos() - across * tip.sin()), 0.0, 0.0];
        let steps = 4000;
        let h = 1.0 / f64::from(steps);
        let rate = |s: f64, y: [f64; 4]| [-y[1], (mass + s) * g * y[0].cos(), y[0].sin(), y[0].cos()];
        for k in 0..steps {
            let s = f64::from(k) * h;
            let on = |y: [f64; 4], r: [f64; 4], h: f64| std::array::from_fn(|i| y[i] + h * r[i]);
            let a = rate(s, y);
            let b = rate(s + 0.5 * h, on(y, a, 0.5 * h));
            let c = rate(s + 0.5 * h, on(y, b, 0.5 * h));
            let d = rate(s + h, on(y, c, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        y
    };
    let tip = root_between(|tip| back(tip)[0], 0.0, 1.5);
    let y = back(tip);
    [y[2], y[3] - 1.0]
}

/// Goal: where the tip hangs, far down, under a weight beside and beyond it. Second order: what two meshes leave is of fourth.
#[test]
fn a_weight_beside_the_tip_bends_the_beam() {
    for (across, along) in [(0.3, 0.0), (0.0, 0.4), (0.2, -0.5)] {
        let (mass, g) = (1.0, 1.2);
        let exact = hanging(mass, g, across, along);
        let of = |cells| {
            let body = json!([{"at": 1.0, "mass_kg": mass, "offset_across_m": across, "offset_along_m": along}]);
            let mut case = slender(json!("clamped"), json!("free"), body, cells);
            case["effects"] = json!({});
            case["loads"] = json!([{"gravity": {"x_m_s2": g}}]);
            let case = parse(&case);
            let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
            assert!(path.fault.is_none(), "{:?}", path.fault);
            let names = columns(&system(&case, 1.0).unwrap());
            ["tip_u1", "tip_u3"].map(|name| path.last().row[names.iter().position(|c| c.name == name).unwrap()])
        };
        let (coarse, fine) = (of(25), of(75));
        let errors = [0, 1].map(|k| (fine[k] + (fine[k] - coarse[k]) / 8.0) / exact[k] - 1.0);
        println!("{across}, {along}: {exact:?}, {errors:?}");
        assert!(errors.iter().all(|error| error.abs() < 2e-5));
    }
}

/// Goal: a soft beam that flies and tumbles with bodies on it, several turns, keeps energy, momentum and angular momentum to the integrator's
/// accuracy, in every kinematics that turns sections.
#[test]
fn a_tumbling_beam_with_bodies_keeps_what_it_has() {
    let sets = [
        ("conservative", json!({}), json!({})),
        ("published", json!({"formulation": "published"}), json!({})),
        ("sheared", json!({}), json!({"shear_stiffness_n": 100})),
        (
            "own rotary inertia left out",
            json!({"effects": {"rotary_inertia": "off"}}),
            json!({}),
        ),
    ];
    for (what, more, beam) in sets {
        let mut case = json!({
            "name": "tumbling",
            "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 2e6, "density_kg_m3": 950},
            "ends": {"root": "free", "tip": "free"},
            "attachments": [
                {"at": 0.33, "mass_kg": 0.01, "rotary_inertia_kg_m2": 4e-6, "offset_across_m": 0.015, "offset_along_m": -0.01},
                {"at": 1.0, "mass_kg": 0.004, "rotary_inertia_kg_m2": 1e-6, "offset_across_m": -0.01}],
            "start": {"u1_rate_m_s": {"polynomial": {"coefficients": [-1.0, 3.0]}}, "u3_rate_m_s": {"polynomial": {"coefficients": [0.5]}}},
            "formulation": "conservative",
            "effects": "full",
            "mesh": {"segments": 8, "cells_per_segment": 1},
            "time": {"end_s": 0.3, "output_interval_s": 0.01},
            "solver": {"rtol": 1e-9, "max_order": 5}
        });
        for (key, value) in more.as_object().unwrap() {
            case[key] = value.clone();
        }
        for (key, value) in beam.as_object().unwrap() {
            case["beam"][key] = value.clone();
        }
        let mut memory = Memory::default();
        let outcome = dynamics::run(&parse(&case), &mut memory).unwrap();
        assert_eq!(
            outcome.summary.status,
            Status::Finished,
            "{what}: {:?}",
            outcome.summary.reason
        );
        let b = &outcome.summary.balances;
        println!(
            "{what}: energy {:.1e}, momentum {:?}, angular momentum {:.1e}",
            b.energy_residual_relative, b.momentum_residual_relative, b.angular_momentum_residual_relative
        );
        assert!(b.energy_residual_relative.abs() < 1e-6, "{what}");
        assert!(
            b.momentum_residual_relative < 1e-7 && b.angular_momentum_residual_relative < 1e-6,
            "{what}"
        );
    }
}
