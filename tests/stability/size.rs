//! Many bladders, fine meshes, stiff and soft materials.

use crate::harness::{Ran, off, run};

/// Goal: 1 to 400 bladders per row in the same beam. Compliance and conductance per length are constant: a_p, aM, aN ~ 1/n, q1 ~ n.
/// Deflections then converge like 1/n (ends of chains, and the pieces between bladders). Tolerance: 100 against 400 within 1 %.
#[test]
fn from_one_bladder_to_four_hundred() {
    let runs: Vec<Ran> = [1usize, 2, 10, 40, 100, 400]
        .map(|n| {
            let share = 10.0 / n as f64;
            let chain = |sign: i64| {
                let indices: Vec<String> = (1..=n as i64).map(|k| (sign * k).to_string()).collect();
                format!("[{}]", indices.join(","))
            };
            let sets = [
                format!("/bladders/per_row={n}"),
                format!("/bladders/width_m={:e}", 0.078 / n as f64),
                format!("/bladders/permeability_m4={:e}", 1.55e-12 / share),
                format!("/tubes/permeability_m4={:e}", 6.72e-13 / share),
                format!("/bladders/area_per_pressure_m2_per_pa={:e}", 1.75e-10 * share),
                format!(
                    r#"/bladders/area_per_moment_m2_per_n_m={{"opening": {:e}, "closing": {:e}}}"#,
                    3.75e-6 * share,
                    6.54e-6 * share
                ),
                format!(
                    r#"/bladders/area_per_force_m2_per_n={{"tension": {:e}, "compression": {:e}}}"#,
                    3.64e-8 * share,
                    6.31e-8 * share
                ),
                format!("/network/chains/0/bladders={}", chain(1)),
                format!("/network/chains/1/bladders={}", chain(-1)),
                format!("/mesh/cells_per_segment={}", (80 / n).clamp(1, 40)),
            ];
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            let ran = run("viscosity", &sets).sound().steps_within(30, 3_000);
            println!(
                "{n} bladders a row | {} unknowns | {} steps | energy {:.1e} | largest tip u1 {:.5e} m",
                ran.summary.unknowns,
                ran.steps(),
                ran.summary.balances.energy_residual_relative,
                ran.largest("tip_u1")
            );
            ran
        })
        .into();
    let change = off(runs[4].largest("tip_u1"), runs[5].largest("tip_u1"));
    assert!(change < 1e-2, "{change}");
}

/// Goal: 1 to 32 cells per segment; the highest frequency grows by 32, but not the number of steps. Second order: the change from 8 to 32
/// is below 0.2 % (half the square of 1/40 times the observed coefficient, with a margin).
#[test]
fn from_one_cell_to_thirty_two() {
    for coupling in [r#"/bladders/coupling="reciprocal""#, crate::harness::PUBLISHED] {
        let runs: Vec<Ran> = [1, 2, 4, 8, 16, 32]
            .map(|k| {
                let cells = format!("/mesh/cells_per_segment={k}");
                let ran = run("viscosity", &[&cells, coupling]).sound().steps_within(30, 3_000);
                let figures = format!("largest tip u1 {:.5e} m", ran.largest("tip_u1"));
                ran.line(&figures)
            })
            .into();
        let change = off(runs[3].largest("tip_u1"), runs[5].largest("tip_u1"));
        assert!(change < 2e-3, "{change}");
    }
}

/// Source: similarity. With E -> s E, loads s, compliances 1/s, times s^-1/2, viscosity s^1/2 the scaled equations are the same. Goal: the
/// program has no absolute scales: 2 kPa to 2 GPa give the same steps and deflection. Tolerance: rounding of the scaled numbers flips
/// single decisions of the step control: 20 % of steps (10 % observed), 10 rtol.
#[test]
fn young_modulus_over_six_decades() {
    let runs: Vec<Ran> = [1e-3, 1e-2, 1.0, 1e2, 1e3]
        .map(|s: f64| {
            let t = s.powf(-0.5);
            let sets = [
                format!("/beam/young_modulus_pa={:e}", 2e6 * s),
                format!("/bladders/area_per_pressure_m2_per_pa={:e}", 1.75e-10 / s),
                format!(
                    r#"/bladders/area_per_moment_m2_per_n_m={{"opening": {:e}, "closing": {:e}}}"#,
                    3.75e-6 / s,
                    6.54e-6 / s
                ),
                format!(
                    r#"/bladders/area_per_force_m2_per_n={{"tension": {:e}, "compression": {:e}}}"#,
                    3.64e-8 / s,
                    6.31e-8 / s
                ),
                format!("/fluid/viscosity_pa_s={:e}", 0.1 / t),
                format!("/loads/0/force_x_n_m/signal/ramp/to={:e}", 40.0 * s),
                format!("/loads/0/force_x_n_m/signal/ramp/duration_s={:e}", 0.02 * t),
                format!("/time/end_s={:e}", 0.2 * t),
                format!("/time/output_interval_s={:e}", 0.002 * t),
            ];
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            let ran = run("viscosity", &sets).sound().steps_within(30, 3_000);
            println!(
                "E {:.0e} Pa | {} steps | tip u1 {:.8e} m",
                2e6 * s,
                ran.steps(),
                ran.largest("tip_u1")
            );
            ran
        })
        .into();
    for ran in &runs {
        assert!(
            off(ran.largest("tip_u1"), runs[2].largest("tip_u1")) < 1e-4,
            "{}",
            ran.name
        );
        assert!(off(ran.steps() as f64, runs[2].steps() as f64) < 0.2, "{}", ran.name);
    }
}
