//! `slcbeam coefficients`: the coefficients of a section from its geometry, with errors.

use std::process::ExitCode;

use clap::Args;
use serde_json::{Map, Value, json};
use slcbeam_section::coefficients::{Coefficients, Numbers};
use slcbeam_section::input::Section;
use slcbeam_section::three::Spatial;

use super::arguments::CaseArguments;
use crate::case::{self, section};
use crate::error::{Code, Error, Result, Violation};
use crate::output::columns::aligned;
use crate::output::numbers::significant;

/// `coefficients`.
#[derive(Debug, Args)]
pub struct CoefficientsArguments {
    /// A section, or a case that has one under `section`
    #[command(flatten)]
    pub case: CaseArguments,
    /// Solve the cell in three dimensions too, and say how far the plane one is off
    #[arg(long)]
    pub three_d: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// A number of the table: its key, unit, value, and the place of its compliance, negative where it is a stiffness.
struct Row {
    key: &'static str,
    unit: &'static str,
    value: f64,
    entry: Option<(usize, usize, f64)>,
}

/// Computes and prints.
pub fn coefficients(asked: &CoefficientsArguments) -> Result<ExitCode> {
    let text = case::text(&asked.case.case)?;
    let section = section::parse(&text, &asked.case.case, &asked.case.sets)?;
    let unsolved = |violations: Vec<Violation>| case::Source::of(&asked.case.case, &text).error(violations);
    let found = section::coefficients(&section).map_err(unsolved)?;
    let three = |section: &Section| {
        let failed = |e: slcbeam_section::error::Error| unsolved(vec![Violation::new(Code::Range, "", e.to_string())]);
        section.three_dimensional().map_err(failed)
    };
    // the table is that of the plane cell where the other stands beside it
    let spatial = (asked.three_d && !section.three_d)
        .then(|| three(&section))
        .transpose()?;
    super::print(&match asked.json {
        true => format!("{:#}\n", in_json(&found, spatial.as_ref())?),
        false => in_words(&section, &found, spatial.as_ref())?,
    })?;
    Ok(ExitCode::SUCCESS)
}

fn rows(c: &Numbers) -> Vec<Row> {
    let row = |key, unit, value, entry| Row {
        key,
        unit,
        value,
        entry,
    };
    vec![
        row(
            "axial_stiffness_factor",
            "1",
            c.axial_stiffness_factor,
            Some((0, 0, -1.0)),
        ),
        row(
            "bending_stiffness_factor",
            "1",
            c.bending_stiffness_factor,
            Some((1, 1, -1.0)),
        ),
        row(
            "area_per_pressure_m2_per_pa",
            "m^2/Pa",
            c.area_per_pressure_m2_per_pa,
            Some((2, 2, 1.0)),
        ),
        row(
            "area_per_other_pressure_m2_per_pa",
            "m^2/Pa",
            c.area_per_other_pressure_m2_per_pa,
            Some((2, 3, 1.0)),
        ),
        row(
            "area_per_moment_m2_per_n_m",
            "m^2/(N m)",
            c.area_per_moment_m2_per_n_m,
            Some((1, 2, 1.0)),
        ),
        row(
            "area_per_force_m2_per_n",
            "m^2/N",
            c.area_per_force_m2_per_n,
            Some((0, 2, 1.0)),
        ),
        row(
            "slope_per_pressure_rad",
            "rad",
            c.slope_per_pressure_rad,
            Some((1, 2, 1.0)),
        ),
        row("length_per_pressure_m", "m", c.length_per_pressure_m, Some((0, 2, 1.0))),
        row("shear_stiffness_n", "N", c.shear_stiffness_n, None),
        row("permeability_m4", "m^4", c.permeability_m4, None),
        row("solid_mass_kg_per_m", "kg/m", c.solid_mass_kg_per_m, None),
        row("solid_rotary_inertia_kg_m", "kg m", c.solid_rotary_inertia_kg_m, None),
        row("fluid_volume_per_length_m2", "m^2", c.fluid_volume_per_length_m2, None),
        row("fluid_second_moment_m4", "m^4", c.fluid_second_moment_m4, None),
    ]
}

/// By how much the plane cell is off, relative, and the value in three dimensions, of a number that the plane cell has.
fn in_space(row: &Row, plane: &Numbers, spatial: &Spatial) -> Option<(f64, f64)> {
    let (i, j, sense) = row.entry?;
    let ratio = (spatial.compliance[i][j] / plane.compliance[i][j]).powf(sense);
    Some((ratio.recip() - 1.0, row.value * ratio)).filter(|_| ratio.is_finite() && ratio != 0.0)
}

fn in_json(found: &Coefficients, spatial: Option<&Spatial>) -> Result<Value> {
    let value = |of: &dyn Fn() -> serde_json::Result<Value>| of().map_err(|e| Error::Usage(e.to_string()));
    let mut all = value(&|| serde_json::to_value(&found.numbers))?;
    all["errors"] = value(&|| serde_json::to_value(&found.errors))?;
    all["asymmetry"] = json!(found.asymmetry);
    all["unknowns"] = json!(found.unknowns);
    if let Some(spatial) = spatial {
        let rows = rows(&found.numbers);
        let told = rows.iter().filter_map(|row| {
            let (off, value) = in_space(row, &found.numbers, spatial)?;
            Some((row.key.to_owned(), json!({"value": value, "plane_off": off})))
        });
        all["three_d"] = told.collect::<Map<_, _>>().into();
        all["three_d"]["compliance"] = json!(spatial.compliance);
        all["three_d"]["errors"] = json!(spatial.errors);
        all["three_d"]["unknowns"] = json!(spatial.unknowns);
    }
    Ok(all)
}

fn in_words(section: &Section, found: &Coefficients, spatial: Option<&Spatial>) -> Result<String> {
    let errors = in_json(found, None)?["errors"].take();
    let mut heads = vec!["coefficient", "value", "unit", "error"];
    if spatial.is_some() {
        heads.extend(["in 3-D", "plane off"]);
    }
    let mut lines = vec![heads.into_iter().map(String::from).collect::<Vec<_>>()];
    for row in rows(&found.numbers).iter().filter(|row| row.value != 0.0) {
        let error = errors[row.key].as_f64().map_or("-".into(), |e| format!("{e:.0e}"));
        let mut line = vec![row.key.into(), significant(row.value, 5), row.unit.into(), error];
        if let Some(spatial) = spatial {
            let told = in_space(row, &found.numbers, spatial);
            let told = told.map_or(["-".into(), "-".into()], |(off, value)| {
                [significant(value, 4), format!("{:+.1} %", 100.0 * off)]
            });
            line.extend(told);
        }
        lines.push(line);
    }
    let [n, m, u, l] = found.numbers.compliance;
    let matrix: Vec<Vec<String>> = [n, m, u, l]
        .iter()
        .zip(["stretch", "curvature", "area, upper", "area, lower"])
        .map(|(row, name)| {
            std::iter::once(name.to_owned())
                .chain(row.iter().map(|c| format!("{c:.4e}")))
                .collect()
        })
        .collect();
    let mut heads = vec![vec![
        String::new(),
        "N".into(),
        "M".into(),
        "p upper".into(),
        "p lower".into(),
    ]];
    heads.extend(matrix);
    Ok(format!(
        "section {} m high, {} m wide, a bladder every {} m; E {} Pa, nu {}\n\n{}\ncompliance (areas times l_b/pitch), symmetric to {:.0e}\n\n{}",
        section.height_m,
        section.width_m,
        section.pitch_m,
        section.material.young_modulus_pa,
        section.material.poisson_ratio,
        aligned(&lines, &[0, 2]),
        found.asymmetry,
        aligned(&heads, &[0])
    ))
}
