//! The four parts of the coupling: each vanishes in proportion to its coefficient.

use super::common::{EVERYTHING, run, written};
use super::limits::falls;

/// Pairs of runs of the scene in which everything acts, with one coefficient made small, and with its part left out. Fluid that swings along bladders would hide
/// the last of these behind the integrator's own error.
fn part(effect: &str, column: &str, small: impl Fn(f64) -> String) {
    let of = |number: f64, on: &str| {
        let effects = format!("/effects={{\"bladder_inertia\":\"off\",\"{effect}\":\"{on}\"}}");
        let coupling =
            r#"/bladders/coupling={"published":{"slope_per_pressure_rad":0.47,"length_per_pressure_m":0.01}}"#;
        let sets = [coupling, &small(number), &effects, "/solver/rtol=1e-10"];
        run(&written(EVERYTHING, &sets))
    };
    falls(
        effect,
        &[1e-2, 1e-3, 1e-4],
        1.0,
        0.05,
        |n| (of(n, "off"), of(n, "on")),
        column,
    );
}

#[test]
fn pressure_bends_in_proportion() {
    part("pressure_to_curvature", "tip_u1", |n| {
        format!("/bladders/coupling/published/slope_per_pressure_rad={n}")
    });
}

#[test]
fn pressure_stretches_in_proportion() {
    part("pressure_to_stretch", "tip_u3", |n| {
        format!("/bladders/coupling/published/length_per_pressure_m={n}")
    });
}

#[test]
fn moments_press_in_proportion() {
    part("moment_to_area", "max_pressure", |n| {
        format!(
            "/bladders/area_per_moment_m2_per_n_m={{\"opening\":{},\"closing\":{}}}",
            3e-6 * n,
            6e-6 * n
        )
    });
}

#[test]
fn forces_press_in_proportion() {
    part("force_to_area", "max_pressure", |n| {
        format!(
            "/bladders/area_per_force_m2_per_n={{\"tension\":{},\"compression\":{}}}",
            3e-8 * n,
            6e-8 * n
        )
    });
}
