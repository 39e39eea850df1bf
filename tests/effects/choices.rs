//! Every choice of effects on a scene in which everything acts at once: derivatives and balances.
//!
//! Tolerances: those of `tests/laws/jacobian.rs` and `tests/physics/ledger.rs`, for the same reasons.

use slcbeam::case::Case;
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;
use slcbeam::model::Model;

use super::common::{AS_PUBLISHED, CONSERVATIVE, EVERYTHING, KINKED, PUBLISHED, RECIPROCAL, run, written};
use super::differences::worst_difference;

/// What is left out, and what else the case must be for that.
pub struct Choice {
    pub effects: &'static str,
    pub sets: &'static [&'static str],
}

const fn choice(effects: &'static str) -> Choice {
    Choice { effects, sets: &[] }
}

/// No flow is prescribed.
const NO_SOURCE: &str = r#"/network/chains/1/ends=["connected","sealed"]"#;
/// A valve that never opens seals bladder 5 off; its other neighbour is a turbine.
const SHUT: &str = r#"/network/turbines=[]"#;
const SHUT_TUBE: &str = "/network/tubes/1/opening=0";
/// A closed network, one that a source feeds, one with two ports of the same pressure.
const CLOSED: &str = r#"/network={"chains":[{"bladders":[1,2,3,-3]},{"bladders":[4,5,-5]}]}"#;
const FED: &str = r#"/network={"chains":[{"bladders":[1,2,3,-3],"ends":[{"flow_m3_s":{"sine":{"amplitude":2e-6,"frequency_hz":90}}},"sealed"]},
    {"bladders":[4,5,-5]}]}"#;
const PORT: &str = r#"/network={"chains":[{"bladders":[1,2,3,-3],"ends":[{"pressure_pa":{"sine":{"amplitude":3000,"frequency_hz":70}}},
    {"pressure_pa":{"sine":{"amplitude":3000,"frequency_hz":70}}}]},{"bladders":[4,5,-5]}]}"#;
const UNIFORM: &str = r#"{"network_pressure_differences":"off"}"#;

/// Nothing acts across the beam; the ends move it along.
const ALONG: [&str; 4] = [
    r#"/loads=[{"force_z_n_m":{"signal":{"sine":{"amplitude":300,"frequency_hz":40}}}},{"gravity":{"z_m_s2":-9.81}}]"#,
    r#"/ends={"root":{"clamped":{"u3_m":{"sine":{"amplitude":0.001,"frequency_hz":40,"ramp_cycles":1}}}},
        "tip":{"free":{"force_z_n":-4}}}"#,
    r#"/start={"u3_rate_m_s":{"polynomial":{"coefficients":[0,0,0.3]}},"pressures":[{"bladders":[2,-4],"pressure_pa":1000}]}"#,
    "/effects/transverse_motion=\"off\"",
];

/// Forces that turn with the tip.
const FOLLOWER: &str = r#"/ends/tip={"free":{"follower_normal_n":{"sine":{"amplitude":10,"frequency_hz":50}},"follower_shear_n":4,
    "moment_n_m":{"sine":{"amplitude":0.05,"frequency_hz":70}}}}"#;
const SMALL: &str = r#"{"finite_rotation":"off"}"#;
const LINEAR: &str = r#"{"finite_rotation":"off","axial_force_on_bending":"off"}"#;

const WAVELESS: &str = r#"{"axial_inertia":"off"}"#;
const UNDAMPED: &str = "/beam/damping={}";
const BENDING_DAMPED: &str = r#"/beam/damping={"bending_time_s":3e-4}"#;
/// Both ends move along; stiff enough for a tolerance of its own.
const PULLED: &str = r#"/ends={"root":"clamped","tip":{"clamped":{"u3_m":{"sine":{"amplitude":0.001,"frequency_hz":60,"ramp_cycles":1}}}}}"#;

const RIGID_ALONG: &str = r#"{"finite_rotation":"off","axial_stretch":"off"}"#;
/// The tip is held and driven along, the root is not.
const TIP_HELD: &str = r#"/ends={"root":{"conditions":{"u1_m":{"sine":{"amplitude":0.001,"frequency_hz":60,"ramp_cycles":1}},"slope_rad":0,
    "force_z_n":{"sine":{"amplitude":5,"frequency_hz":30}}}},
    "tip":{"conditions":{"u3_m":{"sine":{"amplitude":0.001,"frequency_hz":40,"ramp_cycles":1}},"force_x_n":1,"moment_n_m":0}}}"#;

const CHOICES: &[Choice] = &[
    choice(RIGID_ALONG),
    choice(r#"{"finite_rotation":"off","axial_stretch":"off","axial_force_on_bending":"off"}"#),
    choice(r#"{"finite_rotation":"off","axial_stretch":"off","solid_inertia":"off"}"#),
    choice(r#"{"finite_rotation":"off","axial_stretch":"off","pressure_to_stretch":"off","rotary_inertia":"off"}"#),
    choice(r#"{"finite_rotation":"off","axial_stretch":"off","force_to_area":"off"}"#),
    choice(r#"{"finite_rotation":"off","axial_stretch":"off","fluid":"off"}"#),
    Choice {
        effects: RIGID_ALONG,
        sets: &[FOLLOWER],
    },
    Choice {
        effects: RIGID_ALONG,
        sets: &[TIP_HELD],
    },
    Choice {
        effects: r#"{"finite_rotation":"off","axial_stretch":"off","network_pressure_differences":"off"}"#,
        sets: &[PORT],
    },
    choice(SMALL),
    choice(LINEAR),
    Choice {
        effects: SMALL,
        sets: &[FOLLOWER],
    },
    Choice {
        effects: LINEAR,
        sets: &[FOLLOWER],
    },
    choice(r#"{"finite_rotation":"off","solid_inertia":"off"}"#),
    choice(WAVELESS),
    choice(r#"{"axial_inertia":"off","rotary_inertia":"off"}"#),
    choice(r#"{"axial_inertia":"off","finite_rotation":"off"}"#),
    choice(r#"{"axial_inertia":"off","finite_rotation":"off","axial_force_on_bending":"off"}"#),
    Choice {
        effects: WAVELESS,
        sets: &[UNDAMPED],
    },
    Choice {
        effects: WAVELESS,
        sets: &[BENDING_DAMPED],
    },
    Choice {
        effects: WAVELESS,
        sets: &[PULLED, "/solver/rtol=1e-12"],
    },
    choice(r#"{"finite_rotation":"off","rotary_inertia":"off"}"#),
    choice(r#"{"fluid":"off"}"#),
    Choice {
        effects: r#"{"flow":"off"}"#,
        sets: &[NO_SOURCE],
    },
    choice(r#"{"flow_along_bladders":"off"}"#),
    Choice {
        effects: "{}",
        sets: &[SHUT, SHUT_TUBE],
    },
    Choice {
        effects: UNIFORM,
        sets: &[CLOSED],
    },
    Choice {
        effects: UNIFORM,
        sets: &[FED],
    },
    Choice {
        effects: UNIFORM,
        sets: &[PORT],
    },
    Choice {
        effects: r#"{"network_pressure_differences":"off","moment_to_area":"off","force_to_area":"off"}"#,
        sets: &[PORT],
    },
    choice(r#"{"pressure_to_curvature":"off"}"#),
    choice(r#"{"pressure_to_stretch":"off"}"#),
    choice(r#"{"moment_to_area":"off"}"#),
    choice(r#"{"force_to_area":"off"}"#),
    choice(r#"{"moment_to_area":"off","force_to_area":"off"}"#),
    choice(r#"{"pressure_to_curvature":"off","pressure_to_stretch":"off"}"#),
    Choice {
        effects: "{}",
        sets: &ALONG,
    },
];

/// Root and tip: driven with a slope rate and loaded; a moment at a driven root and a slope rate at the tip.
const ENDS: [&str; 2] = [
    r#"/ends={"root":{"clamped":{"u1_m":{"sine":{"amplitude":0.001,"frequency_hz":60,"ramp_cycles":1}},
        "slope_rad":{"sine":{"amplitude":0.03,"frequency_hz":50,"ramp_cycles":1}},
        "u3_m":{"sine":{"amplitude":0.001,"frequency_hz":40,"ramp_cycles":1}}}},
        "tip":{"free":{"force_x_n":{"sine":{"amplitude":5,"frequency_hz":30}},"force_z_n":-4,
        "moment_n_m":{"sine":{"amplitude":0.05,"frequency_hz":70}}}}}"#,
    r#"/ends={"root":{"pinned":{"u1_m":{"sine":{"amplitude":0.001,"frequency_hz":60,"ramp_cycles":1}},
        "u3_m":{"sine":{"amplitude":0.001,"frequency_hz":40,"ramp_cycles":1}},
        "moment_n_m":{"sine":{"amplitude":0.05,"frequency_hz":55}}}},
        "tip":{"guided":{"slope_rad":{"sine":{"amplitude":0.03,"frequency_hz":50,"ramp_cycles":1}},"force_x_n":3,"force_z_n":2}}}"#,
];

/// The scene with a choice, in one of its forms.
fn scene(choice: &Choice, ends: &str, formulation: &str, coupling: &str) -> Case {
    let effects = format!("/effects={}", choice.effects);
    let mut sets = vec![ends, formulation, coupling, &effects];
    sets.extend(choice.sets);
    written(EVERYTHING, &sets)
}

#[test]
fn jacobians_are_exact_whatever_is_left_out() {
    for choice in CHOICES {
        for (ends, formulation, coupling) in [
            (ENDS[0], CONSERVATIVE, RECIPROCAL),
            (ENDS[1], CONSERVATIVE, KINKED),
            (ENDS[0], AS_PUBLISHED, PUBLISHED),
        ] {
            // equations are right or wrong whether the case is refused or not
            let case = scene(choice, ends, formulation, coupling);
            let mut dae = BeamDae::new(System::with(&case, Model::new(&case).unwrap()).unwrap());
            for (seed, size) in [(1, 1.0), (2, 0.1)] {
                let worst = worst_difference(&mut dae, seed, size);
                println!("{} {:?}: {worst:.1e}", choice.effects, choice.sets);
                assert!(worst < 1e-6, "{} {:?}: {worst:.1e}", choice.effects, choice.sets);
            }
        }
    }
}

/// Energy, momentum, angular momentum and volume.
#[test]
fn balances_close_whatever_is_left_out() {
    let mut ran = 0;
    for choice in CHOICES {
        for (ends, formulation, coupling) in [
            (ENDS[0], CONSERVATIVE, RECIPROCAL),
            (ENDS[1], CONSERVATIVE, KINKED),
            (ENDS[0], AS_PUBLISHED, PUBLISHED),
        ] {
            let case = scene(choice, ends, formulation, coupling);
            if System::new(&case).is_err() {
                continue;
            }
            ran += 1;
            let run = run(&case);
            let b = &run.summary.balances;
            let residuals = [
                b.energy_residual_relative,
                b.momentum_residual_relative,
                b.angular_momentum_residual_relative,
                b.volume_residual_relative,
            ];
            println!(
                "{} {:?}, {formulation}, {coupling}: {residuals:?}, {} unknowns, {} steps",
                choice.effects,
                choice.sets.len(),
                run.summary.unknowns,
                run.summary.solver.steps
            );
            assert!(residuals.iter().all(|r| *r < 3e-8), "{}: {residuals:?}", choice.effects);
        }
    }
    assert!(
        ran > CHOICES.len(),
        "{ran} of {} scenes were not refused",
        3 * CHOICES.len()
    );
}
