//! Comparison of an existing run with measured data.

use serde::{Deserialize, Serialize};

use super::outcome::ColumnResiduals;
use crate::case::schema::Case;
use crate::error::{Error, Result};
use crate::study::compare::Recording;
use crate::study::compare::interpolate::cubic;
use crate::study::data::{DataTable, Match, Matched, matching, places};

/// Run compared with data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DataComparison {
    /// Name of the case.
    pub case: String,
    /// Folder of the run.
    pub run: String,
    /// File of the data.
    pub data: String,
    /// Checksum of the data file.
    pub data_crc32: u32,
    /// Columns of the data.
    pub columns: Vec<ComparedColumn>,
}

/// Column of the data compared with a quantity of the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedColumn {
    /// Requested assignment.
    pub matched: Match,
    /// Name of the quantity, without unit.
    pub quantity: String,
    /// Unit of the quantity.
    pub unit: String,
    /// Deviations, run minus data.
    #[serde(flatten)]
    pub left: ColumnResiduals,
    /// Time of the largest deviation [s].
    pub max_at_s: f64,
    /// Instants of the data [s].
    pub times_s: Vec<f64>,
    /// Data, in the unit of the quantity.
    pub measured: Vec<f64>,
    /// Values of the run at these instants, by cubics through its output times.
    pub computed: Vec<f64>,
}

/// Compares a run with data; `data` is the name of the file.
///
/// # Errors
/// Unknown columns, quantities or positions, units that do not match, data before or after the run.
pub fn compare(
    run: &Recording,
    case: Option<&Case>,
    table: &DataTable,
    data: &str,
    matches: &[Match],
    time: Option<&str>,
) -> Result<DataComparison> {
    let names = matches
        .iter()
        .map(|one| placed(one, case))
        .collect::<Result<Vec<_>>>()?;
    let known: Vec<_> = run
        .columns
        .iter()
        .map(|column| (column.name.clone(), column.unit.clone()))
        .collect();
    let matched = matching::resolve(table, matches, &names, &known)?;
    let column = table.time(time)?;
    let instants = table.instants(column)?;
    let (Some(first), Some(last)) = (run.times.first(), run.times.last()) else {
        return Err(Error::Usage(format!("{} has no output times", run.label)));
    };
    let slack = 1e-9 * last.abs();
    let outside = (0..instants.len()).filter(|row| !(first - slack..=last + slack).contains(&instants[*row]));
    let faults = outside.take(1).map(|row| {
        let what = format!("{} s is outside the run ({first} s to {last} s)", instants[row]);
        table.fault(row, column, &what)
    });
    table.sound(faults.collect())?;
    Ok(DataComparison {
        case: run.summary.case.clone(),
        run: run.label.clone(),
        data: data.into(),
        data_crc32: table.crc32,
        columns: matched.iter().map(|one| beside(run, one, &instants)).collect(),
    })
}

fn placed(one: &Match, case: Option<&Case>) -> Result<String> {
    let (Some(place), Some(case)) = (&one.place, case) else {
        return Ok(one.quantity.clone());
    };
    let placed = places::parse_place(case, &one.quantity, place)?;
    match placed.probe {
        None => Ok(placed.name),
        Some(probe) => Err(Error::Usage(format!(
            "--match {}: the run has no record at {} of the length. Add a probe to /probes of its case: {{\"name\": \
             \"{}\", \"at\": {}}}",
            one.describe(),
            probe.at,
            probe.name,
            probe.at
        ))),
    }
}

fn beside(run: &Recording, one: &Matched, instants: &[f64]) -> ComparedColumn {
    let series = &run.columns[one.index];
    let measured = instants
        .iter()
        .zip(&one.values)
        .filter_map(|(t, value)| Some((*t, (*value)?)));
    let (times_s, measured): (Vec<f64>, Vec<f64>) = measured.unzip();
    let computed = times_s.iter().map(|t| cubic(&run.times, *t).mean(|k| series.values[k]));
    let computed: Vec<f64> = computed.collect();
    let far = |k: &usize| (computed[*k] - measured[*k]).abs();
    let most = (0..times_s.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
    ComparedColumn {
        matched: one.asked.clone(),
        quantity: one.name.clone(),
        unit: one.unit.clone(),
        left: ColumnResiduals::compare(&computed, &measured),
        max_at_s: times_s.get(most).copied().unwrap_or_default(),
        times_s,
        measured,
        computed,
    }
}
