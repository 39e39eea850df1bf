//! Physical instabilities with their growth rates, and nearby stable cases.

use nalgebra::Complex;
use slcbeam::model::characteristic::{MATHIEU_COUPLING, mathieu_growth};

use crate::harness::{Ran, run};

/// The slender beam of these cases: length 1 m.
const EI: f64 = 2e9 * 0.05 * 1e-6 / 12.0;
const MASS: f64 = 1200.0 * 0.05 * 0.01;

/// Slope of `ln |u|` at its extrema between two times, by least squares [1/s].
fn envelope_rate(ran: &Ran, from: f64, to: f64) -> f64 {
    let (t, u) = (ran.column("t"), ran.column("tip_u1"));
    let peaks: Vec<(f64, f64)> = (1..t.len() - 1)
        .filter(|&k| (from..=to).contains(&t[k]) && u[k].abs() >= u[k - 1].abs() && u[k].abs() > u[k + 1].abs())
        .map(|k| (t[k], u[k].abs().ln()))
        .collect();
    assert!(peaks.len() >= 3, "{}: {} extrema", ran.name, peaks.len());
    slope(&peaks)
}

fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mt, my) = (
        points.iter().map(|p| p.0).sum::<f64>() / n,
        points.iter().map(|p| p.1).sum::<f64>() / n,
    );
    let above: f64 = points.iter().map(|p| (p.0 - mt) * (p.1 - my)).sum();
    above / points.iter().map(|p| (p.0 - mt).powi(2)).sum::<f64>()
}

/// Source: `model::characteristic::mathieu_growth` (single mode, monodromy matrix). Goal: inside the tongue growth is the physical one,
/// outside there is none. Tolerance 2 %: neglected higher modes change it by the square of the modulation over their distance; the mesh of
/// 40 cells detunes by 1e-3 of a tongue of 5e-2.
#[test]
fn mathieu_inside_and_outside_the_tongue() {
    let first = 1.875_104_068_712_f64.powi(2) * (EI / MASS).sqrt();
    for formulation in [r#"/formulation="conservative""#, r#"/formulation="published""#] {
        let ran = run("mathieu", &[formulation]).sound().steps_within(200, 13_333);
        let omega = 2.0 * std::f64::consts::PI * 4.17;
        let expected = mathieu_growth(first * first, MATHIEU_COUPLING * 0.0318 * omega * omega, omega);
        let rate = envelope_rate(&ran, 2.5, 6.0);
        let ran = ran.line(&format!("inside: growth {rate:.4} 1/s, Mathieu {expected:.4} 1/s"));
        assert!((rate / expected - 1.0).abs() < 2e-2, "{}: {rate} {expected}", ran.name);

        let outside = ["/ends/root/clamped/u3_m/sine/frequency_hz=4.8", formulation];
        let ran = run("mathieu", &outside).sound().steps_within(200, 13_333);
        let u = ran.column("tip_u1");
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let (early, late) = (largest(&u[..300]), largest(&u[300..]));
        let ran = ran.line(&format!("outside: largest tip u1 {early:.2e} then {late:.2e} m"));
        assert!(late < 1.1 * early, "{}: {early} {late}", ran.name);
    }
}

/// `p^2 + 2 w^2 (1 + cosh a cos b) + p w sinh a sin b`, `ab = w`, `b^2 - a^2 = p`: zero at Beck's complex frequencies.
fn beck(p: f64, w: Complex<f64>) -> Complex<f64> {
    let root = (w * w + p * p / 4.0).sqrt();
    let (a, b) = ((root - p / 2.0).sqrt(), (root + p / 2.0).sqrt());
    w * w * 2.0 * (a.cosh() * b.cos() + 1.0) + w * p * a.sinh() * b.sin() + p * p
}

/// Source: Beck 1952; flutter at `P l^2/EI = 20.0510` with `w = 11.0156` (`docs/exact-results.md` section 1). Goal: a follower load 8 %
/// below oscillates forever, 10 % above it flutters with the rate of the exact characteristic equation. Tolerance 5 %: the rate is
/// proportional to the root of the distance to 20.05, which 40 cells shift by 0.2 %, a twentieth of it.
#[test]
fn beck_below_and_above_flutter() {
    assert!(beck(20.050_953_6, Complex::new(11.015_557_6, 0.0)).norm() < 1e-2);
    let mut w = Complex::new(11.0, -2.0);
    for _ in 0..50 {
        let (f, g) = (beck(22.0, w), beck(22.0, w + 1e-6));
        w -= f * 1e-6 / (g - f);
    }
    let expected = w.im.abs() * (EI / MASS).sqrt();
    for formulation in [r#"/formulation="conservative""#, r#"/formulation="published""#] {
        let ran = run(
            "beck",
            &["/time/end_s=0.8", "/time/output_interval_s=5e-4", formulation],
        )
        .sound();
        let rate = envelope_rate(&ran, 0.4, 0.8);
        let ran = ran.line(&format!("P l^2/EI 22: growth {rate:.3} 1/s, exact {expected:.3} 1/s"));
        assert!((rate / expected - 1.0).abs() < 5e-2, "{}: {rate} {expected}", ran.name);

        let below = format!("/ends/tip/free/follower_normal_n/ramp/to={:e}", -18.5 * EI);
        let ran = run("beck", &[&below, formulation]).sound();
        let u = ran.column("tip_u1");
        let largest = |part: &[f64]| part.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let (early, late) = (largest(&u[..u.len() / 2]), largest(&u[u.len() / 2..]));
        let ran = ran.line(&format!("P l^2/EI 18.5: largest tip u1 {early:.2e} then {late:.2e} m"));
        assert!(late < 1.1 * early, "{}: {early} {late}", ran.name);
    }
}

/// Characteristic determinant of a clamped-free column under a dead load, `p = P l^2/EI`, `s = m g^2 l^4/EI` for growth g
/// (s < 0: frequency), in functions of `q = a^2` that are even in a, without its trivial zero at `q_a = q_b`.
fn column(p: f64, s: f64) -> f64 {
    let root = Complex::new(0.25 * p * p - s, 0.0).sqrt();
    let (qa, qb) = (root + 0.5 * p, -root + 0.5 * p);
    let c = |q: Complex<f64>| q.sqrt().cos();
    let f = |q: Complex<f64>| q.sqrt().sin() / q.sqrt();
    let d =
        (qb * c(qb) - qa * c(qa)) * (qb * c(qa) - qa * c(qb)) - (qb * f(qb) - qa * f(qa)) * qa * qb * (f(qb) - f(qa));
    (d / (root * root)).re
}

/// `m g^2 l^4/EI` of the first mode at `load = P/Pcr`: the first change of sign away from zero.
fn first_root(load: f64) -> f64 {
    let p = load * std::f64::consts::PI.powi(2) / 4.0;
    let step = 12.362_4 * (load - 1.0) / 200.0;
    let (mut low, mut high) = (0.5 * step, 1.5 * step);
    while column(p, low) * column(p, high) > 0.0 {
        assert!(high.abs() < 100.0, "no root at {load}");
        (low, high) = (high, high + step);
    }
    for _ in 0..100 {
        let s = 0.5 * (low + high);
        *(if column(p, s) * column(p, low) > 0.0 {
            &mut low
        } else {
            &mut high
        }) = s;
    }
    low
}

/// Source: the exact characteristic equation. Goal: a hundredth below the buckling load the column oscillates with its slow frequency, a
/// hundredth above it falls with its slow rate. Tolerance 1 %: the mesh shifts the load by 3e-5 (80 cells), compression by 2e-5, together
/// 0.3 % of the rate at a distance of 1 %.
#[test]
fn columns_around_their_buckling_load() {
    let critical = std::f64::consts::PI.powi(2) * EI / 4.0;
    for formulation in [r#"/formulation="conservative""#, r#"/formulation="published""#] {
        for (load, end) in [(0.9, 6.0), (0.99, 14.0), (1.01, 4.0), (1.5, 0.9)] {
            let sets = [
                format!("/ends/tip/free/force_z_n/ramp/to={:e}", -load * critical),
                format!("/time/end_s={end}"),
                format!("/time/output_interval_s={:e}", end / 500.0),
                "/mesh/segments=20".to_string(),
                formulation.to_string(),
            ];
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            let ran = run("column", &sets).sound();
            let expected = first_root(load).abs().sqrt() * (EI / MASS).sqrt();
            let (t, u) = (ran.column("t"), ran.column("tip_u1"));
            let got = if load > 1.0 {
                let late = (0..t.len()).filter(|&k| t[k] > 0.6 * end && t[k] < end);
                slope(&late.map(|k| (t[k], u[k].abs().ln())).collect::<Vec<_>>())
            } else {
                let crossings: Vec<f64> = (1..t.len())
                    .filter(|&k| t[k] > 0.3 && u[k - 1] * u[k] < 0.0)
                    .map(|k| t[k - 1] + (t[k] - t[k - 1]) * u[k - 1] / (u[k - 1] - u[k]))
                    .collect();
                let half_periods = (crossings.len() - 1) as f64;
                std::f64::consts::PI * half_periods / (crossings[crossings.len() - 1] - crossings[0])
            };
            println!(
                "column P/Pcr {load}, {formulation} | {} steps | energy {:.1e} | {} {got:.4} 1/s, exact {expected:.4} 1/s",
                ran.steps(),
                ran.summary.balances.energy_residual_relative,
                if load > 1.0 { "growth" } else { "frequency" }
            );
            assert!((got / expected - 1.0).abs() < 1e-2, "{}: {got} {expected}", ran.name);
        }
    }
}
