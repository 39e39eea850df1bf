//! Steps, stops, interpolation, restarts and impossible requests.

use slcbeam::dae::{Dae, EvaluationError, Seeds};
use slcbeam::integrate::AbsoluteTolerances;
use slcbeam::sparse::Pattern;
use slcbeam::sundials::Ida;
use slcbeam::sundials::IdaOptions;

/// `q' = p, p' = -q, 0 = s - q p`: with a known solution, and one algebraic unknown.
struct Pendulum {
    pattern: Pattern,
}

impl Dae for Pendulum {
    fn len(&self) -> usize {
        3
    }

    fn differential(&self) -> &[bool] {
        &[true, true, false]
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn residual(&mut self, _: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        residual.copy_from_slice(&[yp[0] - y[1], yp[1] + y[0], y[2] - y[0] * y[1]]);
        Ok(())
    }

    fn jacobian(
        &mut self,
        _: f64,
        y: &[f64],
        _: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let (a, b) = match seeds {
            Seeds::Step { cj } => ([1.0; 3], [cj; 3]),
            Seeds::Columns { y, yp } => ([y[0], y[1], y[2]], [yp[0], yp[1], yp[2]]),
        };
        values.copy_from_slice(&[b[0], a[0], -a[0] * y[1], -a[1], b[1], -a[1] * y[0], a[2]]);
        Ok(())
    }

    fn name(&self, unknown: usize) -> String {
        ["q", "p", "s"][unknown].to_owned()
    }
}

fn pendulum(options: &IdaOptions) -> Ida<Pendulum> {
    let pattern = Pattern::from_columns(&[vec![0, 1, 2], vec![0, 1, 2], vec![2]]);
    Ida::new(Pendulum { pattern }, 0.0, &[0.0, 1.0, 0.0], &[1.0, 0.0, 1.0], options).unwrap()
}

fn tight() -> IdaOptions {
    IdaOptions {
        relative: 1e-8,
        absolute: AbsoluteTolerances::Same(1e-8),
        max_order: 5,
        ..IdaOptions::default()
    }
}

/// Goal: stops are hit exactly and never passed, near and far; a past one is rejected.
///
/// Tolerance: time is compared by equality; the solution by the accumulated local error, 1e-8 times some hundred steps.
#[test]
fn stop_times_are_hit_exactly() {
    let mut ida = pendulum(&tight());
    // the last two differ only by rounding
    for stop in [1e-3, 0.1, 0.1 + 1e-9, 1.0 / 3.0, 2.0, 2.0 + 4e-16] {
        loop {
            let step = ida.step(stop).unwrap();
            assert!(step.time <= stop && step.time == ida.time());
            if step.stopped {
                break;
            }
            assert!(step.size > 0.0 && (1..=5).contains(&step.order));
        }
        assert_eq!(ida.time(), stop);
        assert!((ida.y()[0] - stop.sin()).abs() < 1e-6);
    }
    let refused = ida.step(1.0).unwrap_err();
    assert!(refused.to_string().contains("lies behind"), "{refused}");
    assert!(ida.step(f64::NAN).is_err());
    assert!(ida.step(2.5).is_ok());
}

/// Goal: within a step the polynomial gives values and derivatives; outside there is an error.
///
/// Tolerance: rounding at the end of the step, where it equals the solution; inside, the local error 1e-8 with a margin for the derivative,
/// which loses a factor 1/h.
#[test]
fn interpolation_matches() {
    let mut ida = pendulum(&tight());
    let mut out = [0.0; 3];
    assert!(ida.interpolate(0.0, 0, &mut out).is_err());
    for _ in 0..60 {
        let step = ida.step(10.0).unwrap();
        ida.interpolate(step.time, 0, &mut out).unwrap();
        for (a, b) in out.iter().zip(ida.y()) {
            assert!((a - b).abs() < 1e-14);
        }
        for part in [0.1, 0.5, 1.0] {
            let t = step.time - part * step.size;
            ida.interpolate(t, 0, &mut out).unwrap();
            assert!((out[0] - t.sin()).abs() < 1e-6 && (out[2] - t.sin() * t.cos()).abs() < 1e-6);
            ida.interpolate(t, 1, &mut out).unwrap();
            assert!((out[0] - t.cos()).abs() < 1e-3, "{} {}", out[0], t.cos());
        }
        assert!(ida.interpolate(step.time - 1.5 * step.size, 0, &mut out).is_err());
        assert!(ida.interpolate(step.time, step.order + 1, &mut out).is_err());
    }
}

/// Goal: counters continue over restarts, in which IDA resets them, and the equations are returned.
#[test]
fn counters_accumulate_over_restarts() {
    let mut ida = pendulum(&tight());
    let mut steps = 0;
    let mut before = ida.counters();
    for restart in 1..=3 {
        for _ in 0..20 {
            ida.step(100.0).unwrap();
            steps += 1;
        }
        let (t, y, yp) = (ida.time(), ida.y().to_vec(), ida.yp().to_vec());
        ida.restart(t, &y, &yp).unwrap();
        let now = ida.counters();
        assert_eq!((now.steps, now.restarts), (steps, restart));
        assert_eq!(now.steps_by_order.iter().sum::<u64>(), steps);
        assert!(
            now.newton_iterations > before.newton_iterations && now.residual_evaluations > before.residual_evaluations
        );
        assert!(now.factorizations > before.factorizations && now.factorizations >= now.jacobian_evaluations);
        assert_eq!(now.linear_solves, now.newton_iterations);
        assert_eq!((ida.time(), ida.y()), (t, y.as_slice()));
        before = now;
    }
    assert!((ida.y()[0] - ida.time().sin()).abs() < 1e-6);
    assert_eq!(ida.into_dae().name(2), "s");
}

/// Goal: two equal runs agree bit for bit.
#[test]
fn runs_repeat_bit_for_bit() {
    let run = || {
        let mut ida = pendulum(&tight());
        while !ida.step(20.0).unwrap().stopped {}
        (ida.y().iter().map(|y| y.to_bits()).collect::<Vec<_>>(), ida.counters())
    };
    assert_eq!(run(), run());
}

/// Goal: order, step limits and the choice of tested unknowns are respected.
#[test]
fn options_are_obeyed() {
    let options = IdaOptions {
        max_order: 1,
        max_step: Some(1e-2),
        initial_step: Some(1e-5),
        ..IdaOptions::default()
    };
    let mut ida = pendulum(&options);
    assert_eq!(ida.step(1.0).unwrap().size, 1e-5);
    while !ida.step(1.0).unwrap().stopped {}
    let counters = ida.counters();
    assert_eq!(counters.steps_by_order, [counters.steps]);
    assert!(counters.steps >= 100);
    ida.set_initial_step(Some(2e-5)).unwrap();
    ida.restart(0.0, &[0.0, 1.0, 0.0], &[1.0, 0.0, 1.0]).unwrap();
    assert_eq!(ida.step(1.0).unwrap().size, 2e-5);
    let all = IdaOptions {
        suppress_algebraic: false,
        relative: 1e-6,
        absolute: AbsoluteTolerances::Each(vec![1e-4, 1e-4, 1e-12]),
        ..tight()
    };
    let some = IdaOptions {
        suppress_algebraic: true,
        ..all.clone()
    };
    let steps = |options| {
        let mut ida = pendulum(&options);
        while !ida.step(5.0).unwrap().stopped {}
        ida.counters().steps
    };
    assert!(steps(some) < steps(all), "the algebraic unknown asks for most steps");
}

/// Goal: impossible requests are rejected with a message.
#[test]
fn impossible_requests_are_refused() {
    let pattern = || Pattern::from_columns(&[vec![0, 1, 2], vec![0, 1, 2], vec![2]]);
    let refuse = |y: &[f64], options: &IdaOptions, words: &str| {
        let failure = Ida::new(Pendulum { pattern: pattern() }, 0.0, y, &[0.0; 3], options)
            .err()
            .unwrap();
        assert!(failure.to_string().contains(words), "{failure}");
    };
    let options = IdaOptions::default;
    refuse(&[0.0; 2], &options(), "2 values");
    refuse(
        &[0.0; 3],
        &IdaOptions {
            relative: 0.0,
            ..options()
        },
        "relative tolerance",
    );
    refuse(
        &[0.0; 3],
        &IdaOptions {
            max_order: 6,
            ..options()
        },
        "order",
    );
    refuse(
        &[0.0; 3],
        &IdaOptions {
            absolute: AbsoluteTolerances::Each(vec![1.0]),
            ..options()
        },
        "1 absolute tolerances",
    );
    let mut ida = Ida::new(
        Pendulum { pattern: pattern() },
        0.0,
        &[f64::NAN, 0.0, 0.0],
        &[0.0; 3],
        &options(),
    )
    .unwrap();
    assert!(ida.step(1.0).is_err());
}
