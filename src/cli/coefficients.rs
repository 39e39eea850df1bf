//! `slcbeam coefficients`: the coefficients of a section from its geometry, with errors.

use std::process::ExitCode;

use clap::Args;
use serde_json::{Map, Value, json};
use slcbeam_section::coefficients::{Coefficients, Numbers};
use slcbeam_section::finite::StrainEnergy;
use slcbeam_section::input::Section;
use slcbeam_section::three::Spatial;

use super::arguments::CaseArguments;
use super::interrupt::WallArguments;
use crate::case::{self, section};
use crate::error::{Error, Result};
use crate::output::columns::table;
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
    /// Limit of wall time.
    #[command(flatten)]
    pub wall: WallArguments,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// A number of the table with its error. `entry` is the place of its compliance, and the power, which is negative for a stiffness.
struct Row {
    key: &'static str,
    unit: &'static str,
    value: f64,
    error: f64,
    entry: Option<(usize, usize, f64)>,
}

/// Computes and prints the coefficients.
pub fn coefficients(asked: &CoefficientsArguments) -> Result<ExitCode> {
    let text = case::text(&asked.case.case)?;
    // while standard input is read, Ctrl-C still ends the program
    asked.wall.flag();
    let mut written = section::parse(&text, &asked.case.case, &asked.case.sets)?;
    // beside the cell in three dimensions, the table shows the plane cell
    written.section.three_d &= !asked.three_d;
    let found = written.coefficients()?;
    let energy = written.strain_energy()?;
    let spatial = asked.three_d.then(|| written.three_dimensional()).transpose()?;
    super::print(&match asked.json {
        true => format!("{:#}\n", in_json(&found, spatial.as_ref(), energy.as_ref())?),
        false => in_words(&written.section, &found, spatial.as_ref()) + &energy.map(of_energy).unwrap_or_default(),
    })?;
    Ok(ExitCode::SUCCESS)
}

fn rows(found: &Coefficients) -> Vec<Row> {
    macro_rules! rows {
        ($($key:ident $unit:literal $entry:expr;)*) => {
            vec![$(Row {
                key: stringify!($key),
                unit: $unit,
                value: found.numbers.$key,
                error: found.errors.$key,
                entry: $entry,
            },)*]
        };
    }
    rows! {
        axial_stiffness_factor "1" Some((0, 0, -1.0));
        bending_stiffness_factor "1" Some((1, 1, -1.0));
        area_per_pressure_m2_per_pa "m^2/Pa" Some((2, 2, 1.0));
        area_per_other_pressure_m2_per_pa "m^2/Pa" Some((2, 3, 1.0));
        area_per_moment_m2_per_n_m "m^2/(N m)" Some((1, 2, 1.0));
        area_per_force_m2_per_n "m^2/N" Some((0, 2, 1.0));
        slope_per_pressure_rad "rad" Some((1, 2, 1.0));
        length_per_pressure_m "m" Some((0, 2, 1.0));
        shear_stiffness_n "N" None;
        permeability_m4 "m^4" None;
        solid_mass_kg_per_m "kg/m" None;
        solid_rotary_inertia_kg_m "kg m" None;
        fluid_volume_per_length_m2 "m^2" None;
        fluid_second_moment_m4 "m^4" None;
    }
}

/// Relative error of the plane cell, and the value in three dimensions, of a number that the plane cell has.
fn in_space(row: &Row, plane: &Numbers, spatial: &Spatial) -> Option<(f64, f64)> {
    let (i, j, sense) = row.entry?;
    let ratio = (spatial.compliance[i][j] / plane.compliance[i][j]).powf(sense);
    Some((ratio.recip() - 1.0, row.value * ratio)).filter(|_| ratio.is_finite() && ratio != 0.0)
}

/// Text about the energy at finite strain.
fn of_energy(energy: StrainEnergy) -> String {
    let names = [
        "stretch [1]",
        "curvature [1/m]",
        "pressure, upper [Pa]",
        "pressure, lower [Pa]",
    ];
    let rows = names.into_iter().zip(energy.limits);
    let rows = rows.map(|(name, [low, high])| [name.to_owned(), significant(low, 4), significant(high, 4)]);
    format!(
        "\nenergy at finite strain beyond the quadratic part: degree {}, error of its slopes {:.0e}, valid within the \
         ellipsoid of\n\n{}",
        energy.degree,
        energy.error,
        table("< | from | to", rows)
    )
}

fn in_json(found: &Coefficients, spatial: Option<&Spatial>, energy: Option<&StrainEnergy>) -> Result<Value> {
    let value = |of: &dyn Fn() -> serde_json::Result<Value>| of().map_err(|e| Error::Usage(e.to_string()));
    let mut all = value(&|| serde_json::to_value(&found.numbers))?;
    all["errors"] = value(&|| serde_json::to_value(&found.errors))?;
    all["asymmetry"] = json!(found.asymmetry);
    all["unknowns"] = json!(found.unknowns);
    if let Some(energy) = energy {
        all["strain_energy"] = value(&|| serde_json::to_value(energy))?;
    }
    if let Some(spatial) = spatial {
        let in_three_d = rows(found).into_iter().filter_map(|row| {
            let (off, value) = in_space(&row, &found.numbers, spatial)?;
            Some((row.key.to_owned(), json!({"value": value, "plane_off": off})))
        });
        all["three_d"] = in_three_d.collect::<Map<_, _>>().into();
        all["three_d"]["compliance"] = json!(spatial.compliance);
        all["three_d"]["errors"] = json!(spatial.errors);
        all["three_d"]["unknowns"] = json!(spatial.unknowns);
    }
    Ok(all)
}

fn in_words(section: &Section, found: &Coefficients, spatial: Option<&Spatial>) -> String {
    let mut headings = "<coefficient | value | <unit | error".to_owned();
    if spatial.is_some() {
        headings += " | in 3-D | plane off";
    }
    let mut lines = vec![];
    for row in rows(found).iter().filter(|row| row.value != 0.0) {
        let mut line = vec![
            row.key.into(),
            significant(row.value, 5),
            row.unit.into(),
            format!("{:.0e}", row.error),
        ];
        if let Some(spatial) = spatial {
            let pair = in_space(row, &found.numbers, spatial);
            let cells = pair.map_or(["-".into(), "-".into()], |(off, value)| {
                [significant(value, 4), format!("{:+.1} %", 100.0 * off)]
            });
            line.extend(cells);
        }
        lines.push(line);
    }
    let names = ["stretch", "curvature", "area, upper", "area, lower"];
    let matrix = names.into_iter().zip(found.numbers.compliance).map(|(name, row)| {
        let numbers = row.iter().map(|c| format!("{c:.4e}"));
        std::iter::once(name.to_owned()).chain(numbers).collect::<Vec<_>>()
    });
    format!(
        "section {} m high, {} m wide, a bladder every {} m; E {} Pa, nu {}\n\n{}\ncompliance (areas times l_b/pitch), symmetric to {:.0e}\n\n{}",
        section.height_m,
        section.width_m,
        section.pitch_m,
        section.material.young_modulus_pa,
        section.material.poisson_ratio,
        table(&headings, lines),
        found.asymmetry,
        table("< | N | M | p upper | p lower", matrix)
    )
}
