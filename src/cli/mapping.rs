//! `slcbeam mapping`: the paper's tables A.1 and A.2.

use std::process::ExitCode;

use serde_json::{Value, json};

use super::arguments::{MapTable, MappingArguments};
use super::resources;
use crate::error::numbers::rounded;
use crate::error::{Result, usage};
use crate::model::Model;
use crate::model::mapping::network_coordinate;
use crate::output::columns::joined;

/// Prints one or both tables as CSV, six significant digits.
pub fn mapping(asked: &MappingArguments) -> Result<ExitCode> {
    let case = resources::load(&asked.case)?;
    let model = Model::new(&case)?;
    let Some(wet) = model.wet.as_ref().filter(|wet| wet.per_row > 0) else {
        return usage("the case has no bladders: there is nothing to map");
    };
    case.single("mapping")?;
    if !case.spans.is_empty() {
        return usage("the tables map equal segments with equal bladders: they are not available with /spans");
    }
    let map = network_coordinate(&case, wet);
    let (theta, xf) = (map.theta_to_xf(), map.xf_to_theta());
    let all = [
        (MapTable::ThetaToXf, "theta_to_xf", ["theta_r", "x_f"], &theta),
        (MapTable::XfToTheta, "xf_to_theta", ["x_f", "theta"], &xf),
    ];
    let wanted = |table: MapTable| asked.table.is_none_or(|own| own == table);
    let shown = || all.into_iter().filter(|(table, ..)| wanted(*table));
    let value = || {
        let table = shown().map(|(_, name, [a, b], rows)| {
            let row = |(x, y, bladder): &_| json!({a: x, b: y, "bladder": bladder});
            (name.to_owned(), rows.iter().map(row).collect())
        });
        Value::Object(table.collect())
    };
    let text = || {
        let table = shown().map(|(_, _, names, rows)| {
            let row = |(x, y, bladder): &(f64, f64, i64)| format!("{},{},{bladder}\n", rounded(*x, 6), rounded(*y, 6));
            let lines: String = rows.iter().map(row).collect();
            format!("{},bladder\n{lines}", names.join(","))
        });
        joined(table, "\n")
    };
    super::answer(asked.json, value, text)
}
