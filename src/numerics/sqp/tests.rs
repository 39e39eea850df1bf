use super::*;

const OPTIONS: SqpOptions = SqpOptions {
    steps: 200,
    close: 1e-8,
    noise: 0.0,
};

fn free(value: f64, slope: &[f64]) -> SqpPoint {
    SqpPoint {
        value,
        slope: DVector::from_column_slice(slope),
        inequalities: DVector::zeros(0),
        slopes: DMatrix::zeros(0, slope.len()),
    }
}

/// Source: Rosenbrock (1960), whose valley ends at (1, 1), here 0.5 in both.
fn rosenbrock(x: &[f64]) -> SqpPoint {
    let [a, b] = [4.0 * x[0] - 1.0, 4.0 * x[1] - 1.0];
    let [da, db] = [-400.0 * a * (b - a * a) - 2.0 * (1.0 - a), 200.0 * (b - a * a)];
    free(100.0 * (b - a * a).powi(2) + (1.0 - a).powi(2), &[4.0 * da, 4.0 * db])
}

/// Goal: the search follows a curved valley to its end, also next to points that cannot be evaluated.
#[test]
fn valleys_are_followed_to_their_end() {
    for wall in [2.0, 0.55] {
        let mut count = 0;
        let found = minimise(&[0.0, 0.9], &OPTIONS, &mut |x| {
            count += 1;
            (x[0] < wall).then(|| rosenbrock(x))
        });
        let found = found.expect("a start");
        assert!(found.ended == SqpStatus::Found && found.at.value < 1e-12, "{found:?}");
        assert!(count < 120, "{count}");
    }
    assert!(minimise(&[0.0, 0.9], &OPTIONS, &mut |_| None).is_none());
}

/// Source: Rosen & Suzuki (Hock & Schittkowski 43): -44 at (0, 1, 2, -1), two of three inequalities active with multipliers 1 and 2.
#[test]
fn inequalities_are_held() {
    let problem = |z: &[f64]| {
        let y: Vec<f64> = z.iter().map(|z| 10.0 * z - 5.0).collect();
        let [a, b, c, d] = [y[0], y[1], y[2], y[3]];
        let slope = [2.0 * a - 5.0, 2.0 * b - 5.0, 4.0 * c - 21.0, 2.0 * d + 7.0];
        let squares = a * a + b * b + c * c + d * d;
        Some(SqpPoint {
            value: a * a + b * b + 2.0 * c * c + d * d - 5.0 * a - 5.0 * b - 21.0 * c + 7.0 * d,
            slope: DVector::from_column_slice(&slope) * 10.0,
            inequalities: DVector::from_vec(vec![
                squares + a - b + c - d - 8.0,
                squares + b * b + d * d - a - d - 10.0,
                squares + a * a - d * d + 2.0 * a - b - d - 5.0,
            ]),
            slopes: DMatrix::from_row_slice(
                3,
                4,
                &[
                    [2.0 * a + 1.0, 2.0 * b - 1.0, 2.0 * c + 1.0, 2.0 * d - 1.0],
                    [2.0 * a - 1.0, 4.0 * b, 2.0 * c, 4.0 * d - 1.0],
                    [4.0 * a + 2.0, 2.0 * b - 1.0, 2.0 * c, -1.0],
                ]
                .concat(),
            ) * 10.0,
        })
    };
    for start in [[0.5; 4], [1.0; 4], [0.0, 1.0, 0.0, 1.0]] {
        let found = minimise(&start, &OPTIONS, &mut |x| problem(x)).expect("a start");
        assert!(found.ended == SqpStatus::Found, "{start:?}: {found:?}");
        let off = |of: &[f64], wanted: &[f64]| of.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off(&found.x, &[0.5, 0.6, 0.7, 0.4]) < 1e-6, "{start:?}: {found:?}");
        assert!(off(&found.multipliers, &[1.0, 0.0, 2.0]) < 1e-4, "{start:?}: {found:?}");
    }
}

/// Goal: a variable that would leave its bounds stays at a bound, with its multiplier; contradictory inequalities are
/// reported.
#[test]
fn bounds_hold_and_contradictions_are_told() {
    let plane = |x: &[f64]| free(x[0] + (x[1] - 0.25).powi(2), &[1.0, 2.0 * (x[1] - 0.25)]);
    let found = minimise(&[0.7, 0.9], &OPTIONS, &mut |x| Some(plane(x))).expect("a start");
    assert!(found.x[0] == 0.0 && (found.x[1] - 0.25).abs() < 1e-7, "{found:?}");
    assert!(
        (found.at_bounds[0] + 1.0).abs() < 1e-9 && found.at_bounds[1].abs() < 1e-6,
        "{found:?}"
    );
    // x0 >= 0.8 and x0 <= 0.2
    let apart = |x: &[f64]| SqpPoint {
        inequalities: DVector::from_vec(vec![0.8 - x[0], x[0] - 0.2]),
        slopes: DMatrix::from_row_slice(2, 2, &[-1.0, 0.0, 1.0, 0.0]),
        ..plane(x)
    };
    let found = minimise(&[0.7, 0.9], &OPTIONS, &mut |x| Some(apart(x))).expect("a start");
    assert!(
        found.ended == SqpStatus::Apart && found.at.violation() > 0.5,
        "{found:?}"
    );
}

/// Goal: errors of 1e-5 in the values do not prevent convergence to a stationary point.
#[test]
fn errors_of_values_are_passed_over() {
    let options = SqpOptions {
        noise: 2e-5,
        close: 1e-5,
        ..OPTIONS
    };
    let bowl = |x: &[f64]| {
        let off = 1e-5 * (1e7 * x[0]).sin();
        free(1.0 + (x[0] - 0.3).powi(2) + off, &[2.0 * (x[0] - 0.3)])
    };
    let found = minimise(&[0.9], &options, &mut |x| Some(bowl(x))).expect("a start");
    assert!(
        found.ended == SqpStatus::Found && (found.x[0] - 0.3).abs() < 1e-5,
        "{found:?}"
    );
}

/// Source: Maratos (1978): along a curved limit full steps raise objective and violation, arbitrarily close to the
/// minimum. Without second-order correction, halved steps needed a thousand designs.
#[test]
fn curved_limits_are_followed() {
    let problem = |x: &[f64]| {
        let [a, b] = [2.0 * x[0], 2.0 * x[1]];
        let round = a * a + b * b - 1.0;
        SqpPoint {
            value: -a - 10.0 * round,
            slope: DVector::from_column_slice(&[-2.0 - 40.0 * a, -40.0 * b]),
            inequalities: DVector::from_vec(vec![round]),
            slopes: DMatrix::from_row_slice(1, 2, &[4.0 * a, 4.0 * b]),
        }
    };
    for start in [[0.05, 0.495], [0.3, 0.4], [0.2, 0.2]] {
        let mut count = 0;
        let found = minimise(&start, &OPTIONS, &mut |x| {
            count += 1;
            Some(problem(x))
        });
        let found = found.expect("a start");
        assert!(
            (found.x[0] - 0.5).abs() < 1e-5 && found.x[1].abs() < 1e-3,
            "{count}: {found:?}"
        );
        assert!(count < 60, "{start:?}: {count}");
    }
}
