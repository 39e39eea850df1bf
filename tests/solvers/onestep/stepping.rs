//! Steps, stops, interpolation, restarts, and impossible requests.

use slcbeam::dae::{Dae, EvaluationError, Seeds};
use slcbeam::integrate::AbsoluteTolerances;
use slcbeam::onestep::{OneStep, OneStepOptions, TableauMethod};
use slcbeam::sparse::Pattern;

use super::orders::{circle, fixed, run};
use crate::problems::Plain;

fn at_start(options: &OneStepOptions) -> OneStep<Plain> {
    OneStep::new(circle(), 0.0, &[0.0, 1.0, 0.0], &[1.0, 0.0, 0.0], options).unwrap()
}

fn tight(method: TableauMethod) -> OneStepOptions {
    OneStepOptions {
        method,
        relative: 1e-8,
        absolute: AbsoluteTolerances::Same(1e-8),
        ..OneStepOptions::default()
    }
}

/// Goal: stops are hit exactly and never passed, near and far; a past one is rejected.
///
/// Tolerance: time is compared by equality; the solution by local errors of 1e-8 over up to a thousand steps.
#[test]
fn stop_times_are_hit_exactly() {
    for method in TableauMethod::ALL {
        let mut one = at_start(&tight(method));
        for stop in [1e-3, 0.1, 0.1 + 1e-9, 1.0 / 3.0, 2.0, 2.0 + 4e-16] {
            loop {
                let step = one.step(stop).unwrap();
                assert!(step.time <= stop && step.time == one.time());
                if step.stopped {
                    break;
                }
                assert!(step.size > 0.0 && step.order == method.order());
            }
            assert_eq!(one.time(), stop);
            assert!((one.y()[0] - stop.sin()).abs() < 1e-5, "{method} at {stop}");
        }
        assert!(one.step(1.0).unwrap_err().to_string().contains("lies behind"));
        assert!(one.step(f64::NAN).is_err() && one.step(2.5).is_ok());
    }
}

/// Goal: within a step, values are of third order or that of the method, rates of one order less, and both are continuous at the ends;
/// outside there are none.
///
/// Tolerance: halving the steps improves the error by a factor 2^order, less a quarter.
#[test]
fn dense_output_is_of_third_order() {
    for method in [
        TableauMethod::Esdirk34,
        TableauMethod::Esdirk46,
        TableauMethod::Esdirk57,
    ] {
        let largest = |steps: f64| {
            let mut one = at_start(&fixed(method, 2.0 / steps));
            let (mut out, mut worst) = ([0.0; 3], [0.0_f64; 3]);
            assert!(one.interpolate(0.0, 0, &mut out).is_err());
            loop {
                let step = one.step(2.0).unwrap();
                one.interpolate(step.time, 0, &mut out).unwrap();
                assert!(out.iter().zip(one.y()).all(|(a, b)| (a - b).abs() < 1e-14));
                one.interpolate(step.time, 1, &mut out).unwrap();
                assert!(out.iter().zip(one.yp()).all(|(a, b)| (a - b).abs() < 1e-12));
                for part in [0.3, 0.5, 0.8] {
                    let t = step.time - part * step.size;
                    let (s, c) = t.sin_cos();
                    one.interpolate(t, 0, &mut out).unwrap();
                    worst[0] = worst[0].max((out[0] - s).abs());
                    worst[1] = worst[1].max((out[2] - s * c).abs());
                    one.interpolate(t, 1, &mut out).unwrap();
                    worst[2] = worst[2].max((out[1] + s).abs());
                }
                assert!(one.interpolate(step.time - 1.5 * step.size, 0, &mut out).is_err());
                assert!(one.interpolate(step.time, 2, &mut out).is_err());
                if step.stopped {
                    return worst;
                }
            }
        };
        let (coarse, fine) = (largest(32.0), largest(64.0));
        for (k, order) in [3.0_f64, 3.0, 2.0].into_iter().enumerate() {
            let gain = coarse[k] / fine[k];
            assert!(
                gain > 0.75 * order.exp2(),
                "{method}, {k}: {:e} {:e}",
                coarse[k],
                fine[k]
            );
        }
    }
}

/// `q' = p, p' = -q` with the integrals of `q²` and of `q p'`.
struct Swing(Pattern);

impl Dae for Swing {
    fn len(&self) -> usize {
        2
    }
    fn differential(&self) -> &[bool] {
        &[true, true]
    }
    fn pattern(&self) -> &Pattern {
        &self.0
    }
    fn residual(&mut self, _: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        residual.copy_from_slice(&[yp[0] - y[1], yp[1] + y[0]]);
        Ok(())
    }
    fn jacobian(
        &mut self,
        _: f64,
        _: &[f64],
        _: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let (a, b) = match seeds {
            Seeds::Step { cj } => ([1.0; 2], [cj; 2]),
            Seeds::Columns { y, yp } => ([y[0], y[1]], [yp[0], yp[1]]),
        };
        values.copy_from_slice(&[b[0], a[0], -a[1], b[1]]);
        Ok(())
    }
    fn integrals(&self) -> usize {
        2
    }
    fn integrands(&mut self, _: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), EvaluationError> {
        out.copy_from_slice(&[y[0] * y[0], y[0] * yp[1]]);
        Ok(())
    }
    fn name(&self, unknown: usize) -> String {
        ["q", "p"][unknown].to_owned()
    }
}

/// Goal: integrals are of the method's order at the ends of steps, of third order within, and start at zero after a restart.
///
/// Tolerances: the order less 0.4; within a step the error of Hermite's cubic, h⁴/384 times a fourth derivative of about 8.
#[test]
fn integrals_are_carried_along() {
    let pattern = || Pattern::from_columns(&[vec![0, 1], vec![0, 1]]);
    for method in TableauMethod::ALL {
        let error = |steps: f64| {
            let h = 2.0 / steps;
            let mut one = OneStep::new(Swing(pattern()), 0.0, &[0.0, 1.0], &[1.0, 0.0], &fixed(method, h)).unwrap();
            let mut out = [0.0; 2];
            let exact = |t: f64| 0.5 * t - 0.25 * (2.0 * t).sin();
            loop {
                let step = one.step(2.0).unwrap();
                one.integrals(None, &mut out).unwrap();
                let end = (out[0] - exact(step.time)).abs().max((out[1] + exact(step.time)).abs());
                let t = step.time - 0.4 * h;
                one.integrals(Some(t), &mut out).unwrap();
                assert!((out[0] - exact(t)).abs() < 2.0 * end + 0.05 * h.powi(4), "{method}");
                if step.stopped {
                    let (t, y, yp) = (one.time(), one.y().to_vec(), one.yp().to_vec());
                    one.restart(t, &y, &yp).unwrap();
                    one.integrals(None, &mut out).unwrap();
                    assert_eq!(out, [0.0; 2]);
                    return end;
                }
            }
        };
        let order = (error(20.0) / error(40.0)).log2();
        assert!(order > f64::from(method.order()) - 0.4, "{method}: {order}");
    }
}

/// Goal: a restarted integrator continues as a new one would, bit for bit; counters continue.
#[test]
fn restarts_forget_the_past() {
    for method in TableauMethod::ALL {
        let mut one = at_start(&tight(method));
        run(&mut one, 1.0);
        let (steps, y, yp) = (one.steps(), one.y().to_vec(), one.yp().to_vec());
        one.restart(1.0, &y, &yp).unwrap();
        let mut new = OneStep::new(circle(), 1.0, &y, &yp, &tight(method)).unwrap();
        run(&mut one, 2.0);
        run(&mut new, 2.0);
        assert_eq!(one.y(), new.y());
        assert_eq!(one.yp(), new.yp());
        let counters = one.counters();
        assert_eq!((counters.restarts, counters.steps), (1, steps + new.steps()));
        assert_eq!(counters.steps_by_order[usize::from(method.order()) - 1], counters.steps);
        assert_eq!(counters.max_order, method.order());
        assert!(counters.residual_evaluations >= counters.newton_iterations);
    }
}

/// Goal: step limits are respected, and impossible requests are rejected with a message.
#[test]
fn options_are_obeyed_or_refused() {
    let options = OneStepOptions {
        max_step: Some(1e-2),
        initial_step: Some(1e-5),
        ..OneStepOptions::default()
    };
    let mut one = at_start(&options);
    assert_eq!(one.step(1.0).unwrap().size, 1e-5);
    while let Ok(step) = one.step(1.0) {
        assert!(step.size <= 1e-2);
        if step.stopped {
            break;
        }
    }
    let refuse = |y: &[f64], options: OneStepOptions, words: &str| {
        let failure = OneStep::new(circle(), 0.0, y, &[0.0; 3], &options).err().unwrap();
        assert!(failure.to_string().contains(words), "{failure}");
    };
    let usual = OneStepOptions::default;
    refuse(&[0.0; 2], usual(), "2 values");
    refuse(&[f64::NAN; 3], usual(), "error weight");
    let relative = 0.0;
    refuse(&[0.0; 3], OneStepOptions { relative, ..usual() }, "relative tolerance");
    let absolute = AbsoluteTolerances::Each(vec![1.0]);
    refuse(&[0.0; 3], OneStepOptions { absolute, ..usual() }, "1 absolute");
    let max_step = Some(-1.0);
    refuse(&[0.0; 3], OneStepOptions { max_step, ..usual() }, "largest step");
}

/// `y' = -1e19 (y - 1)`: relaxes faster than the resolution of time near 1.
struct Instantly(Pattern);

impl Dae for Instantly {
    fn len(&self) -> usize {
        1
    }
    fn differential(&self) -> &[bool] {
        &[true]
    }
    fn pattern(&self) -> &Pattern {
        &self.0
    }
    fn residual(&mut self, _: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        residual[0] = 1e-19 * yp[0] + y[0] - 1.0;
        Ok(())
    }
    fn jacobian(
        &mut self,
        _: f64,
        _: &[f64],
        _: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError> {
        values[0] = match seeds {
            Seeds::Step { cj } => 1.0 + 1e-19 * cj,
            Seeds::Columns { y, yp } => y[0] + 1e-19 * yp[0],
        };
        Ok(())
    }
    fn name(&self, _: usize) -> String {
        "y".into()
    }
}

/// Goal: a start a tenth of the tolerance off, at t = 1: rates of 1e10 1/s require a first step below the last digit of the time. The
/// shortest representable step is used, and L-stability damps the error. Found by random case 44. Tolerance: that of the method.
#[test]
fn what_relaxes_faster_than_time_can_tell_is_no_obstacle() {
    for method in TableauMethod::ALL {
        let dae = Instantly(Pattern::from_columns(&[vec![0]]));
        let mut one = OneStep::new(dae, 1.0, &[1.0 - 1e-9], &[1e10], &tight(method)).unwrap();
        while !one.step(2.0).unwrap().stopped {}
        assert!((one.y()[0] - 1.0).abs() < 1e-7, "{method}: {}", one.y()[0]);
    }
}
