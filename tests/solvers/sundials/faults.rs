//! Recoverable faults are recovered from, fatal ones are returned verbatim, panics propagate.

use std::panic::{AssertUnwindSafe, catch_unwind};

use slcbeam::dae::{Dae, EvaluationError, Seeds};
use slcbeam::integrate::{AbsoluteTolerances, IntegrationError};
use slcbeam::sparse::Pattern;
use slcbeam::sundials::Ida;
use slcbeam::sundials::IdaOptions;

/// `y' = -y` with hooks in the residual and the Jacobian.
struct Decay<R, J> {
    pattern: Pattern,
    residual: R,
    jacobian: J,
}

/// Decay with a faulty residual.
fn decay<R, J>(residual: R, jacobian: J) -> Ida<Decay<R, J>>
where
    R: FnMut(f64, f64) -> Result<f64, EvaluationError>,
    J: FnMut() -> Result<f64, EvaluationError>,
{
    let options = IdaOptions {
        relative: 1e-5,
        absolute: AbsoluteTolerances::Same(1e-8),
        ..IdaOptions::default()
    };
    let dae = Decay {
        pattern: Pattern::from_columns(&[vec![0]]),
        residual,
        jacobian,
    };
    Ida::new(dae, 0.0, &[1.0], &[-1.0], &options).unwrap()
}

impl<R, J> Dae for Decay<R, J>
where
    R: FnMut(f64, f64) -> Result<f64, EvaluationError>,
    J: FnMut() -> Result<f64, EvaluationError>,
{
    fn len(&self) -> usize {
        1
    }

    fn differential(&self) -> &[bool] {
        &[true]
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError> {
        residual[0] = yp[0] + y[0] + (self.residual)(t, y[0])?;
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
        let factor = (self.jacobian)()?;
        values[0] = match seeds {
            Seeds::Step { cj } => factor * (1.0 + cj),
            Seeds::Columns { y, yp } => factor * (y[0] + yp[0]),
        };
        Ok(())
    }

    fn name(&self, _: usize) -> String {
        "charge".to_owned()
    }
}

/// Residuals that succeed a number of times, then always return `bad`.
fn after(
    calls: u32,
    bad: impl Fn() -> Result<f64, EvaluationError>,
) -> impl FnMut(f64, f64) -> Result<f64, EvaluationError> {
    let mut call = 0;
    move |_, _| {
        call += 1;
        if call > calls { bad() } else { Ok(0.0) }
    }
}

/// Integrates to t = 1 in at most a thousand steps.
fn to_one<D: Dae>(ida: &mut Ida<D>) -> Result<f64, Box<IntegrationError>> {
    for _ in 0..1000 {
        if ida.step(1.0)?.stopped {
            return Ok(ida.y()[0]);
        }
    }
    panic!("more than a thousand steps");
}

/// Twelve evaluations that fail or return NaN do not affect the answer.
///
/// Goal: `e⁻¹`, and failures counted. Tolerance: local 1e-5 over some hundred steps stays below 1e-3.
#[test]
fn recoverable_faults_are_recovered_from() {
    let mut calls = 0;
    let hiccup = move |_: f64, _: f64| {
        calls += 1;
        match calls % 40 {
            20 => Err(EvaluationError::Recoverable("hiccup".to_owned())),
            30 => Ok(f64::NAN),
            _ => Ok(0.0),
        }
    };
    let mut ida = decay(hiccup, || Ok(1.0));
    let end = to_one(&mut ida).unwrap();
    assert!((end - (-1.0_f64).exp()).abs() < 1e-3, "{end}");
    assert!(ida.counters().newton_failures + ida.counters().residual_evaluations > 40);
}

/// Goal: a fault that no step cures ends the run with the last message of the equations and the time reached.
#[test]
fn persistent_recoverable_fault_is_told() {
    let torn = after(60, || Err(EvaluationError::Recoverable("the valve is torn".to_owned())));
    let mut ida = decay(torn, || Ok(1.0));
    let failure = to_one(&mut ida).unwrap_err();
    assert_eq!(failure.recoverable.as_deref(), Some("the valve is torn"));
    assert!(failure.time > 0.0 && failure.time < 1.0, "{failure:?}");
    assert!(failure.to_string().contains("however short the step"), "{failure}");
    assert_eq!(ida.time(), failure.time);
    // the last good state remains
    assert!(
        (ida.y()[0] - (-failure.time).exp()).abs() < 1e-3,
        "{:?} {failure:?}",
        ida.y()
    );
}

/// Goal: values that are not finite name the equation.
#[test]
fn values_that_are_not_finite_name_the_equation() {
    let mut ida = decay(after(60, || Ok(f64::INFINITY)), || Ok(1.0));
    let failure = to_one(&mut ida).unwrap_err();
    assert!(
        failure
            .recoverable
            .as_deref()
            .unwrap()
            .contains("equation of charge gives inf"),
        "{failure}"
    );
    let mut ida = decay(|_, _| Ok(0.0), || Ok(f64::NAN));
    let failure = to_one(&mut ida).unwrap_err();
    assert!(
        failure
            .recoverable
            .as_deref()
            .unwrap()
            .contains("equation of charge by charge"),
        "{failure}"
    );
}

/// Goal: a singular matrix names the unknown; it ends the run only after shorter steps were tried.
#[test]
fn singular_matrix_names_the_unknown() {
    let mut calls = 0;
    let mut ida = decay(
        |_, _| Ok(0.0),
        move || {
            calls += 1;
            Ok(if calls == 1 { 0.0 } else { 1.0 })
        },
    );
    assert!(to_one(&mut ida).is_ok(), "the first factorisation may fail");
    let mut ida = decay(|_, _| Ok(0.0), || Ok(0.0));
    let failure = to_one(&mut ida).unwrap_err();
    assert_eq!(failure.singular.as_deref(), Some("charge"), "{failure:?}");
    assert!(ida.counters().factorizations >= 10);
}

/// Goal: a fatal fault is returned verbatim, from the residual and from the Jacobian.
#[test]
fn fatal_faults_come_back_word_for_word() {
    let words = "bladder 3: pressure below vacuum, α = 1.5";
    let mut ida = decay(
        move |t, _| {
            if t > 0.5 {
                Err(EvaluationError::Fatal(words.to_owned()))
            } else {
                Ok(0.0)
            }
        },
        || Ok(1.0),
    );
    let failure = to_one(&mut ida).unwrap_err();
    assert_eq!(failure.to_string(), words);
    assert_eq!(failure.fatal.as_deref(), Some(words));
    let mut ida = decay(|_, _| Ok(0.0), move || Err(EvaluationError::Fatal(words.to_owned())));
    assert_eq!(to_one(&mut ida).unwrap_err().to_string(), words);
}

/// Goal: a panic passes through the C code with its payload; the integrator can be dropped afterwards.
#[test]
fn panics_go_on_with_their_payload() {
    #[derive(Debug, PartialEq)]
    struct Payload(u32);
    let mut ida = decay(
        |t, _| {
            if t > 0.5 {
                std::panic::resume_unwind(Box::new(Payload(42)));
            }
            Ok(0.0)
        },
        || Ok(1.0),
    );
    let payload = catch_unwind(AssertUnwindSafe(|| to_one(&mut ida))).unwrap_err();
    assert_eq!(payload.downcast_ref(), Some(&Payload(42)));
    drop(ida);
    let mut ida = decay(|_, _| Ok(0.0), || std::panic::resume_unwind(Box::new("jacobian")));
    let payload = catch_unwind(AssertUnwindSafe(|| to_one(&mut ida))).unwrap_err();
    assert_eq!(payload.downcast_ref(), Some(&"jacobian"));
}
