//! `slcbeam mapping`: the paper's tables A.1 and A.2.

use std::process::ExitCode;

use serde_json::{Value, json};

use super::arguments::{MapTable, MappingArguments};
use super::resources;
use crate::error::numbers::rounded;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::model::mapping::network_coordinate;

/// Prints one or both tables as CSV, six significant digits.
pub fn mapping(asked: &MappingArguments) -> Result<ExitCode> {
    let case = resources::load(&asked.case)?;
    let model = Model::new(&case)?;
    let Some(wet) = model.wet.as_ref().filter(|wet| wet.per_row > 0) else {
        return Err(Error::Usage("the case has no bladders: there is nothing to map".into()));
    };
    case.single("mapping")?;
    if !case.spans.is_empty() {
        let what = "the tables map equal segments with equal bladders: they are not available with /spans";
        return Err(Error::Usage(what.into()));
    }
    let map = network_coordinate(&case, wet);
    if asked.json {
        let rows = |rows: Vec<(f64, f64, i64)>, names: [&str; 2]| -> Value {
            rows.iter()
                .map(|(a, b, bladder)| json!({names[0]: a, names[1]: b, "bladder": bladder}))
                .collect()
        };
        let mut all = serde_json::Map::new();
        if asked.table != Some(MapTable::XfToTheta) {
            all.insert("theta_to_xf".into(), rows(map.theta_to_xf(), ["theta_r", "x_f"]));
        }
        if asked.table != Some(MapTable::ThetaToXf) {
            all.insert("xf_to_theta".into(), rows(map.xf_to_theta(), ["x_f", "theta"]));
        }
        super::print(&format!("{:#}\n", Value::Object(all)))?;
        return Ok(ExitCode::SUCCESS);
    }
    let table = |heading: &str, rows: Vec<(f64, f64, i64)>| {
        let mut text = format!("{heading}\n");
        for (a, b, bladder) in rows {
            text += &format!("{},{},{bladder}\n", rounded(a, 6), rounded(b, 6));
        }
        text
    };
    let theta = || table("theta_r,x_f,bladder", map.theta_to_xf());
    let xf = || table("x_f,theta,bladder", map.xf_to_theta());
    super::print(&match asked.table {
        Some(MapTable::ThetaToXf) => theta(),
        Some(MapTable::XfToTheta) => xf(),
        None => format!("{}\n{}", theta(), xf()),
    })?;
    Ok(ExitCode::SUCCESS)
}
