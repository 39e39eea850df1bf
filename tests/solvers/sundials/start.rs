//! Consistent initial values.

use slcbeam::dae::Dae;
use slcbeam::integrate::{StartOptions, consistent_start};

use crate::problems::{Plain, transistor, transistor_start};

/// Transistor amplifier from poor guesses of its algebraic voltages.
///
/// Source: IVP test set, initial values. Goal: u2 = u5 = 3, u8 = 0 and the capacitor rates, exponentials in between.
/// Tolerance: the start is consistent up to the leak 1e-6 (1 - e^0) = 0, so round-off of values of order 100.
#[test]
fn transistor_amplifier_starts_consistently() {
    let (exact, rates) = transistor_start();
    let (mut y, mut yp) = (exact, [0.0; 8]);
    (y[1], y[4], y[7]) = (2.8, 3.3, 1.0);
    let report = consistent_start(&mut transistor(), 0.0, &mut y, &mut yp, &StartOptions::default()).unwrap();
    assert!(report.iterations < 20 && report.residual < 1e-12, "{report:?}");
    for i in 0..8 {
        assert!((y[i] - exact[i]).abs() < 1e-11, "{i}: {} {}", y[i], exact[i]);
        assert!((yp[i] - rates[i]).abs() < 1e-8, "{i}: {} {}", yp[i], rates[i]);
    }
}

/// A remote start: `tan⁻¹(y) = 0`, for which undamped Newton diverges from |y| > 1.392.
///
/// Source: Deuflhard, Newton Methods for Nonlinear Problems, example of damping. Tolerance: quadratic convergence.
#[test]
fn damping_reaches_what_newton_misses() {
    let mut dae = Plain::new(&[false], |_, y, _, f| {
        f[0] = y[0].atan();
        Ok(())
    });
    let (mut y, mut yp) = ([20.0], [7.0]);
    let report = consistent_start(&mut dae, 0.0, &mut y, &mut yp, &StartOptions::default()).unwrap();
    assert!(
        y[0].abs() < 1e-12 && yp[0] == 0.0 && report.iterations < 30,
        "{y:?} {report:?}"
    );
}

/// Systems without a solution fail and name the unknown.
///
/// Goal: `y2² + 1 = 0` and an undetermined unknown.
#[test]
fn hopeless_starts_name_the_unknown() {
    let mut dae = Plain::new(&[true, false], |_, y, yp, f| {
        f[0] = yp[0] + y[0];
        f[1] = y[1] * y[1] + 1.0;
        Ok(())
    });
    let failure =
        consistent_start(&mut dae, 0.0, &mut [1.0, 0.7], &mut [0.0; 2], &StartOptions::default()).unwrap_err();
    assert_eq!(
        failure.worst.as_ref().map(|worst| worst.1.as_str()),
        Some("y2"),
        "{failure}"
    );
    let mut dae = Plain::new(&[true, false], |_, y, yp, f| {
        f[0] = yp[0] + y[0];
        f[1] = y[0] - 1.0;
        Ok(())
    });
    let failure =
        consistent_start(&mut dae, 0.0, &mut [1.0, 0.7], &mut [0.0; 2], &StartOptions::default()).unwrap_err();
    assert_eq!(
        failure.worst.as_ref().map(|worst| worst.1.as_str()),
        Some("y2"),
        "{failure}"
    );
    assert_eq!(dae.len(), 2);
}
