//! `uncertainty.json` beside the result of any command that has figures; its text and its table.

use serde_json::{Value, json};

use super::bands;
use super::columns::{aligned, if_any, joined, warnings};
use super::folder::ResultFolder;
use super::numbers::{count, counted, percent, significant};
use crate::error::Result;
use crate::results;
use crate::results::uncertainty::{FigureSpread, UncertainInput, Uncertainty};

/// Name of the file.
pub const UNCERTAINTY: &str = "uncertainty.json";

/// Writes the file into a folder.
///
/// # Errors
/// The file cannot be written.
pub fn write(folder: &ResultFolder, found: &Uncertainty) -> Result<()> {
    folder.write(UNCERTAINTY, results::text(found).as_bytes()).map(|_| ())
}

/// Largest number of digits of the ends of a band in a table.
const MOST_DIGITS: usize = 6;

/// Headings of the table of figures.
const HEADINGS: [&str; 7] = [
    "figure",
    "value",
    "numerical error",
    "sd, first order",
    "sd, samples",
    "95 % of samples",
    "mostly by",
];

/// Figures of a quantity, in order of preference. The table shows the first that exists; the file contains all.
const PREFERRED: [&str; 5] = ["max_abs", "mean", "frequency_hz", "window", "final"];

/// Table of one figure of each quantity that spreads, and warnings.
pub fn describe(found: &Uncertainty) -> String {
    // of a multiplier growth is shown: the drive may fix its frequency
    let foremost: &[&str] = if found.command == "floquet" {
        &["growth_per_s"]
    } else {
        &PREFERRED
    };
    let mut lines = vec![HEADINGS.map(String::from).to_vec()];
    let shown = found.figures.iter().filter(|(name, one)| {
        let first = name.rsplit_once('.').is_none_or(|(quantity, own)| {
            let there = |figure: &&&str| found.figures.contains_key(&format!("{quantity}.{figure}"));
            foremost.iter().find(there).is_none_or(|first| *first == own)
        });
        first && one.sd > 0.0
    });
    lines.extend(shown.map(|(name, one)| row(name, one, &found.inputs).to_vec()));
    let others = 1 + found.figures.len() - lines.len();
    let table = match lines.len() {
        1 => "no figure depends on the uncertain numbers\n".into(),
        _ => aligned(&lines, &[0, 6]),
    };
    let mut text = format!("{}\n{table}", about(found));
    if others > 0 {
        let figures = if others == 1 { "figure" } else { "figures" };
        text += &format!("{others} more {figures} in {UNCERTAINTY}\n");
    }
    if let Some(why) = &found.no_first_order {
        text += &format!("no first order: {why}\n");
    }
    text + &warnings(&found.warnings)
}

/// Heading of the table: inputs and samples.
fn about(found: &Uncertainty) -> String {
    let inputs = found.inputs.iter();
    let inputs = inputs.map(|one| format!("{} = {}", one.pointer, one.distribution));
    let finished = if_any(found.samples - found.finished, |lost| {
        format!(", {} of which did not finish", count(lost as u64))
    });
    format!(
        "Uncertainty from {}, by {}{finished} (seed {}):",
        joined(inputs, ", "),
        counted(found.samples as u64, "sample"),
        found.seed
    )
}

/// The cells of a figure.
fn row(name: &str, one: &FigureSpread, inputs: &[UncertainInput]) -> [String; 7] {
    let size = one.value.abs();
    // no relative numbers for a value of 0
    let relative = |x: f64| match size {
        0.0 => significant(x, 2),
        _ => percent(x / size),
    };
    let digits = match one.sd > 0.0 {
        true => bands::digits(one.low, one.high).clamp(4, MOST_DIGITS),
        false => 4,
    };
    let plus = |x: Option<f64>| x.map_or("–".into(), |x| format!("± {}", relative(x)));
    [
        name.into(),
        significant(one.value, 4),
        plus(one.numerical_error),
        plus(one.first_order.as_ref().map(|first| first.sd)),
        plus(Some(one.sd)),
        format!("{} … {}", significant(one.low, digits), significant(one.high, digits)),
        mostly(one, inputs).unwrap_or_default(),
    ]
}

/// Input with the largest share of the variance: by Sobol's total index, else by derivatives.
fn mostly(one: &FigureSpread, inputs: &[UncertainInput]) -> Option<String> {
    if one.sd == 0.0 {
        return None;
    }
    let shares: Vec<f64> = match (&one.indices, &one.first_order) {
        (Some(indices), _) => indices.iter().map(|index| index.total).collect(),
        (None, Some(first)) => first.shares.clone(),
        (None, None) => return None,
    };
    let (k, share) = shares.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    Some(format!("{} {}", inputs.get(k)?.pointer, percent(share.clamp(0.0, 1.0))))
}

/// Section of a page.
pub fn section(found: &Uncertainty) -> Value {
    let rows = found.figures.iter();
    let rows: Vec<_> = rows.map(|(name, one)| row(name, one, &found.inputs)).collect();
    let mut tables = vec![json!({
        "title": null,
        "about": "Standard deviations and the numerical error are relative to the figure of the case itself. First order: from \
                  derivatives at the means. Samples: from simulations with random values of the uncertain numbers.",
        "headings": HEADINGS, "rows": rows, "file": UNCERTAINTY,
    })];
    let mut indices = vec![];
    for (name, one) in &found.figures {
        for (input, i) in found.inputs.iter().zip(one.indices.iter().flatten()) {
            indices.push(json!([
                name,
                input.pointer,
                i.first,
                i.first_error,
                i.total,
                i.total_error
            ]));
        }
    }
    if !indices.is_empty() {
        tables.push(json!({
            "title": "Shares of the variance",
            "about": "Sobol's indices: share of the variance due to a number alone, and including its interactions with other \
                      numbers; each with its standard error.",
            "headings": ["figure", "number", "alone", "± standard error", "with others", "± standard error"],
            "rows": indices, "file": null,
        }));
    }
    let no_first_order = found.no_first_order.iter();
    let no_first_order = no_first_order.map(|why| format!("There is no first order: {why}."));
    let notes: Vec<String> = no_first_order.chain(found.warnings.iter().cloned()).collect();
    json!({"about": about(found).trim_end_matches(':'), "tables": tables, "notes": notes})
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::uncertainty::FirstOrder;

    #[test]
    fn nothing_that_spreads_is_said() {
        let found = Uncertainty {
            case: "case".into(),
            command: "run".into(),
            inputs: vec![],
            samples: 16,
            finished: 16,
            unfinished: Default::default(),
            seed: 1,
            figures: Default::default(),
            no_first_order: None,
            warnings: vec![],
        };
        assert!(describe(&found).contains("no figure depends on the uncertain numbers"));
    }

    #[test]
    fn a_figure_is_told_beside_its_errors() {
        let input = |pointer: &str| UncertainInput {
            pointer: pointer.into(),
            distribution: "normal:1:0.1".into(),
            mean: 1.0,
            sd: 0.1,
        };
        let spread = FigureSpread {
            value: -2.0,
            numerical_error: Some(0.002),
            first_order: Some(FirstOrder {
                sd: 0.1,
                shares: vec![0.2, 0.8],
            }),
            samples: 64,
            mean: -2.0,
            sd: 0.11,
            sd_error: 0.01,
            low: -2.2,
            high: -1.8,
            indices: None,
        };
        let cells = row("q.final", &spread, &[input("/a"), input("/b")]);
        let expected = [
            "q.final",
            "-2.000",
            "± 0.100 %",
            "± 5.00 %",
            "± 5.50 %",
            "-2.200 … -1.800",
            "/b 80.0 %",
        ];
        assert_eq!(cells.map(|cell| cell.replace('−', "-")), expected);
    }
}
