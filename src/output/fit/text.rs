//! Text of a fit, and of a run over data.

use crate::error::{listed, visible};
use crate::output::columns::{if_any, table, warnings};
use crate::output::numbers::{counted, duration, percent, quantity, significant};
use crate::study::fit::comparison::DataComparison;
use crate::study::fit::outcome::{Bound, Fit, FittedNumber};
use crate::study::fit::robust::LossFunction;

/// Smallest magnitude of a correlation that is listed.
const NOTABLE: f64 = 0.9;

/// Estimates with their errors, statistics of the residuals, and warnings.
pub fn describe(fit: &Fit) -> String {
    let spent = duration(fit.wall_s);
    let mut text = format!(
        "{} fitted to {} of {}: {}, {}, {spent}\n\n",
        fit.case,
        counted(fit.observations as u64, "value"),
        visible(&fit.data),
        counted(fit.steps as u64, "step"),
        counted(fit.simulations as u64, "simulation")
    );
    let headings = "< | estimate | standard error | <95 % | <bounds";
    text += &table(headings, fit.parameters.iter().map(line));
    text += &correlations(fit);
    let columns = fit.columns.iter().map(|column| {
        let left = &column.left;
        let noise = match column.noise_given {
            true => significant(column.noise, 3),
            false => format!("{} (found)", significant(column.noise, 3)),
        };
        [
            format!("{} over {}", column.quantity, visible(&column.matched.column)),
            left.count.to_string(),
            noise,
            significant(left.rms, 3),
            significant(left.max, 3),
            significant(left.r_squared, 6),
        ]
    });
    text += &format!("\n{}", table("< | values | noise | rms | largest | R²", columns));
    let loss = match fit.loss {
        LossFunction::Squares => "",
        LossFunction::Huber => ", Huber's loss",
        LossFunction::Cauchy => ", Cauchy's loss",
    };
    text += &format!(
        "\nchi-square over degrees of freedom {} over {}{loss}",
        significant(fit.chi_square, 4),
        fit.degrees_of_freedom
    );
    if fit.columns.iter().any(|column| !column.noise_given) {
        text += "; noise estimated from the residuals";
    }
    text.push('\n');
    if fit.starts.len() > 1 {
        text += &starts(fit);
    }
    if let Some(worst) = worst(fit) {
        text += &format!("{worst}\n");
    }
    if !fit.left_alone.is_empty() {
        let names = listed(fit.left_alone.iter().map(String::as_str));
        text += &format!("columns left alone: {names}\n");
    }
    text += &warnings(&fit.warnings);
    text
}

fn line(one: &FittedNumber) -> [String; 5] {
    let short = |x: f64| significant(x, 5);
    let error = one.standard_error.map(|error| significant(error, 3));
    let interval = one
        .interval_95
        .map(|[low, high]| format!("{} to {}", short(low), short(high)));
    let missing = match one.at_bound {
        Some(Bound::Low) => "at its lower bound",
        Some(Bound::High) => "at its upper bound",
        None => "not determined",
    };
    [
        one.pointer.clone(),
        significant(one.value, 6),
        error.unwrap_or_else(|| "-".into()),
        interval.unwrap_or_else(|| missing.into()),
        format!("{} to {}", significant(one.low, 3), significant(one.high, 3)),
    ]
}

fn correlations(fit: &Fit) -> String {
    let mut text = String::new();
    for (i, row) in fit.correlation.iter().enumerate() {
        for (k, r) in row.iter().enumerate().take(i) {
            if let Some(r) = r.filter(|r| r.abs() >= NOTABLE) {
                let [a, b] = [k, i].map(|k| &fit.parameters[k].pointer);
                text += &format!("correlation of {a} and {b}: {}\n", significant(r, 4));
            }
        }
    }
    text
}

/// Number of searches that reached the least sum of squares.
fn starts(fit: &Fit) -> String {
    let found: Vec<f64> = fit.starts.iter().filter_map(|start| start.chi_square).collect();
    let best = found.iter().copied().fold(f64::INFINITY, f64::min);
    let same = found.iter().filter(|cost| **cost <= best * 1.001 + 1e-9).count();
    let failed = if_any(fit.starts.len() - found.len(), |n| {
        format!(", {n} found no simulation that finishes")
    });
    format!(
        "{same} of {} reached the least sum of squares{failed}\n",
        counted(fit.starts.len() as u64, "search")
    )
}

/// The estimate that changes most with a finer simulation, relative to its standard error.
fn worst(fit: &Fit) -> Option<String> {
    let moved = fit
        .parameters
        .iter()
        .filter_map(|one| Some((one, one.finer_change?, one.standard_error?)));
    let (one, change, error) = moved.max_by(|a, b| (a.1.abs() / a.2).total_cmp(&(b.1.abs() / b.2)))?;
    Some(format!(
        "largest change with {}: {} by {} ({} standard errors)",
        fit.simulator.finer,
        one.pointer,
        significant(change, 2),
        significant(change.abs() / error, 2)
    ))
}

/// Table of a run beside data.
pub fn comparison(found: &DataComparison) -> String {
    let headings = "<run less data | values | rms | largest | at | bias | rms, relative | largest, relative | R²";
    let line = |column: &crate::study::fit::comparison::ComparedColumn| {
        let (left, unit) = (&column.left, &column.unit);
        [
            format!("{} over {}", column.quantity, visible(&column.matched.column)),
            left.count.to_string(),
            quantity(left.rms, unit, 3),
            quantity(left.max, unit, 3),
            quantity(column.max_at_s, "s", 3),
            quantity(left.bias, unit, 3),
            percent(left.rms_relative),
            percent(left.max_relative),
            significant(left.r_squared, 4),
        ]
    };
    format!(
        "{} over {}\n\n{}\nrelative to the largest value of the data\n",
        visible(&found.run),
        visible(&found.data),
        table(headings, found.columns.iter().map(line))
    )
}
