//! Source: Fig. 5 of Matia & Gat (U3 = 0.12 at 20 Hz) and the sizes of `docs/exact-results.md` section 4.
//! Goal: wiring I keeps the beam straight, II bends it to one side at a time, III to both; magnitudes of pressure and deflection, with
//! impulsive and ramped start.
//! Tolerances: 15 % on magnitudes, which were measured with a prototype; the straight beam and the signs are exact.

use nalgebra::Complex;
use slcbeam::model::Model;

use super::common::{
    AS_PUBLISHED, CONSERVATIVE, CREEPING, E, EI, LENGTH, PUBLISHED, RECIPROCAL, Run, largest, run, run_shipped,
    shipped, within,
};

fn ramp(cycles: u32) -> String {
    format!("/ends/root/clamped/u3_m/sine/ramp_cycles={cycles}")
}

/// Goal: with equal rows, the discretization keeps the symmetry of left and right: the limit is 1e-10 l_s, and rounding errors are eight
/// orders smaller.
#[test]
fn wiring_1_keeps_the_beam_straight() {
    for (formulation, coupling, end) in [
        (AS_PUBLISHED, PUBLISHED, "/time/end_s=0.5"),
        (AS_PUBLISHED, RECIPROCAL, "/time/end_s=0.1"),
        (CONSERVATIVE, PUBLISHED, "/time/end_s=0.1"),
        (CONSERVATIVE, RECIPROCAL, "/time/end_s=0.1"),
    ] {
        let run = run_shipped("wiring-1", &[formulation, coupling, end]);
        let sideways = run.field("u1_m").iter().map(|u| largest(u)).fold(0.0, f64::max) / LENGTH;
        println!(
            "{formulation} {coupling}: |u1| up to {sideways:.1e} l_s, P up to {:.3e} E",
            run.max_abs("max_pressure_pa") / E
        );
        assert!(sideways < 1e-10);
    }
}

/// Goal: peaks of the impulsive start (as in the paper): P 1.2e-2 to 1.4e-2, U1 9.8e-5 (II) and 5.6e-5 (III).
#[test]
fn sizes_of_the_impulsive_start() {
    for (case, u1) in [("wiring-2", 9.8e-5), ("wiring-3", 5.6e-5)] {
        // The deflection peaks within 0.4 s.
        let run = run_shipped(case, &["/time/end_s=0.5", "/time/fields_interval_s=0.1"]);
        let pressure = run.max_abs("max_pressure_pa") / E;
        within(&format!("{case} U1"), run.max_abs("tip_u1_m") / LENGTH, u1, 0.15);
        println!("{case} P {pressure:.4e}");
        assert!((0.85 * 1.2e-2..1.15 * 1.4e-2).contains(&pressure));
    }
}

/// Goal: the steady cycle after a one-cycle ramp, conservative: P 2.4e-3, U1 1.7e-5 (II) and 8e-6 (III). The published form has a larger
/// free vibration after its ramp, and the same pressure.
#[test]
fn sizes_of_the_ramped_start() {
    for (case, u1) in [("wiring-2", 1.7e-5), ("wiring-3", 8e-6)] {
        for formulation in [CONSERVATIVE, AS_PUBLISHED] {
            let sets = [
                &ramp(1),
                formulation,
                CREEPING,
                "/time/window_s=0.05",
                "/solver/rtol=1e-6",
            ];
            let run = run_shipped(case, &sets);
            let deflection = run.window_max_abs("tip_u1_m") / LENGTH;
            within(
                &format!("{case} {formulation} P"),
                run.window_max_abs("max_pressure_pa") / E,
                2.4e-3,
                0.15,
            );
            println!("{case} {formulation} U1 {deflection:.3e}");
            if formulation == CONSERVATIVE {
                within(&format!("{case} U1"), deflection, u1, 0.15);
            }
        }
    }
}

/// Ratio of the smaller to the larger of the largest curvatures of both sides, at every instant of the last cycle at which the larger one
/// exceeds a fifth of the largest of the cycle.
fn mixing(curvatures: &[Vec<f64>]) -> Vec<f64> {
    let most = curvatures.iter().map(|k| largest(k)).fold(0.0, f64::max);
    let sides = |k: &Vec<f64>| {
        let positive = k.iter().fold(0.0_f64, |m, v| m.max(*v));
        let negative = k.iter().fold(0.0_f64, |m, v| m.max(-v));
        (positive.min(negative), positive.max(negative))
    };
    curvatures
        .iter()
        .map(sides)
        .filter(|(_, larger)| *larger > 0.2 * most)
        .map(|(smaller, larger)| smaller / larger)
        .collect()
}

/// Curvature, and its pressure part, over the last cycle.
fn last_cycle(run: &Run) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let (kappa, moment) = (run.field("curvature_1_m"), run.field("moment_n_m"));
    let first = kappa.len() - 101;
    let by_pressure = kappa[first..].iter().zip(&moment[first..]).map(|(k, m)| {
        let alpha = k.iter().zip(m).map(|(k, m)| k - m / EI);
        alpha.collect()
    });
    (kappa[first..].to_vec(), by_pressure.collect())
}

fn shaken(case: &str, coupling: &str, hertz: f64, cycles: f64, more: &[&str]) -> Run {
    let (end, interval) = (cycles / hertz, 0.01 / hertz);
    let mut sets = vec![
        format!("/ends/root/clamped/u3_m/sine/frequency_hz={hertz}"),
        ramp(3),
        format!("/time/end_s={end}"),
        format!("/time/window_s={}", 1.0 / hertz),
        format!("/time/output_interval_s={interval}"),
        format!("/time/fields_interval_s={interval}"),
        CONSERVATIVE.into(),
        CREEPING.into(),
        coupling.into(),
    ];
    sets.extend(more.iter().map(|s| s.to_string()));
    run_shipped(case, &sets)
}

/// Goal: well below the first bending frequency (2 Hz against 12.2 Hz) the beam follows the curvature imposed by pressure: one sign at
/// every instant (II), two (III). "One sign" allows 3 % of the other; the measured value is zero.
#[test]
fn slowly_shaken_wiring_2_bends_to_one_side_and_wiring_3_to_both() {
    // bound on the step: error control alone uses tiny steps here, since velocities of stiff waves jump with each change of step
    let slow = ["/solver/max_step_s=5e-4"];
    for coupling in [PUBLISHED, RECIPROCAL] {
        for (case, one_sign) in [("wiring-2", true), ("wiring-3", false)] {
            let run = shaken(case, coupling, 2.0, 5.0, &slow);
            let (kappa, _) = last_cycle(&run);
            let mixed = mixing(&kappa);
            let (least, most) = (mixed.iter().copied().fold(1.0, f64::min), largest(&mixed));
            println!(
                "{case} {coupling}, 2 Hz: smaller over larger side {least:.3} to {most:.3} at {} of 101 instants",
                mixed.len()
            );
            assert!(mixed.len() > 50);
            if one_sign {
                assert!(most < 0.03);
            } else {
                assert!(least > 0.3);
            }
        }
    }
}

/// Goal: at 20 Hz pressures still impose one sign (II) or two (III), except during their change of sign, when the leaking row lags. Damping
/// removes the transient, so that the cycle repeats within 1 %.
///
/// The beam itself does not follow. Above its first frequency its response to any uniform pressure has two signs (next test):
/// `kappa(0)/kappa(l) = (cosh b + cos b)/(1 + cosh b cos b)`, `b = 1.8751 sqrt(20/12.235)`: -1.56. The paper's "all of the beam experiences
/// negative curvature" is about slow shaking.
#[test]
fn pressures_of_wiring_2_ask_for_one_sign_and_of_wiring_3_for_two() {
    let damped = [
        r#"/beam/damping={"bending_time_s":0.002,"axial_time_s":0.002}"#,
        "/solver/rtol=1e-6",
    ];
    for (case, one_sign) in [("wiring-2", true), ("wiring-3", false)] {
        let run = shaken(case, PUBLISHED, 20.0, 15.0, &damped);
        let (kappa, by_pressure) = last_cycle(&run);
        let steady: Vec<f64> = kappa[100].iter().zip(&kappa[0]).map(|(a, b)| a - b).collect();
        let change = largest(&steady) / kappa.iter().map(|k| largest(k)).fold(0.0, f64::max);
        let share = |mixed: &[f64]| mixed.iter().filter(|m| **m < 0.05).count() as f64 / mixed.len() as f64;
        let (asked, taken) = (share(&mixing(&by_pressure)), share(&mixing(&kappa)));
        println!(
            "{case}, 20 Hz: one sign asked for at {asked:.2}, taken at {taken:.2} of instants; cycle repeats to {change:.1e}"
        );
        assert!(change < 0.01);
        if one_sign {
            assert!(asked > 0.7);
        } else {
            assert!(asked < 0.3);
        }
    }
}

/// Amplitude and phase of the component of a signal with one period over the samples.
fn fourier(samples: impl ExactSizeIterator<Item = f64>) -> Complex<f64> {
    let n = samples.len() as f64;
    let turn = |k: usize| Complex::from_polar(2.0 / n, -std::f64::consts::TAU * k as f64 / n);
    samples.enumerate().map(|(k, x)| turn(k) * x).sum()
}

/// Goal: the closed form above, measured. One pressure oscillates in the whole upper row of a beam that does not act back, with drag that
/// ends the free vibration: `b^4 = (m w^2 - i w c) l^4/EI`. 40 cells shift the first frequency by 1e-3, amplified threefold at 1.6 times
/// the first frequency: 1 %.
#[test]
fn above_its_first_frequency_a_beam_answers_uniform_pressure_with_two_signs() {
    let pressure = r#"{"pressure_pa":{"sine":{"amplitude":100,"frequency_hz":20,"ramp_cycles":3}}}"#;
    let chain = format!(r#"/network/chains=[{{"bladders":[1,2,3,4,5,6,7,8,9,10],"ends":[{pressure},{pressure}]}}]"#);
    let case = shipped(
        "wiring-2",
        &[
            CONSERVATIVE,
            PUBLISHED,
            r#"/bladders/area_per_moment_m2_per_n_m={"opening":0,"closing":0}"#,
            r#"/bladders/area_per_force_m2_per_n={"tension":0,"compression":0}"#,
            &chain,
            "/network/permeability_factor=1000",
            "/ends/root=\"clamped\"",
            r#"/effects={"rotary_inertia":"off","tube_inertia":"off","tube_losses":"off"}"#,
            r#"/beam/damping={"drag_n_s_m2":20}"#,
            "/time/end_s=1",
            "/time/output_interval_s=5e-4",
            "/time/fields_interval_s=5e-4",
            "/time/window_s=0.05",
            "/solver/rtol=1e-7",
        ],
    );
    let m = Model::new(&case).unwrap().section.mass_per_length;
    let omega = 40.0 * std::f64::consts::PI;
    let b: Complex<f64> = (Complex::new(m * omega * omega, -20.0 * omega) / EI).powf(0.25) * LENGTH;
    let exact: Complex<f64> = (b.cosh() + b.cos()) / (b.cosh() * b.cos() + 1.0);
    let run = run(&case);
    let kappa = run.field("curvature_1_m");
    let cycle = &kappa[kappa.len() - 100..];
    let at = |node: usize| fourier(cycle.iter().map(|k| k[node]));
    let measured = at(0) / at(cycle[0].len() - 1);
    let off = (measured - exact).norm() / exact.norm();
    println!("kappa(0)/kappa(l) at 20 Hz: {measured:.5}, exact {exact:.5}, off by {off:.1e}");
    assert!(off < 0.01 && measured.re < -1.0);
}
