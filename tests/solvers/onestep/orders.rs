//! Orders of convergence, stiff problems, problems with published answers.

use slcbeam::dae::Dae;
use slcbeam::integrate::AbsoluteTolerances;
use slcbeam::onestep::{OneStep, OneStepOptions, TableauMethod};

use crate::problems::{Plain, TRANSISTOR, beam, robertson, transistor, transistor_start, transistor_voltages};

/// Options of fixed steps: every error is accepted, and Newton converges to 1e-13 of the weights.
pub fn fixed(method: TableauMethod, step: f64) -> OneStepOptions {
    OneStepOptions {
        method,
        relative: 1.0,
        absolute: AbsoluteTolerances::Same(1.0),
        newton_tolerance: Some(1e-13),
        initial_step: Some(step),
        max_step: Some(step),
        ..OneStepOptions::default()
    }
}

fn adaptive(method: TableauMethod, relative: f64, absolute: AbsoluteTolerances) -> OneStepOptions {
    OneStepOptions {
        method,
        relative,
        absolute,
        ..OneStepOptions::default()
    }
}

pub fn run<D: Dae>(integrator: &mut OneStep<D>, end: f64) {
    while !integrator.step(end).unwrap().stopped {}
}

/// Nonlinear system of index one, with the solution (sin t, cos t, sin t cos t).
pub fn circle() -> Plain {
    Plain::new(&[true, true, false], |_, y, yp, f| {
        let product = y[0] * y[1];
        f[0] = yp[0] - y[1] - 3.0 * (y[2] - product);
        f[1] = yp[1] + y[0] * y[0] * y[0] + y[0] * y[1] * y[1] + (y[2] - product);
        f[2] = y[2] + 0.1 * y[2].powi(3) - product - 0.1 * product.powi(3);
        Ok(())
    })
}

/// Goal: with fixed steps, the error falls with the method's order, in differential and algebraic unknowns and in rates.
///
/// Tolerance on the order: 0.35, since steps small enough to be asymptotic would show rounding errors.
#[test]
fn orders_are_those_of_the_methods() {
    for method in TableauMethod::ALL {
        let error = |steps: f64| {
            let mut one = OneStep::new(
                circle(),
                0.0,
                &[0.0, 1.0, 0.0],
                &[1.0, 0.0, 0.0],
                &fixed(method, 2.0 / steps),
            )
            .unwrap();
            run(&mut one, 2.0);
            assert_eq!(one.counters().steps as f64, steps);
            let (s, c) = 2.0_f64.sin_cos();
            let (y, yp) = (one.y(), one.yp());
            [
                (y[0] - s).abs() + (y[1] - c).abs(),
                (y[2] - s * c).abs(),
                (yp[0] - c).abs() + (yp[1] + s).abs(),
            ]
        };
        let (coarse, fine) = (error(16.0), error(32.0));
        for (what, (coarse, fine)) in ["differential", "algebraic", "rates"]
            .iter()
            .zip(coarse.iter().zip(fine))
        {
            let order = (coarse / fine).log2();
            assert!(
                order > f64::from(method.order()) - 0.35,
                "{method}, {what}: {order} ({coarse:e} {fine:e})"
            );
        }
    }
}

/// `y' = -λ (y - cos t) - sin t` (Prothero & Robinson) with λ h = 1e5, started off the solution. Goal: one step damps the start, by
/// L-stability (`R ~ 1/(λ h)`), and rates remain bounded.
///
/// Tolerance: some 1/(λ h) of the start, and some h²/λ of the smooth solution.
#[test]
fn stiff_transients_are_forgotten() {
    for method in TableauMethod::ALL {
        let problem = Plain::new(&[true], |t, y, yp, f| {
            f[0] = 1e-6 * (yp[0] + t.sin()) + y[0] - t.cos();
            Ok(())
        });
        let mut one = OneStep::new(problem, 0.0, &[2.0], &[-1e6], &fixed(method, 0.1)).unwrap();
        one.step(2.0).unwrap();
        assert!((one.y()[0] - 0.1_f64.cos()).abs() < 1e-3, "{method}: {}", one.y()[0]);
        run(&mut one, 2.0);
        assert!((one.y()[0] - 2.0_f64.cos()).abs() < 1e-7, "{method}: {}", one.y()[0]);
    }
}

/// Robertson's reaction over eleven decades. Source: IVP test set. Tolerance: local errors of 1e-7 over some hundred steps (order 2: a
/// thousand), while concentrations fall by seven decades.
#[test]
fn robertson_reaches_published_values() {
    for method in TableauMethod::ALL {
        let options = adaptive(method, 1e-7, AbsoluteTolerances::Each(vec![1e-12, 1e-16, 1e-10]));
        let mut one = OneStep::new(robertson(), 0.0, &[1.0, 0.0, 0.0], &[-0.04, 0.04, 0.0], &options).unwrap();
        run(&mut one, 1e11);
        let exact = [2.083340149701255e-8, 8.333360770334713e-14, 0.999999979166505];
        for (a, b) in one.y().iter().zip(exact) {
            assert!((a - b).abs() < 2e-3 * b, "{method}: {a:e} instead of {b:e}");
        }
    }
}

/// Transistor amplifier. Source: IVP test set. Goal: index one with exponentials, algebraic unknowns under error control. Tolerance: local
/// errors of 1e-6 over some thousand steps, 1e-4 with a margin for growth; a tenth of the tolerance is more accurate.
#[test]
fn transistor_amplifier_reaches_published_values() {
    let error = |method, tolerance: f64| {
        let (y, yp) = transistor_start();
        let options = adaptive(method, tolerance, AbsoluteTolerances::Same(tolerance));
        let mut one = OneStep::new(transistor(), 0.0, &y, &yp, &options).unwrap();
        run(&mut one, 0.2);
        let voltages = transistor_voltages(one.y());
        let errors = voltages.iter().zip(TRANSISTOR).map(|(a, b)| (a - b).abs());
        errors.fold(0.0, f64::max)
    };
    for method in [TableauMethod::Esdirk34, TableauMethod::Esdirk46] {
        let (loose, tight) = (error(method, 1e-5), error(method, 1e-7));
        assert!(tight < 1e-4 && tight < 0.2 * loose, "{method}: {loose:e} {tight:e}");
    }
}

/// Beam of 40 angles. Source: IVP test set (Hairer & Wanner). Goal: undamped waves do not limit the steps. Tolerances as in
/// `tests/solvers/sundials/published.rs`; order 4 needs no more steps than order 2 there.
#[test]
fn beam_is_not_held_down_by_its_waves() {
    let angles = [-0.5792366591285007e-2, -0.1483595472463012, -0.1767201761075488];
    for method in [TableauMethod::Esdirk34, TableauMethod::Esdirk46] {
        let options = adaptive(method, 1e-5, AbsoluteTolerances::Same(1e-5));
        let mut one = OneStep::new(beam(), 0.0, &[0.0; 80], &[0.0; 80], &options).unwrap();
        run(&mut one, std::f64::consts::PI);
        run(&mut one, 5.0);
        for (i, exact) in [0, 19, 39].into_iter().zip(angles) {
            assert!(
                (one.y()[i] - exact).abs() < 3e-3,
                "{method}: {} instead of {exact}",
                one.y()[i]
            );
        }
        let steps = one.counters().steps;
        assert!(steps < 1500, "{method}: {steps} steps");
    }
}
