//! Axial stretch: what is left out is N/EA, of first order in 1/EA.

use super::common::{Run, difference, run, written};
use super::limits::falls;
use super::waves::shaken;

/// The scene in which everything acts, pressure not stretching (a law of its own that does not vanish with 1/EA makes a stiff
/// beam with bladders active), undamped along (a force that grows with EA), its modulus along raised.
fn stiff(softness: f64, stretch: &str) -> Run {
    let effects = format!(
        r#"/effects={{"finite_rotation":"off","axial_inertia":"off","pressure_to_stretch":"off","axial_stretch":"{stretch}"}}"#
    );
    let stiffness = format!("/beam/axial_stiffness_factor={}", 1.0 / softness);
    let sets = [
        r#"/ends={"root":{"clamped":{"u3_m":{"sine":{"amplitude":0.001,"frequency_hz":40,"ramp_cycles":1}}}},
            "tip":{"free":{"force_x_n":{"sine":{"amplitude":5,"frequency_hz":30}},"force_z_n":-4}}}"#,
        r#"/beam/damping={"bending_time_s":3e-4}"#,
        r#"/bladders/coupling={"published":{"slope_per_pressure_rad":0.47,"length_per_pressure_m":0.0}}"#,
        "/solver/rtol=1e-10",
        &effects,
        &stiffness,
    ];
    run(&written(super::common::EVERYTHING, &sets))
}

/// Held by one end, the beam is statically determinate along: bending and bladders do not feel its stretch at all.
#[test]
fn bending_does_not_feel_a_stretch_without_waves() {
    let (rigid, soft) = (stiff(1.0, "off"), stiff(1.0, "on"));
    for column in ["tip_u1", "max_pressure", "bending_energy"] {
        let off = difference(&rigid.column(column), &soft.column(column));
        println!(
            "{column}: {off:.1e} with {} for {} unknowns",
            rigid.summary.unknowns, soft.summary.unknowns
        );
        assert!(off < 1e-7, "{column}: {off:.1e}");
    }
}

#[test]
fn stretch_vanishes_with_the_inverse_of_the_stiffness() {
    // Relative to the motion without stretch.
    let pair = |softness: f64| (stiff(softness, "on"), stiff(softness, "off"));
    falls("stretch, tip_u3", &[1e-1, 1e-2, 1e-3], 1.0, 0.1, pair, "tip_u3");
}

/// With waves the inertia of the stretch is felt, of the order (f/f_axial)², which goes with 1/EA.
#[test]
fn bending_feels_the_waves_of_stretch_with_the_inverse_of_the_stiffness() {
    let of = |softness: f64, stretch: &str| {
        let effects = format!(r#"{{"finite_rotation":"off","rotary_inertia":"off","axial_stretch":"{stretch}"}}"#);
        shaken(1.0 / softness, true, &effects)
    };
    let pair = |softness: f64| (of(softness, "off"), of(softness, "on"));
    falls(
        "stretch with waves, tip_u1",
        &[0.0625, 0.0156, 0.0039],
        1.0,
        0.1,
        pair,
        "tip_u1",
    );
}
