//! How the error of a reduced model falls with the number that decides.

use super::common::{Run, difference};

/// Errors of pairs of runs, one pair for each number, must fall with the given power of the number.
pub fn falls(what: &str, numbers: &[f64], power: f64, slack: f64, pair: impl Fn(f64) -> (Run, Run), column: &str) {
    let errors: Vec<f64> = numbers
        .iter()
        .map(|&number| {
            let (reduced, full) = pair(number);
            difference(&reduced.column(column), &full.column(column))
        })
        .collect();
    for k in 1..numbers.len() {
        let order = (errors[k - 1] / errors[k]).ln() / (numbers[k - 1] / numbers[k]).ln();
        println!(
            "{what}: {:.1e} and {:.1e} at {:.1e} and {:.1e}: order {order:.3}",
            errors[k - 1],
            errors[k],
            numbers[k - 1],
            numbers[k]
        );
        assert!((order - power).abs() < slack, "{what}: order {order} is not {power}");
    }
}
