//! Recoverable faults are recovered from, fatal ones are returned verbatim, panics propagate.

use std::panic::{AssertUnwindSafe, catch_unwind};

use slcbeam::dae::EvaluationError;
use slcbeam::integrate::IntegrationError;
use slcbeam::onestep::{OneStep, OneStepOptions};

use crate::problems::{Plain, Residual};

fn solve(residual: Residual) -> Result<OneStep<Plain>, Box<IntegrationError>> {
    let mut one = OneStep::new(
        Plain::new(&[true], residual),
        0.0,
        &[1.0],
        &[-1.0],
        &OneStepOptions::default(),
    )?;
    while !one.step(2.0)?.stopped {}
    Ok(one)
}

/// Goal: recovers from a fault that a shorter step avoids: states below the solution's range are rejected.
#[test]
fn recoverable_faults_shorten_the_step() {
    let one = solve(|t, y, yp, f| {
        f[0] = yp[0] + y[0];
        let far = (y[0] - (-t).exp()).abs() > 1e-4;
        if far {
            Err(EvaluationError::Recoverable("too far away".into()))
        } else {
            Ok(())
        }
    })
    .unwrap();
    // tolerance: the options' 1e-4
    assert!((one.y()[0] - (-2.0_f64).exp()).abs() < 1e-3);
    assert!(one.counters().newton_failures > 0);
}

/// Goal: a fault that no step avoids ends the run with its message, the time and the unknown.
#[test]
fn persistent_faults_end_with_a_diagnosis() {
    let failure = solve(|t, y, yp, f| {
        f[0] = yp[0] + y[0];
        if t > 1.0 {
            Err(EvaluationError::Recoverable("closed".into()))
        } else {
            Ok(())
        }
    })
    .err()
    .unwrap();
    assert!((failure.time - 1.0).abs() < 1e-3 && failure.step < 1e-3);
    assert_eq!(failure.recoverable.as_deref(), Some("closed"));
    let text = failure.to_string();
    assert!(text.contains("too small") && text.contains("closed"), "{text}");

    let failure = solve(|t, y, yp, f| {
        f[0] = yp[0] + y[0] + if t > 1.0 { f64::NAN } else { 0.0 };
        Ok(())
    })
    .err()
    .unwrap();
    let text = failure.to_string();
    assert!(
        text.contains("the equation of y1") && text.contains("y1 is not finite"),
        "{text}"
    );

    // y' = y² with y(0) = 1 ends at t = 1
    let failure = OneStep::new(
        Plain::new(&[true], |_, y, yp, f| {
            f[0] = yp[0] - y[0] * y[0];
            Ok(())
        }),
        0.0,
        &[1.0],
        &[1.0],
        &OneStepOptions::default(),
    )
    .and_then(|mut one| {
        loop {
            if one.step(2.0)?.stopped {
                break Ok(());
            }
        }
    })
    .unwrap_err();
    assert!((failure.time - 1.0).abs() < 1e-2, "{failure}");
    assert!(failure.worst.is_some_and(|w| w.name == "y1"));
}

/// Goal: a column without pivot is named: beyond t = 1 two equations are equal.
#[test]
fn singular_matrices_are_named() {
    let coupled = Plain::new(&[true, true], |t, y, yp, f| {
        f[0] = yp[0] + y[1];
        f[1] = if t > 1.0 { f[0] } else { yp[1] - y[0] };
        Ok(())
    });
    let mut one = OneStep::new(coupled, 0.0, &[1.0, 0.0], &[0.0, 1.0], &OneStepOptions::default()).unwrap();
    let failure = loop {
        match one.step(2.0) {
            Ok(step) => assert!(!step.stopped),
            Err(failure) => break failure,
        }
    };
    assert!(failure.singular.is_some(), "{failure}");
    assert!(failure.to_string().contains("singular in the column of y"), "{failure}");
}

/// Goal: fatal faults end the run at once, verbatim; panics propagate to the caller.
#[test]
fn fatal_faults_and_panics_are_passed_on() {
    let failure = solve(|t, y, yp, f| {
        f[0] = yp[0] + y[0];
        if t > 0.5 {
            Err(EvaluationError::Fatal("out of the model".into()))
        } else {
            Ok(())
        }
    })
    .err()
    .unwrap();
    assert_eq!(failure.to_string(), "out of the model");
    let caught = catch_unwind(AssertUnwindSafe(|| {
        solve(|t, y, yp, f| {
            assert!(t < 0.5, "beyond a half");
            f[0] = yp[0] + y[0];
            Ok(())
        })
        .map(|_| ())
    }));
    let payload = caught.unwrap_err();
    assert_eq!(payload.downcast_ref::<&str>(), Some(&"beyond a half"));
}
