//! Source: `docs/model.md` section 8: the energy balance is exact in the semi-discrete system.
//! Goal: no term of the balances is missing or wrong. With all effects acting at once, the energy residual converges to zero with the
//! tolerance, in all four combinations of formulation and coupling.
//! Tolerance: 3e-8 of the largest energy (measured: 3e-11 to 1.2e-8) at rtol 1e-11 over 4 ms, BDF up to order 5 (unstable waves do not grow
//! in so short a time). A missing term would show as its share of all work done, here 1e-6 or more (the smallest is printed).

use super::common::{AS_PUBLISHED, CONSERVATIVE, EVERYTHING, KINKED, PUBLISHED, RECIPROCAL, run, written};

/// Conditions at root and tip; every kind of condition occurs.
const ENDS: [(&str, &str); 5] = [
    (
        "driven root with a slope rate, dead forces and a moment with a rate at the tip",
        r#"/ends={"root":{"clamped":{"u1_m":{"sine":{"amplitude":0.001,"frequency_hz":60,"ramp_cycles":1}},
            "slope_rad":{"sine":{"amplitude":0.03,"frequency_hz":50,"ramp_cycles":1}},
            "u3_m":{"sine":{"amplitude":0.001,"frequency_hz":40,"ramp_cycles":1}}}},
            "tip":{"free":{"force_x_n":{"sine":{"amplitude":5,"frequency_hz":30}},"force_z_n":-4,
            "moment_n_m":{"sine":{"amplitude":0.05,"frequency_hz":70}}}}}"#,
    ),
    (
        "follower forces at the tip",
        r#"/ends={"root":"clamped","tip":{"free":{"follower_normal_n":{"sine":{"amplitude":10,"frequency_hz":50}},
            "follower_shear_n":4,"moment_n_m":{"sine":{"amplitude":0.05,"frequency_hz":70}}}}}"#,
    ),
    (
        "moment at a driven root, slope rate at the tip",
        r#"/ends={"root":{"pinned":{"u1_m":{"sine":{"amplitude":0.001,"frequency_hz":60,"ramp_cycles":1}},
            "moment_n_m":{"sine":{"amplitude":0.05,"frequency_hz":55}}}},
            "tip":{"guided":{"slope_rad":{"sine":{"amplitude":0.03,"frequency_hz":50,"ramp_cycles":1}},"force_x_n":3,"force_z_n":2}}}"#,
    ),
    (
        "follower forces at the root, driven tip",
        r#"/ends={"root":{"free":{"follower_normal_n":{"sine":{"amplitude":5,"frequency_hz":40}},"follower_shear_n":{"sine":{"amplitude":4,"frequency_hz":50}},
            "moment_n_m":{"sine":{"amplitude":0.02,"frequency_hz":55}}}},
            "tip":{"clamped":{"u1_m":{"sine":{"amplitude":0.001,"frequency_hz":60,"ramp_cycles":1}},
            "slope_rad":{"sine":{"amplitude":0.03,"frequency_hz":50,"ramp_cycles":1}}}}}"#,
    ),
    (
        "nothing held, a moment at each end",
        r#"/ends={"root":{"free":{"moment_n_m":{"sine":{"amplitude":0.02,"frequency_hz":55}},"force_x_n":2}},
            "tip":{"free":{"moment_n_m":{"sine":{"amplitude":0.03,"frequency_hz":65}}}}}"#,
    ),
];

/// Residuals of energy, momentum and angular momentum.
fn residuals(ends: &str, formulation: &str, coupling: &str, effects: &str) -> [f64; 3] {
    let effects = format!("/effects={effects}");
    let run = run(&written(EVERYTHING, &[ends, formulation, coupling, &effects]));
    let b = &run.summary.balances;
    let share = |name: &str| b.energy_j[name].abs();
    let acting: Vec<&str> = [
        "work_loads",
        "work_ports",
        "dissipated_bladders",
        "dissipated_tubes",
        "harvested",
        "dissipated_rectifiers",
        "dissipated_damping",
        "work_ends",
        "work_formulation",
        "work_reciprocity",
    ]
    .into_iter()
    .filter(|name| share(name) > 0.0)
    .collect();
    let least = acting.iter().min_by(|a, b| share(a).total_cmp(&share(b))).unwrap();
    let all: f64 = acting.iter().map(|name| share(name)).sum();
    assert!(share(least) > 1e-7 * all);
    let residuals = [
        b.energy_residual_relative,
        b.momentum_residual_relative,
        b.angular_momentum_residual_relative,
    ];
    println!(
        "    {} steps, energy {:.1e}, momentum {:.1e}, angular {:.1e}; {} terms, the least {least} with {:.1e} of all",
        run.summary.solver.steps,
        residuals[0],
        residuals[1],
        residuals[2],
        acting.len(),
        share(least) / all
    );
    residuals
}

fn all_combinations(effects: &str, of: std::ops::Range<usize>) {
    for (what, ends) in &ENDS[of] {
        for formulation in [CONSERVATIVE, AS_PUBLISHED] {
            for coupling in [RECIPROCAL, KINKED, PUBLISHED] {
                println!("{what}; {effects}, {formulation}, {coupling}");
                let residuals = residuals(ends, formulation, coupling, effects);
                assert!(residuals.iter().all(|r| *r < 3e-8), "{what}: {residuals:?}");
            }
        }
    }
}

#[test]
fn the_ledger_closes_with_rotary_inertia() {
    all_combinations(r#"{"rotary_inertia":"on"}"#, 0..5);
}

#[test]
fn the_ledger_closes_without_rotary_inertia() {
    all_combinations(r#"{"rotary_inertia":"off"}"#, 0..2);
}

#[test]
fn the_ledger_closes_for_a_quasi_static_solid() {
    all_combinations(r#"{"solid_inertia":"off"}"#, 0..3);
}

/// `[E77]` `[E79]` Goal: balances close on meshes of fourth order, too: both formulations, finite and small rotations, with and without
/// stretch and shear.
#[test]
fn the_ledger_closes_of_fourth_order() {
    let order = "/mesh/order=4";
    let small = r#"/effects={"finite_rotation":"off"}"#;
    let inextensible = r#"/effects={"finite_rotation":"off","axial_stretch":"off"}"#;
    let closes = |what: &str, sets: &[&str]| {
        let run = run(&written(EVERYTHING, &[&[order], sets].concat()));
        let b = &run.summary.balances;
        let [energy, others @ ..] = [
            b.energy_residual_relative,
            b.momentum_residual_relative,
            b.angular_momentum_residual_relative,
        ];
        println!("{what}: {energy:.1e} {others:?}");
        assert!(
            energy < 3e-8 && others.iter().all(|r| *r < 3e-8),
            "{what}: {energy:e} {others:?}"
        );
    };
    for (what, ends) in ENDS {
        closes(what, &[ends, CONSERVATIVE, RECIPROCAL]);
        closes(what, &[ends, AS_PUBLISHED, PUBLISHED]);
        closes(what, &[ends, CONSERVATIVE, RECIPROCAL, small]);
    }
    closes(ENDS[1].0, &[ENDS[1].1, CONSERVATIVE, RECIPROCAL, inextensible]);
    let stiff = "/beam/shear_stiffness_n=300";
    let sheared = [
        r#"/effects={"shear":"on","rotary_inertia":"on"}"#,
        r#"/effects={"shear":"on","rotary_inertia":"off"}"#,
        r#"/effects={"shear":"on","finite_rotation":"off","rotary_inertia":"on"}"#,
    ];
    for ((what, ends), cells) in ENDS.into_iter().zip([2, 3, 1, 2, 2]) {
        let cells = format!("/mesh/cells_per_segment={cells}");
        for effects in sheared {
            closes(what, &[ends, RECIPROCAL, stiff, effects, &cells]);
        }
    }
    let inextensible = r#"/effects={"shear":"on","finite_rotation":"off","axial_stretch":"off","rotary_inertia":"on"}"#;
    closes(ENDS[1].0, &[ENDS[1].1, RECIPROCAL, stiff, inextensible]);
}

/// Goal: balances close with shear and fluid, for any rotary inertia and for small rotations.
#[test]
fn the_ledger_closes_with_shear() {
    let small = r#"{"shear":"on","finite_rotation":"off","rotary_inertia":"on"}"#;
    for (what, ends) in &ENDS {
        for effects in [
            r#"{"shear":"on","rotary_inertia":"on"}"#,
            r#"{"shear":"on","rotary_inertia":"off"}"#,
            small,
        ] {
            println!("{what}; {effects}");
            let residuals = residuals(ends, "/beam/shear_stiffness_n=300", RECIPROCAL, effects);
            assert!(residuals.iter().all(|r| *r < 3e-8), "{what}: {residuals:?}");
        }
    }
}
