//! `csv/FIELD.csv`: one row per instant, one column per place, times first.

use std::path::Path;

use super::ExportedFiles;
use super::staged_folder::StagedFolder;
use crate::discrete::quantities::{BeamField, FieldAxis};
use crate::error::Result;
use crate::output::folder::TABLES;
use crate::output::history::HistoryWriter;
use crate::output::numbers::shortest;
use crate::study::compare::{Array, Recording};

/// Writes one table per field into `dir/csv`.
///
/// Columns are `t [s]`, then places: `theta=0.0025 m` along the beam, `bladder=-3 s=0.0115 m` in the fluid, with `s` from the bladder's
/// inlet; in a structure `beam=left theta=0.0025 m` and `bladder=left:-3 s=0.0115 m`. The name of the field, which is also that of the file, contains the unit.
pub fn write(dir: &Path, from: &Recording, instants: &[usize]) -> Result<ExportedFiles> {
    let staged = StagedFolder::new(dir, TABLES)?;
    let mut written = ExportedFiles::new(staged.target().to_path_buf());
    for field in &from.fields {
        let path = staged.path(&format!("{}.csv", field.name));
        let mut names = vec!["t [s]".to_string()];
        names.extend(places(from, field));
        let mut table = HistoryWriter::with_names(&path, names)?;
        for &k in instants {
            let row: Vec<f64> = [from.field_times[k]]
                .into_iter()
                .chain(field.row(k).iter().copied())
                .collect();
            table.row(&row)?;
        }
        written.count(table.secure()?.bytes);
    }
    staged.place(|name| name.ends_with(".csv"))?;
    Ok(written)
}

/// Names of the places of a field: nodes, cells of the beam, or cells of the fluid. The file of arrays does not contain
/// [`crate::run::record::Field::axis`], so length and name of the field decide.
fn places(from: &Recording, field: &Array) -> Vec<String> {
    let fluid = ["pressure_pa", "area_change_m2"].contains(&field.name.as_str());
    if let Some(bladders) = from.axis("bladder").filter(|b| fluid && b.len() == field.len) {
        return in_bladders(from, bladders);
    }
    let [axis, beam] = match BeamField::named(&field.name).map(BeamField::axis) {
        Some(FieldAxis::Cells) => [FieldAxis::Cells, FieldAxis::BeamOfCell],
        _ => [FieldAxis::Nodes, FieldAxis::BeamOfNode],
    };
    let along = |axis: FieldAxis| from.axis(axis.name()).filter(|a| a.len() == field.len);
    let names: Vec<String> = from.labels().beams().map(str::to_owned).collect();
    let beam = |k: usize| {
        let number = along(beam)?[k] as usize;
        Some(format!("beam={} ", names.get(number.checked_sub(1)?)?))
    };
    match along(axis) {
        Some(theta) => theta
            .iter()
            .enumerate()
            .map(|(k, &x)| {
                let of = beam(k);
                // parts of a beam meet in two nodes at a joint
                let again = of.is_some() && k > 0 && theta[k - 1] == x;
                let behind = if again { " behind the joint" } else { "" };
                format!("{}theta={} m{behind}", of.unwrap_or_default(), shortest(x))
            })
            .collect(),
        None => (0..field.len).map(|k| format!("place={k}")).collect(),
    }
}

fn in_bladders(from: &Recording, bladders: &[f64]) -> Vec<String> {
    let first = bladders.iter().take_while(|b| **b == bladders[0]).count().max(1);
    let ds = from.bladder_length().unwrap_or(1.0) / first as f64;
    let labels = from.labels();
    let name = |(k, b): (usize, &f64)| {
        let bladder = labels.of_number(*b as i64);
        format!("bladder={bladder} s={} m", shortest(((k % first) as f64 + 0.5) * ds))
    };
    bladders.iter().enumerate().map(name).collect()
}
