//! Problems of the IVP test set (Mazzia & Magherini, Bari) and of SUNDIALS' examples, against their published answers.

use slcbeam::dae::Dae;
use slcbeam::integrate::AbsoluteTolerances;
use slcbeam::sundials::Ida;
use slcbeam::sundials::IdaOptions;

use crate::problems::{TRANSISTOR, beam, robertson, transistor, transistor_start, transistor_voltages};

/// Steps until `end`.
fn run<D: Dae>(ida: &mut Ida<D>, end: f64) {
    while !ida.step(end).unwrap().stopped {}
    assert_eq!(ida.time(), end);
}

fn assert_close(values: &[f64], exact: &[f64], relative: f64) {
    for (i, (a, b)) in values.iter().zip(exact).enumerate() {
        assert!(
            (a - b).abs() <= relative * b.abs(),
            "value {i}: {a:e} instead of {b:e}, {:e}",
            (a - b) / b
        );
    }
}

/// Robertson's reaction over eleven decades of time.
///
/// Source: IVP test set (t = 1e11) and SUNDIALS' idaRoberts (t = 4e10). Goal: stiff scales and an algebraic equation.
/// Tolerance: local errors of 1e-9 relative add up over some thousand steps; 1e-6 includes a margin.
#[test]
fn robertson_reaches_published_values() {
    let options = IdaOptions {
        relative: 1e-9,
        absolute: AbsoluteTolerances::Each(vec![1e-16, 1e-20, 1e-12]),
        max_order: 5,
        ..IdaOptions::default()
    };
    let mut ida = Ida::new(robertson(), 0.0, &[1.0, 0.0, 0.0], &[-0.04, 0.04, 0.0], &options).unwrap();
    run(&mut ida, 4e10);
    assert_close(
        ida.y(),
        &[5.20834517680e-8, 2.08333817793e-13, 0.9999999479163398],
        1e-6,
    );
    run(&mut ida, 1e11);
    assert_close(
        ida.y(),
        &[2.083340149701255e-8, 8.333360770334713e-14, 0.999999979166505],
        1e-6,
    );
    let steps = ida.counters().steps;
    assert!((500..5000).contains(&steps), "{steps} steps");
}

/// Transistor amplifier over twenty periods of the input.
///
/// Source: IVP test set (Rentrop, Roche & Steinebach). Goal: index 1 with exponential nonlinearities. Its algebraic voltages are rates of
/// the differential ones, so their error is of one order less; in the error test they would cost more than ten times the steps. Tolerance:
/// local errors of 5e-9, and 1e-9 V of the smallest voltage, 6 mV. Errors at similar tolerances are 1.5e-7 to 4e-7; 1e-6 relative leaves a
/// margin for steps changed by rounding.
#[test]
fn transistor_amplifier_reaches_published_values() {
    let options = IdaOptions {
        relative: 5e-9,
        absolute: AbsoluteTolerances::Same(1e-9),
        max_order: 5,
        suppress_algebraic: true,
        ..IdaOptions::default()
    };
    let (y, yp) = transistor_start();
    let mut ida = Ida::new(transistor(), 0.0, &y, &yp, &options).unwrap();
    run(&mut ida, 0.2);
    assert_close(&transistor_voltages(ida.y()), &TRANSISTOR, 1e-6);
    let steps = ida.counters().steps;
    assert!((1500..5000).contains(&steps), "{steps} steps");
}

/// Beam of 40 angles under a force that follows sin² t until t = π, at t = 5.
///
/// Source: IVP test set (Hairer & Wanner). Goal: undamped waves, for which order 2 needs hundreds of steps, higher orders tens of
/// thousands. Tolerance: local errors of 1e-5 over 750 steps add up to less than 7e-3, and a hundredth of the tolerance must reduce errors
/// more than tenfold (order 2 promises 100^(2/3) = 22); rates include the waves and are less accurate.
#[test]
fn beam_needs_few_steps_of_order_two() {
    let angles = [-0.5792366591285007e-2, -0.1483595472463012, -0.1767201761075488];
    let rates = [0.3747362681329794e-1, 0.9868747821728363, 1.186724615113034];
    let solve = |tolerance: f64| {
        let options = IdaOptions {
            relative: tolerance,
            absolute: AbsoluteTolerances::Same(tolerance),
            ..IdaOptions::default()
        };
        let mut ida = Ida::new(beam(), 0.0, &[0.0; 80], &[0.0; 80], &options).unwrap();
        run(&mut ida, std::f64::consts::PI);
        run(&mut ida, 5.0);
        let y = ida.y();
        let error = |places: [usize; 3], exact: &[f64]| {
            places
                .iter()
                .zip(exact)
                .map(|(&i, b)| (y[i] - b).abs())
                .fold(0.0, f64::max)
        };
        (ida.counters(), error([0, 19, 39], &angles), error([40, 59, 79], &rates))
    };
    let (counters, angle, rate) = solve(1e-5);
    assert!((400..1500).contains(&counters.steps), "{} steps", counters.steps);
    assert!(
        counters.factorizations < 200,
        "{} factorisations",
        counters.factorizations
    );
    assert_eq!(counters.steps_by_order.iter().sum::<u64>(), counters.steps);
    assert!(angle < 3e-3 && rate < 2e-2, "{angle:e} {rate:e}");
    let (_, finer_angle, finer_rate) = solve(1e-7);
    assert!(
        finer_angle < 0.1 * angle && finer_rate < 0.1 * rate,
        "{finer_angle:e} {finer_rate:e}"
    );
}
